#include "scenes/exchange/vtk_file.h"

#include <bit>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <type_traits>

namespace cscd::scenes {
namespace {

static_assert(std::endian::native == std::endian::little, "the files say that their lowest byte comes first");

// Text as it may stand in an attribute.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char letter : text) {
    switch (letter) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += letter;
    }
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

VtkSurface::VtkSurface(std::span<const Vec3> points, std::span<const Triangle> triangles)
    : by_themselves_(triangles.empty()),
      points_count_(points.size()),
      cells_count_(by_themselves_ ? points.size() : triangles.size()) {
  const auto* numbers = reinterpret_cast<const double*>(points.data());
  points_ = array(named("Points", 3), std::span<const double>(numbers, 3 * points.size()));
  std::vector<std::int64_t> corners, ends;
  for (const Triangle& triangle : triangles)
    for (const VertexId v : triangle) corners.push_back(static_cast<std::int64_t>(v));
  if (by_themselves_) {
    corners.resize(points.size());
    std::iota(corners.begin(), corners.end(), 0);
  }
  for (std::size_t c = 1; c <= cells_count_; ++c)
    ends.push_back(static_cast<std::int64_t>(by_themselves_ ? c : 3 * c));
  cells_ = array("Name=\"connectivity\"", std::span<const std::int64_t>(corners));
  cells_ += array("Name=\"offsets\"", std::span<const std::int64_t>(ends));
}

void VtkSurface::add(const std::string& name, std::span<const float> values, std::size_t width) {
  data_ += array(named(name, width), values);
}

std::string VtkSurface::text() const {
  const std::string cells = by_themselves_ ? "Verts" : "Polys",
                    data = by_themselves_ ? "PointData" : "CellData";
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"" +
         std::to_string(points_count_) + "\" NumberOf" + cells + "=\"" + std::to_string(cells_count_) +
         "\">\n<Points>\n" + points_ + "</Points>\n<" + cells + ">\n" + cells_ + "</" + cells + ">\n<" +
         data + ">\n" + data_ + "</" + data + ">\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_" +
         appended_ + "\n</AppendedData>\n</VTKFile>\n";
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
