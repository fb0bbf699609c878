#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/ids.h"
#include "core/mesh/vertex_paths.h"
#include "scenes/motion/linear_skin.h"
#include "scenes/motion/pose_jets.h"
#include "scenes/motion/skin_jets.h"

namespace cscd::scenes {

// What an import keeps of a character to tell how its surface moves between frames: the clip alone as its
// animation, and which raw vertex each vertex of the surface is.
struct MovingCharacter {
  Character character;
  std::vector<std::int32_t> raw_vertex;  // [vertices]
};

// Thrown for a motion of which no bounds are known.
class NoBounds : public InputError {
 public:
  using InputError::InputError;
};

// The true motion of a character's surface: the paths of its vertices in seconds after the clip's start, as
// the formulas of its keys, bones and weights say, and how far they leave straight lines (core/soundness.md,
// "The true motion").
class CharacterMotion final : public VertexPaths {
 public:
  // Throws NoBounds where the clip holds what has none, by its name, and InputError where there is no clip.
  explicit CharacterMotion(MovingCharacter moving);
  CharacterMotion(const CharacterMotion&) = delete;
  CharacterMotion& operator=(const CharacterMotion&) = delete;

  std::size_t vertex_count() const override { return moving_.raw_vertex.size(); }
  void positions(double seconds, std::span<const VertexId> vertices, std::span<Vec3> at,
                 std::span<double> error) const override;
  void deviations(double from, double to, std::span<const VertexId> vertices,
                  std::span<double> out) const override;
  double largest_deviation(double from, double to) const override;
  double split(double from, double to) const override;
  double at_corner(double seconds, double reach) const override;
  std::optional<Jump> next_jump(double from, double to) const override;

 private:
  struct Place {
    std::int32_t part, vertex;
  };
  class LinearPaths;
  // How far joints take points off their lines over a span, [parts][joints].
  using JointBounds = std::vector<std::vector<LinearSkin::AffineBound>>;
  // Those of some parts, whose skins are linear. Throws Unbounded.
  const JointBounds& joint_bounds(const Span& span, const std::vector<std::size_t>& parts) const;
  // As positions(), and throws Unbounded where an enclosure breaks down.
  void enclose(double seconds, std::span<const VertexId> vertices, std::span<Vec3> at,
               std::span<double> error) const;
  bool is_linear(std::size_t part, const PoseJets::Weights& weights) const;
  double on_time_line(double seconds) const;
  Span on_time_line(double from, double to) const { return {on_time_line(from), on_time_line(to)}; }
  // The corner that is nearest to a time of the file, if it is within reach.
  std::optional<double> corner_near(double time, double reach) const;

  MovingCharacter moving_;
  PoseJets pose_;
  std::vector<double> corners_;                  // those that are no jumps, on the file's time line
  std::vector<Place> place_;                     // [vertices]
  std::vector<std::vector<BallVector>> points_;  // [parts]
  std::vector<LinearSkin> linear_;               // [parts]
  // What joint_bounds() found last: a span is asked about as a whole and then vertex by vertex. It makes an
  // object one thread's.
  struct {
    double from = 0, to = 0;
    std::vector<std::size_t> parts;
    JointBounds bounds;
  } mutable last_;
};

}  // namespace cscd::scenes
