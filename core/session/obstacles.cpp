#include "core/session/obstacles.h"

#include <algorithm>
#include <limits>

#include "core/base/rounding.h"
#include "core/detect/compose.h"

namespace cscd {
namespace {

TriangleMesh joined(const TriangleMesh& own, const TriangleMesh& beside) {
  std::vector<Triangle> triangles(own.triangles().begin(), own.triangles().end());
  const auto behind = [&](VertexId v) {
    return VertexId{static_cast<std::int32_t>(own.vertex_count() + static_cast<std::size_t>(v))};
  };
  for (const Triangle& t : beside.triangles())
    triangles.push_back({behind(t[0]), behind(t[1]), behind(t[2])});
  return {std::move(triangles), own.vertex_count() + beside.vertex_count(), "faces and obstacles"};
}

// The box of the path of a whole surface. Four vertices are treated side by side.
Aabb box_of(const Motion& motion) {
  constexpr std::size_t kSide = 12;
  double low[kSide], high[kSide];
  std::fill_n(low, kSide, std::numeric_limits<double>::infinity());
  std::fill_n(high, kSide, -std::numeric_limits<double>::infinity());
  for (const std::span<const Vec3> pose : {motion.start(), motion.end()}) {
    const double* const at = pose[0].data();
    const auto add = [&](std::size_t from, std::size_t k) {
      const double x = at[from + k];
      low[k] = x < low[k] ? x : low[k];
      high[k] = x > high[k] ? x : high[k];
    };
    const std::size_t count = 3 * pose.size(), whole = count - count % kSide;
    for (std::size_t i = 0; i < whole; i += kSide)
      for (std::size_t k = 0; k < kSide; ++k) add(i, k);
    for (std::size_t k = 0; k < count - whole; ++k) add(whole, k);
  }
  Aabb box{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double least = low[axis], most = high[axis];
    for (std::size_t k = axis; k < kSide; k += 3)
      least = std::min(least, low[k]), most = std::max(most, high[k]);
    box.at_least[axis] = float_below(least);
    box.at_least[4 + axis] = float_below(-most);
  }
  return box;
}

}  // namespace

// The pairs of one triangle of the deforming surface and one of an obstacle whose swept boxes overlap.
class Obstacles::ObstaclePairs {
 public:
  ObstaclePairs(const TriangleMesh& own, std::span<const Vec3> reference, const TriangleMesh& beside,
                std::span<const Vec3> positions)
      : own_tree_(build_tree(own, reference)),
        obstacle_tree_(build_tree(beside, positions)),
        own_(own, own_tree_),
        obstacles_(beside, obstacle_tree_),
        behind_(static_cast<std::int32_t>(own.triangle_count())) {}

  void refit_own(const Motion& own, double margin = 0) { own_.refit(own, margin); }
  void refit_obstacles(const Motion& beside) { obstacles_.refit(beside); }
  // Whether some triangle of an obstacle comes near a box.
  bool near(const Aabb& box, NodeIndex node = 0) const {
    if (!overlap(box, obstacles_[node])) return false;
    return obstacle_tree_.is_leaf(node) || near(box, obstacle_tree_.left(node)) ||
           near(box, obstacle_tree_.right(node));
  }

  // Hands every such pair to `sink` and returns the number of overlap tests.
  std::uint64_t cull(TrianglePairSink& sink) const {
    std::uint64_t tests = 0;
    descend(0, 0, sink, tests);
    return tests;
  }

  // A culler of its own for each detector and for the test of the start. It sees motions of together(), and
  // recomputes the bounds of the deforming surface alone.
  class View : public Culler {
   public:
    View(ObstaclePairs& between, std::size_t own_vertices) : pairs_(between), own_vertices_(own_vertices) {}
    bool knows_distance(const Thickness& /*thickness*/) const override { return true; }
    void refit(const Step& step) override {
      const Motion& motion = step.motion;
      pairs_.refit_own({motion.start().first(own_vertices_), motion.end().first(own_vertices_)},
                       step.thickness.largest());
    }
    CullCounts cull(TrianglePairSink& sink) override {
      CullCounts counts;
      counts.bvot = pairs_.cull(sink);
      return counts;
    }

   private:
    ObstaclePairs& pairs_;
    std::size_t own_vertices_;
  };

 private:
  void descend(NodeIndex a, NodeIndex b, TrianglePairSink& sink, std::uint64_t& tests) const {
    if (sink.closed()) return;
    ++tests;
    if (!overlap(own_[a], obstacles_[b])) return;
    const bool leaf_a = own_tree_.is_leaf(a), leaf_b = obstacle_tree_.is_leaf(b);
    if (leaf_a && leaf_b) {
      const auto t = static_cast<std::int32_t>(obstacle_tree_.triangle(b));
      sink.add(own_tree_.triangle(a), TriangleId{behind_ + t});
    } else if (leaf_b || (!leaf_a && size(own_[a]) > size(obstacles_[b]))) {
      descend(own_tree_.left(a), b, sink, tests);
      descend(own_tree_.right(a), b, sink, tests);
    } else {
      descend(a, obstacle_tree_.left(b), sink, tests);
      descend(a, obstacle_tree_.right(b), sink, tests);
    }
  }
  static float size(const Aabb& box) {
    float sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum -= box.at_least[k] + box.at_least[4 + k];
    return sum;
  }

  Tree own_tree_, obstacle_tree_;
  SweptBoxes own_, obstacles_;
  std::int32_t behind_;
};

Obstacles::Obstacles(const TriangleMesh& own, std::span<const Vec3> reference, const TriangleMesh& beside,
                     std::span<const Vec3> positions, std::vector<std::size_t> first_vertex,
                     const ElementaryTest& elementary)
    : own_vertices_(own.vertex_count()),
      together_(joined(own, beside)),
      elementary_(elementary),
      first_vertex_(std::move(first_vertex)),
      start_(reference.begin(), reference.end()),
      follows_(first_vertex_.size(), true),
      moved_(first_vertex_.size(), false),
      at_rest_(first_vertex_.size(), true),
      pairs_(std::make_unique<ObstaclePairs>(own, reference, beside, positions)),
      start_test_(together_, std::make_unique<ObstaclePairs::View>(*pairs_, own_vertices_)) {
  has_loose_ = count_loose_vertices(beside).count > 0;
  for (std::size_t& first : first_vertex_) first += own_vertices_;
  first_vertex_.push_back(together_.vertex_count());
  start_.insert(start_.end(), positions.begin(), positions.end());
  end_ = start_;
  pairs_->refit_obstacles({positions, positions});
  make_detectors();
}

void Obstacles::leave_out(const Exclusions& exclusions) {
  exclusions_ = &exclusions;
  make_detectors();
}

void Obstacles::make_detectors() {
  const auto detector = [&](bool first) {
    const StrategyInput setup{together_, start_, nullptr, elementary_, 1, first, exclusions_};
    return compose(std::make_unique<ObstaclePairs::View>(*pairs_, own_vertices_), setup,
                   {.relative_boxes = true, .own_vertices = own_vertices_});
  };
  first_ = detector(true);
  all_ = detector(false);
  candidates_.emplace(together_, start_, exclusions_, own_vertices_);
}

Obstacles::~Obstacles() = default;

std::size_t Obstacles::vertex_count(std::size_t obstacle) const {
  return first_vertex_[obstacle + 1] - first_vertex_[obstacle];
}

void Obstacles::move(std::size_t obstacle, std::span<const Vec3> start, std::span<const Vec3> end) {
  const std::size_t first = first_vertex_[obstacle], count = vertex_count(obstacle);
  const std::span<Vec3> kept_start = std::span(start_).subspan(first, count),
                        kept_end = std::span(end_).subspan(first, count);
  // Where an obstacle is moved twice between two steps, the end of the last step is no longer known.
  follows_[obstacle] = !moved_[obstacle] && same_bits(start, kept_end);
  moved_[obstacle] = true;
  at_rest_[obstacle] = same_bits(start, end);
  stale_ = stale_ || !same_bits(start, kept_start) || !same_bits(end, kept_end);
  std::ranges::copy(start, kept_start.begin());
  std::ranges::copy(end, kept_end.begin());
}

bool Obstacles::starts_where_a_free_step_ended(const Motion& own) const {
  return free_ && std::ranges::find(follows_, false) == follows_.end() &&
         same_bits(own.start(), std::span(end_).first(own_vertices_));
}

// Whether something of an obstacle comes near a box. Loose vertices are in no triangle's box.
bool Obstacles::near(const Aabb& box) const {
  return has_loose_ || pairs_->near(box);
}

// Computes the bounds of obstacles anew where some of them have moved.
void Obstacles::bring_up_to_date() {
  if (!stale_) return;
  pairs_->refit_obstacles({std::span(start_).subspan(own_vertices_), std::span(end_).subspan(own_vertices_)});
  stale_ = false;
}

void Obstacles::step(const Motion& own, bool first, bool time_alone, bool see_start, ContactSet& found,
                     Crossings& start) {
  found.clear();
  start.pairs.clear();
  start.total = 0;
  bring_up_to_date();
  const Aabb box = thickness_.is_zero() ? box_of(own) : thickened(box_of(own), thickness_.largest());
  if (!near(box)) {  // the start is apart as well
    free_ = false;
    return;
  }
  const bool known_free = starts_where_a_free_step_ended(own);
  free_ = false;  // until the step is answered
  std::ranges::copy(own.start(), start_.begin());
  std::ranges::copy(own.end(), end_.begin());
  if (see_start && !known_free) {
    start = start_test_.find_all(start_, kMostCrossings);
    if (exclusions_ != nullptr)
      start.total -= std::erase_if(start.pairs, [&](const CrossingPair& pair) {
        return exclusions_->excludes(together_, TrianglePair{pair.first, pair.second});
      });
  }
  (first ? first_ : all_)
      ->detect({.motion = motion(), .thickness = thickness_, .time_alone = time_alone}, found);
  found.sort();
  if (first) keep_first(found);
  // With exclusions two triangles may come to cross by a contact that is left out.
  free_ = see_start && exclusions_ == nullptr && found.contacts.empty() && start.total == 0;
  moved_.assign(moved_.size(), false);
  follows_ = at_rest_;
}

void Obstacles::find_candidates(const Motion& own, const Thickness& thickness,
                                std::vector<FeaturePair>& out) {
  out.clear();
  candidates_->start_step();
  bring_up_to_date();
  if (!near(thickened(box_of(own), thickness.largest()))) return;
  free_ = false;  // the positions of the last step are written over
  std::ranges::copy(own.start(), start_.begin());
  std::ranges::copy(own.end(), end_.begin());
  pairs_->refit_own(own, thickness.largest());
  CandidateSink sink(*candidates_, motion(), thickness, out);
  pairs_->cull(sink);
  sink.flush();
  candidates_->take_loose(motion(), thickness, out);
}

}  // namespace cscd
