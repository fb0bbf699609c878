#include "core/fast/clusters/surface_clusters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "core/base/numbers.h"
#include "core/fast/clusters/best_viewpoint.h"
#include "core/fast/clusters/limbs.h"
#include "core/fast/clusters/seams.h"

namespace cscd::fast {
namespace {

// How much of a piece one point has to see: this share of its triangles, with a cosine between ray and normal
// of at least this.
struct Sight {
  double share, cosine;
};
// Pieces of an open surface, and of a hub, are halved until then. A sheet bends anywhere, so its pieces may
// be larger than those of a limb.
constexpr Sight kSheet = {0.8, 0.5}, kHub = {0.8, 0.3};
constexpr Sight kSheetMerged = {0.8, 0.3};  // pieces of an open surface are merged as long as this holds
constexpr Sight kSlab = {0.95, 0.4};        // limbs are cut, and pieces of a closed surface merged, by this

constexpr std::size_t kSmall = 100;   // a piece of fewer triangles is not halved,
constexpr std::size_t kMany = 500;    // nor is one of less than this fraction of the surface
constexpr std::size_t kSample = 512;  // at most so many triangles of a piece are looked at
constexpr int kStraightened = 3;      // the number of times that seams are straightened

// A slab of a limb has at least so many rows of triangles of the surface that is cut into patches, and so
// many triangles. In a thinner slab, the clusters at its two seams (covers.h) leave no room between them for
// a patch.
constexpr double kSlabRows = 16, kSlabTriangles = 400;
constexpr std::size_t kBins = 64;  // parts of a limb whose girth is measured
constexpr double kLeastGirth =
    0.3;  // a limb counts as at least so thick at its tip, in times of its mean girth

using Triangles = std::vector<TriangleId>;
using Pair = std::pair<std::int32_t, std::int32_t>;

// Pieces of the surface that are halved, merged and straightened until they are the clusters. At first each
// connected component is a piece.
class Pieces {
 public:
  Pieces(const TriangleMesh& mesh, std::span<const Vec3> positions)
      : mesh_(mesh),
        has_limbs_(mesh.closed_and_oriented()),
        paths_(mesh, positions,
               has_limbs_ ? TrianglePaths::Steps::over_vertices : TrianglePaths::Steps::across_edges),
        piece_(mesh.triangle_count()) {
    for (std::size_t t = 0; t < piece_.size(); ++t) {
      all_.push_back(TriangleId{static_cast<std::int32_t>(t)});
      faces_.push_back(face_of(mesh, positions, all_[t]));
      piece_[t] = mesh.component(all_[t]);
    }
  }

  // Cuts limbs into slabs, and halves what they stick out from. A limb that has too few
  // rows to be cut is halved too; a limb that closes to a ring is one.
  void slice(std::span<const Vec3> positions, double fineness) {
    std::vector<double> area;
    for (const Triangle& c : mesh_.triangles())
      area.push_back((positions[+c[1]] - positions[+c[0]]).cross(positions[+c[2]] - positions[+c[0]]).norm() /
                     2);
    std::vector<Body> bodies;
    for (Triangles& component : members()) {
      const bool is_small = component.size() < 2 * least_triangles();  // nothing of it is cut
      bodies.push_back(is_small ? Body{{}, std::move(component)} : body_of(paths_, area, piece_, component));
    }
    std::int32_t count = 0;
    for (const Body& body : bodies) {
      for (const Limb& limb : body.limbs) name(limb.triangles, count);
      name(body.hub, count);
    }
    std::vector<Triangles> open;
    for (Body& body : bodies) {
      for (const Limb& limb : body.limbs) {
        std::vector<Triangles> slabs = slabs_of(limb, area, fineness);
        for (const Triangles& slab : slabs) name(slab, count);
        if (slabs.size() == 1) open.push_back(std::move(slabs[0]));
      }
      if (!body.hub.empty()) open.push_back(std::move(body.hub));
    }
    halve(std::move(open), kHub);
  }

  // Halves all pieces along their length, until enough of each piece is seen or it is small.
  void halve(const Sight& wanted) { halve(members(), wanted); }
  void halve(std::vector<Triangles> open, const Sight& wanted) {
    auto count = static_cast<std::int32_t>(pieces());
    const std::size_t small = least_triangles();
    while (!open.empty()) {
      const Triangles piece = std::move(open.back());
      open.pop_back();
      if (piece.size() < 2 * small || seen_well(piece, wanted)) continue;
      const TriangleId one = farthest_from(piece, piece[0]), other = farthest_from(piece, one);
      std::vector<double> to_one;
      for (const TriangleId t : piece) to_one.push_back(paths_.length(t));
      paths_.measure(piece_, piece, std::span(&other, 1));
      std::array<Triangles, 2> halves;
      for (std::size_t i = 0; i < piece.size(); ++i)
        halves[paths_.length(piece[i]) < to_one[i] ? 1 : 0].push_back(piece[i]);
      if (halves[0].empty() || halves[1].empty()) continue;  // the piece has no extent
      name(halves[1], count);
      for (Triangles& half : halves) open.push_back(std::move(half));
    }
  }

  // Merges neighbours while enough of both is seen well from one point, first those with the longest seam for
  // their size. Halves of a limb become rings again, and a hub with the stumps of many limbs becomes one
  // piece.
  void merge(const Sight& wanted) {
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
      if (!seen_well(both, wanted)) {
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
  // a limb, not up and down. Next to a limb, a hub would grow into it, so where there are limbs, pieces grow
  // in proportion to how deep they are.
  void straighten() {
    Triangles seam, middle;
    for_each_seam_edge(mesh_, piece_, [&](TriangleId a, TriangleId b) { seam.insert(seam.end(), {a, b}); });
    if (seam.empty()) return;
    paths_.measure(piece_, all_, seam);
    std::vector<double> deepest(pieces());
    for (const TriangleId t : all_) {
      double& deep = deepest[index(piece_[+t])];
      deep = std::max(deep, paths_.length(t));
    }
    std::copy_if(all_.begin(), all_.end(), std::back_inserter(middle),
                 [&](TriangleId t) { return paths_.length(t) >= deepest[index(piece_[+t])] / 2; });
    double sum = 0, count = 0;
    for (const double deep : deepest)
      if (deep > 0 && std::isfinite(deep)) sum += deep, ++count;
    std::vector<double> stretch;
    for (const double deep : deepest)
      stretch.push_back(has_limbs_ && deep > 0 && std::isfinite(deep) ? sum / count / deep : 1);
    paths_.grow(piece_, all_, middle, stretch);
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

  std::size_t least_triangles() const { return std::max(kSmall, piece_.size() / kMany); }
  // Makes the triangles a piece of their own, which gets the next number.
  void name(std::span<const TriangleId> triangles, std::int32_t& count) {
    if (triangles.empty()) return;
    for (const TriangleId t : triangles) piece_[+t] = count;
    ++count;
  }

  bool seen_well(const Triangles& piece, const Sight& wanted) const {
    std::vector<Face> sample;
    const std::size_t stride = (piece.size() + kSample - 1) / kSample;
    for (std::size_t i = 0; i < piece.size(); i += stride) sample.push_back(faces_[+piece[i]]);
    const Vec3 from = best_viewpoint(sample);
    const auto well = std::count_if(sample.begin(), sample.end(), [&](const Face& f) {
      const Vec3 ray = f.centre - from;
      return f.normal.dot(ray) > wanted.cosine * ray.norm();
    });
    return static_cast<double>(well) >= wanted.share * static_cast<double>(sample.size());
  }

  // Cuts a limb, which is a piece, into the fewest slabs of which enough is seen. Slabs are as long as the
  // limb is thick where they lie: each has the same length in times of the limb's girth.
  std::vector<Triangles> slabs_of(const Limb& limb, std::span<const double> area, double fineness) const {
    const double low = limb.lowest(), length = limb.length();
    const auto place = [&](std::size_t i) { return length > 0 ? kBins * (limb.along[i] - low) / length : 0; };
    const auto bin = [&](std::size_t i) { return std::min(kBins - 1, static_cast<std::size_t>(place(i))); };
    std::vector<double> area_in(kBins), up_to(kBins + 1);
    for (std::size_t i = 0; i < limb.triangles.size(); ++i) area_in[bin(i)] += area[+limb.triangles[i]];
    const double mean = std::accumulate(area_in.begin(), area_in.end(), 0.0) / kBins;
    for (std::size_t b = 0; b < kBins; ++b)
      up_to[b + 1] = up_to[b] + (mean > 0 ? mean / std::max(area_in[b], kLeastGirth * mean) : 1);
    const auto share_below = [&](std::size_t i) {
      const std::size_t b = bin(i);
      const double in_bin = place(i) - static_cast<double>(b);
      return (up_to[b] + in_bin * (up_to[b + 1] - up_to[b])) / up_to[kBins];
    };
    const double least = std::max(kSlabTriangles / fineness, static_cast<double>(piece_.size() / kMany));
    const double most_slabs = std::min(static_cast<double>(limb.triangles.size()) / least,
                                       rows_of(limb) * std::sqrt(fineness) / kSlabRows);
    std::vector<Triangles> slabs;
    for (std::size_t count = 1;; ++count) {
      slabs.assign(count, {});
      for (std::size_t i = 0; i < limb.triangles.size(); ++i)
        slabs[std::min(count - 1, static_cast<std::size_t>(share_below(i) * static_cast<double>(count)))]
            .push_back(limb.triangles[i]);
      std::erase_if(slabs, [](const Triangles& slab) { return slab.empty(); });
      if (static_cast<double>(count + 1) > most_slabs ||
          std::ranges::all_of(slabs, [&](const Triangles& slab) { return seen_well(slab, kSlab); }))
        return slabs;
    }
  }

  // Returns the number of rows of triangles from the root of a limb, which is a piece, to its tip.
  double rows_of(const Limb& limb) const {
    const auto lowest = std::ranges::min_element(limb.along) - limb.along.begin();
    std::vector<std::int32_t> row(piece_.size(), kNone);
    Triangles reached{limb.triangles[static_cast<std::size_t>(lowest)]};
    row[+reached[0]] = 0;
    for (std::size_t next = 0; next < reached.size(); ++next) {
      const TriangleId from = reached[next];
      for (const TrianglePaths::Step& step : paths_.steps_from(from)) {
        if (row[+step.to] != kNone || piece_[+step.to] != piece_[+from]) continue;
        row[+step.to] = row[+from] + 1;
        reached.push_back(step.to);
      }
    }
    return row[+reached.back()];
  }

  TriangleId farthest_from(const Triangles& piece, TriangleId from) {
    paths_.measure(piece_, piece, std::span(&from, 1));
    return *std::ranges::max_element(piece, {}, [&](TriangleId t) { return paths_.length(t); });
  }

  const TriangleMesh& mesh_;
  bool has_limbs_;  // an open surface has none: it bends anywhere
  TrianglePaths paths_;
  Triangles all_;
  std::vector<Face> faces_;
  std::vector<std::int32_t> piece_;  // [triangles]: the piece of each
};

}  // namespace

std::vector<std::int32_t> surface_clusters(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                           double fineness) {
  Pieces pieces(mesh, reference);
  if (mesh.closed_and_oriented()) {
    pieces.slice(reference, fineness);
    pieces.merge(kSlab);
  } else {
    pieces.halve(kSheet);
    pieces.merge(kSheetMerged);
  }
  for (int i = 0; i < kStraightened; ++i) pieces.straighten();
  return pieces.numbered();
}

}  // namespace cscd::fast
