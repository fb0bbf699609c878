#include "scenes/exchange/vtk_file.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <type_traits>
#include <utility>

namespace cscd::scenes {
namespace {

static_assert(std::endian::native == std::endian::little, "the files say that their lowest byte comes first");

// Text as it may stand in an attribute.
std::string escaped(std::string_view text) {
  constexpr std::pair<char, std::string_view> kEscapes[] = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
  std::string out;
  for (const char& letter : text) {
    const auto* const found = std::ranges::find(kEscapes, letter, &std::pair<char, std::string_view>::first);
    out += found == std::end(kEscapes) ? std::string_view(&letter, 1) : found->second;
  }
  return out;
}

template <class Value>
constexpr const char* type_of() {
  if constexpr (std::is_same_v<Value, double>) return "Float64";
  if constexpr (std::is_same_v<Value, float>) return "Float32";
  return "Int64";
}

std::string named(const std::string& name, std::size_t width) {
  return "Name=\"" + escaped(name) + "\" NumberOfComponents=\"" + std::to_string(width) + "\"";
}

}  // namespace

template <class Value>
std::string VtkSurface::array(const std::string& attributes, std::span<const Value> values) {
  const std::string element = std::string("<DataArray type=\"") + type_of<Value>() + "\" " + attributes +
                              " format=\"appended\" offset=\"" + std::to_string(appended_.size()) + "\"/>\n";
  const std::uint64_t bytes = values.size_bytes();
  appended_.append(reinterpret_cast<const char*>(&bytes), sizeof bytes);
  appended_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  return element;
}

void VtkSurface::set_cells(const char* kind, std::span<const Vec3> points,
                           std::span<const std::int64_t> corners, std::span<const std::int64_t> ends) {
  kind_ = kind;
  points_count_ = points.size();
  cells_count_ = ends.size();
  const auto* numbers = reinterpret_cast<const double*>(points.data());
  points_ = array(named("Points", 3), std::span<const double>(numbers, 3 * points.size()));
  cells_ = array("Name=\"connectivity\"", corners);
  cells_ += array("Name=\"offsets\"", ends);
}

VtkSurface::VtkSurface(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  std::vector<std::int64_t> corners, ends;
  for (const Triangle& triangle : triangles) {
    for (const VertexId v : triangle) corners.push_back(static_cast<std::int64_t>(v));
    ends.push_back(static_cast<std::int64_t>(corners.size()));
  }
  if (triangles.empty()) {
    corners.resize(points.size());
    ends.resize(points.size());
    std::iota(corners.begin(), corners.end(), 0);
    std::iota(ends.begin(), ends.end(), 1);
  }
  set_cells(triangles.empty() ? "Verts" : "Polys", points, corners, ends);
}

VtkSurface::VtkSurface(std::span<const std::vector<Vec3>> polylines) {
  std::vector<Vec3> points;
  std::vector<std::int64_t> corners, ends;
  for (const std::vector<Vec3>& line : polylines) {
    points.insert(points.end(), line.begin(), line.end());
    ends.push_back(static_cast<std::int64_t>(points.size()));
  }
  corners.resize(points.size());
  std::iota(corners.begin(), corners.end(), 0);
  set_cells("Lines", points, corners, ends);
}

void VtkSurface::add(const std::string& name, std::span<const float> values, std::size_t width) {
  (kind_ == "Verts" ? point_data_ : data_) += array(named(name, width), values);
}
void VtkSurface::add_to_points(const std::string& name, std::span<const float> values) {
  point_data_ += array(named(name, 1), values);
}

std::string VtkSurface::text() const {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"" +
         std::to_string(points_count_) + "\" NumberOf" + kind_ + "=\"" + std::to_string(cells_count_) +
         "\">\n<Points>\n" + points_ + "</Points>\n<" + kind_ + ">\n" + cells_ + "</" + kind_ +
         ">\n<PointData>\n" + point_data_ + "</PointData>\n<CellData>\n" + data_ +
         "</CellData>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_" + appended_ +
         "\n</AppendedData>\n</VTKFile>\n";
}

std::string to_pvd(std::span<const VtkMoment> moments) {
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const VtkMoment& moment : moments) {
    char time[32];
    std::snprintf(time, sizeof time, "%.9g", moment.time);
    out += std::string("<DataSet timestep=\"") + time + "\" part=\"" + std::to_string(moment.part) +
           "\" file=\"" + escaped(moment.file) + "\"/>\n";
  }
  return out + "</Collection>\n</VTKFile>\n";
}

}  // namespace cscd::scenes
