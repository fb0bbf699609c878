#include "scenes/exchange/usd_file.h"

#include <cstdio>
#include <utility>

namespace cscd::scenes {
namespace {

std::string text_of(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", x);
  return text;
}

void append_vector(const Vec3& x, std::string& out) {
  char text[96];
  std::snprintf(text, sizeof text, "(%.9g, %.9g, %.9g)", x.x(), x.y(), x.z());
  out += text;
}

template <class Row, class Append>
void append_list(const Row& row, const Append& append, std::string& out) {
  out += '[';
  bool first = true;
  for (const auto& value : row) {
    if (!first) out += ", ";
    first = false;
    append(value);
  }
  out += ']';
}

// USD lets y and z point up, and no other axis. The root of a scene that has another axis up is turned until
// that axis is y.
std::string turn_to_y(const std::string& up) {
  const auto about = [](const std::string& axis, const char* degrees) {
    return "    float xformOp:rotate" + axis + " = " + degrees +
           "\n    uniform token[] xformOpOrder = [\"xformOp:rotate" + axis + "\"]\n";
  };
  if (up == "x") return about("Z", "90");
  if (up == "-x") return about("Z", "-90");
  if (up == "-y") return about("X", "180");
  if (up == "-z") return about("X", "90");
  return {};
}

}  // namespace

UsdSurface::UsdSurface(std::span<const Triangle> triangles, UsdStage stage) : stage_(std::move(stage)) {
  append_list(
      triangles, [&](const Triangle&) { counts_ += '3'; }, counts_);
  append_list(
      triangles,
      [&](const Triangle& c) {
        corners_ += std::to_string(+c[0]) + ", " + std::to_string(+c[1]) + ", " + std::to_string(+c[2]);
      },
      corners_);
}

void UsdSurface::append(double frame, std::span<const Vec3> positions, std::span<const std::uint8_t> colour,
                        std::span<const Colour> palette, std::span<const float> depth,
                        std::span<const Vec3> marks, std::span<const std::vector<Vec3>> curves) {
  if (points_.empty()) first_frame_ = frame;
  last_frame_ = frame;
  const std::string time = "            " + text_of(frame) + ": ";
  const auto add_points = [&time](const auto& points, std::string& out) {
    out += time;
    append_list(
        points, [&out](const Vec3& x) { append_vector(x, out); }, out);
    out += ",\n";
  };
  add_points(positions, points_);
  Vec3 low = positions[0], high = low;
  for (const Vec3& x : positions) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  add_points(std::array{low, high}, extents_);
  add_points(marks, marks_);
  std::vector<Vec3> curve_points;
  for (const std::vector<Vec3>& curve : curves)
    curve_points.insert(curve_points.end(), curve.begin(), curve.end());
  curve_counts_ += time;
  append_list(
      curves, [&](const std::vector<Vec3>& curve) { curve_counts_ += std::to_string(curve.size()); },
      curve_counts_);
  curve_counts_ += ",\n";
  add_points(curve_points, curve_points_);
  std::string row;
  append_list(
      depth, [&](float d) { row += text_of(static_cast<double>(d)); }, row);
  depths_.add(time, std::exchange(row, {}));
  append_list(
      colour,
      [&](std::uint8_t c) {
        append_vector({palette[c][0], palette[c][1], palette[c][2]}, row);
      },
      row);
  colours_.add(time, std::move(row));
}

void UsdSurface::HeldSamples::add(const std::string& time, std::string row) {
  if (row != last_row) {
    if (last_time != written_time) rows += last_time + last_row + ",\n";
    rows += time + row + ",\n";
    written_time = time;
    last_row = std::move(row);
  }
  last_time = time;
}

std::string UsdSurface::text(double mark_width) const {
  std::string out =
      "#usda 1.0\n(\n    defaultPrim = \"clip\"\n    startTimeCode = " + text_of(first_frame_) +
      "\n    endTimeCode = " + text_of(last_frame_) + "\n    timeCodesPerSecond = " + text_of(stage_.fps) +
      "\n    metersPerUnit = " + text_of(stage_.metres_per_unit) + "\n    upAxis = \"" +
      (stage_.up == "z" ? "Z" : "Y") + "\"\n)\n\ndef Xform \"clip\"\n{\n" + turn_to_y(stage_.up);
  const auto samples = [&](const std::string& name, const std::string& rows, const std::string& notes = "") {
    out += "    " + name + ".timeSamples = {\n" + rows + "    }" + notes + "\n";
  };
  out +=
      "def Mesh \"surface\"\n{\n    uniform token subdivisionScheme = \"none\"\n    int[] faceVertexCounts "
      "= " +
      counts_ + "\n    int[] faceVertexIndices = " + corners_ + "\n";
  samples("float3[] extent", extents_);
  samples("point3f[] points", points_);
  out += "    color3f[] primvars:displayColor (\n        interpolation = \"uniform\"\n    )\n";
  samples("color3f[] primvars:displayColor", colours_.rows);
  out += "    float[] primvars:depth (\n        interpolation = \"vertex\"\n    )\n";
  samples("float[] primvars:depth", depths_.rows);
  out += "}\n\ndef Points \"contacts\"\n{\n";
  samples("point3f[] points", marks_);
  const auto look = [&](double width, const char* colour) {
    out += "    float[] widths = [" + text_of(width) +
           "] (\n        interpolation = \"constant\"\n    )\n    color3f[] primvars:displayColor = [" +
           colour + "]\n}\n";
  };
  look(mark_width, "(0, 0.447, 0.698)");
  out +=
      "\ndef BasisCurves \"crossings\"\n{\n    uniform token type = \"linear\"\n    uniform token wrap = "
      "\"nonperiodic\"\n";
  samples("int[] curveVertexCounts", curve_counts_);
  samples("point3f[] points", curve_points_);
  look(mark_width / 2, "(0.84, 0.37, 0)");
  return out + "}\n";
}

}  // namespace cscd::scenes
