#include <cstring>

#include "core/base/error.h"
#include "scenes/import/fbx/document.h"

namespace cscd::scenes::fbx {
namespace {

constexpr std::size_t kHeaderBytes = 27;  // name, two marks, the order of bytes, version
// Files of this version and later store sizes in 64 bits.
constexpr std::int64_t kWideSizes = 7500;

// Parses a file from front to back and never reads beyond its end.
class BinaryParser {
 public:
  explicit BinaryParser(std::string_view bytes) : bytes_(bytes) {}

  Document parse() {
    if (bytes_.size() < kHeaderBytes) refuse();
    if (bytes_[22] != 0)
      throw InputError(
          "its FBX header is damaged, or the file has its most significant bytes first; export it again");
    at_ = kHeaderBytes - 4;
    Document document;
    document.binary = true;
    document.version = number<std::uint32_t>();
    if (document.version < 7000) return document;  // the caller refuses it
    wide_ = document.version >= kWideSizes;
    // An empty record ends the list. A checksum follows.
    while (read_element(document.root.children, bytes_.size(), 0)) {
    }
    return document;
  }

 private:
  [[noreturn]] void refuse() const {
    throw InputError("byte " + std::to_string(at_) +
                     ": the FBX file is damaged or cut short; export it again");
  }

  template <class Number>
  Number number() {
    if (bytes_.size() - at_ < sizeof(Number)) refuse();
    Number value;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }

  std::uint64_t size() { return wide_ ? number<std::uint64_t>() : number<std::uint32_t>(); }

  std::string_view take(std::uint64_t length) {
    if (length > bytes_.size() - at_) refuse();
    const std::string_view taken = bytes_.substr(at_, static_cast<std::size_t>(length));
    at_ += taken.size();
    return taken;
  }

  // Reads one element. Returns false at the record that ends a list.
  bool read_element(std::vector<Element>& siblings, std::size_t limit, int depth) {
    if (depth > kDeepest) throw InputError("its FBX elements are nested too deeply; export it again");
    const std::uint64_t said_end = size(), values = size(), value_bytes = size();
    const std::size_t name_length = number<std::uint8_t>();
    if (said_end == 0 && values == 0 && value_bytes == 0 && name_length == 0) return false;
    Element& element = siblings.emplace_back();
    element.name = take(name_length);
    // Some writers leave out the end of an element without children.
    const std::uint64_t end = said_end == 0 ? at_ + value_bytes : said_end;
    if (end > limit || end < at_ || value_bytes > end - at_ || values > value_bytes) refuse();
    const std::size_t values_end = at_ + static_cast<std::size_t>(value_bytes);
    for (std::uint64_t i = 0; i < values; ++i) element.values.push_back(read_value());
    if (at_ != values_end) refuse();
    while (at_ < end)
      if (!read_element(element.children, static_cast<std::size_t>(end), depth + 1)) break;
    if (at_ != end) refuse();
    return true;
  }

  Value read_value() {
    const char type = number<char>();
    const auto integer = [](std::int64_t value) {
      return Value{Value::Kind::integer, value, static_cast<double>(value)};
    };
    switch (type) {
      case 'C':
      case 'B':
      case 'Z':
        return integer(number<std::uint8_t>());
      case 'Y':
        return integer(number<std::int16_t>());
      case 'I':
        return integer(number<std::int32_t>());
      case 'L':
        return integer(number<std::int64_t>());
      case 'F':
        return {Value::Kind::real, 0, static_cast<double>(number<float>())};
      case 'D':
        return {Value::Kind::real, 0, number<double>()};
      case 'S':
      case 'R':
        return {Value::Kind::text, 0, 0, take(number<std::uint32_t>())};
      case 'f':
      case 'd':
      case 'l':
      case 'i':
      case 'b':
      case 'c':
        return read_array(type);
      default:
        refuse();
    }
  }

  Value read_array(char type) {
    Value value;
    value.kind = Value::Kind::array;
    value.array.type = type;
    value.array.count = number<std::uint32_t>();
    const std::uint32_t encoding = number<std::uint32_t>();
    if (encoding > 1) refuse();
    value.array.deflated = encoding == 1;
    value.array.bytes = take(number<std::uint32_t>());
    return value;
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  bool wide_ = false;
};

}  // namespace

Document parse_binary(std::string_view bytes) {
  return BinaryParser(bytes).parse();
}

}  // namespace cscd::scenes::fbx
