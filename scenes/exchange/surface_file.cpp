#include "scenes/exchange/surface_file.h"

#include <bit>
#include <cstdio>
#include <numeric>

#include "core/base/error.h"
#include "scenes/exchange/number_bytes.h"
#include "scenes/polygon/cut_polygon.h"

namespace cscd::scenes {

void require_sound(const SurfaceFile& surface) {
  if (surface.positions.empty()) throw InputError("has no vertices; export it again");
  if (surface.positions.size() > kMostInSurfaceFile || surface.faces.corners.size() > 3 * kMostInSurfaceFile)
    throw InputError("has more than " + std::to_string(kMostInSurfaceFile) +
                     " vertices or triangles; simplify it");
  for (const std::int32_t v : surface.faces.corners)
    if (v < 0 || static_cast<std::size_t>(v) >= surface.positions.size())
      throw InputError("has a face of vertex " + std::to_string(v) + " (counted from 0), but " +
                       std::to_string(surface.positions.size()) + " vertices; export it again");
}

namespace {

// Cuts a face whose corners lie at `corners`, one after the other.
PolygonCut cut_late(std::span<const std::int32_t> face, std::span<const Vec3> corners, CutFaces& cut) {
  std::vector<std::int32_t> numbers(face.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  std::vector<std::array<std::int32_t, 3>> triangles;
  const PolygonCut result = cut_polygon(numbers, corners, triangles);
  for (std::array<std::int32_t, 3> t : triangles) {
    for (std::int32_t& corner : t) corner = face[static_cast<std::size_t>(corner)];
    cut.triangles.push_back(t);
  }
  return result;
}

}  // namespace

CutFaces cut_faces(const Polygons& faces, std::span<const Vec3> positions, const LateFaces& late) {
  CutFaces cut;
  std::size_t overlapping = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto moment = late.find(f);
    const PolygonCut result = moment == late.end() ? cut_polygon(faces[f], positions, cut.triangles)
                                                   : cut_late(faces[f], moment->second, cut);
    if (result == PolygonCut::none)
      throw InputError("face " + std::to_string(f) + " (counted from 0): its " +
                       std::to_string(faces[f].size()) +
                       " corners cannot be cut into triangles; triangulate the surface before the export");
    overlapping += result == PolygonCut::overlapping;
  }
  if (overlapping > 0) cut.note = std::to_string(overlapping) + " " + kOverlapping;
  return cut;
}

namespace {

void append_obj_vertex(const Vec3& x, std::string& out) {
  char line[128];
  std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", x.x(), x.y(), x.z());
  out += line;
}

}  // namespace

std::string to_obj(std::span<const Vec3> positions, std::span<const Triangle> triangles) {
  std::string out = "# written by cscd\n";
  for (const Vec3& x : positions) append_obj_vertex(x, out);
  char line[128];
  for (const Triangle& c : triangles) {
    std::snprintf(line, sizeof line, "f %zu %zu %zu\n", +c[0] + 1, +c[1] + 1, +c[2] + 1);
    out += line;
  }
  return out;
}

std::string to_ply(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                   std::span<const float> quality, std::span<const Rgb> colours) {
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment written by cscd\nelement vertex " +
                    std::to_string(positions.size()) +
                    "\nproperty double x\nproperty double y\nproperty double z\n";
  if (!quality.empty()) out += "property float quality\n";
  if (!colours.empty()) out += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  out += "element face " + std::to_string(triangles.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis)
      append_bits(std::bit_cast<std::uint64_t>(positions[v][axis]), 8, false, out);
    if (!quality.empty()) append_bits(std::bit_cast<std::uint32_t>(quality[v]), 4, false, out);
    if (!colours.empty())
      for (const std::uint8_t value : colours[v]) append_bits(value, 1, false, out);
  }
  for (const Triangle& c : triangles) {
    out += '\3';
    for (const VertexId v : c) append_bits(+v, 4, false, out);
  }
  return out;
}

std::string curves_to_obj(std::span<const std::vector<Vec3>> curves, std::span<const std::size_t> events) {
  std::string out = "# written by cscd\n";
  std::size_t first = 1;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::vector<Vec3>& curve = curves[i];
    const bool closed = curve.size() > 2 && curve.front() == curve.back();
    const std::size_t points = curve.size() - closed;
    if (i == 0 || events[i] != events[i - 1]) out += "o event_" + std::to_string(events[i]) + "\n";
    for (std::size_t p = 0; p < points; ++p) append_obj_vertex(curve[p], out);
    out += 'l';
    for (std::size_t p = 0; p < points; ++p) out += ' ' + std::to_string(first + p);
    if (closed) out += ' ' + std::to_string(first);
    out += '\n';
    first += points;
  }
  return out;
}

}  // namespace cscd::scenes
