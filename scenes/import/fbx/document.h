#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// The tree of named elements that every FBX file is, whatever it means. Debian 12 has no library that reads
// FBX as the FBX SDK does: assimp 5.2.5 knows bones by their names, which need not be unique, and drops
// layers, inherit types and kinds of interpolation. That is why this room exists.
namespace cscd::scenes::fbx {

// An array of numbers as it lies in the file. It is decoded only where someone asks for its numbers, because
// most arrays of a file (normals, texture coordinates) are of no interest here.
struct PackedNumbers {
  char type = 0;  // of the numbers: 'f', 'd', 'l', 'i', 'b' or 'c' in binary files, 't' for text
  bool deflated = false;
  std::uint64_t count = 0;  // as the file says, for binary files
  std::string_view bytes;
};

// One value of an element. Text points into the file's bytes.
struct Value {
  enum class Kind { integer, real, text, array } kind = Kind::integer;
  std::int64_t integer = 0;
  double real = 0;  // of integers too
  std::string_view text{};
  PackedNumbers array{};
};

struct Element {
  std::string_view name;
  std::vector<Value> values{};
  std::vector<Element> children{};

  // The first child of a name, or null.
  const Element* child(std::string_view wanted) const;
  // The text of a value, or empty text where there is none.
  std::string_view text(std::size_t index) const;
  // The integer of a value, or `otherwise` where there is none.
  std::int64_t integer(std::size_t index, std::int64_t otherwise = 0) const;
};

struct Document {
  bool binary = false;
  std::int64_t version = 0;  // 7400 for FBX 7.4
  Element root;
};

// Parses a whole file. The document points into `bytes`, which must outlive it. Throws InputError for what is
// no FBX file, for versions before 7100, and for damage.
Document parse(std::string_view bytes);

// The numbers of an element's first value, which is an array, or in old text files a plain list. Throws
// InputError for damage and for more than `most` numbers; `what` names the array in the refusal.
std::vector<double> reals(const Element& element, std::size_t most, const std::string& what);
std::vector<std::int64_t> integers(const Element& element, std::size_t most, const std::string& what);

// As reals(), and for each number whether text wrote it as an integer.
struct WrittenNumber {
  double real;
  std::int64_t integer;
  bool is_integer;
};
std::vector<WrittenNumber> written_numbers(const Element& element, std::size_t most, const std::string& what);

// How the two kinds of files are parsed; called by parse(), and by nobody else.
Document parse_binary(std::string_view bytes);
Document parse_text(std::string_view bytes);

// Reads one number of a text file. Words such as "nan" and "1.#INF" become what is not finite. Returns false
// for what is no number.
bool read_number(std::string_view word, WrittenNumber& number);

// Deeper trees than any program writes are refused, because reading them recurses.
constexpr int kDeepest = 64;

}  // namespace cscd::scenes::fbx
