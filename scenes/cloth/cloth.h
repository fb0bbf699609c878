#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "scenes/cloth/nearness.h"

namespace cscd::scenes {

// Laws of a cloth. Lengths are lengths of the scene, and times are in frames. Every vertex has mass 1.
struct ClothOptions {
  Vec3 gravity = Vec3::Zero();    // acceleration, per frame squared
  double drag = 0;                // share of the velocity lost, per frame
  double viscosity = 0;           // share of the difference of two neighbours' velocities lost, per frame
  double stretch_compliance = 0;  // stretch of an edge under a force of 1; 0 for edges that keep their length
  double bend_compliance = 0;     // the same for the distance of the two corners across an edge
  double volume_compliance = 0;   // change of the enclosed volume under a pressure of 1
  double thickness = 0;  // least distance of vertices that share no edge; 0 lets the cloth pass itself
  double friction = 0;   // Coulomb's coefficient, with itself and with obstacles
  std::optional<double> floor = {};  // height below which no vertex gets
};

// A ball that moves, at the start and the end of a step. No vertex gets into it.
struct BallObstacle {
  double radius;
  Vec3 start, end;
};

// A closed surface that moves, such as the body that wears the cloth, at the start and the end of a step. The
// vertices of the cloth stay `gap` away from its outer side. If the gap is larger than the circumscribed
// circles of the cloth's triangles, which is 0.58 edges where they are equilateral, then no point of the
// surface reaches a triangle either.
struct MovingSurface {
  NearSurface& near;                 // of the surface's mesh
  std::span<const Vec3> start, end;  // [vertices of the surface]
  double gap;
};

// Simulates a cloth by position-based dynamics with compliant constraints (Macklin, Mueller, Chentanez,
// "XPBD: position-based simulation of compliant constrained dynamics", MIG 2016), with one sweep over all
// constraints in each small step (Macklin et al., "Small steps in physics simulation", SCA 2019).
//
// Edges keep their lengths, and the distance of the two corners across an edge resists bending. A closed
// surface can also be held to a volume. The cloth keeps off itself by its vertices alone: two vertices that
// share no edge stay `thickness` apart, with friction.
//
// Vertices that are far enough apart keep the whole surface embedded. If an edge pierces a triangle in a
// point, and no edge is longer than L, then the point divides the edge and the triangle with weights for
// which the weighted mean of the six squared distances between ends and corners is at most L^2 (1/4 + 1/3).
// So a surface whose vertices are all more than 0.764 L apart is embedded. Triangles should be about
// equilateral for this reason, and the thickness a little less than their edge.
//
// The sweeps run in one fixed order, so the results have the same bits with every compiler. Sweeps whose
// direction turns from step to step would feed motion into the cloth, until it boils.
class Cloth {
 public:
  // `rest` [vertices] is the shape in which no constraint is violated. The mesh must outlive the object.
  Cloth(const TriangleMesh& mesh, std::span<const Vec3> rest, const ClothOptions& options);

  // A vertex that is led, and its place at the end of the step.
  struct Led {
    VertexId vertex;
    Vec3 place;
  };
  // Moves the positions [vertices] through one step of the length `h` in frames. `volume` is the volume that
  // a closed surface is held to, or nullopt. `body` is a surface that the cloth stays out of, or nullptr.
  // Where somebody has moved vertices since the last step, such as a response to contacts, the cloth goes on
  // from there, and the move counts as motion during one frame.
  void step(std::vector<Vec3>& positions, double h, std::span<const Led> led,
            std::span<const BallObstacle> balls, std::optional<double> volume,
            const MovingSurface* body = nullptr);

  double rest_volume() const { return rest_volume_; }

 private:
  struct Distance {  // a constraint on the distance of two vertices
    int a, b;
    double rest;
  };
  void predict(std::vector<Vec3>& positions, double h, std::span<const Led> led);
  void restore(std::vector<Vec3>& positions, const std::vector<Distance>& distances, double softness) const;
  void restore_volume(std::vector<Vec3>& positions, double volume, double softness);
  void find_close_vertices(const std::vector<Vec3>& positions);
  void push_apart(std::vector<Vec3>& positions);
  void keep_outside(std::vector<Vec3>& positions, std::span<const BallObstacle> balls) const;
  void keep_off(std::vector<Vec3>& positions, const MovingSurface& body) const;
  void limit_speed(std::vector<Vec3>& positions) const;
  Vec3 rubbed(const Vec3& slip, double depth) const;

  const TriangleMesh& mesh_;
  ClothOptions options_;
  std::vector<Distance> edges_, bends_;
  double rest_volume_;
  NearPoints near_points_;
  std::vector<std::pair<int, int>> close_;  // pairs that may come closer than the thickness
  std::vector<Vec3> searched_;              // [vertices]: positions when close_ was found; empty at first
  std::vector<Vec3> before_;                // [vertices]: positions at the start of the step
  std::vector<Vec3> left_;                  // [vertices]: positions at the end of the last step
  std::vector<Vec3> moved_;                 // [vertices]: the way that inertia takes a vertex in the step
  std::vector<double> inverse_mass_;        // [vertices]: 0 for a vertex that is led, otherwise 1
  std::vector<Vec3> gradient_;              // [vertices]: of the volume
  double last_h_ = 0;
};

}  // namespace cscd::scenes
