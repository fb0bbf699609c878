#include "core/crossing/curves.h"

#include <algorithm>
#include <set>

#include "core/crossing/generic_side.h"
#include "core/mesh/adjacency.h"

namespace cscd {
namespace {

// One end of a segment: the segment's number, its end 0 or 1, and what lies there.
struct SegmentEnd {
  EdgeId edge;
  TriangleId face;
  std::int32_t segment;
  std::uint8_t end;
  bool tied;        // of the pair that has the segment, some side was a tie
  VertexId behind;  // the end of the edge that lies behind the face

  // What lies there, as one number: comparing numbers is most of the work of sorting.
  std::uint64_t key() const { return static_cast<std::uint64_t>(+edge) << 32 | +face; }
};

// Where an edge meets the plane of a face, from rounded heights above that plane.
Vec3 piercing_point(std::span<const Vec3> x, const Edge& edge, const Triangle& face) {
  const Vec3 normal = (x[+face[1]] - x[+face[0]]).cross(x[+face[2]] - x[+face[0]]);
  const double from = normal.dot(x[+edge[0]] - x[+face[0]]), to = normal.dot(x[+edge[1]] - x[+face[0]]);
  const double share = from == to ? 0.5 : std::clamp(from / (from - to), 0.0, 1.0);
  return (1 - share) * x[+edge[0]] + share * x[+edge[1]];
}

class CurveFinder {
 public:
  CurveFinder(const TriangleMesh& mesh, std::span<const Vec3> positions, std::span<const Vec3> scaled)
      : mesh_(mesh), scaled_(scaled), sides_(positions) {}

  CrossingCurves find(std::span<const CrossingPair> pairs) {
    segments_.reserve(pairs.size());
    ends_.reserve(2 * pairs.size());
    for (const CrossingPair& pair : pairs) out_.touching += !add(pair);
    complete();
    taken_.assign(segments_.size(), false);
    for (std::size_t i = 0; i < segments_.size(); ++i)
      for (int end = 0; end < 2; ++end)
        if (!taken_[i] && end_kind(i, end) != CrossingCurve::End::closed) walk(i, end);
    for (std::size_t i = 0; i < segments_.size(); ++i)
      if (!taken_[i]) walk(i, 0);
    out_.degenerate = sides_.degenerate();
    return std::move(out_);
  }

 private:
  struct Segment {
    CrossingPair triangles;
    std::array<std::int32_t, 2> piercing{-1, -1};
    VertexId shared{-1};  // takes the place of the second piercing
  };

  // Adds the segment of a pair, unless its triangles touch without passing through each other.
  bool add(const CrossingPair& pair) {
    const Triangle &a = mesh_.corners(pair.first), &b = mesh_.corners(pair.second);
    Segment segment{pair};
    std::uint8_t found = 0;
    const auto number = static_cast<std::int32_t>(segments_.size());
    const auto look = [&](TriangleId with_edges, TriangleId face) {
      const Triangle &corners = mesh_.corners(with_edges), &plane = mesh_.corners(face);
      if (found == 2) return;
      const std::size_t ties = sides_.degenerate();
      std::array<int, 3> side{};  // 0 for a vertex of the face
      for (std::size_t k = 0; k < 3; ++k)
        if (!contains(plane, corners[k])) side[k] = sides_.side(plane[0], plane[1], plane[2], corners[k]);
      for (std::size_t k = 0; k < 3 && found < 2; ++k) {
        const std::size_t next = k == 2 ? 0 : k + 1;
        if (side[k] * side[next] >= 0) continue;
        const EdgeId edge = mesh_.edges_of(with_edges)[k];
        if (!sides_.passes_inside(mesh_.ends(edge), plane)) continue;
        ends_.push_back(
            {edge, face, number, found++, sides_.degenerate() > ties, corners[side[k] > 0 ? k : next]});
      }
    };
    look(pair.first, pair.second);
    look(pair.second, pair.first);
    if (found == 0) return false;
    if (found == 1) segment.shared = *std::ranges::find_if(a, [&](VertexId v) { return contains(b, v); });
    segments_.push_back(segment);
    return true;
  }

  // A curve that goes on into a pair that the caller did not name: two triangles that share a vertex may pass
  // through each other by nothing that can be measured, and so not meet. Adds such pairs until there are
  // none.
  void complete() {
    for (bool added = true; added;) {
      added = false;
      number_piercings();
      for (std::int32_t p = 0; p < static_cast<std::int32_t>(out_.piercings.size()); ++p) {
        const auto [edge, face] = std::pair(out_.piercings[static_cast<std::size_t>(p)].edge,
                                            out_.piercings[static_cast<std::size_t>(p)].face);
        const std::span<const TriangleId> all = mesh_.triangles_at(edge);
        if (at(p).size() == all.size()) continue;
        for (const TriangleId other : all)
          if (const CrossingPair pair = std::minmax(other, face);
              !is_known(p, pair) && added_.insert(pair).second && add(pair))
            added = true;
        if (added) break;  // piercings are numbered anew
      }
    }
  }
  bool is_known(std::int32_t piercing, const CrossingPair& pair) const {
    return std::ranges::any_of(at(piercing), [&](const SegmentEnd& e) {
      return segments_[static_cast<std::size_t>(e.segment)].triangles == pair;
    });
  }

  void number_piercings() {
    std::ranges::sort(ends_, [](const SegmentEnd& a, const SegmentEnd& b) { return a.key() < b.key(); });
    out_.piercings.reserve(ends_.size() / 2 + 1);
    first_.reserve(ends_.size() / 2 + 2);
    out_.piercings.clear();
    first_.clear();
    for (std::size_t i = 0; i < ends_.size();) {
      const auto number = static_cast<std::int32_t>(out_.piercings.size());
      const auto [edge, face, segment, end, tied, behind] = ends_[i];
      const Edge& both = mesh_.ends(edge);
      const VertexId before = both[behind == both[0] ? 1 : 0];
      out_.piercings.push_back(
          {edge, face, behind, before, piercing_point(scaled_, both, mesh_.corners(face)), tied});
      first_.push_back(i);
      for (const auto key = ends_[i].key(); i < ends_.size() && ends_[i].key() == key; ++i)
        segments_[static_cast<std::size_t>(ends_[i].segment)].piercing[ends_[i].end] = number;
    }
    first_.push_back(ends_.size());
  }

  // The segments that have the piercing as an end.
  std::span<const SegmentEnd> at(std::int32_t piercing) const {
    const auto p = static_cast<std::size_t>(piercing);
    return std::span(ends_).subspan(first_[p], first_[p + 1] - first_[p]);
  }

  CrossingCurve::End end_kind(std::size_t segment, int end) const {
    const std::int32_t piercing = segments_[segment].piercing[static_cast<std::size_t>(end)];
    if (piercing < 0) return CrossingCurve::End::vertex;
    const std::size_t count = at(piercing).size();
    return count == 2  ? CrossingCurve::End::closed
           : count < 2 ? CrossingCurve::End::border
                       : CrossingCurve::End::branch;
  }

  CrossingCurve::Node node(std::size_t segment, int end, const std::array<TriangleId, 2>& sheets) const {
    const Segment& s = segments_[segment];
    const std::int32_t piercing = s.piercing[static_cast<std::size_t>(end)];
    if (piercing < 0) return {-1, 0, s.shared};
    const TriangleId face = out_.piercings[static_cast<std::size_t>(piercing)].face;
    return {piercing, static_cast<std::uint8_t>(face == sheets[0] ? 1 : 0), VertexId{-1}};
  }

  // Follows a curve from one end of a segment.
  void walk(std::size_t start, int end) {
    CrossingCurve curve;
    curve.first = end_kind(start, end);
    std::size_t segment = start;
    std::array<TriangleId, 2> sheets{segments_[start].triangles.first, segments_[start].triangles.second};
    curve.nodes.push_back(node(segment, end, sheets));
    for (;;) {
      taken_[segment] = true;
      curve.segments.push_back(sheets);
      const int far = 1 - end;
      const CrossingCurve::Node next = node(segment, far, sheets);
      const CrossingCurve::End kind = end_kind(segment, far);
      if (kind != CrossingCurve::End::closed) {
        curve.nodes.push_back(next);
        curve.last = kind;
        break;
      }
      const std::span<const SegmentEnd> both = at(next.piercing);
      const SegmentEnd& other = static_cast<std::size_t>(both[0].segment) == segment ? both[1] : both[0];
      if (static_cast<std::size_t>(other.segment) == start) break;
      curve.nodes.push_back(next);
      segment = static_cast<std::size_t>(other.segment);
      end = other.end;
      const auto& [a, b] = segments_[segment].triangles;
      const TriangleId kept = sheets[1 - next.edge_sheet];
      sheets[next.edge_sheet] = a == kept ? b : a;
    }
    out_.curves.push_back(std::move(curve));
  }

  const TriangleMesh& mesh_;
  std::span<const Vec3> scaled_;
  GenericSides sides_;
  std::vector<Segment> segments_;
  std::vector<SegmentEnd> ends_;    // sorted by piercing, once these are numbered
  std::vector<std::size_t> first_;  // [piercings + 1], of each among ends_
  std::vector<bool> taken_;
  std::set<CrossingPair> added_;  // by complete()
  CrossingCurves out_;
};

}  // namespace

CrossingCurves find_curves(const TriangleMesh& mesh, std::span<const Vec3> positions,
                           std::span<const CrossingPair> pairs, std::span<const Vec3> scaled) {
  if (pairs.empty()) return {};
  return CurveFinder(mesh, positions, scaled).find(pairs);
}

}  // namespace cscd
