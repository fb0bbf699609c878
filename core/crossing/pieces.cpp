#include "core/crossing/pieces.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/base/sort_unique.h"
#include "core/detect/start/crossings.h"

namespace cscd {
namespace {

constexpr std::uint64_t in_halves(std::uint64_t upper, std::uint64_t lower) {
  return upper << 32 | lower;
}

}  // namespace

OverlapPieces::OverlapPieces(const TriangleMesh& mesh, const Overlaps& all,
                             std::span<const std::size_t> number) {
  std::uint32_t pieces = 0;
  std::vector<std::uint32_t> last(mesh.triangle_count(), ~0U);  // in which piece; most are met several times
  const auto add = [&](TriangleId t, std::uint32_t piece) {
    if (std::exchange(last[+t], piece) != piece)
      triangles_.push_back(in_halves(static_cast<std::uint64_t>(+t), piece));
  };
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == kNone) continue;
    std::map<std::int32_t, std::vector<std::uint32_t>> pieces_at;  // of an image
    for (const CrossingRegion& region : all.overlaps[i].regions) {
      const std::uint32_t piece = pieces++;
      for (const std::int32_t image : region.images) pieces_at[image].push_back(piece);
      for (const VertexId v : region.vertices)
        for (const TriangleId t : mesh.triangles_at(v)) add(t, piece);
    }
    const auto face = [&](std::uint32_t one, std::uint32_t other) {
      facing_.push_back({in_halves(one, other), number[i]});
      facing_.push_back({in_halves(other, one), number[i]});
    };
    if (const auto& touching = all.overlaps[i].touching; !touching.empty()) {
      face(pieces - 1, pieces);  // the region, which takes all of a component, and the wall
      for (const auto& segment : touching) add(segment[1], pieces);
      ++pieces;
    }
    for (const std::int32_t curve : all.overlaps[i].curves) {
      for (const std::int32_t sheet : {0, 1}) {
        std::vector<std::uint32_t>& here = pieces_at[2 * curve + sheet];
        if (here.empty()) here.push_back(pieces++);
        for (const auto& segment : all.crossing.curves[static_cast<std::size_t>(curve)].segments)
          for (const std::uint32_t piece : here) add(segment[static_cast<std::size_t>(sheet)], piece);
      }
      for (const std::uint32_t one : pieces_at[2 * curve])
        for (const std::uint32_t other : pieces_at[2 * curve + 1]) face(one, other);
    }
  }
  sort_unique(triangles_);
  sort_unique(facing_);
}

std::size_t OverlapPieces::find(TriangleId a, TriangleId b) const {
  const auto pieces_of = [&](TriangleId t) {
    const std::uint64_t first = in_halves(static_cast<std::uint64_t>(+t), 0);
    const auto from = std::lower_bound(triangles_.begin(), triangles_.end(), first);
    return std::span(from, std::lower_bound(from, triangles_.end(), first + in_halves(1, 0)));
  };
  std::size_t found = kNone;
  for (const std::uint64_t one : pieces_of(a))
    for (const std::uint64_t other : pieces_of(b)) {
      constexpr std::uint64_t kPiece = 0xffffffff;
      const std::uint64_t both = in_halves(one & kPiece, other & kPiece);
      const auto at = std::ranges::lower_bound(facing_, both, {}, &Facing::pieces);
      if (at != facing_.end() && at->pieces == both) found = std::min(found, at->number);
    }
  return found;
}

std::size_t OverlapPieces::find(const TriangleMesh& mesh, const FeaturePair& pair) const {
  std::size_t found = kNone;
  for (const auto& [a, b] : carriers(mesh, pair)) found = std::min(found, find(a, b));
  return found;
}

}  // namespace cscd
