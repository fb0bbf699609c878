#include <algorithm>

#include "core/base/error.h"
#include "core/base/number_text.h"
#include "scenes/import/collada/parts.h"

namespace cscd::scenes::collada {
namespace {

// Keys that lie at most this many seconds apart stand for the curve between them: 1/60 s, with room for how
// times are rounded.
constexpr double kDense = 1.0 / 60 + 1e-4;

// The most numbers that assimp has room for in a key.
constexpr std::size_t kMostInKey = 16;

std::size_t counted(const std::map<std::string, std::size_t>& counts, const std::string& word) {
  const auto found = counts.find(word);
  return found == counts.end() ? 0 : found->second;
}

// How many numbers a key has for what stands behind the name of a transform and is read there: all its
// numbers, one by its name, or one of a matrix. 0 for what is not read.
std::size_t numbers_of_member(std::string_view transform, std::string_view member) {
  if (member.empty()) return numbers_of_transform(transform);
  if (member == ".ANGLE") return transform == "rotate";
  if (member == ".X" || member == ".Y" || member == ".Z") return transform != "matrix";
  const auto digit = [&](std::size_t at) { return member[at] >= '0' && member[at] <= '3'; };
  return transform == "matrix" && member.size() == 6 && member[0] == '(' && digit(1) &&
         member.substr(2, 2) == ")(" && digit(4) && member[5] == ')';
}

std::string told_channel(pugi::xml_node channel) {
  return "animation channel '" + std::string(channel.attribute("target").value()) + "'";
}

// The numbers of a sampler's keys.
struct Keys {
  std::vector<double> times, outputs, leaving, arriving;
};

class Animations {
 public:
  explicit Animations(const Document& document) : document_(document) { count_nodes(); }

  void require_clear_joints() const {
    for (const pugi::xml_node library : document_.root().children("library_controllers"))
      for (const pugi::xml_node controller : library.children("controller")) {
        const pugi::xml_node joints = controller.child("skin").child("joints");
        for (const pugi::xml_node array : document_.source_of(joints, "JOINT").children())
          if (array.name() == std::string_view("Name_array") ||
              array.name() == std::string_view("IDREF_array"))
            for (const std::string_view word : words_of(array))
              if (const std::string joint(word); fits(joint) > 1)
                throw InputError("bone '" + joint + "': several nodes have this name; rename all but one");
      }
  }

  std::vector<std::string> notes_on_channels() const {
    std::size_t dense = 0;
    std::vector<pugi::xml_node> others;
    for (const pugi::xml_node library : document_.root().children("library_animations"))
      walk(library, [&](pugi::xml_node element) {
        if (element.name() != std::string_view("channel")) return;
        if (const std::size_t numbers = numbers_moved(element); numbers > 0)
          dense += check_channel(element, numbers);
        else
          others.push_back(element);
      });
    std::vector<std::string> notes;
    if (dense > 0)
      notes.push_back(std::to_string(dense) +
                      " animation channels of keys joined by curves or steps are read as straight lines; "
                      "their keys are at most 1/60 s apart");
    // assimp takes some of them for channels of nodes whose ids are alike.
    for (pugi::xml_node channel : others) channel.parent().remove_child(channel);
    if (!others.empty())
      notes.push_back(std::to_string(others.size()) +
                      " animation channels move no node of the scene and are ignored");
    return notes;
  }

 private:
  // Counts the names and ids of the nodes that the scene shows or can take from the library.
  void count_nodes() {
    const auto count = [this](pugi::xml_node element) {
      if (element.name() != std::string_view("node")) return;
      const std::string id = element.attribute("id").value(), name = element.attribute("name").value(),
                        sid = element.attribute("sid").value();
      ++named_[id];
      if (name != id) ++named_[name];
      ++by_sid_[sid];
      if (id.empty()) return;
      Node& node = nodes_[id];
      ++node.count;
      node.element = element;
    };
    const std::string scene = document_.scene().attribute("id").value();
    for (const pugi::xml_node library : document_.root().children("library_visual_scenes"))
      for (const pugi::xml_node visual : library.children("visual_scene"))
        if (scene.empty() || scene == visual.attribute("id").value()) walk(visual, count);
    for (const pugi::xml_node library : document_.root().children("library_nodes")) walk(library, count);
  }

  // Returns how many nodes assimp would take for a joint: those whose id or name fits, or, if there are
  // none, those whose scoped id fits.
  std::size_t fits(const std::string& joint) const {
    const std::size_t named = counted(named_, joint);
    return named > 0 ? named : counted(by_sid_, joint);
  }

  // How many numbers of a node of the scene the channel moves. assimp drops channels that move none without
  // a word, so what they name has to exist and to have no bearing on positions, as a camera has none.
  std::size_t numbers_moved(pugi::xml_node channel) const {
    const std::string target = channel.attribute("target").value(), where = told_channel(channel);
    const std::size_t slash = target.find('/');
    const std::string id = target.substr(0, slash);
    const auto found = nodes_.find(id);
    if (found == nodes_.end()) {
      // Without a slash, a member such as (0) follows the id.
      const pugi::xml_node other =
          document_.target_of(slash == target.npos ? id.substr(0, id.find('(')) : id);
      if (id.empty() || !other)
        throw InputError(where + ": no element of the file has the id '" + id +
                         "'; repair it or export the file again");
      for (pugi::xml_node above = other; above; above = above.parent())
        if (above.name() == std::string_view("geometry") || above.name() == std::string_view("controller"))
          throw InputError(where + ": moves a " + above.name() +
                           " itself, which is not read; bake the animation on export");
      return 0;
    }
    if (found->second.count > 1)
      throw InputError("animated node '" + id + "': several nodes have this id; rename all but one");
    const std::string_view moved = slash == target.npos ? "" : std::string_view(target).substr(slash + 1);
    const std::size_t member = std::min(moved.find_first_of(".("), moved.size());
    const std::string sid(moved.substr(0, member));
    std::size_t numbers = 0;
    if (sid.empty() || sid.find('/') == sid.npos) {
      const Moved what = sid.empty() ? Moved{} : moved_in(found->second.element, sid);
      if (!what.is_there)
        throw InputError(where + ": node '" + id + "' has no transform with the sid '" + sid +
                         "'; repair it or export the file again");
      if (what.transform.empty()) return 0;
      numbers = numbers_of_member(what.transform, moved.substr(member));
    }
    if (numbers == 0)
      throw InputError(where +
                       ": moves a part of a transform that is not read; bake the animation on export");
    // assimp looks for members from the front of the whole target.
    if (id.find('(') != id.npos || std::ranges::count(target, '.') > 1)
      throw InputError(where + ": points and brackets in the id of the node hide what is moved; rename it");
    return numbers;
  }

  // What a channel moves: a transform, by the name of its element, or something else that is there.
  struct Moved {
    bool is_there = false;
    std::string transform = {};
  };

  // What a node itself has under a scoped id: a transform, or something else, such as its visibility.
  static Moved moved_in(pugi::xml_node node, const std::string& sid) {
    Moved what;
    for (const pugi::xml_node child : node.children()) {
      if (child.name() == std::string_view("node")) continue;
      if (child.attribute("sid").value() == sid && numbers_of_transform(child.name()) > 0)
        return {true, child.name()};
      bool has = child.attribute("sid").value() == sid;
      walk(child, [&](pugi::xml_node part) { has |= part.attribute("sid").value() == sid; });
      what.is_there = what.is_there || has;
    }
    return what;
  }

  // Tells whether the channel of a node, which moves so many numbers, has dense keys that are joined by other
  // than straight lines.
  bool check_channel(pugi::xml_node channel, std::size_t numbers) const {
    const std::string where = told_channel(channel);
    const pugi::xml_node sampler = document_.target_of(channel.attribute("source").value());
    if (sampler.parent() != channel.parent())
      throw InputError(where + ": its sampler is not in the same <animation>; export it again");
    const std::vector<std::string_view> kinds =
        words_of(document_.source_of(sampler, "INTERPOLATION").child("Name_array"));
    const bool straight = std::ranges::all_of(kinds, [](std::string_view kind) { return kind == "LINEAR"; });
    const Keys keys = read_keys(sampler, numbers, !straight, where);
    bool bent = false;
    for (std::size_t i = 0; i + 1 < keys.times.size() && i < kinds.size(); ++i) {
      if (kinds[i] == "LINEAR" || stands_still(kinds[i], i, keys)) continue;
      bent = true;
      if (!(keys.times[i + 1] - keys.times[i] <= kDense))
        throw InputError(where + ": its keys are joined by " + std::string(kinds[i]) +
                         ", which is not read; bake the animation to 60 keys a second on export");
    }
    return bent;
  }

  Keys read_keys(pugi::xml_node sampler, std::size_t numbers, bool with_tangents,
                 const std::string& where) const {
    Keys keys;
    std::optional<Source> times, outputs;
    try {
      times = document_.numbers_of_source(sampler, "INPUT");
      outputs = document_.numbers_of_source(sampler, "OUTPUT");
    } catch (const InputError& error) {
      throw InputError(where + ": " + error.what());
    }
    if (!times || !outputs || times->stride != 1 || times->offset != 0 ||
        times->count != times->numbers.size() || times->count != outputs->count ||
        outputs->stride > kMostInKey)
      throw InputError(where +
                       ": its times and values are missing or do not fit each other; export it again");
    if (outputs->stride != numbers)
      throw InputError(where + ": has " + many(outputs->stride, "number") + " a key, and what it moves has " +
                       std::to_string(numbers) + "; export it again");
    keys.times = std::move(times->numbers);
    keys.outputs = std::move(outputs->numbers);
    const auto falls = std::ranges::adjacent_find(keys.times, [](double a, double b) { return !(a < b); });
    if (falls != keys.times.end())
      throw InputError(where + ": the time of key " + std::to_string(falls - keys.times.begin() + 1) +
                       " (counted from 0) is not after that of the key before; resample the animation");
    if (!with_tangents) return keys;
    const auto tangents = [&](const char* meaning) -> std::vector<double> {
      const pugi::xml_node array = document_.source_of(sampler, meaning).child("float_array");
      return array ? numbers_of(array) : std::vector<double>();
    };
    keys.leaving = tangents("OUT_TANGENT");
    keys.arriving = tangents("IN_TANGENT");
    return keys;
  }

  // Tells whether a segment keeps one value all the way, so that it is straight however its keys are joined.
  static bool stands_still(std::string_view kind, std::size_t key, const Keys& keys) {
    const std::size_t count = keys.times.size(), numbers = keys.outputs.size() / count;
    if (numbers == 0) return false;
    for (std::size_t k = 0; k < numbers; ++k)
      if (keys.outputs[numbers * key + k] != keys.outputs[numbers * (key + 1) + k]) return false;
    if (kind == "STEP") return true;
    // Where there is one value, tangents of Bezier curves are points in the plane of time and value.
    if (kind != "BEZIER" || numbers != 1 || keys.leaving.size() != 2 * count ||
        keys.arriving.size() != 2 * count)
      return false;
    return keys.leaving[2 * key + 1] == keys.outputs[key] &&
           keys.arriving[2 * (key + 1) + 1] == keys.outputs[key];
  }

  const Document& document_;
  std::map<std::string, std::size_t> named_, by_sid_;  // how many nodes have an id or a name; a scoped id
  struct Node {
    std::size_t count = 0;
    pugi::xml_node element;
  };
  std::map<std::string, Node> nodes_;  // by id: how many have it, and one of them
};

}  // namespace

std::vector<std::string> check_animations(const Document& document) {
  const Animations animations(document);
  animations.require_clear_joints();
  return animations.notes_on_channels();
}

}  // namespace cscd::scenes::collada
