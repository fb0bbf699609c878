#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "scenes/cloth/cloth.h"
#include "scenes/effects/effect.h"
#include "scenes/shape/key_curve.h"

namespace cscd::scenes {
namespace {

const ParameterRow kBallRows[] = {
    {"radius", ParameterKind::number, "of the ball, with the gap that the cloth keeps", true, 1e-9, 1e9},
    {"path", ParameterKind::table, "frame, x, y, z of its centre", true, -1e300, 1e300, 4},
};
const ParameterRow kGripRows[] = {
    {"from", ParameterKind::vector, "lower corner of the box whose vertices at rest are gripped"},
    {"to", ParameterKind::vector, "upper corner of that box"},
    {"path", ParameterKind::table, "frame, x, y, z: the way since the first frame; free before and after",
     true, -1e300, 1e300, 4},
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

// Cloth by XPBD, position-based dynamics with compliant constraints (Macklin, Mueller, Chentanez, "XPBD:
// position-based simulation of compliant constrained dynamics", MIG 2016). See scenes/cloth/cloth.h.
class ClothDynamics final : public Effect {
 public:
  ClothDynamics(const Parameters& p, const Shape& shape)
      : mesh_(shape.triangles, shape.positions.size(), p.where()),
        cloth_(mesh_, shape.positions, options(p)) {
    if (p.has("balls"))
      for (const Parameters& ball : p.objects("balls")) {
        check(ball, kBallRows);
        balls_.push_back({ball.number("radius"), {ball.table("path"), ball.where() + ": parameter path"}});
      }
    if (p.has("grips"))
      for (const Parameters& grip : p.objects("grips")) {
        check(grip, kGripRows);
        grips_.push_back({inside(shape, grip), {grip.table("path"), grip.where() + ": parameter path"}});
      }
    if (!p.has("volume")) return;
    require_closed_and_oriented(mesh_, p.where() + ": parameter volume");
    volume_.emplace(p.table("volume"), p.where() + ": parameter volume");
  }

  void step(SceneState& state) override {
    led_.clear();
    for (Grip& grip : grips_) lead(grip, state);
    moving_.clear();
    for (const Ball& ball : balls_)
      moving_.push_back(
          {ball.radius, place_at(ball.path, state.time - state.step), place_at(ball.path, state.time)});
    std::optional<double> volume;
    if (volume_) volume = volume_->at(state.time, 1) * cloth_.rest_volume();
    cloth_.step(state.positions, state.step, led_, moving_, volume);
  }

 private:
  static ClothOptions options(const Parameters& p) {
    ClothOptions options;
    options.gravity = p.vector("gravity");
    options.drag = p.number("drag");
    options.viscosity = p.number("viscosity", 0);
    options.stretch_compliance = p.number("stretch_compliance", 0);
    options.bend_compliance = p.number("bend_compliance");
    options.volume_compliance = p.number("volume_compliance", 0);
    options.thickness = p.number("thickness");
    options.friction = p.number("friction", 0);
    if (p.has("floor")) options.floor = p.number("floor");
    return options;
  }

  static std::vector<VertexId> inside(const Shape& shape, const Parameters& grip) {
    const Vec3 from = grip.vector("from"), to = grip.vector("to");
    std::vector<VertexId> vertices;
    for (std::size_t v = 0; v < shape.positions.size(); ++v) {
      const Vec3& at = shape.positions[v];
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
      for (const VertexId v : grip.vertices) grip.gripped.push_back(state.positions[+v]);
    const Vec3 way = place_at(grip.path, state.time) - place_at(grip.path, grip.path.first_frame());
    for (std::size_t i = 0; i < grip.vertices.size(); ++i)
      led_.push_back({grip.vertices[i], grip.gripped[i] + way});
  }

  TriangleMesh mesh_;
  Cloth cloth_;
  std::vector<Ball> balls_;
  std::vector<Grip> grips_;
  std::optional<KeyCurve> volume_;
  std::vector<MovingBall> moving_;
  std::vector<Cloth::Led> led_;
};

}  // namespace

EffectRow cloth_dynamics_row() {
  static const ParameterRow rows[] = {
      {"gravity", ParameterKind::vector, "acceleration, per frame squared"},
      {"drag", ParameterKind::number, "share of the velocity lost, per frame", true, 0, 1e9},
      {"viscosity", ParameterKind::number, "share of neighbours' relative velocity lost, per frame", false, 0,
       1e9},
      {"stretch_compliance", ParameterKind::number, "stretch of an edge per force", false, 0, 1e300},
      {"bend_compliance", ParameterKind::number, "change of the distance across an edge per force", true, 0,
       1e300},
      {"thickness", ParameterKind::number,
       "least distance of vertices that share no edge; 0 lets the cloth pass through itself", true, 0, 1e9},
      {"friction", ParameterKind::number, "Coulomb's coefficient", false, 0, 1e3},
      {"floor", ParameterKind::number, "height of a floor", false},
      {"balls", ParameterKind::objects, "balls that the cloth stays out of", false},
      {"grips", ParameterKind::objects, "parts of the cloth that are led", false},
      {"volume", ParameterKind::table, "frame, share of the volume at rest that a closed surface holds",
       false, -1e300, 1e300, 2},
      {"volume_compliance", ParameterKind::number, "change of the volume per pressure", false, 0, 1e300},
  };
  EffectRow row{"cloth_dynamics",
                "cloth under gravity that keeps off itself, off balls and off a floor (XPBD)", Pace::substep,
                rows, [](const Parameters& parameters, const Shape& shape) -> std::unique_ptr<Effect> {
                  return std::make_unique<ClothDynamics>(parameters, shape);
                }};
  row.of_surface = true;
  return row;
}

}  // namespace cscd::scenes
