#include "scenes/import/collada.h"

#include <cmath>
#include <cstdlib>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <string_view>

#include "core/base/error.h"

namespace cscd::scenes {
namespace {

// Keys that lie at most this many seconds apart stand for the curve between them: 1/60 s, with room for how
// times are rounded.
constexpr double kDense = 1.0 / 60 + 1e-4;

std::string_view after_hash(std::string_view url) {
  return url.starts_with('#') ? url.substr(1) : url;
}

std::vector<std::string> words_of(const char* text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::vector<double> numbers_of(const char* text) {
  std::vector<double> numbers;
  for (char* end = nullptr;; text = end) {
    const double number = std::strtod(text, &end);
    if (end == text) return numbers;
    numbers.push_back(number);
  }
}

// Calls `visit` for every element, without recursion: a file may nest deeper than the stack allows.
template <class Visit>
void walk(pugi::xml_node root, const Visit& visit) {
  struct Walker final : pugi::xml_tree_walker {
    const Visit& visit;
    explicit Walker(const Visit& v) : visit(v) {}
    bool for_each(pugi::xml_node& node) override {
      visit(node);
      return true;
    }
  } walker(visit);
  root.traverse(walker);
}

class Collada {
 public:
  explicit Collada(const pugi::xml_document& document) : root_(document.child("COLLADA")) {
    walk(root_, [this](pugi::xml_node element) {
      if (const pugi::xml_attribute id = element.attribute("id")) by_id_.try_emplace(id.value(), element);
    });
    count_nodes();
  }

  void require_clear_joints() const {
    for (const pugi::xml_node library : root_.children("library_controllers"))
      for (const pugi::xml_node controller : library.children("controller")) {
        const pugi::xml_node joints = controller.child("skin").child("joints");
        for (const pugi::xml_node array : source_of(joints, "JOINT").children())
          if (array.name() == std::string_view("Name_array") ||
              array.name() == std::string_view("IDREF_array"))
            for (const std::string& joint : words_of(array.child_value()))
              if (fits(joint) > 1)
                throw InputError("bone '" + joint + "': several nodes have this name; rename all but one");
      }
  }

  std::vector<std::string> notes_on_keys() const {
    std::size_t dense = 0;
    for (const pugi::xml_node library : root_.children("library_animations"))
      walk(library, [&](pugi::xml_node element) {
        if (element.name() == std::string_view("channel")) dense += check_channel(element);
      });
    if (dense == 0) return {};
    return {
        std::to_string(dense) +
        " animation channels of keys joined by curves or steps are read as straight lines; their keys are at "
        "most 1/60 s apart"};
  }

 private:
  // Counts the names and ids of the nodes that the scene shows or can take from the library.
  void count_nodes() {
    const std::string scene(
        after_hash(root_.child("scene").child("instance_visual_scene").attribute("url").value()));
    const auto count = [this](pugi::xml_node element) {
      if (element.name() != std::string_view("node")) return;
      const std::string id = element.attribute("id").value(), name = element.attribute("name").value(),
                        sid = element.attribute("sid").value();
      ++named_[id];
      if (name != id) ++named_[name];
      ++by_sid_[sid];
      if (!id.empty()) ++nodes_[id];
    };
    for (const pugi::xml_node library : root_.children("library_visual_scenes"))
      for (const pugi::xml_node visual : library.children("visual_scene"))
        if (scene.empty() || scene == visual.attribute("id").value()) walk(visual, count);
    for (const pugi::xml_node library : root_.children("library_nodes")) walk(library, count);
  }

  static std::size_t counted(const std::map<std::string, std::size_t>& counts, const std::string& word) {
    const auto found = counts.find(word);
    return found == counts.end() ? 0 : found->second;
  }

  // Returns how many nodes assimp would take for a joint: those whose id or name fits, or, if there are
  // none, those whose scoped id fits.
  std::size_t fits(const std::string& joint) const {
    const std::size_t named = counted(named_, joint);
    return named > 0 ? named : counted(by_sid_, joint);
  }

  pugi::xml_node target_of(std::string_view url) const {
    const auto found = by_id_.find(std::string(after_hash(url)));
    return found == by_id_.end() ? pugi::xml_node() : found->second;
  }

  // The source named by the input of `owner` that has this meaning.
  pugi::xml_node source_of(pugi::xml_node owner, std::string_view meaning) const {
    for (const pugi::xml_node input : owner.children("input"))
      if (input.attribute("semantic").value() == meaning) return target_of(input.attribute("source").value());
    return {};
  }

  // Tells whether the channel moves a node by dense keys that are joined by other than straight lines.
  bool check_channel(pugi::xml_node channel) const {
    const std::string target = channel.attribute("target").value();
    const std::string node = target.substr(0, target.find('/'));
    const std::size_t nodes = counted(nodes_, node);
    if (nodes == 0) return false;
    if (nodes > 1)
      throw InputError("animated node '" + node + "': several nodes have this id; rename all but one");
    const pugi::xml_node sampler = target_of(channel.attribute("source").value());
    const std::vector<std::string> kinds =
        words_of(source_of(sampler, "INTERPOLATION").child("Name_array").child_value());
    const auto values = [&](const char* meaning) {
      return numbers_of(source_of(sampler, meaning).child("float_array").child_value());
    };
    const std::vector<double> times = values("INPUT"), outputs = values("OUTPUT"),
                              leaving = values("OUT_TANGENT"), arriving = values("IN_TANGENT");
    bool bent = false;
    for (std::size_t i = 0; i + 1 < times.size() && i < kinds.size(); ++i) {
      if (kinds[i] == "LINEAR" || stands_still(kinds[i], i, times.size(), outputs, leaving, arriving))
        continue;
      bent = true;
      if (!(times[i + 1] - times[i] <= kDense))
        throw InputError("animation channel '" + target + "': its keys are joined by " + kinds[i] +
                         ", which is not read; bake the animation to 60 keys a second on export");
    }
    return bent;
  }

  // Tells whether a segment keeps one value all the way, so that it is straight however its keys are joined.
  static bool stands_still(const std::string& kind, std::size_t key, std::size_t keys,
                           const std::vector<double>& outputs, const std::vector<double>& leaving,
                           const std::vector<double>& arriving) {
    const std::size_t numbers = outputs.size() / keys;
    if (numbers == 0) return false;
    for (std::size_t k = 0; k < numbers; ++k)
      if (outputs[numbers * key + k] != outputs[numbers * (key + 1) + k]) return false;
    if (kind == "STEP") return true;
    // Where there is one value, tangents of Bezier curves are points in the plane of time and value.
    if (kind != "BEZIER" || numbers != 1 || leaving.size() != 2 * keys || arriving.size() != 2 * keys)
      return false;
    return leaving[2 * key + 1] == outputs[key] && arriving[2 * (key + 1) + 1] == outputs[key];
  }

  pugi::xml_node root_;
  std::map<std::string, pugi::xml_node> by_id_;
  std::map<std::string, std::size_t> named_, by_sid_;  // how many nodes have an id or a name; a scoped id
  std::map<std::string, std::size_t> nodes_;           // how many nodes have an id
};

}  // namespace

std::vector<std::string> notes_on_collada(const std::string& xml) {
  pugi::xml_document document;
  if (!document.load_buffer(xml.data(), xml.size())) return {};
  const Collada collada(document);
  collada.require_clear_joints();
  return collada.notes_on_keys();
}

}  // namespace cscd::scenes
