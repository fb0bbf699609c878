#include "core/drvbc/mega_clusters.h"

#include <algorithm>
#include <numeric>
#include <random>

#include "core/base/random.h"

namespace cscd {

using radial::ClusterHierarchy;
using radial::Observer;
using radial::Orientation;
using radial::OrientationTable;

namespace {
constexpr std::int32_t kUnassigned = -1;
}

MegaClusters::MegaClusters(const radial::AtomicClusters& atomic, const Rig& rig,
                           std::vector<radial::ObserverKind> kinds, double gamma, bool cache)
    : atomic_(atomic),
      rig_(rig),
      kinds_(std::move(kinds)),
      gamma_(gamma),
      cache_(cache),
      seeds_(atomic.clusters.size()),
      label_(seeds_.size()),
      suspects_(seeds_.size()),
      refused_by_(seeds_.size()) {
  observers_.reserve(seeds_.size());
  std::iota(seeds_.begin(), seeds_.end(), std::size_t{0});
  std::mt19937 random(kPreparationSeed);
  shuffle(seeds_, random);
}

void MegaClusters::regrow(const OrientationTable& table, const Rig::Interval& bones,
                          ClusterHierarchy& hierarchy) {
  std::fill(label_.begin(), label_.end(), kUnassigned);
  std::fill(refused_by_.begin(), refused_by_.end(), kUnassigned);
  observers_.clear();
  for (const std::size_t seed : seeds_) {
    if (label_[seed] != kUnassigned) continue;
    const auto mega = static_cast<std::int32_t>(count());
    label_[seed] = mega;
    members_.assign(1, seed);
    const std::size_t bone = +atomic_.clusters[seed].bone;
    Observer observer = radial::observer(kinds_[seed], bones.start[bone], bones.end[bone]);
    const bool merged = merge_first_neighbour(seed, observer, table, bones, hierarchy);
    observers_.push_back(observer);
    if (!merged) {
      table.classify(seed, observer, hierarchy.classes(seed));
      continue;
    }
    // From here on the observer is fixed, and the cluster grows over its neighbours, breadth first.
    for (std::size_t next = 0; next < members_.size(); ++next)
      for (const std::int32_t candidate : atomic_.neighbours[members_[next]]) {
        const auto c = static_cast<std::size_t>(candidate);
        if (label_[c] != kUnassigned || refused_by_[c] == mega) continue;
        if (fits(c, observer, table, hierarchy)) {
          label_[c] = mega;
          members_.push_back(c);
        } else {
          refused_by_[c] = mega;
        }
      }
  }

  for (std::size_t c = 0; cache_ && c < suspects_.size(); ++c) {
    const std::span<const Orientation> classes = hierarchy.classes(c);
    suspects_[c].clear();
    for (std::uint32_t member = 0; member < classes.size(); ++member)
      if (classes[member] != Orientation::positive) suspects_[c].push_back(member);
  }
}

bool MegaClusters::merge_first_neighbour(std::size_t seed, Observer& observer, const OrientationTable& table,
                                         const Rig::Interval& bones, ClusterHierarchy& hierarchy) {
  if (gamma_ <= 0) return false;
  for (const std::int32_t candidate : atomic_.neighbours[seed]) {
    const auto c = static_cast<std::size_t>(candidate);
    if (label_[c] != kUnassigned) continue;
    const std::optional<MovingPoint> joint = shared_joint(seed, c, bones);
    if (!joint) continue;
    const Observer at_joint = Observer::point(*joint);
    if (!fits(c, at_joint, table, hierarchy) || !fits(seed, at_joint, table, hierarchy)) continue;
    label_[c] = label_[seed];
    members_.push_back(c);
    observer = at_joint;
    return true;
  }
  return false;
}

// Whether the share of triangles that are not positive is below gamma. Leaves the classes in the hierarchy.
bool MegaClusters::fits(std::size_t cluster, const Observer& observer, const OrientationTable& table,
                        ClusterHierarchy& hierarchy) {
  const std::span<Orientation> classes = hierarchy.classes(cluster);
  const auto too_many = [&](std::size_t count) {
    return static_cast<double>(count) >= gamma_ * static_cast<double>(classes.size());
  };
  std::size_t not_positive = 0;
  for (const std::uint32_t member : suspects_[cluster]) {
    not_positive += table.classify(cluster, member, observer) != Orientation::positive;
    if (too_many(not_positive)) return false;
  }
  table.classify(cluster, observer, classes);
  not_positive = classes.size() -
                 static_cast<std::size_t>(std::count(classes.begin(), classes.end(), Orientation::positive));
  return !too_many(not_positive);
}

// Returns the joint that the bones of two clusters share: the head of the child, or of either bone if they
// are siblings. Two clusters of one bone share the joint at its head.
std::optional<MovingPoint> MegaClusters::shared_joint(std::size_t a, std::size_t b,
                                                      const Rig::Interval& bones) const {
  const BoneId bone_a = atomic_.clusters[a].bone, bone_b = atomic_.clusters[b].bone;
  const BoneId parent_a = rig_.parent[+bone_a], parent_b = rig_.parent[+bone_b];
  const auto head = [&](BoneId bone) { return MovingPoint{bones.start[+bone].head, bones.end[+bone].head}; };
  if (parent_b == bone_a) return head(bone_b);
  if (parent_a == bone_b || bone_a == bone_b || (parent_a == parent_b && parent_a != BoneId{-1}))
    return head(bone_a);
  return std::nullopt;
}

}  // namespace cscd
