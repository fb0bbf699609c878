#include "core/fast/adaptive_cover.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace cscd::fast {
namespace {

// Nothing is done until one in kUnsettled of all triangles is not positive. Preparation has looked at
// clusters longer than can be done between two intervals, and characters in motion seldom have so many.
constexpr std::uint64_t kUnsettled = 4;
// A cluster is cut anew if more than one in kFailing of its triangles is certified by no cover.
constexpr std::uint32_t kFailing = 5;
// Returns the fewest triangles of a cluster that is halved. Halving smaller ones makes more seams, which cost
// more than is won. A single patch is always smaller, because it has no halves.
std::uint32_t least_halved(const TriangleMesh& mesh) {
  return static_cast<std::uint32_t>(std::clamp<std::size_t>(mesh.triangle_count() / 8, kLanes16 + 1, 512));
}
// Two halves may be joined unless more than one in kHopeless of their triangles is certified by no cover.
// Often it is the ragged contour between them that keeps triangles from being certified.
constexpr std::uint32_t kHopeless = 2;
// An observer is good enough if it sees this share of a cluster.
constexpr double kWellSeen = 0.97;
// Another observer is taken if it sees so much more.
constexpr double kBetter = 0.03;
// A cluster that fails again after so few intervals is halved, however well its observer seems to see it.
constexpr std::uint64_t kSoon = 8;
// Following may take one in kShare of what the descents take. Both are counted in overlap tests of bounding
// volumes: a search for an observer costs kSearch of them, and a cluster that is cut costs kTriangle for each
// of its triangles. What an interval leaves over is saved, up to kMostSaved; what it spends too much is owed.
constexpr std::int64_t kShare = 2, kSearch = 5000, kTriangle = 3;
constexpr std::int64_t kMostSaved = 20 * kSearch;
// So many triangles of a cluster are offered to its rays as targets.
constexpr std::size_t kMostTargets = 128;
// Once joining two halves has failed, it is put off for kFirstWait intervals, and for twice as many each
// further time.
constexpr std::uint32_t kFirstWait = 8, kLongestWait = 1024;
// Where no better observer was found, one is looked for again after so many intervals.
constexpr std::uint64_t kLasting = 64;

}  // namespace

AdaptiveCover::AdaptiveCover(const TriangleMesh& mesh, std::span<const Vec3> reference, CutSurface& cut)
    : mesh_(mesh),
      reference_(reference),
      cut_(cut),
      prepared_nodes_(cut.covers[0].observers.size()),
      prepared_observers_(cut.covers[0].observers),
      builder_(mesh),
      below_(cut.tree.nodes.size()),
      least_halved_(least_halved(mesh)),
      budget_(kMostSaved) {
  const PatchTree& tree = cut_.tree;
  std::vector<std::int32_t> own(below_.size());    // the cluster of everything below a node, or kNone
  for (std::size_t n = below_.size(); n-- > 0;) {  // children come after their parents
    Below& below = below_[n];
    below.wait = kFirstWait;
    const PatchTree::Node node = tree.nodes[n];
    if (node.is_leaf()) {
      const std::size_t p = node.patch();
      below.first = p;
      below.last = p + 1;
      below.triangles = static_cast<std::uint32_t>(tree.triangles_of(p).size());
      own[n] = tree.patches[p].cluster[0];
      continue;
    }
    const Below &left = below_[node.left()], &right = below_[node.right()];
    below.first = left.first;
    below.last = right.last;
    below.triangles = left.triangles + right.triangles;
    own[n] = own[node.left()] == own[node.right()] ? own[node.left()] : kNone;
    for (const std::size_t child : {node.left(), node.right()})
      if (own[n] != kNone) below_[child].parent = static_cast<std::int32_t>(n);
  }
  for (std::size_t n = 0; n < below_.size(); ++n)
    if (own[n] != kNone && below_[n].parent == kNone) {
      below_[n].cluster = own[n];
      prepared_nodes_[static_cast<std::size_t>(own[n])] = n;
    }
  for (const std::size_t node : prepared_nodes_) clusters_.push_back({node, 0, false, 0, 0});
}

void AdaptiveCover::forget(Certificates& certificates) {
  if (interval_ == 0 && whole_) return;
  whole_ = false;
  begun_ = false;
  interval_ = 0;
  next_to_join_ = 0;
  budget_ = kMostSaved;
  for (Below& below : below_) below.cluster = kNone, below.not_before = 0, below.wait = kFirstWait;
  positions_ = reference_;
  certificates_ = &certificates;
  clusters_.resize(prepared_nodes_.size());
  cut_.covers[0].observers = prepared_observers_;
  certificates.resize_first_cover();
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    clusters_[c] = {prepared_nodes_[c], 0, false, 0, 0};
    relabel(c);
    triangles_below(prepared_nodes_[c]);
    std::ranges::sort(triangles_);  // preparation takes them in this order
    certificates.set_cluster(c, builder_, mesh_, triangles_, triangles_, reference_);
  }
  whole_ = true;
}

void AdaptiveCover::follow(std::span<const Vec3> positions, std::uint64_t tests, Certificates& certificates) {
  ++interval_;
  positions_ = positions;
  certificates_ = &certificates;
  const RadialCounts& counts = certificates.counts();
  begun_ = begun_ || (counts.uncertain + counts.negative) * kUnsettled > mesh_.triangle_count();
  if (!begun_) return;
  count_uncertified(certificates);
  budget_ = std::min(budget_ + static_cast<std::int64_t>(tests) / kShare, kMostSaved);
  if (budget_ <= 0) return;
  whole_ = false;
  cut_failing();
  join_halves();
  whole_ = true;
}

// Counts what is not certified, and collects the clusters that fail, the one with most to win first.
void AdaptiveCover::count_uncertified(const Certificates& certificates) {
  for (Cluster& cluster : clusters_) cluster.uncertified = cluster.negative = 0;
  certificates.for_each_uncertified([&](std::size_t p, Mask16 uncertain, Mask16 negative) {
    Cluster& cluster = clusters_[static_cast<std::size_t>(cut_.tree.patches[p].cluster[0])];
    cluster.uncertified += static_cast<std::uint32_t>(std::popcount(static_cast<unsigned>(uncertain)));
    cluster.negative += static_cast<std::uint32_t>(std::popcount(static_cast<unsigned>(negative)));
  });
  // Positive and negative triangles of one cluster are not dropped against each other.
  for (Cluster& cluster : clusters_) {
    const std::uint32_t positive = below_[cluster.node].triangles - cluster.uncertified - cluster.negative;
    cluster.uncertified += std::min(positive, cluster.negative);
  }
  failing_.clear();
  for (std::size_t c = 0; c < clusters_.size(); ++c) {
    Cluster& cluster = clusters_[c];
    const std::uint32_t triangles = below_[cluster.node].triangles;
    const bool prepared_small = cluster.renewed == 0 && triangles < least_halved_;
    if (prepared_small || cluster.uncertified * kFailing <= triangles) continue;
    failing_.push_back(c);
    if (cluster.renewed == 0) continue;
    const std::uint64_t age = interval_ - cluster.renewed;
    cluster.failed = age <= kSoon || (cluster.failed && age <= kLasting);
  }
  // A stable sort would allocate memory in every interval.
  std::ranges::sort(failing_, [&](std::size_t a, std::size_t b) {
    return clusters_[a].uncertified != clusters_[b].uncertified
               ? clusters_[a].uncertified > clusters_[b].uncertified
               : a < b;
  });
}

// Gives failing clusters other observers or halves them, as long as the budget lasts.
void AdaptiveCover::cut_failing() {
  for (std::size_t next = 0; next < failing_.size() && budget_ > 0; ++next) {
    const std::size_t c = failing_[next], node = clusters_[c].node;
    const bool large = below_[node].triangles >= least_halved_;
    if (!clusters_[c].failed) {
      const Sight sight = sight_of(node);
      const double seen = brief_share_seen(mesh_, positions_, triangles_, cut_.covers[0].observers[c]);
      if (sight.seen > seen + kBetter && (sight.seen >= kWellSeen || !large)) {
        assign(c, node, sight.from);
        continue;
      }
      clusters_[c].failed = true;
      clusters_[c].renewed = interval_;
    }
    if (large) halve(c);
  }
}

void AdaptiveCover::halve(std::size_t cluster) {
  const std::size_t node = clusters_[cluster].node;
  const std::size_t left = cut_.tree.nodes[node].left(), right = cut_.tree.nodes[node].right();
  below_[node].cluster = kNone;
  put_off(below_[node]);
  const Sight left_sight = sight_of(left), right_sight = sight_of(right);
  assign(cluster, left, left_sight.from);
  const std::size_t other = add(right, right_sight.from);
  for (const auto& [half, seen] : {std::pair(cluster, left_sight.seen), std::pair(other, right_sight.seen)})
    if (seen < kWellSeen) {
      clusters_[half].failed = true;
      failing_.push_back(half);
    }
}

void AdaptiveCover::put_off(Below& whole) const {
  whole.not_before = interval_ + whole.wait;
  whole.wait = std::min(2 * whole.wait, kLongestWait);
}

void AdaptiveCover::join_halves() {
  for (std::size_t tried = 0; tried < clusters_.size() && budget_ > 0; ++tried) {
    next_to_join_ = (next_to_join_ + 1) % clusters_.size();
    const std::size_t c = next_to_join_;
    const std::int32_t parent = below_[clusters_[c].node].parent;
    if (parent == kNone) continue;
    const auto node = static_cast<std::size_t>(parent);
    Below& whole = below_[node];
    const std::int32_t left = below_[cut_.tree.nodes[node].left()].cluster;
    const std::int32_t right = below_[cut_.tree.nodes[node].right()].cluster;
    if (left == kNone || right == kNone || whole.not_before > interval_) continue;
    const std::uint32_t uncertified = clusters_[static_cast<std::size_t>(left)].uncertified +
                                      clusters_[static_cast<std::size_t>(right)].uncertified;
    if (uncertified * kHopeless > whole.triangles) continue;
    const Sight sight = sight_of(node);
    if (sight.seen < kWellSeen) {
      put_off(whole);
      continue;
    }
    below_[cut_.tree.nodes[node].left()].cluster = below_[cut_.tree.nodes[node].right()].cluster = kNone;
    assign(static_cast<std::size_t>(left), node, sight.from);
    remove(static_cast<std::size_t>(right));
  }
}

std::span<const TriangleId> AdaptiveCover::triangles_below(std::size_t node) {
  triangles_.clear();
  for (std::size_t p = below_[node].first; p < below_[node].last; ++p) {
    const std::span<const TriangleId> of_patch = cut_.tree.triangles_of(p);
    triangles_.insert(triangles_.end(), of_patch.begin(), of_patch.end());
  }
  return triangles_;
}

Sight AdaptiveCover::sight_of(std::size_t node) {
  budget_ -= kSearch;
  return brief_sight_of(mesh_, positions_, triangles_below(node));
}

void AdaptiveCover::assign(std::size_t cluster, std::size_t node, const FollowingPoint& observer) {
  budget_ -= kTriangle * below_[node].triangles;
  clusters_[cluster] = {node, interval_, false, 0, 0};
  cut_.covers[0].observers[cluster] = observer;
  relabel(cluster);
  const std::span<const TriangleId> all = triangles_below(node);
  targets_.clear();
  const std::size_t stride = (all.size() + kMostTargets - 1) / kMostTargets;
  for (std::size_t i = stride / 2; i < all.size(); i += stride) targets_.push_back(all[i]);
  certificates_->set_cluster(cluster, builder_, mesh_, all, targets_, positions_);
}

std::size_t AdaptiveCover::add(std::size_t node, const FollowingPoint& observer) {
  clusters_.emplace_back();
  cut_.covers[0].observers.emplace_back();
  certificates_->resize_first_cover();
  assign(clusters_.size() - 1, node, observer);
  return clusters_.size() - 1;
}

// The last cluster takes the number of the one that goes.
void AdaptiveCover::remove(std::size_t cluster) {
  const std::size_t last = clusters_.size() - 1;
  if (cluster != last) {
    clusters_[cluster] = clusters_[last];
    cut_.covers[0].observers[cluster] = cut_.covers[0].observers[last];
    certificates_->rename_last(cluster);
    relabel(cluster);
  }
  clusters_.pop_back();
  cut_.covers[0].observers.pop_back();
  certificates_->resize_first_cover();
}

// Enters a cluster wherever the clusters of triangles and patches are kept.
void AdaptiveCover::relabel(std::size_t cluster) {
  Below& below = below_[clusters_[cluster].node];
  below.cluster = static_cast<std::int32_t>(cluster);
  for (std::size_t p = below.first; p < below.last; ++p) {
    cut_.tree.patches[p].cluster[0] = below.cluster;
    for (const TriangleId t : cut_.tree.triangles_of(p)) cut_.covers[0].cluster_of[+t] = below.cluster;
  }
  certificates_->relabel(below.first, below.last);
}

}  // namespace cscd::fast
