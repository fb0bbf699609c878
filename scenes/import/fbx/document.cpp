#include "scenes/import/fbx/document.h"

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <zlib.h>

#include "core/base/error.h"
#include "scenes/base/text_encoding.h"

namespace cscd::scenes::fbx {
namespace {

// Deflate expands one byte to at most this many.
constexpr std::uint64_t kMostInflation = 1032;

std::size_t size_of(char type) {
  switch (type) {
    case 'd':
    case 'l':
      return 8;
    case 'f':
    case 'i':
      return 4;
    default:
      return 1;
  }
}

void require_at_most(std::uint64_t count, std::size_t most, const std::string& what) {
  if (count > most)
    throw InputError(what + ": has " + std::to_string(count) + " numbers, more than the " +
                     std::to_string(most) + " that are supported; simplify the model");
}

[[noreturn]] void refuse_damage(const std::string& what) {
  throw InputError(what + ": its numbers are damaged; export the file again");
}

std::string inflated(const PackedNumbers& packed, std::uint64_t bytes, const std::string& what) {
  if (bytes > kMostInflation * (packed.bytes.size() + 1)) refuse_damage(what);
  std::string out(static_cast<std::size_t>(bytes), '\0');
  auto length = static_cast<uLongf>(bytes);
  const int result = uncompress(reinterpret_cast<Bytef*>(out.data()), &length,
                                reinterpret_cast<const Bytef*>(packed.bytes.data()),
                                static_cast<uLong>(packed.bytes.size()));
  if (result != Z_OK || length != bytes) refuse_damage(what);
  return out;
}

// FBX files and the processors that this program runs on are little-endian.
template <class Number>
WrittenNumber number_at(const char* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  if constexpr (std::is_floating_point_v<Number>)
    return {static_cast<double>(number), 0, false};
  else
    return {static_cast<double>(number), static_cast<std::int64_t>(number), true};
}

WrittenNumber number_at(char type, const char* bytes) {
  switch (type) {
    case 'd':
      return number_at<double>(bytes);
    case 'f':
      return number_at<float>(bytes);
    case 'l':
      return number_at<std::int64_t>(bytes);
    case 'i':
      return number_at<std::int32_t>(bytes);
    default:
      return number_at<std::int8_t>(bytes);
  }
}

template <class Visit>
void visit_binary(const PackedNumbers& packed, std::size_t most, const std::string& what,
                  const Visit& visit) {
  require_at_most(packed.count, most, what);
  const std::size_t size = size_of(packed.type);
  const std::uint64_t bytes = packed.count * size;
  std::string storage;
  std::string_view raw = packed.bytes;
  if (packed.deflated) {
    storage = inflated(packed, bytes, what);
    raw = storage;
  }
  if (raw.size() < bytes) refuse_damage(what);
  for (std::size_t i = 0; i < packed.count; ++i) visit(number_at(packed.type, raw.data() + i * size));
}

template <class Visit>
void visit_text(std::string_view text, std::size_t most, const std::string& what, const Visit& visit) {
  std::size_t count = 0;
  while (!text.empty()) {
    const std::size_t start = text.find_first_not_of(" \t\r\n,");
    if (start == text.npos) break;
    text.remove_prefix(start);
    if (text.front() == ';') {  // a comment
      text.remove_prefix(std::min(text.find_first_of("\r\n"), text.size()));
      continue;
    }
    const std::size_t end = std::min(text.find_first_of(" \t\r\n,;"), text.size());
    WrittenNumber number{};
    if (!read_number(text.substr(0, end), number)) refuse_damage(what);
    text.remove_prefix(end);
    require_at_most(++count, most, what);
    visit(number);
  }
}

template <class Visit>
void visit_numbers(const Element& element, std::size_t most, const std::string& what, const Visit& visit) {
  if (element.values.empty()) return;
  const Value& first = element.values.front();
  if (first.kind == Value::Kind::array) {
    if (first.array.type == 't')
      visit_text(first.array.bytes, most, what, visit);
    else
      visit_binary(first.array, most, what, visit);
    return;
  }
  require_at_most(element.values.size(), most, what);
  for (const Value& value : element.values) {
    if (value.kind != Value::Kind::integer && value.kind != Value::Kind::real) refuse_damage(what);
    visit(WrittenNumber{value.real, value.integer, value.kind == Value::Kind::integer});
  }
}

}  // namespace

const Element* Element::child(std::string_view wanted) const {
  for (const Element& element : children)
    if (element.name == wanted) return &element;
  return nullptr;
}

std::string_view Element::text(std::size_t index) const {
  if (index >= values.size() || values[index].kind != Value::Kind::text) return {};
  return values[index].text;
}

std::int64_t Element::integer(std::size_t index, std::int64_t otherwise) const {
  if (index >= values.size() || values[index].kind != Value::Kind::integer) return otherwise;
  return values[index].integer;
}

bool read_number(std::string_view word, WrittenNumber& number) {
  if (word.empty() || word.size() > 400) return false;
  if (word.front() == '+') word.remove_prefix(1);
  const char *begin = word.data(), *end = begin + word.size();
  const auto whole = std::from_chars(begin, end, number.integer);
  number.is_integer = whole.ec == std::errc{} && whole.ptr == end;
  if (number.is_integer) {
    number.real = static_cast<double>(number.integer);
    return true;
  }
  number.integer = 0;
  const auto real = std::from_chars(begin, end, number.real);
  if (real.ec == std::errc::result_out_of_range)  // strtod tells too large from too small
    number.real = std::strtod(std::string(word).c_str(), nullptr);
  else if (real.ec != std::errc{})
    return false;
  // Windows writes 1.#INF, -1.#IND and 1.#QNAN for numbers that are not finite.
  if (real.ptr != end && *real.ptr == '#')
    number.real = std::numeric_limits<double>::quiet_NaN();
  else if (real.ptr != end && *real.ptr != '(')  // nan(ind)
    return false;
  return true;
}

void require_new(std::int64_t version, bool binary) {
  if (version >= 7100) return;
  throw InputError("is FBX " + std::to_string(version / 1000) + "." + std::to_string(version / 100 % 10) +
                   (binary ? " binary" : " text") +
                   ", which is too old: FBX 7.1 (2011) and later are read; export it as FBX 7.4 binary");
}

Document parse(std::string_view bytes) {
  constexpr std::string_view kBinary = "Kaydara FBX Binary";
  Document document =
      bytes.starts_with(kBinary) ? parse_binary(bytes) : parse_text(without_byte_order_mark(bytes));
  require_new(document.version, document.binary);
  return document;
}

std::vector<double> reals(const Element& element, std::size_t most, const std::string& what) {
  std::vector<double> out;
  visit_numbers(element, most, what, [&out](const WrittenNumber& n) { out.push_back(n.real); });
  return out;
}

std::vector<std::int64_t> integers(const Element& element, std::size_t most, const std::string& what) {
  std::vector<std::int64_t> out;
  visit_numbers(element, most, what, [&](const WrittenNumber& n) {
    if (!n.is_integer) refuse_damage(what);
    out.push_back(n.integer);
  });
  return out;
}

std::vector<WrittenNumber> written_numbers(const Element& element, std::size_t most,
                                           const std::string& what) {
  std::vector<WrittenNumber> out;
  visit_numbers(element, most, what, [&out](const WrittenNumber& n) { out.push_back(n); });
  return out;
}

}  // namespace cscd::scenes::fbx
