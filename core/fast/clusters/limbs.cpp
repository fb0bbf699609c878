#include "core/fast/clusters/limbs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include "core/base/numbers.h"
#include "core/mesh/adjacency.h"

namespace cscd::fast {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kMostBuckets = 1 << 16;

// A branch is a limb if the square of its length is more than this share of its area. A tube as long as half
// its girth is at 0.5, half a ball at 0.39.
constexpr double kLong = 0.35;
// A branch that is not long still is no mere bump of a limb that it meets if it has more than this share of
// the limb's area.
constexpr double kBulky = 0.25;
constexpr double kFoot = 0.2;      // this share of a limb's length is its foot, which says how wide it is
constexpr double kBottomRows = 3;  // so many rows of triangles at its root are where a limb grows from

// The triangles that lie beyond a place where paths from one source meet again. Branches that meet end there,
// and what lies before that place is a branch of its own.
struct Branch {
  Limb part;       // `along` is the length of the path from the source
  double tip = 0;  // the greatest length
  double area = 0;
  bool is_hub = false;   // other branches have ended in it
  std::size_t into = 0;  // the branch that it has ended in, or itself
};

// Finds the branches of a component by the lengths of paths that have been measured. Goes through the
// triangles from the farthest to the nearest: a triangle that touches no branch begins one, and where a
// triangle touches several, those that are limbs end.
class Branches {
 public:
  Branches(const TrianglePaths& paths, std::span<const double> area, std::span<const TriangleId> component)
      : paths_(paths), area_(area), branch_of_(area.size(), kNone) {
    std::vector<TriangleId> order(component.begin(), component.end());
    std::ranges::stable_sort(order,
                             [&](TriangleId a, TriangleId b) { return paths.length(a) > paths.length(b); });
    for (const TriangleId t : order) {
      Branch& branch = branches_[branch_at(t)];
      branch.part.triangles.push_back(t);
      branch.area += area[+t];
      branch_of_[+t] = static_cast<std::int32_t>(branch.into);
    }
    for (Branch& branch : branches_)
      for (const TriangleId t : branch.part.triangles) branch.part.along.push_back(paths.length(t));
  }

  const std::vector<Branch>& all() const { return branches_; }

 private:
  std::size_t begin(double tip) {
    branches_.push_back({{}, tip, 0, false, branches_.size()});
    return branches_.size() - 1;
  }

  std::size_t branch_at(TriangleId t) {
    met_.clear();
    for (const TrianglePaths::Step& step : paths_.steps_from(t)) {
      if (branch_of_[+step.to] == kNone) continue;
      std::size_t b = index(branch_of_[+step.to]);
      while (branches_[b].into != b) b = branches_[b].into;
      if (std::ranges::find(met_, b) == met_.end()) met_.push_back(b);
    }
    if (met_.empty()) return begin(paths_.length(t));
    return met_.size() == 1 ? met_[0] : joined(paths_.length(t));
  }

  // Joins the branches that meet, at some distance from the source. Returns the branch that goes on.
  std::size_t joined(double here) {
    const auto area = [&](std::size_t b) { return branches_[b].area; };
    const std::size_t largest = *std::ranges::max_element(met_, {}, area);
    const auto is_long = [&](std::size_t b) {
      const double length = branches_[b].tip - here;
      return length * length > kLong * branches_[b].area;
    };
    const auto counts = [&](std::size_t b) {
      return is_long(b) || branches_[b].is_hub || area(b) > kBulky * area(largest);
    };
    const bool limbs_end = std::ranges::count_if(met_, counts) >= 2;
    const std::size_t on = limbs_end ? begin(here) : largest;
    for (const std::size_t b : met_) {
      if (b == on) continue;
      if (!limbs_end || !is_long(b)) absorb(b, on);
      branches_[b].into = on;
    }
    branches_[on].is_hub |= limbs_end;
    return on;
  }

  void absorb(std::size_t from, std::size_t into) {
    Branch &a = branches_[into], &b = branches_[from];
    a.part.triangles.insert(a.part.triangles.end(), b.part.triangles.begin(), b.part.triangles.end());
    a.area += std::exchange(b.area, 0);
    a.tip = std::max(a.tip, b.tip);
    a.is_hub |= b.is_hub;
    b.part.triangles.clear();
  }

  const TrianglePaths& paths_;
  std::span<const double> area_;
  std::vector<std::int32_t> branch_of_;  // [triangles]
  std::vector<Branch> branches_;
  std::vector<std::size_t> met_;
};

double area_of(std::span<const double> area, std::span<const TriangleId> triangles) {
  return std::accumulate(triangles.begin(), triangles.end(), 0.0,
                         [&](double sum, TriangleId t) { return sum + area[+t]; });
}

// Lets every limb grow into the hub by about its radius.
void grow_roots(TrianglePaths& paths, std::span<const double> area, Body& body) {
  std::vector<std::int32_t> piece(area.size(), kNone);  // the limb of each triangle
  std::vector<double> radius, lowest;
  std::vector<TriangleId> bottoms, reached = body.hub;
  for (const Limb& limb : body.limbs) {
    const double length = limb.length();
    const double row =
        std::sqrt(2 * area_of(area, limb.triangles) / static_cast<double>(limb.triangles.size()));
    double foot = 0;
    lowest.push_back(limb.lowest());
    for (std::size_t i = 0; i < limb.triangles.size(); ++i) {
      const TriangleId t = limb.triangles[i];
      const double height = limb.along[i] - lowest.back();
      if (height < kFoot * length) foot += area[+t];
      if (height >= kBottomRows * row) continue;
      piece[+t] = static_cast<std::int32_t>(radius.size());
      bottoms.push_back(t);
    }
    radius.push_back(length > 0 ? foot / (kFoot * length) / (2 * std::numbers::pi) : 0);
  }
  reached.insert(reached.end(), bottoms.begin(), bottoms.end());
  const double widest = *std::ranges::max_element(radius);
  std::vector<double> stretch;
  for (const double r : radius) stretch.push_back(r > 0 ? widest / r : 1);
  paths.grow(piece, reached, bottoms, stretch);
  std::erase_if(body.hub, [&](TriangleId t) {
    if (piece[+t] == kNone || !(paths.length(t) < widest)) return false;
    const std::size_t l = index(piece[+t]);
    body.limbs[l].triangles.push_back(t);
    body.limbs[l].along.push_back(lowest[l] - paths.length(t) / stretch[l]);
    return true;
  });
}

}  // namespace

TrianglePaths::TrianglePaths(const TriangleMesh& mesh, std::span<const Vec3> positions, Steps steps)
    : length_(mesh.triangle_count()) {
  std::vector<Vec3> middle;
  for (const Triangle& c : mesh.triangles())
    middle.push_back(positions[+c[0]] / 3 + positions[+c[1]] / 3 + positions[+c[2]] / 3);
  std::vector<std::int32_t> met(mesh.triangle_count(), -1);
  std::size_t finite = 0;
  double sum = 0;
  for (std::size_t t = 0; t < middle.size(); ++t) {
    const auto number = static_cast<std::int32_t>(t);
    first_step_.push_back(steps_.size());
    const auto take = [&](TriangleId next) {
      if (met[+next] == number || +next == t) return;
      met[+next] = number;
      steps_.push_back({next, (middle[+next] - middle[t]).norm()});
      if (std::isfinite(steps_.back().length)) sum += steps_.back().length, ++finite;
    };
    if (steps == Steps::over_vertices)
      for_each_neighbour(mesh, TriangleId{number}, take);
    else
      for (const EdgeId e : mesh.edges_of(TriangleId{number}))
        std::ranges::for_each(mesh.triangles_at(e), take);
  }
  first_step_.push_back(steps_.size());
  if (finite > 0 && sum > 0) bucket_width_ = sum / static_cast<double>(finite);
}

void TrianglePaths::put(TriangleId t, double length) {
  length_[+t] = length;
  const auto bucket = static_cast<std::size_t>(std::min(length / bucket_width_, kMostBuckets));
  if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
  buckets_[bucket].push_back({t, length});
}

// Paths wait in buckets by their length. A bucket is about one step wide, and within it no order is kept: a
// triangle that is reached on a shorter path later is looked at again. That takes less time than a heap, and
// ends at the same lengths.
template <class LengthOf, class Take>
void TrianglePaths::flood(std::span<const TriangleId> reached, std::span<const TriangleId> seeds,
                          const LengthOf& length_of, const Take& take) {
  for (const TriangleId t : reached) length_[+t] = kInfinite;
  for (const TriangleId seed : seeds) put(seed, 0);
  for (std::size_t bucket = 0; bucket < buckets_.size(); ++bucket) {
    for (std::size_t i = 0; i < buckets_[bucket].size(); ++i) {
      const auto [t, length] = buckets_[bucket][i];
      if (length > length_[+t]) continue;
      for (const Step& step : steps_from(t)) {
        const double through = length + length_of(t, step);
        if (!(through < length_[+step.to])) continue;
        take(t, step.to);
        put(step.to, through);
      }
    }
    buckets_[bucket].clear();
  }
}

void TrianglePaths::measure(std::span<const std::int32_t> piece, std::span<const TriangleId> reached,
                            std::span<const TriangleId> seeds) {
  flood(
      reached, seeds,
      [&](TriangleId from, const Step& step) {
        return piece[+step.to] == piece[+from] ? step.length : kInfinite;
      },
      [](TriangleId, TriangleId) {});
}

void TrianglePaths::grow(std::span<std::int32_t> piece, std::span<const TriangleId> reached,
                         std::span<const TriangleId> seeds, std::span<const double> stretch) {
  std::fill(length_.begin(), length_.end(), 0.0);  // no path is shorter, so none leaves what is to be reached
  flood(
      reached, seeds,
      [&](TriangleId from, const Step& step) {
        return step.length * stretch[static_cast<std::size_t>(piece[+from])];
      },
      [&](TriangleId from, TriangleId to) { piece[+to] = piece[+from]; });
}

double Limb::lowest() const {
  return *std::ranges::min_element(along);
}

double Limb::length() const {
  const auto [low, high] = std::ranges::minmax_element(along);
  return *high - *low;
}

Body body_of(TrianglePaths& paths, std::span<const double> area, std::span<const std::int32_t> piece,
             std::span<const TriangleId> component) {
  const auto farthest_from = [&](TriangleId from) {
    paths.measure(piece, component, std::span(&from, 1));
    return *std::ranges::max_element(component, {}, [&](TriangleId t) { return paths.length(t); });
  };
  const TriangleId one = farthest_from(component[0]), other = farthest_from(one);
  Body body;
  std::vector<bool> taken(area.size());
  const auto take = [&](const Limb& part) {
    Limb limb;
    for (std::size_t i = 0; i < part.triangles.size(); ++i) {
      if (taken[+part.triangles[i]]) continue;
      taken[+part.triangles[i]] = true;
      limb.triangles.push_back(part.triangles[i]);
      limb.along.push_back(part.along[i]);
    }
    if (!limb.triangles.empty()) body.limbs.push_back(std::move(limb));
  };
  const Branches from_one(paths, area, component);
  for (const Branch& branch : from_one.all())
    if (!branch.is_hub) take(branch.part);
  if (std::ranges::all_of(component, [&](TriangleId t) { return taken[+t]; })) return body;
  // No branches meet where the limb ends in which the paths begin. From the other end of the surface they do.
  farthest_from(other);
  const Branches from_other(paths, area, component);
  for (const Branch& branch : from_other.all())
    if (!branch.is_hub && std::ranges::find(branch.part.triangles, one) != branch.part.triangles.end())
      take(branch.part);
  for (const TriangleId t : component)
    if (!taken[+t]) body.hub.push_back(t);
  if (!body.hub.empty() && !body.limbs.empty()) grow_roots(paths, area, body);
  return body;
}

}  // namespace cscd::fast
