#include "core/session/near_pairs.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/base/rounding.h"
#include "core/detect/compose.h"
#include "core/mesh/mean_edge.h"
#include "core/session/surface_motion.h"

namespace cscd {
namespace {

// How far an anchor reaches beyond the thickness, in mean edges: not as far as most neighbours on the
// surface, of which there are many, so for the first anchor at most the height that all but one in so many
// triangles exceed. Lists reach at most this share of that; the rest is for patches that bend.
constexpr double kMostReach = 0.5, kOfLists = 0.5;
constexpr std::size_t kFewLow = 100;
// A list is made to last for so many steps.
constexpr double kSteps = 8;
// Steps in which nothing moves need no room; what comes after them does, at least this share of the most.
constexpr double kLeastRoom = 0.0625;
// An anchor holds the nearest pairs: at most as many as there are triangles, or as many as what a strategy
// does in a step, and at least one for so many triangles, or the number below. The next anchor reaches no
// farther than one that was cut short. After one that holds less than this share of what it may hold, it
// reaches farther, by the factor.
constexpr std::size_t kTrianglesForOne = 8, kLeastMany = 1024;
constexpr double kFew = 0.5, kFarther = 2;
// After so many lists, which have taken about as long as an anchor, an anchor that reaches farther is made.
constexpr std::size_t kListsOfNearAnchor = 16;
// The work of a strategy is counted in pairs of triangles: those that it tests, one for so many overlap
// tests, and one for so many triangles that it looks at.
constexpr std::size_t kOverlapTests = 32, kLookedAt = 16;
// Making a list from an anchor is taken for as much work as one pair for so many triangles of the surface.
constexpr double kOfList = 12;
// Pairs are looked at because patches have bent until that takes this share of what an anchor takes.
constexpr double kBent = 0.5;
// So many small steps go by without an anchor after one that has spared less than it took, and after several
// of these; fewer where steps are so many times shorter.
constexpr std::size_t kFirstWait = 8, kLongestWait = 256;
constexpr double kFarShorter = 4;

// All but few triangles are higher than this. Neighbours that are not would be listed for each other.
double low_height(const TriangleMesh& mesh, std::span<const Vec3> pose) {
  std::vector<double> height(mesh.triangle_count());
  for (std::size_t t = 0; t < height.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles()[t];
    const Vec3 p = pose[+b] - pose[+a], q = pose[+c] - pose[+b], r = pose[+a] - pose[+c];
    const double longest = std::sqrt(std::max({p.squaredNorm(), q.squaredNorm(), r.squaredNorm()}));
    height[t] = longest > 0 ? p.cross(q).norm() / longest : 0;
  }
  const auto low = height.begin() + static_cast<std::ptrdiff_t>(height.size() / kFewLow);
  std::ranges::nth_element(height, low);
  return *low;
}

// Of a pair that is listed several times, keeps what says most.
void keep_one_of_each(std::vector<NearPair>& near) {
  const auto triangles = [](const NearPair& of) { return std::minmax(of.pair.a, of.pair.b); };
  std::ranges::sort(near, [&](const NearPair& a, const NearPair& b) {
    return std::tuple(triangles(a), b.low) < std::tuple(triangles(b), a.low);
  });
  const auto same = [&](const NearPair& a, const NearPair& b) { return triangles(a) == triangles(b); };
  near.erase(std::unique(near.begin(), near.end(), same), near.end());
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

NearPairs::NearPairs(const TriangleMesh& mesh, std::span<const Vec3> reference, const Thickness& thickness)
    : mesh_(mesh),
      reference_(reference),
      thickness_(thickness),
      edge_(mean_edge(mesh, reference)),
      sample_(sampled_vertices(mesh.vertex_count())),
      most_room_(kMostReach * edge_) {
  most_room_ =
      std::clamp(low_height(mesh, reference) - thickness.largest(), kLeastRoom * most_room_, most_room_);
}

bool NearPairs::is_within_reach(const Motion& motion) {
  const double thick = thickness_.largest();
  const double most = (reach_ - thick) / 2;
  if (!(reach_ > 0) || !(sampled_length(motion, sample_, most) <= most)) return false;
  needed_ = surface_motion(motion, pose_, sample_, most).reach(thick);
  return needed_ <= reach_;
}

void NearPairs::note_work(const CullCounts& counts) {
  work_ = static_cast<std::size_t>(counts.pctp + counts.bvot.value_or(0) / kOverlapTests) +
          mesh_.triangle_count() / kLookedAt + 1;
}

bool NearPairs::is_worth_listing(const Motion& motion) {
  // A list lasts for as many steps as fit into half of its reach. Together they have to spare at least the
  // work of making the list.
  const double spared = kOfList * static_cast<double>(work_) / static_cast<double>(mesh_.triangle_count());
  const double longest = std::min(1.0, spared) * kOfLists * most_room_ / 2;
  if (work_ == 0 || sample_.empty() || !(longest > 0)) return false;
  const double length = sampled_length(motion, sample_, longest);
  if (!(length <= longest)) return false;
  const bool has_anchor = is_anchor_ || (motions_ && motions_->has_anchor());
  if (!has_anchor && waits_ > 0 && kFarShorter * length >= waits_for_) return --waits_, false;
  length_ = surface_motion(motion, motion.start(), sample_, longest).most;
  return length_ <= longest;
}

// A list is made for the end of the step, because the next step is likely to start there.
bool NearPairs::covers(const Motion& motion, const Complete& complete) {
  if (!is_within_reach(motion)) {
    if (!is_worth_listing(motion)) return false;
    const double room = std::clamp(2 * kSteps * length_, kLeastRoom * most_room_, kOfLists * most_room_);
    if (!list(motion.end(), room, complete)) {
      Detector* const detector = complete();
      if (detector == nullptr || !anchor(motion.end(), *detector)) return false;
    }
    if (!is_within_reach(motion)) return forget_anchor(), false;
  }
  ++served_;
  return true;
}

void NearPairs::forget_anchor() {
  is_anchor_ = false;
  if (motions_) motions_->forget_anchor();
}

bool NearPairs::anchor(std::span<const Vec3> pose, Detector& detector) {
  const double thick = thickness_.largest();
  const bool spared_less = anchors_ > 0 && (served_ * work_ < looked_at_);
  waits_ = next_wait_ = spared_less ? std::clamp(2 * next_wait_, kFirstWait, kLongestWait) : 0;
  waits_for_ = length_;
  ++anchors_;
  served_ = looked_at_ = bent_ = 0;
  forget_anchor();
  reach_ = 0, near_.clear();  // nothing is known until the list is whole
  pose_.assign(pose.begin(), pose.end());
  const std::size_t count = mesh_.triangle_count();
  const std::size_t most = std::max(kLeastMany, std::clamp(work_, count / kTrianglesForOne, count));
  const double reach = thick + most_room_;
  NearCollector collector(mesh_, pose_, most, reach, near_);
  if (!detector.pass_on({.motion = Motion(pose_, pose_), .thickness = Thickness(reach)}, collector))
    return most_room_ = 0, false;
  looked_at_ = collector.count();
  const double room = collector.reach() - thick;
  if (collector.closed() || !(room > 0)) return most_room_ /= kFarther, false;
  if (collector.reach() < reach)
    most_room_ = room;
  else if (static_cast<double>(near_.size()) < kFew * static_cast<double>(most))
    most_room_ = std::min(kFarther * room, kMostReach * edge_);
  use_list(collector.reach());
  is_anchor_ = true;
  anchor_room_ = room;
  lists_of_anchor_ = 0;
  return true;
}

void NearPairs::use_list(double reach) {
  std::ranges::sort(near_, {}, &NearPair::low);
  reach_ = reach;
  ++lists_;
}

// The list of an anchor becomes what further lists are made from, by the patches of the strategy, if it knows
// any.
void NearPairs::take_anchor(const Complete& complete) {
  is_anchor_ = false;
  if (!motions_) {
    const Detector* const detector = complete();
    if (detector != nullptr && detector->patches() != nullptr)
      motions_.emplace(reference_, *detector->patches());
  }
  if (motions_) motions_->set_anchor(pose_, reach_, near_);
}

// Lists what comes within the thickness and some room in a pose, from the anchor.
bool NearPairs::list(std::span<const Vec3> pose, double room, const Complete& complete) {
  if (is_anchor_) take_anchor(complete);
  if (!motions_ || !motions_->has_anchor()) return false;
  if (++lists_of_anchor_ > kListsOfNearAnchor && most_room_ > anchor_room_) return forget_anchor(), false;
  reach_ = 0, near_.clear();
  pose_.assign(pose.begin(), pose.end());
  const double reach = thickness_.largest() + std::min(room, kOfLists * anchor_room_);
  NearCollector collector(mesh_, pose_, std::max(kLeastMany, mesh_.triangle_count()), reach, near_);
  const auto most = static_cast<std::size_t>(kBent * static_cast<double>(looked_at_));
  const std::optional<std::size_t> bent =
      motions_->pass_on(pose_, reach, most - std::min(most, bent_), near_, collector);
  if (!bent || collector.closed()) return motions_->forget_anchor(), false;
  if (*bent > 0) keep_one_of_each(near_);
  bent_ += *bent;
  use_list(collector.reach());
  return true;
}

void NearPairs::pass_on(const Motion& motion, TrianglePairSink& sink) const {
  const double thick = thickness_.largest();
  for (const auto& [low, pair] : near_) {
    if (low > needed_) break;
    const Triangle &a = mesh_.corners(pair.a), &b = mesh_.corners(pair.b);
    // Both triangles as seen from a corner of the first: what they have moved against each other.
    double apart = 0, error = 0;
    for (const std::span<const Vec3> to : {motion.start(), motion.end()}) {
      const Vec3 own = to[+a[0]] - pose_[+a[0]];
      double of_a = 0, of_b = 0, largest = own.cwiseAbs().maxCoeff();
      const auto look = [&](VertexId v, double& most_moved) {
        const Vec3 displacement = to[+v] - pose_[+v];
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
  return compose(std::make_unique<NearCuller>(near), setup, {.threads = setup.threads, .owners = true});
}

}  // namespace cscd
