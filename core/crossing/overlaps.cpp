#include "core/crossing/overlaps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/sort_unique.h"
#include "core/crossing/reach.h"
#include "core/crossing/sheet_distance.h"
#include "core/crossing/skins.h"
#include "core/elementary/exact/static_contact.h"
#include "core/geometry/unit_scale.h"
#include "core/mesh/adjacency.h"

namespace cscd {
namespace {

// The largest coordinates of poses that are measured as they are: products of four lengths of a pose, or of
// its smallest triangles, neither overflow nor vanish.
constexpr double kSmallestPose = 0x1p-60, kLargestPose = 0x1p60;

void scale_back(CrossingDepth& depth, double scale) {
  const double upper = depth.upper;
  depth.lower /= scale;
  depth.upper /= scale;
  if (depth.upper * scale < upper)
    depth.upper = std::nextafter(depth.upper, std::numeric_limits<double>::infinity());
  depth.point /= scale;
  depth.out /= scale;
}

// Gives the lengths in a pose from those in the same pose times `scale`, a power of two.
void scale_back(Overlaps& all, double scale) {
  for (Piercing& piercing : all.crossing.piercings) piercing.point /= scale;
  for (Overlap& overlap : all.overlaps) {
    scale_back(overlap.depth, scale);
    for (CrossingRegion& region : overlap.regions) {
      scale_back(region.depth, scale);
      for (Vec3& way : region.way) way /= scale;
      region.area = region.area / scale / scale;
    }
  }
}

}  // namespace

// The search of one pose. What is decided exactly is decided for `exact`, the positions as they are given.
// Lengths are computed from `positions` and are in their scale: the same positions times a power of two.
class PoseOverlaps {
 public:
  PoseOverlaps(OverlapFinder& finder, std::span<const Vec3> exact, std::span<const Vec3> positions,
               double largest, bool each_way)
      : finder_(finder),
        mesh_(finder.mesh_),
        exact_(exact),
        positions_(positions),
        largest_(largest),
        each_way_(each_way),
        skins_(mesh_, positions, kOnSheet * largest) {}

  Overlaps find(std::span<const CrossingPair> pairs) {
    pairs_ = pairs;
    out_.crossing = find_curves(mesh_, exact_, pairs, positions_);
    if (crossing().curves.empty() && !any_touches_a_closed_one()) return std::move(out_);
    if (crossing().degenerate > 0) find_ties();
    finder_.visited_.resize(mesh_.vertex_count(), 0);
    finder_.listed_.resize(mesh_.triangle_count(), 0);
    parts_.emplace(mesh_, finder_.marks_, crossing(), exact_, positions_);
    parts_->find();
    choose_regions();
    for (std::size_t r = 0; r < regions_.size(); ++r) flood(r);
    gather_other_sheets();
    gather_skins();
    for (std::size_t r = 0; r < regions_.size(); ++r) measure(r);
    group();
    find_enclosed();
    std::ranges::stable_sort(out_.overlaps, std::ranges::greater{},
                             [](const Overlap& o) { return o.depth.lower; });
    parts_.reset();  // before its curves go
    return std::move(out_);
  }

 private:
  using Side = CrossingRegion::Side;

  struct Seed {
    VertexId vertex;
    std::int32_t image;
  };
  struct Found {
    CrossingRegion region;
    std::vector<Seed> seeds;
  };

  const CrossingCurves& crossing() const { return out_.crossing; }
  bool is_on_curve(VertexId v) const { return parts_->is_on_curve(v); }

  // Notes which vertices lie exactly on a triangle. A broken tie puts such a vertex on either side of the
  // sheet, but it lies in none.
  void find_ties() {
    const auto note = [&](TriangleId of, TriangleId on) {
      const Triangle& c = mesh_.corners(on);
      for (const VertexId v : mesh_.corners(of))
        if (!contains(c, v) &&
            vertex_touches_triangle(exact_[+v], exact_[+c[0]], exact_[+c[1]], exact_[+c[2]]))
          on_sheet_.emplace_back(v, mesh_.component(on));
    };
    for (const auto& [a, b] : pairs_) note(a, b), note(b, a);
    sort_unique(on_sheet_);
  }
  bool lies_on(VertexId v, std::int32_t component) const {
    return std::ranges::binary_search(on_sheet_, std::pair(v, component));
  }
  // How many vertices of a part lie off the other sheet. What a broken tie alone cuts off has none.
  std::int32_t size_of(std::size_t group, std::int32_t part) {
    const Fragments::Group& sheets = parts_->group(group);
    const auto is_tie = [&](const auto& at) {
      return at.second == sheets.other &&
             mesh_.component(mesh_.triangles_at(at.first).front()) == sheets.own &&
             parts_->part_of(group, at.first) == part;
    };
    const auto [known, is_new] = sizes_.try_emplace({group, part});
    if (is_new)
      known->second = parts_->vertex_count(group, part) -
                      static_cast<std::int32_t>(std::ranges::count_if(on_sheet_, is_tie));
    return known->second;
  }

  // Chooses the region on one side of each curve, on each of its sheets.
  void choose_regions() {
    region_of_image_.assign(2 * crossing().curves.size(), kNone);
    std::map<std::pair<std::size_t, std::int32_t>, std::size_t> known;
    for (std::size_t c = 0; c < crossing().curves.size(); ++c)
      for (const CrossingCurve::Node& node : crossing().curves[c].nodes) {
        if (node.piercing < 0) continue;
        const Piercing& piercing = crossing().piercings[index(node.piercing)];
        const std::size_t g = parts_->group_of(piercing);
        const Fragments::Group& group = parts_->group(g);
        const Fragments::Parting p = parts_->parting(piercing.edge, group.other);
        if (!p.parts() || is_on_curve(p.behind) || is_on_curve(p.before)) continue;
        const std::int32_t behind = parts_->part_of(g, p.behind), before = parts_->part_of(g, p.before);
        if (behind == before) continue;
        const Side side = side_of(group, p);
        const bool is_smaller = size_of(g, behind) <= size_of(g, before);
        const bool is_behind = side == Side::behind || (side == Side::smaller && is_smaller);
        const auto image = static_cast<std::int32_t>(2 * c + node.edge_sheet);
        const auto [at, added] = known.try_emplace({g, is_behind ? behind : before}, regions_.size());
        if (added) regions_.push_back({});
        Found& found = regions_[at->second];
        found.region.own = group.own;
        found.region.other = group.other;
        found.region.side = side;
        found.seeds.push_back({is_behind ? p.behind : p.before, image});
        found.region.images.push_back(image);
        region_of_image_[index(image)] = static_cast<std::int32_t>(at->second);
      }
    for (Found& found : regions_) sort_unique(found.region.images);
  }

  // On which side of an edge that is parted the region lies.
  Side side_of(const Fragments::Group& group, const Fragments::Parting& edge) {
    if (parts_->marks().is_open[index(group.other)]) return Side::smaller;
    if (group.own == group.other) {
      const std::optional<int> behind = parts_->winding(group.own, edge.behind);
      if (!behind) return Side::smaller;
      if (*behind > 0) return Side::behind;
      if (*parts_->winding(group.own, edge.before) < -1) return Side::before;
    }
    // What winds 0 times behind an edge and -1 times before it is turned inside out, unless all faces look
    // inward: then the surface winds -1 times around its own inside.
    return parts_->is_inward(group.other) == (group.own == group.other) ? Side::behind : Side::before;
  }

  // Collects the vertices of a region, from all its curves inwards.
  void flood(std::size_t r) {
    Found& found = regions_[r];
    std::vector<VertexId>& list = found.region.vertices;
    const std::int32_t other = found.region.other;
    const std::uint32_t number = ++finder_.lists_;
    const auto take = [&](VertexId v, std::int32_t image) {
      if (std::exchange(finder_.visited_[+v], number) == number) return;
      list.push_back(v);
      found.region.image.push_back(image);
    };
    for (const Seed& seed : found.seeds) take(seed.vertex, seed.image);
    for (std::size_t i = 0; i < list.size(); ++i)
      for (const TriangleId t : mesh_.triangles_at(list[i])) {
        const Triangle& c = mesh_.corners(t);
        found.region.area +=
            (positions_[+c[1]] - positions_[+c[0]]).cross(positions_[+c[2]] - positions_[+c[0]]).norm() / 6;
        for (std::size_t k = 0; k < 3; ++k) {
          const VertexId one = c[k], two = c[(k + 1) % 3];
          if (one != list[i] && two != list[i]) continue;
          const VertexId next = one == list[i] ? two : one;
          if (finder_.visited_[+next] == number || is_on_curve(next)) continue;
          const EdgeId edge = mesh_.edges_of(t)[k];
          if (parts_->marks().pierced[+edge] < 0 || !parts_->parting(edge, other).parts())
            take(next, found.region.image[i]);
        }
      }
  }

  // For each image, the triangles that have a vertex of its own, or that its curve runs through.
  void gather_other_sheets() {
    sheet_.resize(region_of_image_.size());
    for (std::size_t m = 0; m < sheet_.size(); ++m)
      for (const auto& pair : crossing().curves[m / 2].segments) sheet_[m].push_back(pair[m % 2]);
    for (const Found& found : regions_)
      for (std::size_t i = 0; i < found.region.vertices.size(); ++i)
        for (const TriangleId t : mesh_.triangles_at(found.region.vertices[i]))
          sheet_[index(found.region.image[i])].push_back(t);
  }

  // Whether a curve has no vertex beyond it on one sheet: no edge that it meets there has its ends on two
  // sides. What it cuts off then lies in the triangles through which it runs.
  bool has_no_vertex(std::int32_t image) const {
    const CrossingCurve& curve = crossing().curves[index(image / 2)];
    using End = CrossingCurve::End;
    if (!curve.closed() && (curve.first != End::vertex || curve.last != End::vertex)) return false;
    return std::ranges::none_of(curve.nodes, [&](const CrossingCurve::Node& node) {
      if (node.piercing < 0 || node.edge_sheet != image % 2) return false;
      const Piercing& p = crossing().piercings[index(node.piercing)];
      return parts_->parting(p.edge, mesh_.component(p.face)).parts();
    });
  }

  void gather_skins() {
    for (const auto& [a, b] : pairs_) {
      const std::int32_t of_a = mesh_.component(a), of_b = mesh_.component(b);
      if (of_a == of_b) continue;
      skins_.add(of_a, of_b, b);
      skins_.add(of_b, of_a, a);
    }
    for (const Found& found : regions_)
      if (found.region.own != found.region.other)
        for (const VertexId v : found.region.vertices)
          for (const TriangleId t : mesh_.triangles_at(v))
            skins_.add(found.region.other, found.region.own, t);
    skins_.spread();
  }
  // Whether what a curve cuts off the other sheet of an image is not bounded (CrossingRegion::other_is_open).
  bool is_open_beyond(std::int32_t image) const {
    const std::int32_t opposite = image ^ 1;
    return region_of_image_[index(opposite)] == kNone && !has_no_vertex(opposite);
  }

  // Distances to the other sheet of what belongs to one image, in region `own` or in none; valid until the
  // next call. Sets `is_open` where that sheet is not bounded (CrossingRegion::other_is_open).
  const SheetDistance& to_other_sheet(std::int32_t image, std::int32_t own, bool& is_open) {
    const std::int32_t opposite = image ^ 1, other = region_of_image_[index(opposite)];
    is_open = is_open_beyond(image);
    const std::int32_t here = mesh_.component(sheet_[index(image)].front()),
                       beyond = mesh_.component(sheet_[index(opposite)].front());
    if (here != beyond) return is_open ? to_component(beyond) : skins_.to(here, beyond);
    std::vector<TriangleId> triangles;
    const std::uint32_t list = ++finder_.lists_;
    const auto add = [&](std::int32_t of) {
      for (const TriangleId t : sheet_[index(of)])
        if (std::exchange(finder_.listed_[+t], list) != list) triangles.push_back(t);
    };
    add(opposite);
    if (other != kNone && other != own)
      for (const std::int32_t also : regions_[index(other)].region.images) add(also);
    return to_sheet_.emplace(mesh_, positions_, triangles);
  }

  const SheetDistance& to_component(std::int32_t component) {
    SheetDistance& to =
        to_component_.try_emplace(component, mesh_, positions_, parts_->marks().triangles_of(component))
            .first->second;
    to.start_anew();
    return to;
  }

  // Takes a point into account.
  static void deepen(CrossingDepth& depth, const Vec3& point, VertexId vertex,
                     const SheetDistance::Nearest& nearest) {
    if (nearest.distance <= depth.lower && depth.nearest != TriangleId{-1}) return;
    depth.lower = nearest.distance;
    depth.point = point;
    depth.vertex = vertex;
    depth.nearest = nearest.triangle;
  }
  Vec3 way(const Vec3& from, TriangleId to) const {
    const Triangle& c = mesh_.corners(to);
    return -nearest_of_vertex_face({from, positions_[+c[0]], positions_[+c[1]], positions_[+c[2]]}).way;
  }
  void point_out(CrossingDepth& depth) const {
    if (depth.nearest != TriangleId{-1}) depth.out = way(depth.point, depth.nearest);
  }

  void measure(std::size_t r) {
    CrossingRegion& region = regions_[r].region;
    if (each_way_) region.way.assign(region.vertices.size(), Vec3::Zero());
    double farthest = 0;  // of the region's vertices, ties among them
    // The vertices that are farthest from the curves come first: they are deepest most often, and then the
    // others need no search.
    const auto look = [&](const SheetDistance& to, std::optional<std::int32_t> image) {
      for (std::size_t i = region.vertices.size(); i-- > 0;) {
        if (image && region.image[i] != *image) continue;
        const Vec3& x = positions_[+region.vertices[i]];
        const bool is_tie = lies_on(region.vertices[i], region.other);
        const SheetDistance::Nearest nearest = to.nearest(x, each_way_ ? 0
                                                             : is_tie  ? farthest
                                                                       : region.depth.lower);
        farthest = std::max(farthest, nearest.distance);
        if (is_tie) continue;
        if (each_way_) region.way[i] = way(x, nearest.triangle);
        deepen(region.depth, x, region.vertices[i], nearest);
      }
    };
    if (region.own != region.other) {
      region.other_is_open =
          std::ranges::any_of(region.images, [&](std::int32_t image) { return is_open_beyond(image); });
      look(region.other_is_open ? to_component(region.other) : skins_.to(region.own, region.other), {});
    } else {
      for (const std::int32_t image : region.images) {
        bool is_open = false;
        look(to_other_sheet(image, static_cast<std::int32_t>(r), is_open), image);
        region.other_is_open |= is_open;
      }
    }
    if (region.depth.lower == 0 && !on_sheet_.empty()) measure_tied_edges(r);
    point_out(region.depth);
    region.depth.upper = farthest + reach_of(regions_[r].region.images, region.vertices);
    if (region.other_is_open && region.own == region.other) region.depth.lower = 0;
  }

  // Takes into account the middle of a part of an edge, one end of which is a tie. The middle may lie on the
  // other component, in it, or outside of it.
  void deepen_tied(CrossingDepth& depth, const Vec3& middle, std::int32_t own, std::int32_t other) {
    if (own == other || parts_->marks().is_open[index(other)]) return;
    const SheetDistance::Nearest nearest = to_component(other).nearest(middle, depth.lower);
    if (nearest.distance > std::max(depth.lower, kOnSheet * largest_) && is_inside(other, middle))
      deepen(depth, middle, VertexId{-1}, nearest);
  }

  // Whether a closed component winds around a point that lies off it: the sum of the solid angles of its
  // triangles, up to rounding (Van Oosterom and Strackee 1983), is a multiple of 4 pi.
  bool is_inside(std::int32_t component, const Vec3& point) const {
    double half = 0;  // of the sum
    for (const TriangleId t : parts_->marks().triangles_of(component)) {
      const Triangle& c = mesh_.corners(t);
      const Vec3 a = positions_[+c[0]] - point, b = positions_[+c[1]] - point, d = positions_[+c[2]] - point;
      const double la = a.norm(), lb = b.norm(), ld = d.norm();
      half += std::atan2(a.dot(b.cross(d)), la * lb * ld + a.dot(b) * ld + b.dot(d) * la + d.dot(a) * lb);
    }
    return std::abs(half) > std::numbers::pi;
  }

  // Where all vertices of a region lie on the other component, edges between them may lie in it.
  void measure_tied_edges(std::size_t r) {
    CrossingRegion& region = regions_[r].region;
    for (const VertexId v : region.vertices)
      for (const TriangleId t : mesh_.triangles_at(v))
        for (const EdgeId edge : mesh_.edges_of(t)) {
          const Edge& ends = mesh_.ends(edge);
          if (ends[0] != v && ends[1] != v) continue;
          const Vec3& x = positions_[+v];
          Vec3 end = positions_[+(ends[0] == v ? ends[1] : ends[0])];  // of what lies in the region
          for (const Piercing& p : parts_->piercings_of(edge))
            if (mesh_.component(p.face) == region.other &&
                (p.point - x).squaredNorm() < (end - x).squaredNorm())
              end = p.point;
          deepen_tied(region.depth, (x + end) / 2, region.own, region.other);
        }
  }

  // The depth of what a curve cuts off one sheet without a vertex: edges go in and come out again.
  CrossingDepth depth_of_edges(std::int32_t image) {
    CrossingDepth depth;
    bool is_open = false;
    double farthest = 0;
    const SheetDistance* to = nullptr;
    for (const CrossingCurve::Node& node : crossing().curves[index(image / 2)].nodes) {
      if (node.piercing < 0 || node.edge_sheet != image % 2) continue;
      const Piercing& from = crossing().piercings[index(node.piercing)];
      const Edge& ends = mesh_.ends(from.edge);
      if (from.behind != ends[1]) continue;  // the edge goes in at `from`, seen from its first end
      const Vec3 way = positions_[+ends[1]] - positions_[+ends[0]];
      const Piercing* out = nullptr;
      for (const Piercing& at : parts_->piercings_of(from.edge)) {
        if (mesh_.component(at.face) != mesh_.component(from.face) || way.dot(at.point - from.point) <= 0)
          continue;
        if (out == nullptr || way.dot(at.point - out->point) < 0) out = &at;
      }
      if (out == nullptr || out->behind != ends[0]) continue;
      if (to == nullptr) to = &to_other_sheet(image, kNone, is_open);
      const Vec3 middle = (from.point + out->point) / 2;
      const SheetDistance::Nearest nearest = to->nearest(middle, depth.lower);
      farthest = std::max(farthest, nearest.distance);
      if (from.tied || out->tied)
        deepen_tied(depth, middle, mesh_.component(mesh_.triangles_at(from.edge).front()),
                    mesh_.component(from.face));
      else
        deepen(depth, middle, VertexId{-1}, nearest);
    }
    point_out(depth);
    depth.upper = farthest + reach_of(std::span(&image, 1), {});
    if (is_open) depth = {.upper = depth.upper};
    return depth;
  }

  double reach_of(std::span<const std::int32_t> images, std::span<const VertexId> vertices) const {
    return reach(mesh_, positions_, crossing(),
                 {images, vertices, parts_->marks().is_cut, parts_->marks().is_on_curve});
  }

  // Of two that are as deep, a vertex goes before a point on an edge.
  static void deepest_of(CrossingDepth& depth, const CrossingDepth& other) {
    const double upper = std::max(depth.upper, other.upper);
    const auto order = [](const CrossingDepth& d) { return std::pair(d.lower, d.vertex != VertexId{-1}); };
    if (depth.nearest == TriangleId{-1} || order(other) > order(depth)) depth = other;
    depth.upper = upper;
  }

  // Joins curves that bound one region, and the two sheets of each, to overlaps.
  void group() {
    std::vector<std::int32_t> parent(crossing().curves.size(), -1);
    for (const Found& found : regions_)
      for (const std::int32_t image : found.region.images)
        unite(parent, found.region.images.front() / 2, image / 2);
    std::map<std::int32_t, std::size_t> number;
    for (std::size_t c = 0; c < parent.size(); ++c) {
      const auto curve = static_cast<std::int32_t>(c);
      const auto [at, added] = number.try_emplace(root_of(parent, curve), out_.overlaps.size());
      if (added) out_.overlaps.emplace_back();
      Overlap& overlap = out_.overlaps[at->second];
      overlap.curves.push_back(curve);
      for (const std::int32_t image : {2 * curve, 2 * curve + 1})
        if (region_of_image_[index(image)] == kNone) deepest_of(overlap.depth, depth_of_edges(image));
    }
    for (Found& found : regions_)
      out_.overlaps[number.at(root_of(parent, found.region.images.front() / 2))].regions.push_back(
          std::move(found.region));
    for (Overlap& overlap : out_.overlaps) {
      std::ranges::stable_sort(overlap.regions, std::ranges::greater{},
                               [](const CrossingRegion& r) { return r.depth.lower; });
      for (const CrossingRegion& region : overlap.regions) deepest_of(overlap.depth, region.depth);
    }
  }

  bool is_open(std::int32_t component) const { return finder_.marks_.is_open[index(component)]; }
  bool any_touches_a_closed_one() const {
    return std::ranges::any_of(pairs_, [&](const CrossingPair& pair) {
      const std::int32_t a = mesh_.component(pair.first), b = mesh_.component(pair.second);
      return a != b && (!is_open(a) || !is_open(b));
    });
  }

  // Finds components that lie in another one altogether. Where ties are broken inwards, such a one pierces
  // nothing of the wall that it touches, or nothing that cuts vertices off.
  void find_enclosed() {
    std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::array<TriangleId, 2>>> meeting;
    const auto both_of = [&](std::int32_t a, std::int32_t b) {
      return std::pair(std::min(a, b), std::max(a, b));
    };
    for (const auto& [a, b] : pairs_) {
      const std::int32_t of_a = mesh_.component(a), of_b = mesh_.component(b);
      if (of_a == of_b || (is_open(of_a) && is_open(of_b))) continue;
      meeting[both_of(of_a, of_b)].push_back(of_a < of_b ? std::array{a, b} : std::array{b, a});
    }
    for (const Overlap& overlap : out_.overlaps)
      for (const CrossingRegion& region : overlap.regions)
        if (region.depth.lower > kOnSheet * largest_) meeting.erase(both_of(region.own, region.other));
    for (const auto& entry : meeting) {
      const auto [one, other] = entry.first;
      if (!add_enclosed(one, other, entry.second) && !add_enclosed(other, one, entry.second)) continue;
      // What ties make between the two belongs to it.
      std::erase_if(out_.overlaps, [&](const Overlap& overlap) {
        if (overlap.curves.empty()) return false;
        const auto& segment = crossing().curves[index(overlap.curves.front())].segments.front();
        return entry.first == both_of(mesh_.component(segment[0]), mesh_.component(segment[1]));
      });
    }
  }

  // Adds the overlap of a component that lies in a closed one altogether. Returns whether it does.
  bool add_enclosed(std::int32_t own, std::int32_t other,
                    const std::vector<std::array<TriangleId, 2>>& touching) {
    if (is_open(other)) return false;
    const bool inward = !is_open(own) && parts_->is_inward(own);
    if (inward != parts_->is_inward(other)) return false;  // one is a cavity, which holds nothing
    CrossingRegion region;
    region.own = own;
    region.other = other;
    // As where a curve ends on an open piece, the distance is that to the whole of the other.
    const SheetDistance& to = is_open(own) ? to_component(other) : skins_.to(own, other);
    const std::uint32_t number = ++finder_.lists_;
    for (const TriangleId t : parts_->marks().triangles_of(own)) {
      const Triangle& c = mesh_.corners(t);
      region.area +=
          (positions_[+c[1]] - positions_[+c[0]]).cross(positions_[+c[2]] - positions_[+c[0]]).norm() / 2;
      for (const VertexId v : c) {
        if (std::exchange(finder_.visited_[+v], number) == number) continue;
        const Vec3& x = positions_[+v];
        const SheetDistance::Nearest nearest = to.nearest(x, each_way_ ? 0 : region.depth.lower);
        region.vertices.push_back(v);
        if (each_way_) region.way.push_back(way(x, nearest.triangle));
        deepen(region.depth, x, v, nearest);
      }
    }
    const double farthest = region.depth.lower;  // of a vertex
    if (farthest <= kOnSheet * largest_)  // all vertices lie on the wall, and edges between them inside
      for (const TriangleId t : parts_->marks().triangles_of(own))
        for (const EdgeId edge : mesh_.edges_of(t)) {
          const auto [p, q] = mesh_.ends(edge);
          const Vec3 middle = (positions_[+p] + positions_[+q]) / 2;
          deepen(region.depth, middle, VertexId{-1}, to.nearest(middle, region.depth.lower));
        }
    if (region.depth.lower <= kOnSheet * largest_ || !is_inside(other, region.depth.point)) return false;
    point_out(region.depth);
    region.depth.upper = farthest + reach_of({}, region.vertices);
    Overlap& overlap = out_.overlaps.emplace_back();
    overlap.touching = touching;
    if (mesh_.component(touching.front()[0]) != own)
      for (auto& [a, b] : overlap.touching) std::swap(a, b);
    overlap.depth = region.depth;
    overlap.regions.push_back(std::move(region));
    return true;
  }

  OverlapFinder& finder_;
  const TriangleMesh& mesh_;
  std::span<const Vec3> exact_, positions_;
  double largest_;  // of the coordinates of `positions_`
  bool each_way_;
  std::span<const CrossingPair> pairs_;  // that meet
  Overlaps out_;
  std::optional<Fragments> parts_;
  std::vector<Found> regions_;
  std::vector<std::int32_t> region_of_image_;   // [images], or kNone
  std::vector<std::vector<TriangleId>> sheet_;  // [images]
  std::map<std::int32_t, SheetDistance> to_component_;
  Skins skins_;
  std::vector<std::pair<VertexId, std::int32_t>> on_sheet_;  // with the component of that sheet; sorted
  std::map<std::pair<std::size_t, std::int32_t>, std::int32_t> sizes_;  // of parts of groups
  std::optional<SheetDistance> to_sheet_;
};

Overlaps OverlapFinder::find(std::span<const Vec3> positions, std::span<const CrossingPair> pairs,
                             bool each_way) {
  if (pairs.empty()) return {};
  double largest = 0;
  for (const Vec3& x : positions) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  if (largest >= kSmallestPose && largest <= kLargestPose)
    return PoseOverlaps(*this, positions, positions, largest, each_way).find(pairs);
  const double scale = unit_scale(largest);
  std::vector<Vec3> scaled(positions.begin(), positions.end());
  for (Vec3& x : scaled) x *= scale;
  Overlaps found = PoseOverlaps(*this, positions, scaled, largest * scale, each_way).find(pairs);
  scale_back(found, scale);
  return found;
}

}  // namespace cscd
