#include "scenes/exchange/surface_file.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "scenes/exchange/number_bytes.h"

namespace cscd::scenes {
namespace {

constexpr std::size_t kMost = std::size_t{1} << 28;  // vertices, and triangles: as many as a mesh may have

// The words of one line after another.
class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}

  // Goes to the next line; returns false behind the last.
  bool next() {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line_ = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++number_;
    return true;
  }
  // The next word of the line, empty at its end.
  std::string_view word() {
    const std::size_t from = std::min(line_.find_first_not_of(" \t\r"), line_.size());
    const std::size_t to = std::min(line_.find_first_of(" \t\r", from), line_.size());
    const std::string_view word = line_.substr(from, to - from);
    line_.remove_prefix(to);
    return word;
  }
  std::size_t position() const { return std::min(at_, text_.size()); }
  std::size_t line_number() const { return number_; }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError("line " + std::to_string(number_) + ": " + what + "; export the file again");
  }
  template <class Number>
  Number number(std::string_view word, const char* what) const {
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc{} || end != word.data() + word.size())
      fail("'" + std::string(word.substr(0, 40)) + "' is no " + what);
    return value;
  }
  Vec3 vector() {
    Vec3 x;
    for (int axis = 0; axis < 3; ++axis) x[axis] = number<double>(word(), "coordinate");
    if (!x.allFinite()) fail("a coordinate is not finite");
    return x;
  }

 private:
  std::string_view text_, line_;
  std::size_t at_ = 0, number_ = 0;
};

void add_polygon(const std::vector<std::int64_t>& polygon, SurfaceFile& surface) {
  for (std::size_t k = 2; k < polygon.size(); ++k)
    surface.triangles.push_back({static_cast<std::int32_t>(polygon[0]),
                                 static_cast<std::int32_t>(polygon[k - 1]),
                                 static_cast<std::int32_t>(polygon[k])});
}

void require_sound(const SurfaceFile& surface) {
  if (surface.positions.empty()) throw InputError("has no vertices; export it again");
  if (surface.positions.size() > kMost || surface.triangles.size() > kMost)
    throw InputError("has more than " + std::to_string(kMost) + " vertices or triangles; simplify it");
  for (const Vec3& x : surface.positions)
    if (!x.allFinite()) throw InputError("has a coordinate that is not finite; export it again");
  for (const auto& triangle : surface.triangles)
    for (const std::int32_t v : triangle)
      if (v < 0 || static_cast<std::size_t>(v) >= surface.positions.size())
        throw InputError("has a face of vertex " + std::to_string(v) + " (counted from 0), but " +
                         std::to_string(surface.positions.size()) + " vertices; export it again");
}

// A property of a PLY element.
struct Property {
  std::string name;
  char type = 'f';  // i signed, u unsigned, f floating
  std::size_t bytes = 4;
  bool list = false;
  char count_type = 'u';
  std::size_t count_bytes = 1;
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

std::pair<char, std::size_t> ply_type(std::string_view name, const Lines& lines) {
  constexpr struct {
    std::string_view name;
    char type;
    std::size_t bytes;
  } kTypes[] = {{"char", 'i', 1},  {"int8", 'i', 1},    {"uchar", 'u', 1},  {"uint8", 'u', 1},
                {"short", 'i', 2}, {"int16", 'i', 2},   {"ushort", 'u', 2}, {"uint16", 'u', 2},
                {"int", 'i', 4},   {"int32", 'i', 4},   {"uint", 'u', 4},   {"uint32", 'u', 4},
                {"float", 'f', 4}, {"float32", 'f', 4}, {"double", 'f', 8}, {"float64", 'f', 8}};
  for (const auto& row : kTypes)
    if (row.name == name) return {row.type, row.bytes};
  lines.fail("'" + std::string(name.substr(0, 40)) + "' is no type of a PLY file");
}

// Reads the numbers of a PLY file's body one after the other, in any of its three formats.
class PlyNumbers {
 public:
  PlyNumbers(std::string_view body, bool ascii, bool big) : body_(body), ascii_(ascii), big_(big) {}

  double next(char type, std::size_t bytes) {
    if (ascii_) {
      const std::size_t from = body_.find_first_not_of(" \t\r\n");
      if (from == std::string_view::npos) end();
      const std::size_t to = std::min(body_.find_first_of(" \t\r\n", from), body_.size());
      double value = 0;
      const auto [stop, error] = std::from_chars(body_.data() + from, body_.data() + to, value);
      if (error != std::errc{} || stop != body_.data() + to)
        throw InputError("holds '" + std::string(body_.substr(from, std::min<std::size_t>(to - from, 40))) +
                         "' where a number has to be; export it again");
      body_.remove_prefix(to);
      return value;
    }
    if (body_.size() < bytes) end();
    const std::uint64_t bits = bits_of(body_.substr(0, bytes), big_);
    body_.remove_prefix(bytes);
    if (type == 'f')
      return bytes == 8 ? std::bit_cast<double>(bits)
                        : std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    if (type == 'u') return static_cast<double>(bits);
    const std::size_t unused = 64 - 8 * bytes;
    return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
  }

 private:
  [[noreturn]] static void end() { throw InputError("ends before its last element; export it again"); }
  std::string_view body_;
  bool ascii_, big_;
};

}  // namespace

SurfaceFile read_obj(std::string_view text) {
  SurfaceFile surface;
  std::vector<std::int64_t> polygon;
  std::int64_t highest = -1;  // of all vertices that faces name
  std::size_t line_of_highest = 0;
  Lines lines(text);
  while (lines.next()) {
    const std::string_view kind = lines.word();
    if (kind == "v") {
      surface.positions.push_back(lines.vector());
    } else if (kind == "f") {
      polygon.clear();
      for (std::string_view word = lines.word(); !word.empty(); word = lines.word()) {
        const auto index = lines.number<std::int64_t>(word.substr(0, word.find('/')), "vertex number");
        // Negative numbers count back from the vertex read last.
        polygon.push_back(index < 0 ? static_cast<std::int64_t>(surface.positions.size()) + index
                                    : index - 1);
        if (polygon.back() < 0 || polygon.back() >= static_cast<std::int64_t>(kMost))
          lines.fail("'" + std::string(word.substr(0, 40)) + "' names no vertex");
        if (polygon.back() > highest) {
          highest = polygon.back();
          line_of_highest = lines.line_number();
        }
      }
      if (polygon.size() < 3) lines.fail("a face has fewer than three corners");
      add_polygon(polygon, surface);
    }
  }
  // Faces may come before the vertices that they name.
  if (!surface.positions.empty() && highest >= static_cast<std::int64_t>(surface.positions.size()))
    throw InputError("line " + std::to_string(line_of_highest) + ": a face names vertex " +
                     std::to_string(highest + 1) + ", and the file has " +
                     std::to_string(surface.positions.size()) + " vertices; export the file again");
  require_sound(surface);
  return surface;
}

SurfaceFile read_ply(std::string_view bytes) {
  Lines lines(bytes);
  if (!lines.next() || lines.word() != "ply")
    throw InputError("does not begin like a PLY file; export it again");
  std::vector<Element> elements;
  bool ascii = false, big = false, known = false, ended = false;
  while (!ended && lines.next()) {
    const std::string_view word = lines.word();
    if (word == "format") {
      const std::string_view format = lines.word();
      ascii = format == "ascii";
      big = format == "binary_big_endian";
      known = ascii || big || format == "binary_little_endian";
    } else if (word == "element") {
      elements.push_back({std::string(lines.word()), 0, {}});
      elements.back().count = lines.number<std::size_t>(lines.word(), "count");
      if (elements.back().count > kMost) lines.fail("counts more elements than are read");
    } else if (word == "property") {
      if (elements.empty()) lines.fail("a property belongs to no element");
      Property property;
      std::string_view type = lines.word();
      if (type == "list") {
        property.list = true;
        std::tie(property.count_type, property.count_bytes) = ply_type(lines.word(), lines);
        type = lines.word();
      }
      std::tie(property.type, property.bytes) = ply_type(type, lines);
      property.name = lines.word();
      elements.back().properties.push_back(std::move(property));
    } else if (word == "end_header") {
      ended = true;
    }
  }
  if (!ended || !known) throw InputError("has no PLY header that names a known format; export it again");

  SurfaceFile surface;
  PlyNumbers numbers(bytes.substr(lines.position()), ascii, big);
  std::vector<std::int64_t> list;
  for (const Element& element : elements) {
    if (element.properties.empty()) continue;
    const bool vertices = element.name == "vertex", faces = element.name == "face";
    int axes = 0;
    for (std::size_t i = 0; i < element.count; ++i) {
      Vec3 x = Vec3::Zero();
      for (const Property& property : element.properties) {
        if (property.list) {
          const double count = numbers.next(property.count_type, property.count_bytes);
          if (!(count >= 0 && count <= 1e6))
            throw InputError("has a list of " + std::to_string(count) + " entries; export it again");
          list.clear();
          for (double k = 0; k < count; ++k) {
            const double entry = numbers.next(property.type, property.bytes);
            list.push_back(std::isfinite(entry) && std::abs(entry) < kMost ? static_cast<std::int64_t>(entry)
                                                                           : -1);
          }
          if (faces && (property.name == "vertex_indices" || property.name == "vertex_index"))
            add_polygon(list, surface);
          continue;
        }
        const double value = numbers.next(property.type, property.bytes);
        if (vertices && property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z') {
          x[property.name[0] - 'x'] = value;
          ++axes;
        }
      }
      if (vertices) surface.positions.push_back(x);
    }
    if (vertices && axes != 3 * static_cast<int>(element.count))
      throw InputError("has vertices without x, y and z; export it again");
  }
  require_sound(surface);
  return surface;
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
