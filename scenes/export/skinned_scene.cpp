#include "scenes/export/skinned_scene.h"

#include <algorithm>

#include "core/base/error.h"
#include "scenes/clip/digest.h"
#include "scenes/export/glb.h"

namespace cscd::scenes {
namespace {

// A bone is rigid if its map differs from a rotation by at most this. Maps of bones are products of many
// rotations, which are orthogonal only to some 1e-7 where limbs are long. Near the bone, that error moves a
// vertex by less than single precision rounds off.
constexpr double kRigid = 1e-6;

void require_linear(const Scene& scene) {
  const std::string last = scene.effects.empty() ? "none" : scene.effects.back().name;
  if (last != "skinning_linear")
    throw InputError("scene " + scene.name + ": its last effect is " + last +
                     ", so its vertices are not where linear blending of its bones (skinning_linear) takes "
                     "them, which is all that a skin in a model file can say; export it as .h5");
}

// Refuses scenes that could be written and then not be read back.
void require_readable(const Scene& scene, std::size_t bones) {
  const CharacterLimits limits;
  if (scene.frames > limits.frames || scene.frames * bones > limits.keys / 2)
    throw InputError("scene " + scene.name + ": " + std::to_string(scene.frames) + " frames of " +
                     std::to_string(bones) +
                     " bones are more keys than are read back from a model file; export it as .h5");
}

// Collects a character from the states of a scene.
class Recorder {
 public:
  explicit Recorder(const Scene& scene) : scene_(scene) {
    character_.format = "scene";
    character_.nodes.push_back({scene.name, -1, from_trs(Vec3::Zero(), turn_to_y(scene.up), Vec3::Ones())});
    character_.animations.push_back({scene.name, 0, 0, 0, {}});
  }

  void add(const SceneState& state) {
    if (frames_ == 0) {
      require_readable(scene_, state.shape.rig.parent.size());
      add_surface(state.shape);
    }
    const double seconds = static_cast<double>(frames_++) / kExportedFps;
    character_.animations[0].seconds = seconds;
    world_.clear();
    for (std::size_t bone = 0; bone < state.bones.size(); ++bone) add_keys(state, bone, seconds);
  }

  Character take() { return std::move(character_); }

 private:
  // The node of a bone stands at the bone's head and has the world's axes at rest.
  void add_surface(const Shape& shape) {
    Part part;
    part.name = character_.nodes[0].name;
    part.node = 0;
    for (std::size_t bone = 0; bone < shape.rig.parent.size(); ++bone) {
      const Vec3& head = shape.rig.reference[bone].head;
      const BoneId parent = shape.rig.parent[bone];
      const bool root = parent == BoneId{-1};
      const int node = static_cast<int>(bone) + 1;
      Transform local, offset;
      local.origin = root ? head : Vec3(head - shape.rig.reference[+parent].head);
      offset.origin = -head;
      character_.nodes.push_back({shape.bone_names[bone], root ? 0 : static_cast<int>(parent) + 1, local});
      character_.animations[0].channels.push_back({node, {}, {}, {}});
      part.joints.push_back({node, offset});
    }
    // The surface's node gets a name that no bone has, because some readers know nodes by their names.
    while (std::ranges::count(character_.nodes, character_.nodes[0].name, &Node::name) > 1)
      character_.nodes[0].name += "_surface";
    part.positions = shape.positions;
    for (const Triangle& t : shape.triangles)
      part.triangles.push_back({static_cast<std::int32_t>(t[0]), static_cast<std::int32_t>(t[1]),
                                static_cast<std::int32_t>(t[2])});
    for (const JointWeights& weights : shape.weights) {
      if (!weights.has_bones())
        throw InputError("scene " + scene_.name +
                         ": its cloth has no bones, and every vertex of a skin needs one; export it as .h5");
      part.first.push_back(part.influences.size());
      for (std::size_t k = 0; k < JointWeights::most && weights.bone[k] != BoneId{-1}; ++k)
        part.influences.push_back({static_cast<int>(weights.bone[k]), weights.weight[k]});
    }
    part.first.push_back(part.influences.size());
    character_.parts.push_back(std::move(part));
  }

  // Bones come after their parents, so the parent's place in this frame is already known.
  void add_keys(const SceneState& state, std::size_t bone, double seconds) {
    const Eigen::Matrix3d& turn = state.rotations[bone];
    world_.push_back({{turn.col(0), turn.col(1), turn.col(2)}, state.bones[bone].head});
    const BoneId parent = state.shape.rig.parent[bone];
    const Trs parts =
        trs_of(parent == BoneId{-1} ? world_[bone] : composed(inverse(world_[+parent]), world_[bone]));
    for (std::size_t i = 0; i < 3; ++i)
      if (!((parts.rest[i] - Transform().column[i]).norm() < kRigid))
        throw InputError("scene " + character_.animations[0].name + ", frame " + std::to_string(frames_ - 1) +
                         ": bone " + state.shape.bone_names[bone] +
                         " is stretched or sheared, which keys of a model file cannot say; export it as .h5");
    Channel& channel = character_.animations[0].channels[bone];
    channel.moves.push_back({seconds, parts.move});
    channel.rotations.push_back({seconds, parts.rotation});
  }

  const Scene& scene_;
  Character character_;
  std::size_t frames_ = 0;
  std::vector<Transform> world_;  // [bones so far]; map of each bone's node in the current frame
};

// Ignores the frames: the recorder takes the states instead.
class NoFrames final : public FrameSink {
 public:
  void append(const FrameView&, const FrameView*) override {}
};

}  // namespace

Character skinned_scene(const Scene& scene, const Progress& progress) {
  require_linear(scene);
  Recorder recorder(scene);
  NoFrames sink;
  const Generated generated = run_scene(
      scene, [&](const ClipHeader&) -> FrameSink& { return sink; }, progress,
      [&](const SceneState& state) { recorder.add(state); });
  require_expected_digest(scene, generated.digest);
  return recorder.take();
}

}  // namespace cscd::scenes
