#include "core/fast/cut/surface_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "core/fast/cut/best_viewpoint.h"
#include "core/fast/cut/covers.h"
#include "core/fast/cut/seams.h"

namespace cscd::fast {
namespace {

constexpr double kShare = 0.8;  // this share of a piece's triangles has to be seen well from one point, at a
constexpr double kHalvedUntil =
    0.5;  // cosine between ray and normal of at least this, or the piece is halved,
constexpr double kMergedUntil = 0.3;  // and of this for pieces to be merged
constexpr std::size_t kSmall = 100;   // a piece of fewer triangles is not halved,
constexpr std::size_t kMany = 500;    // nor is one of less than this fraction of the surface
constexpr std::size_t kSample = 512;  // at most so many triangles of a piece are looked at
constexpr int kStraightened = 3;      // the number of times that seams are straightened

using Triangles = std::vector<TriangleId>;
using Pair = std::pair<std::int32_t, std::int32_t>;

// Pieces of the surface that are halved, merged and straightened until they are the clusters. At first each
// connected component is a piece.
class Pieces {
 public:
  Pieces(const TriangleMesh& mesh, std::span<const Vec3> positions)
      : mesh_(mesh), piece_(mesh.triangle_count()), path_(mesh.triangle_count()) {
    for (std::size_t t = 0; t < piece_.size(); ++t) {
      all_.push_back(TriangleId{static_cast<std::int32_t>(t)});
      faces_.push_back(face_of(mesh, positions, all_[t]));
      piece_[t] = mesh.component(all_[t]);
    }
    std::size_t steps = 0;
    double lengths = 0;
    for (const TriangleId t : all_) {
      first_step_.push_back(steps_.size());
      for (const EdgeId e : mesh.edges_of(t))
        for (const TriangleId next : mesh.triangles_at(e))
          if (next != t) steps_.push_back({next, (faces_[+next].centre - faces_[+t].centre).norm()});
    }
    first_step_.push_back(steps_.size());
    for (const Step& step : steps_)
      if (std::isfinite(step.length)) lengths += step.length, ++steps;
    bucket_width_ = steps > 0 && lengths > 0 ? lengths / static_cast<double>(steps) : 1;
  }

  // Halves pieces along their length, until enough of each piece is seen well or it is small.
  void halve() {
    std::vector<Triangles> open = members();
    auto count = static_cast<std::int32_t>(open.size());
    const std::size_t small = std::max(kSmall, piece_.size() / kMany);
    while (!open.empty()) {
      const Triangles piece = std::move(open.back());
      open.pop_back();
      if (piece.size() < 2 * small || seen_well(piece, kHalvedUntil)) continue;
      const TriangleId one = farthest_from(piece, piece[0]), other = farthest_from(piece, one);
      std::vector<double> to_one;
      for (const TriangleId t : piece) to_one.push_back(path_[+t]);
      flood(piece, {other}, false);
      std::array<Triangles, 2> halves;
      for (std::size_t i = 0; i < piece.size(); ++i)
        halves[path_[+piece[i]] < to_one[i] ? 1 : 0].push_back(piece[i]);
      if (halves[0].empty() || halves[1].empty()) continue;  // the piece has no extent
      for (const TriangleId t : halves[1]) piece_[+t] = count;
      ++count;
      for (Triangles& half : halves) open.push_back(std::move(half));
    }
  }

  // Merges neighbours while enough of both is seen well from one point, first those with the longest seam for
  // their size. Halves of a limb become rings again, and a hub with the stumps of many limbs becomes one
  // piece.
  void merge() {
    std::vector<Triangles> members = this->members();
    std::map<Pair, std::size_t> seams;  // lengths in edges
    std::vector<std::size_t> border(members.size());
    for_each_seam_edge(mesh_, piece_, [&](TriangleId a, TriangleId b) {
      ++seams[std::minmax(piece_[+a], piece_[+b])];
      ++border[index(piece_[+a])], ++border[index(piece_[+b])];
    });
    std::set<Pair> refused;
    const auto best = [&] {
      Pair found{-1, -1};
      double most = 0;
      for (const auto& [pair, length] : seams) {
        const auto& [a, b] = pair;
        const double share =
            static_cast<double>(length) / static_cast<double>(std::min(border[index(a)], border[index(b)]));
        if (share <= most || refused.contains(pair)) continue;
        most = share;
        found = pair;
      }
      return found;
    };
    for (Pair pair = best(); pair.first >= 0; pair = best()) {
      const std::int32_t into = pair.first, from = pair.second;
      Triangles both = members[index(into)];
      both.insert(both.end(), members[index(from)].begin(), members[index(from)].end());
      if (!seen_well(both, kMergedUntil)) {
        refused.insert(pair);
        continue;
      }
      for (const TriangleId t : members[index(from)]) piece_[+t] = into;
      members[index(into)] = std::move(both);
      border[index(into)] += border[index(from)] - 2 * seams[pair];
      seams.erase(pair);
      std::map<Pair, std::size_t> left;
      for (const auto& [other, length] : seams)
        left[std::minmax(other.first == from ? into : other.first,
                         other.second == from ? into : other.second)] += length;
      seams = std::move(left);
      std::erase_if(refused, [&](const Pair& p) {
        return p.first == into || p.second == into || p.first == from || p.second == from;
      });
    }
  }

  // Lets the pieces grow again from their middles. Seams then run halfway between the middles: straight round
  // a limb, not up and down.
  void straighten() {
    Triangles seam, middle;
    for_each_seam_edge(mesh_, piece_, [&](TriangleId a, TriangleId b) { seam.insert(seam.end(), {a, b}); });
    if (seam.empty()) return;
    flood(all_, seam, false);
    std::vector<double> deepest(pieces());
    for (std::size_t t = 0; t < piece_.size(); ++t)
      deepest[index(piece_[t])] = std::max(deepest[index(piece_[t])], path_[t]);
    std::copy_if(all_.begin(), all_.end(), std::back_inserter(middle),
                 [&](TriangleId t) { return path_[+t] >= deepest[index(piece_[+t])] / 2; });
    flood(all_, middle, true);
  }

  std::vector<std::int32_t> numbered() const {
    std::vector<std::int32_t> number(pieces(), kNone), out;
    std::int32_t count = 0;
    for (const std::int32_t p : piece_) {
      if (number[index(p)] == kNone) number[index(p)] = count++;
      out.push_back(number[index(p)]);
    }
    return out;
  }

 private:
  // One more than the largest number of a piece.
  std::size_t pieces() const { return index(*std::ranges::max_element(piece_)) + 1; }
  std::vector<Triangles> members() const {
    std::vector<Triangles> members(pieces());
    for (const TriangleId t : all_) members[index(piece_[+t])].push_back(t);
    return members;
  }

  bool seen_well(const Triangles& piece, double cosine) const {
    std::vector<Face> sample;
    const std::size_t stride = (piece.size() + kSample - 1) / kSample;
    for (std::size_t i = 0; i < piece.size(); i += stride) sample.push_back(faces_[+piece[i]]);
    const Vec3 from = best_viewpoint(sample);
    const auto well = std::count_if(sample.begin(), sample.end(), [&](const Face& f) {
      const Vec3 ray = f.centre - from;
      return f.normal.dot(ray) > cosine * ray.norm();
    });
    return static_cast<double>(well) >= kShare * static_cast<double>(sample.size());
  }

  TriangleId farthest_from(const Triangles& piece, TriangleId from) {
    flood(piece, {from}, false);
    return *std::max_element(piece.begin(), piece.end(),
                             [&](TriangleId a, TriangleId b) { return path_[+a] < path_[+b]; });
  }

  // Computes the lengths of shortest paths from the seeds. `reached` are the triangles that can be reached.
  // Without `take`, paths stay within one piece. With `take`, they go over all of these triangles, which then
  // belong to the piece of their seed.
  //
  // Paths wait in buckets by their length. A bucket is about one step wide, and within it no order is kept: a
  // triangle that is reached on a shorter path later is looked at again. That takes less time than a heap,
  // and ends at the same lengths.
  void flood(const Triangles& reached, const Triangles& seeds, bool take) {
    for (const TriangleId t : reached) path_[+t] = std::numeric_limits<double>::infinity();
    const auto put = [&](TriangleId t, double length) {
      path_[+t] = length;
      const auto bucket = static_cast<std::size_t>(std::min(length / bucket_width_, kMostBuckets));
      if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
      buckets_[bucket].push_back({t, length});
    };
    for (const TriangleId seed : seeds) put(seed, 0);
    for (std::size_t bucket = 0; bucket < buckets_.size(); ++bucket) {
      for (std::size_t i = 0; i < buckets_[bucket].size(); ++i) {
        const auto [t, length] = buckets_[bucket][i];
        if (length > path_[+t]) continue;
        for (std::size_t s = first_step_[+t]; s < first_step_[+t + 1]; ++s) {
          const Step& step = steps_[s];
          if (!take && piece_[+step.to] != piece_[+t]) continue;
          const double through = length + step.length;
          if (!(through < path_[+step.to])) continue;
          if (take) piece_[+step.to] = piece_[+t];
          put(step.to, through);
        }
      }
      buckets_[bucket].clear();
    }
  }

  static constexpr double kMostBuckets = 1 << 16;

  const TriangleMesh& mesh_;
  Triangles all_;
  std::vector<Face> faces_;
  std::vector<std::int32_t> piece_;  // [triangles]: the piece of each
  std::vector<double> path_;         // [triangles]: length of the shortest path in the last flood
  struct Step {
    TriangleId to;
    double length;
  };
  std::vector<std::size_t> first_step_;  // [triangles + 1]
  std::vector<Step> steps_;              // from each triangle over its edges
  double bucket_width_ = 1;
  std::vector<std::vector<Step>> buckets_;  // the triangles to go on from, with the length of the path there
};

}  // namespace

std::vector<std::int32_t> surface_clusters(const TriangleMesh& mesh, std::span<const Vec3> reference) {
  Pieces pieces(mesh, reference);
  pieces.halve();
  pieces.merge();
  for (int i = 0; i < kStraightened; ++i) pieces.straighten();
  return pieces.numbered();
}

}  // namespace cscd::fast
