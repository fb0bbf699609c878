#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/detect/detector.h"
#include "core/mesh/triangle_mesh.h"

namespace cscd::scenes {

struct ContactStepOptions {
  double push = 0.3;      // gap left at a contact, in mean edge lengths of the reference pose
  double spread = 8;      // how far along the surface a contact is felt, in the same
  double back_off = 0.8;  // a step that has to be cut as a whole keeps this share of the time before contact
  int rounds = 8;         // corrections of one step before it is cut as a whole
};

// One step of a surface that must not run into itself: what a simulator does with the answer of a collision
// query. At every contact of the predicted step the two sides lose their approach from the time of impact on
// and are pushed apart, along the normal there and fading out along the surface, until the detector finds the
// straight way from start to end free. If it does not become so, the whole step is cut short before its first
// contact.
//
// The same bits with every compiler: of `first`, whose later contacts depend on its clusters, only the
// verdict and the earliest time are used.
class ContactStep {
 public:
  // Both detectors run with an exact elementary test; `first` finds the earliest contact, `all` every one.
  ContactStep(const TriangleMesh& mesh, std::span<const Vec3> reference, std::unique_ptr<Detector> first,
              std::unique_ptr<Detector> all, const ContactStepOptions& options);

  // Moves `end` (at first the prediction) to where the surface can go from `start`.
  void resolve(std::span<const Vec3> start, std::vector<Vec3>& end, const Rig::Interval& bones);

  // What has been done since construction.
  struct Counts {
    std::size_t steps = 0, colliding = 0, cut = 0, rounds = 0;
  };
  const Counts& counts() const { return counts_; }

 private:
  bool is_free(std::span<const Vec3> start, const std::vector<Vec3>& end, const Rig::Interval& bones);
  void correct(std::span<const Vec3> start, std::vector<Vec3>& end);
  void add_correction(const Contact& contact, std::span<const Vec3> start, std::span<const Vec3> end);
  void spread();

  const TriangleMesh& mesh_;
  ContactStepOptions options_;  // lengths in the frame's units
  std::unique_ptr<Detector> first_, all_;
  ContactSet found_;
  struct Neighbour {
    VertexId vertex;
    double length;
  };
  std::vector<std::size_t> first_neighbour_;
  std::vector<Neighbour> neighbours_;  // of vertex v: first_neighbour_[v] .. [v + 1]
  std::vector<Vec3> correction_, smoothed_;
  std::vector<std::size_t> contacts_at_;
  std::vector<double> path_;       // to the nearest vertex in contact
  std::vector<VertexId> reached_;  // in order of their paths
  Counts counts_;
};

}  // namespace cscd::scenes
