#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/detect/culler.h"
#include "core/fast/classify/local_positions.h"
#include "core/fast/classify/patch_lanes.h"
#include "core/fast/prepare/patches.h"
#include "core/session/near_list.h"

namespace cscd {

// Finds the pairs of triangles that are near each other in a pose, from those that were near in an earlier
// pose, the *anchor*. A rigid motion takes each patch of the surface from the anchor close to where it is in
// the pose; what is missing is the *deviation* of its vertices. Two triangles are as far apart as they were
// in the anchor, up to what both deviate from one rigid motion (core/soundness.md, "Theorem: patches that
// keep their shape").
//
// The object takes about a kilobyte for each patch, which has up to sixteen triangles, 60 bytes for each
// vertex, and 16 for each pair that is listed in the anchor.
class PatchMotions {
 public:
  // `reference`, [vertices], is the pose at rest, in which the surface has been cut into `patches`.
  PatchMotions(std::span<const Vec3> reference, const fast::PatchTree& patches);

  // Makes a pose the anchor. `near` holds all pairs that are within `reach`, which is above 0, of each other
  // in it.
  void set_anchor(std::span<const Vec3> pose, double reach, std::span<const NearPair> near);
  bool has_anchor() const { return reach_ > 0; }
  void forget_anchor() { reach_ = 0; }

  // Finds all pairs that are within `reach`, which is above 0, of each other in a pose, and some others. A
  // pair whose distance is known well enough from the anchor is appended to `known`; every other one is
  // passed on to the sink, which has to measure it. A pair may come both ways. Returns how many pairs were
  // passed on because their patches have bent. Returns nothing, and may have left out pairs, where there are
  // more than `most` of these, where there is no anchor, and where the anchor does not reach farther than
  // `reach`.
  std::optional<std::size_t> pass_on(std::span<const Vec3> pose, double reach, std::size_t most,
                                     std::vector<NearPair>& known, TrianglePairSink& sink);

 private:
  static constexpr std::size_t kGroup = kLanes16;  // patches that are looked at side by side

  // A place of a triangle is sixteen times its patch and its lane in the patch.
  struct Listed {
    double low;  // the two are at least so far apart in the anchor
    std::int32_t a, b;
    std::pair<int, int> patches() const { return {a / int{kLanes16}, b / int{kLanes16}}; }
  };
  // Takes a position x in the anchor to turn (x - from) + to.
  struct Rigid {
    float turn[3][3], from[3], to[3];
    float quaternion[4];  // of the turn
    float deviation;      // the largest of the patch's own vertices
  };
  // Grown by half the reach that is asked for. Another box is apart where one of its `least` exceeds a number
  // of `against`.
  struct Box {
    float least[8];    // x, y, z, 0, -x, -y, -z, 0 of what it holds
    float against[8];  // the largest x, y, z, 0, -x, -y, -z, 0
    void set_against() {
      for (std::size_t i = 0; i < 8; ++i) against[i] = -least[i ^ 4];
    }
  };
  struct Common;
  struct Turn {
    Float16 at[4];  // a quaternion for each of sixteen patches
  };

  void find_motions(std::size_t group);
  void find_boxes();
  unsigned overlapping(std::size_t node, std::size_t first) const;
  void look_below(std::size_t node, TrianglePairSink& sink);
  void look_between(std::size_t a, std::size_t b, TrianglePairSink& sink);
  float nearer(std::size_t a, std::size_t b) const;
  void look_at(std::size_t a, std::size_t b, TrianglePairSink& sink);
  void look_closely(std::size_t a, std::size_t b, TrianglePairSink& sink);
  void look_at_listed(double reach, std::vector<NearPair>& known, TrianglePairSink& sink) const;

  fast::PatchTree tree_;
  std::vector<std::array<std::array<std::int32_t, kLanes16>, kGroup>> vertex_;  // [groups][place][patch]
  std::vector<std::int32_t> place_;                                             // [triangles]
  fast::LocalPositions positions_;       // of the pose that is looked at, and of the anchor
  std::vector<Turn> turn_;               // [groups]
  std::vector<Rigid> motion_;            // [patches]
  std::vector<fast::PatchLanes> lanes_;  // [patches]
  std::vector<Box> box_;                 // [nodes]
  std::vector<Vec3> anchor_;             // [vertices]
  double reach_ = 0;  // pairs that are not listed are farther apart than this in the anchor; 0 without one
  std::vector<Listed> listed_;  // by their patches
  float off_ = 0;               // what roundings add to a deviation
  float local_reach_ = 0, budget_ = 0, margin_ = 0;
  std::size_t passed_ = 0, most_ = 0;
};

}  // namespace cscd
