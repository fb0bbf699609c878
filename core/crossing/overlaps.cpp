#include "core/crossing/overlaps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/base/sort_unique.h"
#include "core/crossing/disjoint_sets.h"
#include "core/crossing/reach.h"
#include "core/crossing/self_winding.h"
#include "core/crossing/sheet_distance.h"
#include "core/geometry/unit_scale.h"

namespace cscd {
namespace {

constexpr std::int32_t kNone = -1;
// The largest coordinates of poses that are measured as they are: products of four lengths of a pose, or of
// its smallest triangles, neither overflow nor vanish.
constexpr double kSmallestPose = 0x1p-60, kLargestPose = 0x1p60;

std::size_t index(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

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

OverlapFinder::OverlapFinder(const TriangleMesh& mesh)
    : mesh_(mesh), open_(static_cast<std::size_t>(mesh.component_count()), false) {
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const EdgeId id{static_cast<std::int32_t>(e)};
    const std::span<const TriangleId> both = mesh.triangles_at(id);
    const auto runs_forward = [&](TriangleId t) {
      const Triangle& c = mesh.corners(t);
      const auto first = std::ranges::find(c, mesh.ends(id)[0]) - c.begin();
      return c[static_cast<std::size_t>((first + 1) % 3)] == mesh.ends(id)[1];
    };
    if (both.size() == 2 && runs_forward(both[0]) != runs_forward(both[1])) continue;
    for (const TriangleId t : both) open_[index(mesh.component(t))] = true;
  }
}

// The search of one pose. What is decided exactly is decided for `exact`, the positions as they are given.
// Lengths are computed from `positions` and are in their scale: the same positions times a power of two.
class PoseOverlaps {
 public:
  PoseOverlaps(OverlapFinder& finder, std::span<const Vec3> exact, std::span<const Vec3> positions,
               bool each_way)
      : finder_(finder), mesh_(finder.mesh_), exact_(exact), positions_(positions), each_way_(each_way) {}
  ~PoseOverlaps() { clean(); }  // also where memory runs out on the way
  PoseOverlaps(const PoseOverlaps&) = delete;
  PoseOverlaps& operator=(const PoseOverlaps&) = delete;

  Overlaps find(std::span<const CrossingPair> pairs) {
    out_.crossing = find_curves(mesh_, exact_, pairs, positions_);
    if (crossing().curves.empty()) return std::move(out_);
    cut();
    join_fragments();
    choose_regions();
    for (std::size_t r = 0; r < regions_.size(); ++r) flood(r);
    gather_other_sheets();
    for (std::size_t r = 0; r < regions_.size(); ++r) measure(r);
    group();
    clean();
    return std::move(out_);
  }

 private:
  using Side = CrossingRegion::Side;

  // Edges of one component and the faces of one, the same or another, that they pierce.
  struct Group {
    std::int32_t own, other;           // components
    std::vector<std::int32_t> parent;  // [fragments], joined where the other component does not part them
    auto operator<=>(const Group& with) const {
      return std::pair(own, other) <=> std::pair(with.own, with.other);
    }
    bool operator==(const Group& with) const { return own == with.own && other == with.other; }
  };
  struct Seed {
    VertexId vertex;
    std::int32_t image;
  };
  struct Found {
    std::size_t group;
    CrossingRegion region;
    std::vector<Seed> seeds;
  };

  const CrossingCurves& crossing() const { return out_.crossing; }
  std::int32_t component(EdgeId edge) const { return mesh_.component(mesh_.triangles_at(edge).front()); }

  // Joins all vertices between which no curve runs to fragments.
  void cut() {
    finder_.parent_.assign(mesh_.vertex_count(), -1);
    finder_.pierced_.resize(mesh_.edge_count(), kNone);
    finder_.is_cut_.resize(mesh_.triangle_count(), 0);
    finder_.listed_.resize(mesh_.triangle_count(), 0);
    finder_.is_on_curve_.resize(mesh_.vertex_count(), 0);
    finder_.visited_.resize(mesh_.vertex_count(), kNone);
    for (std::size_t p = crossing().piercings.size(); p-- > 0;)
      finder_.pierced_[+crossing().piercings[p].edge] = static_cast<std::int32_t>(p);
    mark(1);
    const std::span<const Edge> edges = mesh_.edges();
    for (std::size_t e = 0; e < edges.size(); ++e)
      if (finder_.pierced_[e] < 0 && !is_on_curve(edges[e][0]) && !is_on_curve(edges[e][1]))
        unite(finder_.parent_, static_cast<std::int32_t>(edges[e][0]),
              static_cast<std::int32_t>(edges[e][1]));
  }
  bool is_on_curve(VertexId v) const { return finder_.is_on_curve_[+v] != 0; }

  std::int32_t vertex_root(VertexId v) { return root_of(finder_.parent_, static_cast<std::int32_t>(v)); }
  // The number of a vertex's fragment, or kNone if none of its edges is pierced.
  std::int32_t fragment(VertexId v) const {
    const std::int32_t root = root_of(finder_.parent_, static_cast<std::int32_t>(v));
    const auto at = std::ranges::lower_bound(roots_, root);
    return at == roots_.end() || *at != root ? kNone : static_cast<std::int32_t>(at - roots_.begin());
  }

  // How faces of a component part the ends of an edge: not at all if as many have the one end behind them
  // as the other. Faces of an open component may look anywhere; there, an even number of faces does not part.
  struct Parting {
    int faces = 0;  // how many more have the end `behind` behind them than the end `before`
    VertexId behind{-1}, before{-1};
    bool parts() const { return faces != 0; }
  };
  Parting parting(EdgeId edge, std::int32_t other) const {
    int balance = 0;  // of faces that have end 0 behind them
    const std::vector<Piercing>& all = crossing().piercings;
    const Edge& ends = mesh_.ends(edge);
    for (std::size_t p = index(finder_.pierced_[+edge]); p < all.size() && all[p].edge == edge; ++p)
      if (mesh_.component(all[p].face) == other) balance += all[p].behind == ends[0] ? 1 : -1;
    if (finder_.open_[index(other)]) balance %= 2;
    return {std::abs(balance), ends[balance > 0 ? 0 : 1], ends[balance > 0 ? 1 : 0]};
  }

  // For each pair of components, joins the fragments of one that the other component does not part: those at
  // both ends of an edge that its faces do not part.
  void join_fragments() {
    const std::vector<Piercing>& all = crossing().piercings;
    for (const Piercing& p : all) {
      roots_.push_back(vertex_root(p.behind));
      roots_.push_back(vertex_root(p.before));
      Group group{component(p.edge), mesh_.component(p.face), {}};
      if (groups_.empty() || groups_.back() != group) groups_.push_back(std::move(group));
    }
    sort_unique(roots_);
    sort_unique(groups_);
    std::vector<std::int32_t> sizes;
    for (const std::int32_t root : roots_) sizes.push_back(finder_.parent_[index(root)]);
    for (Group& group : groups_) group.parent = sizes;
    for (std::size_t p = 0; p < all.size(); ++p) {
      if (p > 0 && all[p].edge == all[p - 1].edge) continue;
      if (is_on_curve(all[p].behind) || is_on_curve(all[p].before)) continue;
      const std::int32_t own = component(all[p].edge);
      for (Group& group : groups_)
        if (group.own == own && !parting(all[p].edge, group.other).parts())
          unite(group.parent, fragment(all[p].behind), fragment(all[p].before));
    }
  }

  std::size_t group_of(const Piercing& p) const {
    const std::pair key(component(p.edge), mesh_.component(p.face));
    const auto at =
        std::ranges::lower_bound(groups_, key, {}, [](const Group& g) { return std::pair(g.own, g.other); });
    return static_cast<std::size_t>(at - groups_.begin());
  }

  // Chooses the region on one side of each curve, on each of its sheets.
  void choose_regions() {
    region_of_image_.assign(2 * crossing().curves.size(), kNone);
    std::map<std::pair<std::size_t, std::int32_t>, std::size_t> known;
    for (std::size_t c = 0; c < crossing().curves.size(); ++c)
      for (const CrossingCurve::Node& node : crossing().curves[c].nodes) {
        if (node.piercing < 0) continue;
        const Piercing& piercing = crossing().piercings[index(node.piercing)];
        const std::size_t g = group_of(piercing);
        const Parting p = parting(piercing.edge, groups_[g].other);
        if (!p.parts() || is_on_curve(p.behind) || is_on_curve(p.before)) continue;
        std::vector<std::int32_t>& parent = groups_[g].parent;
        const std::int32_t behind = root_of(parent, fragment(p.behind)),
                           before = root_of(parent, fragment(p.before));
        if (behind == before) continue;
        const Side side = side_of(groups_[g], p);
        const bool is_behind =
            side == Side::behind || (side == Side::smaller && is_smaller(groups_[g], behind, before));
        const auto image = static_cast<std::int32_t>(2 * c + node.edge_sheet);
        const auto [at, added] = known.try_emplace({g, is_behind ? behind : before}, regions_.size());
        if (added) regions_.push_back({g, {}, {}});
        Found& found = regions_[at->second];
        found.region.own = groups_[g].own;
        found.region.other = groups_[g].other;
        found.region.side = side;
        found.seeds.push_back({is_behind ? p.behind : p.before, image});
        found.region.images.push_back(image);
        region_of_image_[index(image)] = static_cast<std::int32_t>(at->second);
      }
    for (Found& found : regions_) sort_unique(found.region.images);
  }

  // Whether the part behind the other sheet has no more vertices than that before.
  static bool is_smaller(const Group& group, std::int32_t behind, std::int32_t before) {
    return group.parent[index(behind)] >= group.parent[index(before)];  // minus the numbers of vertices
  }
  // On which side of an edge that is parted the region lies.
  Side side_of(const Group& group, const Parting& edge) {
    if (finder_.open_[index(group.other)]) return Side::smaller;
    if (group.own == group.other) {
      if (!windings_.contains(group.own)) windings_[group.own] = windings_of(group.own);
      const auto winding = [&](VertexId v) { return windings_[group.own][index(fragment(v))]; };
      if (!winding(edge.behind)) return Side::smaller;
      if (*winding(edge.behind) > 0) return Side::behind;
      if (*winding(edge.before) < -1) return Side::before;
    }
    // What winds 0 times behind an edge and -1 times before it is turned inside out, unless all faces look
    // inward: then the surface winds -1 times around its own inside.
    if (!inward_.contains(group.other))
      inward_[group.other] =
          faces_inward(mesh_, positions_, group.other, [&](VertexId v) { return is_on_curve(v); });
    return inward_[group.other] == (group.own == group.other) ? Side::behind : Side::before;
  }

  // How often a closed component winds around what is just before its faces at the vertices of each fragment:
  // known at an outermost vertex, and one more for each of its faces behind which an edge leads from there.
  // Nothing where this cannot be decided.
  std::vector<std::optional<int>> windings_of(std::int32_t own) const {
    std::vector<WindingStep> steps;
    for (const Piercing& p : crossing().piercings) {
      if (component(p.edge) != own || is_on_curve(p.behind) || is_on_curve(p.before)) continue;
      const Parting edge = parting(p.edge, own);
      steps.push_back({fragment(edge.before), fragment(edge.behind), edge.faces});
    }
    const std::optional<OutermostVertex> known =
        find_outermost_vertex(mesh_, exact_, own, [&](VertexId v) { return is_on_curve(v); });
    if (!known) return std::vector<std::optional<int>>(roots_.size());
    return spread_winding(roots_.size(), steps, fragment(known->vertex), known->winding);
  }

  // Collects the vertices of a region, from all its curves inwards.
  void flood(std::size_t r) {
    Found& found = regions_[r];
    std::vector<VertexId>& list = found.region.vertices;
    const std::int32_t other = groups_[found.group].other;
    const auto take = [&](VertexId v, std::int32_t image) {
      if (finder_.visited_[+v] == static_cast<std::int32_t>(r)) return;
      list.push_back(v);
      found.region.image.push_back(image);
      finder_.visited_[+v] = static_cast<std::int32_t>(r);
    };
    for (const Seed& seed : found.seeds) take(seed.vertex, seed.image);
    for (std::size_t i = 0; i < list.size(); ++i)
      for (const TriangleId t : mesh_.triangles_at(list[i])) {
        const Triangle& c = mesh_.corners(t);
        found.region.area +=
            (positions_[+c[1]] - positions_[+c[0]]).cross(positions_[+c[2]] - positions_[+c[0]]).norm() / 6;
        for (std::size_t k = 0; k < 3; ++k) {
          const EdgeId edge = mesh_.edges_of(t)[k];
          const Edge& ends = mesh_.ends(edge);
          if (ends[0] != list[i] && ends[1] != list[i]) continue;
          const VertexId next = ends[0] == list[i] ? ends[1] : ends[0];
          if (!is_on_curve(next) && !(finder_.pierced_[+edge] >= 0 && parting(edge, other).parts()))
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

  std::vector<TriangleId> component_triangles(std::int32_t component) const {
    std::vector<TriangleId> out;
    for (std::size_t t = 0; t < mesh_.triangle_count(); ++t)
      if (const TriangleId id{static_cast<std::int32_t>(t)}; mesh_.component(id) == component)
        out.push_back(id);
    return out;
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
      return parting(p.edge, mesh_.component(p.face)).parts();
    });
  }

  // The other sheet of what belongs to one image, in region `own` or in none. Sets `is_open` where that is
  // not bounded (CrossingRegion::other_is_open).
  std::vector<TriangleId> other_sheet(std::int32_t image, std::int32_t own, bool& is_open) const {
    const std::int32_t opposite = image ^ 1, other = region_of_image_[index(opposite)];
    std::vector<TriangleId> out;
    const std::uint32_t list = ++finder_.lists_;
    const auto add = [&](std::int32_t of) {
      for (const TriangleId t : sheet_[index(of)])
        if (std::exchange(finder_.listed_[+t], list) != list) out.push_back(t);
    };
    add(opposite);
    if (other == kNone && !has_no_vertex(opposite)) {
      is_open = true;
      const std::int32_t component = mesh_.component(out.front());
      if (component != mesh_.component(sheet_[index(image)].front())) return component_triangles(component);
    } else if (other != kNone && other != own) {
      for (const std::int32_t also : regions_[index(other)].region.images) add(also);
    }
    return out;
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
    for (const std::int32_t image : regions_[r].region.images) {
      const std::vector<TriangleId> other =
          other_sheet(image, static_cast<std::int32_t>(r), region.other_is_open);
      const SheetDistance to(mesh_, positions_, other);
      // The vertices that are farthest from the curves come first: they are deepest most often, and then the
      // others need no search.
      for (std::size_t i = region.vertices.size(); i-- > 0;) {
        if (region.image[i] != image) continue;
        const Vec3& x = positions_[+region.vertices[i]];
        const SheetDistance::Nearest nearest = to.nearest(x, each_way_ ? 0 : region.depth.lower);
        if (each_way_) region.way[i] = way(x, nearest.triangle);
        deepen(region.depth, x, region.vertices[i], nearest);
      }
    }
    point_out(region.depth);
    region.depth.upper = region.depth.lower + reach_of(regions_[r].region.images, region.vertices);
    if (region.other_is_open && region.own == region.other) region.depth.lower = 0;
  }

  // The depth of what a curve cuts off one sheet without a vertex: edges go in and come out again.
  CrossingDepth depth_of_edges(std::int32_t image) const {
    CrossingDepth depth;
    bool is_open = false;
    std::vector<std::pair<double, const Piercing*>> on_edge;
    std::optional<SheetDistance> to;
    std::vector<TriangleId> other;
    for (const CrossingCurve::Node& node : crossing().curves[index(image / 2)].nodes) {
      if (node.piercing < 0 || node.edge_sheet != image % 2) continue;
      const Piercing& from = crossing().piercings[index(node.piercing)];
      const Edge& ends = mesh_.ends(from.edge);
      if (from.behind != ends[1]) continue;  // the edge goes in at `from`, seen from its first end
      const Vec3 way = positions_[+ends[1]] - positions_[+ends[0]];
      const Piercing* out = nullptr;
      for (auto p = index(finder_.pierced_[+from.edge]);
           p < crossing().piercings.size() && crossing().piercings[p].edge == from.edge; ++p) {
        const Piercing& at = crossing().piercings[p];
        if (mesh_.component(at.face) != mesh_.component(from.face) || way.dot(at.point - from.point) <= 0)
          continue;
        if (out == nullptr || way.dot(at.point - out->point) < 0) out = &at;
      }
      if (out == nullptr || out->behind != ends[0]) continue;
      if (!to) {
        other = other_sheet(image, kNone, is_open);
        to.emplace(mesh_, positions_, other);
      }
      const Vec3 middle = (from.point + out->point) / 2;
      deepen(depth, middle, VertexId{-1}, to->nearest(middle, depth.lower));
    }
    point_out(depth);
    depth.upper = depth.lower + reach_of(std::span(&image, 1), {});
    if (is_open) depth = {.upper = depth.upper};
    return depth;
  }

  double reach_of(std::span<const std::int32_t> images, std::span<const VertexId> vertices) const {
    return reach(mesh_, positions_, crossing(), {images, vertices, finder_.is_cut_, finder_.is_on_curve_});
  }

  static void deepest_of(CrossingDepth& depth, const CrossingDepth& other) {
    const double upper = std::max(depth.upper, other.upper);
    if (depth.nearest == TriangleId{-1} || other.lower > depth.lower) depth = other;
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
    std::ranges::stable_sort(out_.overlaps, std::ranges::greater{},
                             [](const Overlap& o) { return o.depth.lower; });
  }

  void mark(std::uint8_t as) {
    for (const CrossingCurve& curve : crossing().curves) {
      for (const auto& pair : curve.segments)
        for (const TriangleId t : pair) finder_.is_cut_[+t] = as;
      for (const CrossingCurve::Node& node : curve.nodes)
        if (node.piercing < 0) finder_.is_on_curve_[+node.vertex] = as;
    }
  }
  // Leaves the finder's marks as they were.
  void clean() {
    if (finder_.visited_.size() != mesh_.vertex_count()) return;  // nothing has been marked yet
    mark(0);
    for (const Piercing& p : crossing().piercings) finder_.pierced_[+p.edge] = kNone;
    const auto leave = [&](const CrossingRegion& region) {
      for (const VertexId v : region.vertices) finder_.visited_[+v] = kNone;
    };
    for (const Overlap& overlap : out_.overlaps) std::ranges::for_each(overlap.regions, leave);
    for (const Found& found : regions_) leave(found.region);  // those that no overlap has taken
  }

  OverlapFinder& finder_;
  const TriangleMesh& mesh_;
  std::span<const Vec3> exact_, positions_;
  bool each_way_;
  Overlaps out_;
  std::vector<std::int32_t> roots_;                                   // of the fragments at piercings; sorted
  std::vector<Group> groups_;                                         // sorted
  std::map<std::int32_t, bool> inward_;                               // of components
  std::map<std::int32_t, std::vector<std::optional<int>>> windings_;  // of components, [roots_]
  std::vector<Found> regions_;
  std::vector<std::int32_t> region_of_image_;   // [images], or kNone
  std::vector<std::vector<TriangleId>> sheet_;  // [images]
};

Overlaps OverlapFinder::find(std::span<const Vec3> positions, std::span<const CrossingPair> pairs,
                             bool each_way) {
  if (pairs.empty()) return {};
  double largest = 0;
  for (const Vec3& x : positions) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  if (largest >= kSmallestPose && largest <= kLargestPose)
    return PoseOverlaps(*this, positions, positions, each_way).find(pairs);
  const double scale = unit_scale(largest);
  std::vector<Vec3> scaled(positions.begin(), positions.end());
  for (Vec3& x : scaled) x *= scale;
  Overlaps found = PoseOverlaps(*this, positions, scaled, each_way).find(pairs);
  scale_back(found, scale);
  return found;
}

}  // namespace cscd
