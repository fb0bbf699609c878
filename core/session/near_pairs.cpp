#include "core/session/near_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/rounding.h"
#include "core/detect/carried_pairs.h"
#include "core/detect/compose.h"
#include "core/detect/contact_geometry.h"
#include "core/detect/filter_block.h"
#include "core/geometry/nearest_points.h"
#include "core/mesh/mean_edge.h"

namespace cscd {
namespace {

// How far a list reaches beyond the thickness, in mean edges: no farther than neighbours on the surface, of
// which there are many; less at first, until it is known how many pairs that are.
constexpr double kMostReach = 0.5, kFirstReach = 0.25;
// A list is made to last for twice as many steps as the one before has covered, at least for the first
// number. It is not made where it would last for fewer than the second.
constexpr std::size_t kFirstSteps = 16;
constexpr double kLeastSteps = 3;
// A list holds the nearest pairs: at least the number below, at most as many as there are triangles, and in
// between what takes a few times as long to find as a strategy took for a step. That is as many as it tested
// pairs of triangles, and one for so many overlap tests. The next list reaches no farther than one that was
// cut short. After one that holds less than this share of what it may hold, it reaches farther, by the
// factor.
constexpr double kOverlapTests = 32, kFew = 0.5;
constexpr std::size_t kLeastMany = 1024;
constexpr double kWider = 2;
// So many small steps go by without a list after one that has covered too few, and after several such lists.
constexpr std::size_t kFirstWait = 8, kLongestWait = 256;
constexpr double kFarShorter = 4;
// Steps in which nothing moves need no room; what comes after them does, at least this share of the most.
constexpr double kLeastRoom = 0.0625;
constexpr std::size_t kSampled = 64;
// Squares of lengths below this underflow.
constexpr double kTiny = 0x1p-480;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// The roundings of a few sums and of a square root, as a factor.
double rounded_up(double length) {
  return std::max(length, kTiny) * (1 + 16 * kUnitRoundoff);
}

Vec3 mean_displacement(std::span<const Vec3> from, std::span<const Vec3> to,
                       std::span<const std::size_t> sample) {
  Vec3 sum = Vec3::Zero();
  for (const std::size_t v : sample) sum += to[v] - from[v];
  return sum / static_cast<double>(sample.size());
}

// The distance of what two triangles carry, in a pose, is at least this.
double least_distance(const TriangleMesh& mesh, std::span<const Vec3> pose, const CarriedPairs& carried) {
  double least = kInfinite;
  for_each_carried(mesh, carried, [&](const FeaturePair& pair) {
    const auto [p, q, r, s] = vertices_of(mesh, pair);
    const std::array<Vec3, 4> points{pose[+p], pose[+q], pose[+r], pose[+s]};
    const bool is_face = pair.kind == FeaturePair::Kind::vertex_face;
    const Nearest nearest = is_face ? nearest_of_vertex_face(points) : nearest_of_edges(points);
    least = std::min(least, distance_bounds(points, is_face ? 1 : 2, nearest.way).low);
  });
  return least;
}

class NearCuller : public Culler {
 public:
  explicit NearCuller(const NearPairs& near) : near_(near) {}
  bool knows_distance(const Thickness& /*thickness*/) const override { return true; }
  void refit(const Step& step) override { step_ = &step; }
  CullCounts cull(TrianglePairSink& sink) override {
    near_.pass_on(step_->motion, sink);
    return {};
  }
  bool keeps_all() const override { return true; }

 private:
  const NearPairs& near_;
  const Step* step_ = nullptr;  // whose answer is being made
};

}  // namespace

// Takes what is within the reach in a pose. Where that is more than a list holds, gives up the half that is
// farthest, and reaches less far from then on.
class NearPairs::Collector : public TrianglePairSink {
 public:
  Collector(const TriangleMesh& mesh, std::span<const Vec3> pose, std::size_t most, double reach,
            std::vector<Near>& out)
      : mesh_(mesh), pose_(pose), most_(most), reach_(reach), out_(out) {}
  // What was passed on and is not in the list is farther apart than this.
  double reach() const { return reach_; }

 private:
  void take(const std::vector<TrianglePair>& block) override {
    const Motion rest(pose_, pose_);
    for (std::size_t first = 0; first < block.size(); first += kLanes16) {
      const auto pairs = std::span(block).subspan(first, std::min(kLanes16, block.size() - first));
      const auto before = no_contact_before(mesh_, rest, pairs, reach_);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (before[i] > 1) continue;
        const Triangle &a = mesh_.corners(pairs[i].a), &b = mesh_.corners(pairs[i].b);
        const CarriedPlaces near = not_farther_than(reach_, rest, a, b, carried_by(a, b));
        if (near == 0) continue;
        const double low = least_distance(mesh_, pose_, {pairs[i], near});
        if (low <= reach_) out_.push_back({low, pairs[i]});
      }
      if (out_.size() > most_) reach_less_far();
      if (closed()) return;
    }
  }
  void reach_less_far() {
    const auto middle = out_.begin() + static_cast<std::ptrdiff_t>(most_ / 2);
    std::ranges::nth_element(out_, middle, {}, &Near::low);
    reach_ = middle->low;
    std::erase_if(out_, [&](const Near& near) { return near.low > reach_; });
    if (out_.size() > most_ || !(reach_ > 0)) close();
  }

  const TriangleMesh& mesh_;
  std::span<const Vec3> pose_;
  std::size_t most_;
  double reach_;
  std::vector<Near>& out_;
};

NearPairs::NearPairs(const TriangleMesh& mesh, std::span<const Vec3> reference, const Thickness& thickness)
    : mesh_(mesh), thickness_(thickness), edge_(mean_edge(mesh, reference)), most_room_(kFirstReach * edge_) {
  const std::size_t count = std::min(kSampled, mesh.vertex_count());
  for (std::size_t i = 0; i < count; ++i) sample_.push_back(i * mesh.vertex_count() / count);
}

// The displacement of the sample within one step, less its mean. No bound: it spares large steps a look at
// all vertices.
double NearPairs::sampled_length(const Motion& motion) const {
  const Vec3 mean = mean_displacement(motion.start(), motion.end(), sample_);
  double longest = 0;
  for (const std::size_t v : sample_)
    longest = std::max(longest, (motion.end()[v] - motion.start()[v] - mean).squaredNorm());
  return std::sqrt(longest);
}

double NearPairs::moved(const Motion& motion, std::span<const Vec3> from, double enough) const {
  constexpr std::size_t kBlock = 1024;
  double error = 0;  // of differences, whose roundings are shares of what they are made of
  double longest = 0;
  for (std::size_t end = 0; end < 2; ++end) {
    const std::span<const Vec3> to = end == 0 ? motion.start() : motion.end();
    const Vec3 shift = mean_displacement(from, to, sample_);
    Vec3 largest = Vec3::Zero();
    for (std::size_t first = 0; first < from.size(); first += kBlock) {
      const std::size_t last = std::min(first + kBlock, from.size());
      for (std::size_t v = first; v < last; ++v) {
        const Vec3 displacement = to[v] - from[v];
        largest = largest.cwiseMax(displacement.cwiseAbs());
        longest = std::max(longest, (displacement - shift).squaredNorm());
      }
      if (!(std::sqrt(longest) <= enough)) return kInfinite;
    }
    error = std::max(error, 4 * kUnitRoundoff * (largest.maxCoeff() + shift.cwiseAbs().maxCoeff()));
  }
  const double bound = rounded_up(std::sqrt(longest) + error);
  return bound <= enough ? bound : kInfinite;
}

bool NearPairs::is_within_reach(const Motion& motion) {
  const double thick = thickness_.largest();
  moved_ = moved(motion, anchor_, reach_);
  // Rounded up, so that what is farther than the reach stays farther than the thickness.
  return rounded_up(2 * moved_ + thick) <= reach_;
}

void NearPairs::note_work(const CullCounts& counts) {
  worth_ =
      counts.pctp + static_cast<std::size_t>(static_cast<double>(counts.bvot.value_or(0)) / kOverlapTests);
}

bool NearPairs::covers(const Motion& motion) {
  if (!(reach_ > 0) || !(2 * sampled_length(motion) <= reach_ - thickness_.largest()) ||
      !is_within_reach(motion))
    return false;
  ++served_;
  return true;
}

bool NearPairs::is_worth_anchoring(const Motion& motion) {
  const double longest = most_room_ / (2 * kLeastSteps);
  if (sample_.empty() || !(longest > 0)) return false;
  const double length = sampled_length(motion);
  if (!(length <= longest)) return false;
  if (waits_ > 0 && kFarShorter * length >= waits_for_) return --waits_, false;
  length_ = moved(motion, motion.start(), longest);
  return length_ <= longest;
}

bool NearPairs::anchor(const Motion& motion, Detector& detector) {
  const bool served_few = anchors_ > 0 && static_cast<double>(served_) < kLeastSteps;
  waits_ = next_wait_ = served_few ? std::clamp(2 * next_wait_, kFirstWait, kLongestWait) : 0;
  waits_for_ = length_;
  const auto steps = static_cast<double>(std::max(kFirstSteps, 2 * served_));
  const double room = std::clamp(2 * steps * length_, kLeastRoom * most_room_, most_room_);
  return make_anchor(motion.start(), thickness_.largest() + room, detector) && is_within_reach(motion);
}

bool NearPairs::make_anchor(std::span<const Vec3> pose, double reach, Detector& detector) {
  ++anchors_;
  served_ = 0;
  reach_ = 0;  // nothing is known until the list is whole
  near_.clear();
  anchor_.assign(pose.begin(), pose.end());
  const std::size_t most = std::max(kLeastMany, std::min(mesh_.triangle_count(), worth_));
  Collector collector(mesh_, anchor_, most, reach, near_);
  if (!detector.pass_on({.motion = Motion(anchor_, anchor_), .thickness = Thickness(reach)}, collector))
    return most_room_ = 0, false;
  const double room = collector.reach() - thickness_.largest();
  if (collector.closed() || !(room > 0)) return most_room_ /= kWider, false;
  if (collector.reach() < reach)
    most_room_ = room;
  else if (static_cast<double>(near_.size()) < kFew * static_cast<double>(most))
    most_room_ = std::clamp(kWider * room, most_room_, kMostReach * edge_);
  std::ranges::sort(near_, {}, &Near::low);
  reach_ = collector.reach();
  return true;
}

void NearPairs::pass_on(const Motion& motion, TrianglePairSink& sink) const {
  const double thick = thickness_.largest(), most = rounded_up(2 * moved_ + thick);
  for (const auto& [low, pair] : near_) {
    if (low > most) break;
    const Triangle &a = mesh_.corners(pair.a), &b = mesh_.corners(pair.b);
    // Both triangles as seen from a corner of the first: what they have moved against each other.
    double apart = 0, error = 0;
    for (const std::span<const Vec3> to : {motion.start(), motion.end()}) {
      const Vec3 own = to[+a[0]] - anchor_[+a[0]];
      double of_a = 0, of_b = 0, largest = own.cwiseAbs().maxCoeff();
      const auto look = [&](VertexId v, double& most_moved) {
        const Vec3 displacement = to[+v] - anchor_[+v];
        largest = std::max(largest, displacement.cwiseAbs().maxCoeff());
        most_moved = std::max(most_moved, (displacement - own).squaredNorm());
      };
      look(a[1], of_a), look(a[2], of_a);
      for (const VertexId v : b) look(v, of_b);
      apart = std::max(apart, std::sqrt(of_a) + std::sqrt(of_b));
      error = std::max(error, 16 * kUnitRoundoff * largest);
    }
    if (!(low > rounded_up(apart + error + thick))) sink.add(pair.a, pair.b);
  }
}

std::unique_ptr<Detector> make_near_detector(const NearPairs& near, const StrategyInput& setup) {
  return compose(std::make_unique<NearCuller>(near), setup, {.threads = setup.threads});
}

}  // namespace cscd
