#include "scenes/import/fbx/read_fbx.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "core/base/error.h"
#include "scenes/character/pose.h"
#include "scenes/import/fbx/animation.h"
#include "scenes/import/fbx/curve.h"
#include "scenes/import/fbx/mesh.h"
#include "scenes/import/fbx/model_transform.h"
#include "scenes/import/fbx/morphs.h"
#include "scenes/import/fbx/objects.h"
#include "scenes/import/fbx/skin.h"
#include "scenes/polygon/cut_polygon.h"

namespace cscd::scenes {
namespace {

using namespace fbx;

// Returns the frame rate that the number of a TimeMode stands for; nothing where it stands for none.
std::optional<double> frames_per_second(const Objects& objects) {
  constexpr double kTelevision = 30000.0 / 1001, kFilm = 24000.0 / 1001, kFine = 60000.0 / 1001;
  constexpr double kRates[] = {0,  120, 100,  60,    50, 48, 30, 30,    kTelevision, kTelevision,
                               25, 24,  1000, kFilm, 0,  96, 72, kFine, 2 * kFine};
  constexpr double kCustom = 14, kMost = 1e5;  // beyond, a custom rate is a mistake
  const double mode = objects.setting("TimeMode").value_or(0);
  double rate = 0;
  if (mode == kCustom)
    rate = objects.setting("CustomFrameRate").value_or(0);
  else if (mode >= 0 && mode < static_cast<double>(std::size(kRates)))
    rate = kRates[static_cast<std::size_t>(mode)];
  return rate > 0 && rate <= kMost ? std::optional(rate) : std::nullopt;
}

class Builder {
 public:
  Builder(const Document& document, const CharacterLimits& limits) : objects_(document), limits_(limits) {}

  Character build() {
    character_.frames_per_second = frames_per_second(objects_);
    clips_ = read_clips(objects_, limits_, clip_left_out_);
    for (const Clip& clip : clips_) note_animated(clip);
    add_nodes();
    rest_ = rest_pose(character_);
    for (const Object* model : in_order_) add_parts(*model);
    for (const Clip& clip : clips_) {
      // Programs write an empty stack for a take that holds nothing.
      if (clip.models.empty() && clip.shapes.empty())
        ++empty_clips_;
      else
        add_animation(clip);
    }
    const double unit = objects_.setting("UnitScaleFactor").value_or(1);
    character_.centimetres_per_unit = std::isfinite(unit) && unit > 0 ? unit : 0;
    character_.format = "FBX";
    character_.up = up_axis();
    add_notes();
    return std::move(character_);
  }

 private:
  // Files say by a number which axis points up, and by a sign which of its ends. Empty where they do not.
  std::string up_axis() const {
    const double axis = objects_.setting("UpAxis").value_or(-1);
    if (axis != 0 && axis != 1 && axis != 2) return {};
    const bool down = objects_.setting("UpAxisSign").value_or(1) < 0;
    return std::string(down ? "-" : "") + "xyz"[static_cast<int>(axis)];
  }

  void note_animated(const Clip& clip) {
    for (const auto& [model, motion] : clip.models) {
      Animated& animated = animated_[model];
      animated.move |= !motion.moves.empty();
      animated.turn |= !motion.turns.empty();
      if (motion.scales.empty()) continue;
      animated.scale = true;
      animated.uniform_scale &= is_uniform(motion.scales);
    }
  }

  static bool same(const Curve& a, const Curve& b) {
    const auto same_keys = [](const Key<double>& p, const Key<double>& q) {
      return p.time == q.time && p.value == q.value && p.next == q.next && p.arriving == q.arriving &&
             p.leaving == q.leaving;
    };
    return std::equal(a.keys.begin(), a.keys.end(), b.keys.begin(), b.keys.end(), same_keys) &&
           a.beyond.before == b.beyond.before && a.beyond.after == b.beyond.after &&
           a.beyond.repeats_before == b.beyond.repeats_before &&
           a.beyond.repeats_after == b.beyond.repeats_after;
  }
  static bool is_uniform(const Components<3>& scales) {
    const auto& axis = scales.axis;
    if (!axis[0].empty() && same(axis[0], axis[1]) && same(axis[0], axis[2])) return true;
    double value[3];
    for (std::size_t k = 0; k < 3; ++k) {
      if (!is_level(axis[k])) return false;
      value[k] = axis[k].empty() ? scales.rest[k] : axis[k].keys.front().value;
    }
    return value[0] == value[1] && value[1] == value[2];
  }
  static bool is_uniform(const Layered<3>& scales) {
    return is_uniform(scales.base) &&
           std::all_of(scales.above.begin(), scales.above.end(),
                       [](const Layer<3>& layer) { return is_uniform(layer.values); });
  }

  // Returns the model that a model hangs on, or null for the scene.
  const Object* parent_of(const Object& model) const {
    const Object* parent = nullptr;
    bool found = false;
    for (const Connection& connection : objects_.out_of(model)) {
      const bool node = connection.destination == nullptr || connection.destination->type == "Model";
      if (!node || !connection.property.empty()) continue;
      if (found && connection.destination != parent)
        throw InputError(told("node", model) + ": hangs on two nodes; export it again");
      parent = connection.destination;
      found = true;
    }
    return parent;
  }

  // Adds the nodes, parents first, as the file connects them. Works without recursion: a file may nest
  // deeper than the stack allows.
  void add_nodes() {
    character_.nodes.push_back({"RootNode", -1, {}});
    const std::vector<const Object*> models = objects_.all("Model");
    if (models.size() > limits_.nodes)
      throw InputError("has more than " + std::to_string(limits_.nodes) + " nodes; simplify the model");
    std::map<const Object*, std::vector<const Object*>> children;
    std::set<const Object*> placed;  // files may state twice where a node hangs
    for (const Object* model : models)
      if (parent_of(*model) == nullptr) children[nullptr].push_back(model);
    for (const Object* model : models)
      for (const Object* child : objects_.sources(*model, "Model"))
        if (placed.insert(child).second) children[model].push_back(child);
    std::vector<std::pair<const Object*, const Object*>> open;  // a model and its parent
    const auto open_children = [&](const Object* parent) {
      const std::vector<const Object*>& list = children[parent];
      for (std::size_t i = list.size(); i-- > 0;) open.emplace_back(list[i], parent);
    };
    std::map<const Object*, Chain> chains{{nullptr, Chain{}}};
    open_children(nullptr);
    while (!open.empty()) {
      const auto [model, parent] = open.back();
      open.pop_back();
      chains[model] =
          add_model(character_, model->name, read_transform(*model), animated_[model], chains[parent]);
      in_order_.push_back(model);
      open_children(model);
    }
    if (in_order_.size() < models.size())
      throw InputError("has " + std::to_string(models.size() - in_order_.size()) +
                       " nodes that hang on each other in a circle; export it again");
    for (const auto& [model, chain] : chains)
      if (model != nullptr) {
        chains_[model] = chain;
        node_of_[model] = chain.last;
      }
  }

  // Adds the surfaces that hang on a model.
  void add_parts(const Object& model) {
    for (const Object* geometry : objects_.sources(model, "Geometry")) {
      if (geometry->subtype == "Mesh")
        add_part(model, *geometry);
      else
        ++other_surfaces_;
    }
  }

  void add_part(const Object& model, const Object& geometry) {
    const Object* skin = skin_of(objects_, geometry);
    const Mesh& mesh = mesh_of(geometry);
    for (const Object* deformer : objects_.sources(geometry, "Deformer"))
      other_deformers_ += deformer->subtype != "Skin" && deformer->subtype != "BlendShape";
    if (character_.parts.size() >= limits_.parts || vertices_ + mesh.positions.size() > limits_.vertices ||
        triangles_ + mesh.triangles.size() > limits_.triangles)
      throw InputError(told("mesh", geometry) + ": is more than the " + std::to_string(limits_.parts) +
                       " meshes, " + std::to_string(limits_.vertices) + " vertices or " +
                       std::to_string(limits_.triangles) +
                       " triangles that are supported; simplify the model");
    vertices_ += mesh.positions.size();
    triangles_ += mesh.triangles.size();
    Part part;
    part.name = geometry.name.empty() ? model.name : geometry.name;
    part.node = node_of_.at(&model);
    part.positions = mesh.positions;
    part.triangles = mesh.triangles;
    part.mesh = number_of(geometry);
    part.primitive = 0;
    const Transform geometry_map = geometric_transform(model),
                    mesh_at_rest = rest_[static_cast<std::size_t>(part.node)];
    const Transform identity;
    if (geometry_map.column != identity.column || geometry_map.origin != identity.origin) {
      character_.nodes.push_back({model.name + " (geometry)", part.node, geometry_map});
      part.node = static_cast<int>(character_.nodes.size()) - 1;
    }
    read_skin(objects_, skin, {node_of_, geometry_map, mesh_at_rest}, limits_, part, skin_left_out_);
    const bool follows_bones_alone =
        skin != nullptr && std::adjacent_find(part.first.begin(), part.first.end()) == part.first.end();
    if (follows_bones_alone && !skinned_.insert(&geometry).second) {
      ++again_;
      return;
    }
    shapes_.push_back(read_shapes(objects_, geometry, limits_, part));
    character_.parts.push_back(std::move(part));
  }

  const Mesh& mesh_of(const Object& geometry) {
    const auto found = meshes_.find(&geometry);
    if (found != meshes_.end()) return found->second;
    const Mesh& mesh = meshes_.emplace(&geometry, read_mesh(geometry, limits_)).first->second;
    lines_ += mesh.lines;
    overlapping_ += mesh.overlapping;
    return mesh;
  }

  int number_of(const Object& geometry) const {
    int number = 0;
    for (const Object* other : objects_.all("Geometry")) {
      if (other == &geometry) break;
      number += other->subtype == "Mesh";
    }
    return number;
  }

  // Adds a vector to a value that layers make. A layer that adds to those below does not change what they
  // were shifted by; a layer that mixes has to be shifted with them.
  static Layered<3> shifted(Layered<3> layered, const Vec3& by) {
    const auto shift = [&by](Components<3>& components) {
      for (std::size_t k = 0; k < 3; ++k) {
        components.axis[k] = scaled(std::move(components.axis[k]), 1, by[static_cast<int>(k)]);
        components.rest[k] += by[static_cast<int>(k)];
      }
    };
    shift(layered.base);
    for (Layer<3>& layer : layered.above)
      if (layer.blend == LayerBlend::mix) shift(layer.values);
    return layered;
  }

  void add_animation(const Clip& clip) {
    Animation animation;
    animation.name = clip.name;
    animation.start = clip.start;
    animation.seconds = clip.seconds;
    // Without a rate, ticks serve as frames: the file's times are in FBX's own ticks in any case.
    animation.ticks_per_second = character_.frames_per_second.value_or(objects_.ticks_per_second());
    for (const Object* model : in_order_) {
      const auto found = clip.models.find(model);
      if (found == clip.models.end()) continue;
      const Motion& motion = found->second;
      const Chain& chain = chains_.at(model);
      const ModelTransform transform = read_transform(*model);
      if (!motion.moves.empty())
        channel(animation, chain.moves).move_components = shifted(motion.moves, transform.before);
      if (!motion.turns.empty()) channel(animation, chain.turns).angles = {motion.turns, transform.order};
      if (!motion.scales.empty()) channel(animation, chain.scales).scale_components = motion.scales;
    }
    animation.layer_weights = clip.layer_weights;
    add_morphs(clip, animation);
    character_.animations.push_back(std::move(animation));
  }

  // Returns the channel of a node, and adds it if there is none. The parts of one model follow one another,
  // so only the last three channels are searched.
  static Channel& channel(Animation& animation, int node) {
    const std::size_t count = animation.channels.size();
    for (std::size_t i = count; i-- > 0 && i + 3 >= count;)
      if (animation.channels[i].node == node) return animation.channels[i];
    Channel& added = animation.channels.emplace_back();
    added.node = node;
    return added;
  }

  void add_morphs(const Clip& clip, Animation& animation) {
    for (std::size_t p = 0; p < shapes_.size(); ++p) {
      MorphChannel morph{static_cast<int>(p), std::vector<Layered<1>>(shapes_[p].size())};
      bool any = false;
      for (std::size_t t = 0; t < shapes_[p].size(); ++t) {
        const auto found = clip.shapes.find({shapes_[p][t].owner, shapes_[p][t].property});
        if (found == clip.shapes.end() || found->second.empty()) continue;
        count_copied(found->second);
        morph.weights[t] = found->second;
        any = true;
      }
      if (any) animation.morphs.push_back(std::move(morph));
    }
  }

  // The keys of a channel are copied for each of its shapes, which a small file can make many.
  void count_copied(const Layered<1>& driven) {
    for_each_curve(driven, [this](const Curve& curve) { copied_keys_ += curve.keys.size(); });
    if (copied_keys_ > limits_.keys)
      throw InputError("has more than " + std::to_string(limits_.keys) +
                       " animation keys of blend shapes; resample it");
  }

  void add_notes() {
    const auto note = [this](std::size_t count, const char* what) {
      if (count > 0) character_.notes.push_back(std::to_string(count) + " " + what);
    };
    note(lines_, "points and lines left out");
    note(overlapping_, kOverlapping);
    note(other_surfaces_, "curves, patches and other surfaces that are no polygons left out");
    note(again_, "meshes that several nodes share taken once, as their joints place them");
    note(other_deformers_, "deformers that are neither skins nor blend shapes not applied");
    note(empty_clips_, "clips that animate nothing left out");
    note(objects_.all("Constraint").size(), "constraints not applied");
    note(clip_left_out_.keys, "keys ignored that repeat the key before");
    note(clip_left_out_.ends, "animation curves go on in an unknown way, and hold beyond their keys");
    note(clip_left_out_.layers, "muted animation layers ignored");
    note(skin_left_out_.weights, "weights not positive or without a bone ignored");
  }

  const Objects objects_;
  const CharacterLimits& limits_;
  Character character_;
  std::vector<Clip> clips_;
  std::map<const Object*, Animated> animated_;
  std::map<const Object*, Chain> chains_;
  std::map<const Object*, int> node_of_;  // the last node of each model
  std::vector<const Object*> in_order_;   // models in the order of their nodes
  Pose rest_;
  std::map<const Object*, Mesh> meshes_;
  std::set<const Object*> skinned_;  // geometries placed by bones alone that already have a part
  std::vector<std::vector<ShapeChannel>> shapes_;               // [parts]
  std::size_t vertices_ = 0, triangles_ = 0, copied_keys_ = 0;  // counts so far
  LeftOut clip_left_out_;
  SkinLeftOut skin_left_out_;
  std::size_t lines_ = 0, overlapping_ = 0, other_surfaces_ = 0, again_ = 0, empty_clips_ = 0,
              other_deformers_ = 0;
};

}  // namespace

Character read_fbx(std::string_view bytes, const CharacterLimits& limits) {
  const Document document = parse(bytes);
  return Builder(document, limits).build();
}

}  // namespace cscd::scenes
