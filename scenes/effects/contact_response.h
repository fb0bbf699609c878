#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/detect/detector.h"
#include "core/detect/strategy.h"
#include "core/mesh/triangle_mesh.h"
#include "scenes/effects/effect.h"

namespace cscd::scenes {

struct ContactStepOptions {
  double push = 0.3;      // gap left at a contact, in mean edge lengths of the reference pose
  double spread = 8;      // reach of a contact along the surface, in the same unit
  double back_off = 0.8;  // share of the time before contact that a step keeps if it is cut as a whole
  int rounds = 8;         // the most corrections of a step before it is cut as a whole
};

// Makes steps of a surface that must not run into itself, as a simulator does with the answers of a
// collision query.
//
// At every contact of the predicted step the two sides lose their approach from the time of impact on, and
// are pushed apart along the normal at the contact. This correction fades out along the surface.
// Corrections are repeated until the detector finds no contact on the straight way from start to end. If
// contacts remain after the last correction, the whole step is cut short before its first contact.
//
// The results have the same bits with every compiler. Therefore only the verdict and the earliest time of
// `first` are used: its later contacts depend on its clusters.
class ContactStep {
 public:
  // Both detectors must run with an exact elementary test. `first` finds the earliest contact, and `all`
  // finds all contacts. `reference` [vertices] gives the edge lengths in the reference pose.
  ContactStep(const TriangleMesh& mesh, std::span<const Vec3> reference, std::unique_ptr<Detector> first,
              std::unique_ptr<Detector> all, const ContactStepOptions& options);

  // Takes the prediction in `end` and changes it to an end that the surface can reach from `start` without
  // contact. Both are [vertices].
  void resolve(std::span<const Vec3> start, std::vector<Vec3>& end, const Rig::Interval& bones);

  // Counts since construction: steps, steps whose prediction had contacts, steps cut as a whole, and
  // corrections.
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
  ContactStepOptions options_;  // push and spread are lengths of the scene here
  std::unique_ptr<Detector> first_, all_;
  ContactSet found_;
  struct Neighbour {
    VertexId vertex;
    double length;
  };
  std::vector<std::size_t> first_neighbour_;
  std::vector<Neighbour> neighbours_;  // those of vertex v: first_neighbour_[v] .. first_neighbour_[v + 1]
  std::vector<Vec3> correction_, smoothed_;
  std::vector<std::size_t> contacts_at_;
  std::vector<double> path_;       // [vertices]: length of the path to the nearest vertex in contact
  std::vector<VertexId> reached_;  // vertices with a correction, in ascending order of their paths
  Counts counts_;
};

// Makes the effect contact_response with another detector of first contacts than our own. Tests use this to
// put in broken detectors.
using MakeDetector = std::function<std::unique_ptr<Detector>(const StrategyInput& setup)>;
std::unique_ptr<Effect> make_contact_response(const Parameters& parameters, const Shape& shape,
                                              const MakeDetector& first);

}  // namespace cscd::scenes
