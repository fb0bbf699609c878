#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "scenes/cloth/cloth.h"
#include "scenes/cloth/worn_parts.h"
#include "scenes/effects/effect.h"
#include "scenes/shape/key_curve.h"

namespace cscd::scenes {
namespace {

const ParameterRow kBallRows[] = {
    number_row("radius", "length", "radius of the ball, with the gap that the cloth keeps", {1e-9, 1e9}),
    table_row("path", "frame, length", 4, "keys of frame, x, y, z of the ball's centre"),
};
const ParameterRow kGripRows[] = {
    vector_row("from", "length", "lower corner of the box whose vertices at rest are gripped"),
    vector_row("to", "length", "upper corner of that box"),
    table_row(
        "path", "frame, length", 4,
        "keys of frame, x, y, z of the way since the first key; the vertices are free before and after"),
};

Vec3 place_at(const KeyCurve& curve, double frame) {
  return {curve.at(frame, 1), curve.at(frame, 2), curve.at(frame, 3)};
}

struct Ball {
  double radius;
  KeyCurve path;
};

// Some vertices that are gripped where they are at the first key of a path, led along the path, and let go
// after its last key.
struct Grip {
  std::vector<VertexId> vertices;
  KeyCurve path;
  std::vector<Vec3> gripped = {};  // [vertices]: their places at the first key; empty before
};

// The body that wears the cloth. Skinning moves it once a frame, and it moves in a straight line between two
// frames, as it does for whoever asks for contacts of that interval.
class Wearer {
 public:
  Wearer(const SurfacePart& part, std::span<const Vec3> rest, double gap, const std::string& where)
      : part_(part), mesh_(part.triangles, part.in_shape.size(), where), near_(mesh_), gap_(gap) {
    require_closed_and_oriented(mesh_, where + ": parameter body_gap");
    from_ = to_ = end_ = part_.of(rest);
  }
  Wearer(const Wearer&) = delete;
  Wearer& operator=(const Wearer&) = delete;

  void begin_frame(std::span<const Vec3> positions) {
    from_ = std::move(to_);
    to_ = part_.of(positions);
    end_ = from_;
  }
  // The motion of a step that ends after `share` of the frame.
  MovingSurface until(double share) {
    start_ = end_;
    for (std::size_t v = 0; v < end_.size(); ++v) end_[v] = from_[v] + share * (to_[v] - from_[v]);
    return {near_, start_, end_, gap_};
  }

 private:
  const SurfacePart& part_;
  TriangleMesh mesh_;
  NearSurface near_;
  double gap_;
  std::vector<Vec3> from_, to_;    // [vertices]: at the frame's start and end
  std::vector<Vec3> start_, end_;  // [vertices]: at the step's start and end
};

// Cloth by XPBD, position-based dynamics with compliant constraints (Macklin, Mueller, Chentanez, "XPBD:
// position-based simulation of compliant constrained dynamics", MIG 2016). See scenes/cloth/cloth.h.
//
// A shape with bones may wear cloth (scenes/cloth/worn_parts.h). The effect then moves the cloth alone, and
// runs after skinning. Vertices of the cloth that have bones are led where skinning takes them.
class ClothDynamics final : public Effect {
 public:
  ClothDynamics(const Parameters& p, const Shape& shape)
      : parts_(worn_parts(shape)),
        rest_(parts_.cloth.of(shape.positions)),
        mesh_(parts_.cloth.triangles, rest_.size(), p.where()),
        cloth_(mesh_, rest_, options(p)) {
    if (!parts_.body.in_shape.empty())
      for (std::size_t v = 0; v < rest_.size(); ++v)
        if (shape.weights[+parts_.cloth.in_shape[v]].has_bones())
          carried_.push_back({VertexId{static_cast<int>(v)}, rest_[v], rest_[v]});
    if (p.has("body_gap")) {
      if (parts_.body.in_shape.empty())
        throw InputError(p.where() +
                         ": parameter body_gap needs a shape with a body that wears the cloth; "
                         "remove the parameter or name such a shape");
      wearer_.emplace(parts_.body, shape.positions, p.number("body_gap"), p.where());
    }
    if (p.has("balls"))
      for (const Parameters& ball : p.objects("balls")) {
        balls_.push_back({ball.number("radius"), {ball.table("path"), ball.where() + ": parameter path"}});
      }
    if (p.has("grips"))
      for (const Parameters& grip : p.objects("grips")) {
        grips_.push_back({inside(rest_, grip), {grip.table("path"), grip.where() + ": parameter path"}});
      }
    if (!p.has("volume")) return;
    require_closed_and_oriented(mesh_, p.where() + ": parameter volume");
    volume_.emplace(p.table("volume"), p.where() + ": parameter volume");
  }

  void step(SceneState& state) override {
    positions_ = parts_.cloth.of(state.positions);
    const int frame = static_cast<int>(std::ceil(state.time));
    const double share = state.time - (frame - 1);
    if (frame != frame_) begin_frame(state);
    frame_ = frame;
    led_.clear();
    for (const Carried& one : carried_) led_.push_back({one.vertex, one.from + share * (one.to - one.from)});
    for (Grip& grip : grips_) lead(grip, state);
    moving_.clear();
    for (const Ball& ball : balls_)
      moving_.push_back(
          {ball.radius, place_at(ball.path, state.time - state.step), place_at(ball.path, state.time)});
    std::optional<double> volume;
    if (volume_) volume = volume_->at(state.time, 1) * cloth_.rest_volume();
    std::optional<MovingSurface> body;
    if (wearer_) body.emplace(wearer_->until(share));
    cloth_.step(positions_, state.step, led_, moving_, volume, body ? &*body : nullptr);
    for (std::size_t v = 0; v < positions_.size(); ++v)
      state.positions[+parts_.cloth.in_shape[v]] = positions_[v];
  }

 private:
  static ClothOptions options(const Parameters& p) {
    ClothOptions options;
    options.gravity = p.vector("gravity");
    options.drag = p.number("drag");
    options.viscosity = p.number("viscosity");
    options.stretch_compliance = p.number("stretch_compliance");
    options.bend_compliance = p.number("bend_compliance");
    options.volume_compliance = p.number("volume_compliance");
    options.thickness = p.number("thickness");
    options.friction = p.number("friction");
    if (p.has("floor")) options.floor = p.number("floor");
    return options;
  }

  // A vertex of the cloth that bones carry, and its places at the frame's start and end.
  struct Carried {
    VertexId vertex;
    Vec3 from, to;
  };

  // Takes over what skinning made of the frame.
  void begin_frame(const SceneState& state) {
    for (Carried& one : carried_) {
      one.from = one.to;
      one.to = positions_[+one.vertex];
    }
    for (const Carried& one : carried_) positions_[+one.vertex] = one.from;
    if (wearer_) wearer_->begin_frame(state.positions);
  }

  static std::vector<VertexId> inside(std::span<const Vec3> rest, const Parameters& grip) {
    const Vec3 from = grip.vector("from"), to = grip.vector("to");
    std::vector<VertexId> vertices;
    for (std::size_t v = 0; v < rest.size(); ++v) {
      const Vec3& at = rest[v];
      if ((at.array() >= from.array()).all() && (at.array() <= to.array()).all())
        vertices.push_back(VertexId{static_cast<int>(v)});
    }
    if (vertices.empty())
      throw InputError(grip.where() + ": no vertex at rest lies between from and to; move them");
    return vertices;
  }

  void lead(Grip& grip, const SceneState& state) {
    if (state.time < grip.path.first_frame() || state.time > grip.path.last_frame()) return;
    if (grip.gripped.empty())
      for (const VertexId v : grip.vertices) grip.gripped.push_back(positions_[+v]);
    const Vec3 way = place_at(grip.path, state.time) - place_at(grip.path, grip.path.first_frame());
    for (std::size_t i = 0; i < grip.vertices.size(); ++i)
      led_.push_back({grip.vertices[i], grip.gripped[i] + way});
  }

  WornParts parts_;
  std::vector<Vec3> rest_;  // [vertices of the cloth]
  TriangleMesh mesh_;       // of the cloth
  Cloth cloth_;
  std::vector<Carried> carried_;
  std::optional<Wearer> wearer_;
  std::vector<Ball> balls_;
  std::vector<Grip> grips_;
  std::optional<KeyCurve> volume_;
  std::vector<BallObstacle> moving_;
  std::vector<Cloth::Led> led_;
  std::vector<Vec3> positions_;  // [vertices of the cloth]
  int frame_ = 0;                // the frame that the last step was a part of
};

}  // namespace

EffectRow cloth_dynamics_row() {
  static const ParameterRow rows[] = {
      vector_row("gravity", "length / frame^2", "acceleration of all vertices, which have mass 1"),
      number_row("drag", "1 / frame", "share of the velocity that is lost", {0, 1e9}),
      number_row("viscosity", "1 / frame",
                 "share of the difference of two neighbours' velocities that is lost", {0, 1e9})
          .or_else({0}),
      number_row("stretch_compliance", "frame^2", "how much a force of 1 stretches an edge", {0, 1e300})
          .or_else({0}),
      number_row("bend_compliance", "frame^2",
                 "how much a force of 1 changes the distance of the two corners across an edge", {0, 1e300}),
      number_row("thickness", "length",
                 "least distance of vertices that share no edge; 0 lets the cloth pass through itself",
                 {0, 1e9}),
      number_row("friction", "", "Coulomb's coefficient of friction", {0, 1e3}).or_else({0}),
      number_row("floor", "length", "height of a floor; without it there is no floor").optional(),
      number_row(
          "body_gap", "length",
          "least distance from the body that wears the cloth; without it the cloth does not notice the body",
          {1e-9, 1e9})
          .optional(),
      objects_row("balls", "balls that the cloth stays out of", kBallRows).optional(),
      objects_row("grips", "parts of the cloth that are led", kGripRows).optional(),
      table_row("volume", "frame, share", 2,
                "keys of frame and the share of its volume at rest that a closed surface holds; without it "
                "the volume is free")
          .optional(),
      number_row("volume_compliance", "length^4 frame^2", "how much a pressure of 1 changes the volume",
                 {0, 1e300})
          .or_else({0}),
  };
  EffectRow row{"cloth_dynamics",
                "cloth under gravity that keeps off itself, its wearer, balls and a floor (XPBD)",
                Pace::substep, rows, make_effect<ClothDynamics>};
  row.of_surface = true;
  return row;
}

}  // namespace cscd::scenes
