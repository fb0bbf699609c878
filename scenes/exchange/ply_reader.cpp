#include <array>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "scenes/base/text_encoding.h"
#include "scenes/exchange/number_bytes.h"
#include "scenes/exchange/surface_file.h"
#include "scenes/exchange/text_lines.h"

namespace cscd::scenes {
namespace {

// How a PLY file writes numbers: i signed, u unsigned, f floating.
struct PlyType {
  char kind = 'f';
  std::size_t bytes = 4;
};

// A property of a PLY element.
struct Property {
  std::string name;
  PlyType type;
  bool list = false;
  PlyType count_type{'u', 1};
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

struct PlyHeader {
  bool ascii = false, big = false;
  std::vector<Element> elements;
};

PlyType ply_type(std::string_view name, const TextLines& lines) {
  constexpr struct {
    std::string_view name;
    PlyType type;
  } kTypes[] = {{"char", {'i', 1}},  {"int8", {'i', 1}},    {"uchar", {'u', 1}},  {"uint8", {'u', 1}},
                {"short", {'i', 2}}, {"int16", {'i', 2}},   {"ushort", {'u', 2}}, {"uint16", {'u', 2}},
                {"int", {'i', 4}},   {"int32", {'i', 4}},   {"uint", {'u', 4}},   {"uint32", {'u', 4}},
                {"float", {'f', 4}}, {"float32", {'f', 4}}, {"double", {'f', 8}}, {"float64", {'f', 8}}};
  for (const auto& row : kTypes)
    if (row.name == name) return row.type;
  lines.fail(lines.quoted(name) + " is no type of a PLY file");
}

Property read_property(TextLines& lines) {
  Property property;
  std::string_view type = lines.word();
  if (type == "list") {
    property.list = true;
    property.count_type = ply_type(lines.word(), lines);
    type = lines.word();
  }
  property.type = ply_type(type, lines);
  property.name = lines.word();
  return property;
}

PlyHeader read_header(TextLines& lines) {
  PlyHeader header;
  bool known = false;
  while (lines.next()) {
    const std::string_view word = lines.word();
    if (word == "format") {
      const std::string_view format = lines.word();
      header.ascii = format == "ascii";
      header.big = format == "binary_big_endian";
      known = header.ascii || header.big || format == "binary_little_endian";
      if (!known) lines.fail(lines.quoted(format) + " is no format of a PLY file");
      if (const std::string_view version = lines.word(); version != "1.0")
        lines.fail("the version of PLY is " + lines.quoted(version) + ", and 1.0 alone is known");
    } else if (word == "element") {
      header.elements.push_back({std::string(lines.word()), 0, {}});
      const double count = lines.number(lines.word(), "count");
      if (!(count >= 0 && count <= static_cast<double>(kMostInSurfaceFile)) || count != std::floor(count))
        lines.fail("counts more elements than are read, or a part of one");
      header.elements.back().count = static_cast<std::size_t>(count);
    } else if (word == "property") {
      if (header.elements.empty()) lines.fail("a property belongs to no element");
      header.elements.back().properties.push_back(read_property(lines));
    } else if (word == "end_header" && known) {
      return header;
    } else if (!word.empty() && word != "comment" && word != "obj_info") {
      lines.fail(lines.quoted(word) + " is no line of a PLY header");
    }
  }
  throw InputError("has no PLY header that names a known format; export it again");
}

// Reads the numbers of elements from a binary body, one after another.
class BinaryNumbers {
 public:
  BinaryNumbers(std::string_view body, bool big) : body_(body), big_(big) {}

  void begin() {}
  double next(PlyType type) {
    if (body_.size() < type.bytes) throw InputError("ends before its last element; export it again");
    const std::uint64_t bits = bits_of(body_.substr(0, type.bytes), big_);
    body_.remove_prefix(type.bytes);
    if (type.kind == 'f')
      return type.bytes == 8 ? std::bit_cast<double>(bits)
                             : std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    if (type.kind == 'u') return static_cast<double>(bits);
    const std::size_t unused = 64 - 8 * type.bytes;
    return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
  }
  void end() {}
  // Bytes that are too many show that a file was changed on its way, as where line ends were put into it.
  void end_of_file() const {
    if (body_.find_first_not_of(" \t\r\n") != body_.npos)
      throw InputError("has " + std::to_string(body_.size()) +
                       " bytes behind its last element; export it again");
  }

 private:
  std::string_view body_;
  bool big_;
};

// Reads the numbers of elements from a body of text, in which each element is a line.
class TextNumbers {
 public:
  TextNumbers(std::string_view body, std::size_t lines_before) : lines_(body) {
    lines_.count_from(lines_before);
  }

  void begin() {
    if (!next_line()) throw InputError("ends before its last element; export it again");
  }
  double next(PlyType) {
    const std::string_view word = std::exchange(word_, lines_.word());
    if (word.empty()) lines_.fail("ends before the last number of its element");
    const std::optional<double> value = number_of(word);
    if (!value) lines_.fail("holds " + lines_.quoted(word) + " where a number has to be");
    return *value;
  }
  void end() const {
    if (!word_.empty()) lines_.fail("holds more numbers than an element of the header has");
  }
  void end_of_file() {
    if (next_line()) lines_.fail("stands behind the last element that the header counts");
  }

 private:
  bool next_line() {
    do {
      if (!lines_.next()) return false;
      word_ = lines_.word();
    } while (word_.empty());
    return true;
  }

  TextLines lines_;
  std::string_view word_;
};

template <class Numbers>
class PlyBody {
 public:
  PlyBody(Numbers numbers, SurfaceFile& surface) : numbers_(std::move(numbers)), surface_(surface) {}

  void read(const std::vector<Element>& elements) {
    for (const Element& element : elements) {
      if (element.properties.empty()) continue;
      if (element.name == "vertex") require_axes(element);
      if (element.name == "tristrips")
        throw InputError("its faces are strips of triangles, which are not read; export it with faces");
      for (std::size_t i = 0; i < element.count; ++i) {
        numbers_.begin();
        read_element(element, i);
        numbers_.end();
      }
    }
    numbers_.end_of_file();
  }

 private:
  static bool is_axis(const Property& property) {
    return !property.list && property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z';
  }

  static void require_axes(const Element& element) {
    std::array<int, 3> named{};
    for (const Property& property : element.properties)
      if (is_axis(property)) ++named[static_cast<std::size_t>(property.name[0] - 'x')];
    if (named != std::array{1, 1, 1})
      throw InputError("has vertices without one x, y and z each; export it again");
  }

  void read_element(const Element& element, std::size_t number) {
    Vec3 x = Vec3::Zero();
    for (const Property& property : element.properties) {
      if (property.list) {
        const bool is_face =
            element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
        read_list(property, is_face ? &surface_.faces : nullptr, number);
      } else if (const double value = numbers_.next(property.type); is_axis(property)) {
        x[property.name[0] - 'x'] = value;
      }
    }
    if (element.name != "vertex") return;
    if (!x.allFinite())
      throw InputError("vertex " + std::to_string(number) +
                       " (counted from 0): a coordinate is not finite; export it again");
    surface_.positions.push_back(x);
  }

  // Adds a list to the faces, or passes over it.
  void read_list(const Property& property, Polygons* faces, std::size_t element) {
    constexpr double kMostEntries = 1e6;
    const double count = numbers_.next(property.count_type);
    if (!(count >= 0 && count <= kMostEntries) || count != std::floor(count))
      throw InputError("has a list of " + std::to_string(count) + " entries; export it again");
    for (double k = 0; k < count; ++k) {
      const double entry = numbers_.next(property.type);
      if (faces == nullptr) continue;
      if (!(entry >= 0 && entry < static_cast<double>(kMostInSurfaceFile)) || entry != std::floor(entry))
        throw InputError("face " + std::to_string(element) +
                         " (counted from 0): a corner names no vertex; export it again");
      faces->corners.push_back(static_cast<std::int32_t>(entry));
    }
    if (faces == nullptr) return;
    if (count >= 3) {
      faces->ends.push_back(faces->corners.size());
      return;
    }
    faces->corners.resize(faces->corners.size() - static_cast<std::size_t>(count));
    ++surface_.points_and_lines;
  }

  Numbers numbers_;
  SurfaceFile& surface_;
};

}  // namespace

SurfaceFile read_ply(std::string_view file) {
  const std::string_view bytes = without_byte_order_mark(file);
  // The end of the first line is that of all lines of the header: behind it, other bytes may follow.
  const std::size_t first_end = bytes.find_first_of("\r\n");
  const bool returns =
      first_end != bytes.npos && bytes[first_end] == '\r' && !bytes.substr(first_end).starts_with("\r\n");
  TextLines lines(bytes, returns ? TextLines::kReturn : TextLines::kFeed);
  if (!lines.next() || lines.word() != "ply")
    throw InputError("does not begin like a PLY file; export it again");
  const PlyHeader header = read_header(lines);
  const std::string_view body = bytes.substr(lines.position());
  SurfaceFile surface;
  if (header.ascii)
    PlyBody(TextNumbers(body, lines.line_number()), surface).read(header.elements);
  else
    PlyBody(BinaryNumbers(body, header.big), surface).read(header.elements);
  require_sound(surface);
  return surface;
}

}  // namespace cscd::scenes
