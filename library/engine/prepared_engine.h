#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "core/detect/exclusions.h"
#include "core/detect/strategy.h"
#include "core/mesh/triangle_mesh.h"
#include "core/session/candidates.h"
#include "core/session/near_pairs.h"
#include "core/session/obstacles.h"
#include "core/session/session.h"
#include "core/session/vertex_bounds.h"
#include "library/engine/arguments.h"
#include "library/engine/crossings.h"
#include "library/engine/engine.h"

#include "cscd/cscd.h"

namespace cscd {

// An engine that holds a mesh, what it was told of it, and the searches that answer its questions.
class SelfCollision::Engine::Prepared final : public SelfCollision::Engine {
 public:
  Prepared(const Faces& faces, const Positions& reference, Options options);

  void place_obstacle(std::size_t obstacle, const Positions& positions) override {
    move(obstacle, positions, positions);
  }
  void move_obstacle(std::size_t obstacle, const Positions& start, const Positions& end) override {
    move(obstacle, start, end);
  }
  bool is_free(const Positions& start, const Positions& end) override {
    return !free_until(motion(start, end), Session::Sought::any_contact);
  }
  void first_contact(const Positions& start, const Positions& end, Answer& out) override {
    contacts(motion(start, end), true, out);
  }
  void all_contacts(const Positions& start, const Positions& end, Answer& out) override {
    contacts(motion(start, end), false, out);
  }
  double largest_step(const Positions& start, const Positions& end, double safety) override;
  Candidates candidates(const Positions& start, const Positions& end, double radius) override;
  std::vector<double> vertex_bounds(const Positions& positions, double cap) override;
  SelfCollision::Crossings crossings(const Positions& positions) override {
    return crossing_search().find(pose(positions), exclusions_);
  }
  PathsAnswer true_motion(const Paths& paths, double from, double to, double resolution) override;
  std::vector<std::byte> preparation() const override { return first_.plain->saved_preparation(); }
  std::size_t vertex_count() const override { return mesh_.vertex_count(); }
  std::size_t face_count() const override { return mesh_.triangle_count(); }
  bool closed() const override { return mesh_.closed_and_oriented(); }

 private:
  // The sessions that answer one question. Each is prepared when it is asked for first. `plain` knows of no
  // exclusions: what is excluded is dropped from its answer. Where that leaves nothing of the first contact,
  // `filtered` finds the first of the others. So a step in which nothing excluded touches costs what it costs
  // without exclusions, and what it proves says how the next step starts.
  struct Question {
    bool first;
    std::optional<Session> plain = std::nullopt, filtered = std::nullopt;
    int filtered_steps = 0;  // the number of steps from here on that `filtered` answers alone
  };

  // The positions as they lie in the caller's memory. Sessions look for numbers that are not finite, in the
  // pass in which they look whether a start is known; for other questions, check_finite() does.
  Motion motion(const Positions& start, const Positions& end) const;
  std::span<const Vec3> pose(const Positions& positions) const;
  void check_finite(std::span<const Vec3> positions, const std::string& which) const;

  void check_labels() const;
  Thickness checked_thickness() const;
  bool is_thick() const { return !thickness_.is_zero(); }

  StrategyInput setup(bool first, const cscd::Exclusions* exclusions) const;
  Session& made(std::optional<Session>& wanted, bool first, const Strategy& strategy,
                const cscd::Exclusions* exclusions);
  Session& plain(Question& question);
  CrossingSearch& crossing_search();
  CandidateSearch& search();

  // The pairs that matter while no vertex moves farther than its cap. The caps of vertices that are not
  // `far` are no longer than they have to be for a search by culling; those of others may have any length.
  VertexBounds bounds_within(std::span<const Vec3> pose, const std::vector<double>& caps,
                             std::span<const VertexId> far);

  void move(std::size_t obstacle, const Positions& start, const Positions& end);

  // Answers one step. The answer is kept until the next.
  void step(const Motion& motion, bool first, Session::Sought sought);
  std::optional<double> time() const;  // of the first contact
  void contacts(const Motion& motion, bool first, Answer& out);
  // Returns the time of a contact, the first one if that is `sought`; 0 if something crosses at the start;
  // null if nothing does.
  std::optional<double> free_until(const Motion& motion, Session::Sought sought);
  // Returns the time at which the feature pair that touched first in an earlier step touches in this one;
  // null if it does not, and where its positions are not finite.
  std::optional<double> touches_again(const Motion& motion) const;

  void step_itself(Question& question, const Motion& motion, Session::Sought sought);
  std::size_t leave_out();
  void leave_out_ongoing(const Motion& motion, bool first);

  void append(const TriangleMesh& mesh, Candidates& out) const;
  Contact written(const TriangleMesh& mesh, const cscd::Contact& contact, const Motion& motion) const;

  Options options_;
  std::vector<Vec3> reference_;
  TriangleMesh mesh_;
  std::unique_ptr<ObstacleMesh> beside_;
  std::optional<Obstacles> obstacles_;
  Thickness thickness_;          // of vertices of the mesh, and behind them of obstacles
  cscd::Exclusions exclusions_;  // vertices and faces of obstacles are numbered behind the mesh's
  std::optional<NearPairs> near_;
  Question first_{.first = true}, all_{.first = false};
  std::optional<CandidateSearch> search_;
  StepAnswer answer_;        // about the mesh alone
  ContactSet touched_;       // of the mesh and obstacles
  cscd::Crossings crossed_;  // of the mesh and obstacles
  std::vector<FeaturePair> found_;
  std::optional<CrossingSearch> crossing_search_;
  // The last one that free_until() met.
  std::vector<Vec3> crossing_start_;
  // The feature pair that touched first in the last step in which anything of the mesh touched.
  std::optional<FeaturePair> touched_first_;
};

}  // namespace cscd
