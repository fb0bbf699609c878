#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Reads the tree of named elements that every FBX file is, whatever the elements mean. This reader exists
// because Debian 12 has no library that reads FBX as the FBX SDK does: assimp 5.2.5 identifies bones by
// their names, which need not be unique, and drops layers, inherit types and kinds of interpolation.
namespace cscd::scenes::fbx {

// An array of numbers as it lies in the file. It is decoded only on request, because most arrays of a file
// (normals, texture coordinates) are not needed.
struct PackedNumbers {
  char type = 0;  // of the numbers: 'f', 'd', 'l', 'i', 'b' or 'c' in binary files, 't' in text files
  bool deflated = false;
  std::uint64_t count = 0;  // as a binary file says
  std::string_view bytes;
};

// One value of an element. Text points into the file's bytes.
struct Value {
  enum class Kind { integer, real, text, array } kind = Kind::integer;
  std::int64_t integer = 0;
  double real = 0;  // holds integers too
  std::string_view text{};
  PackedNumbers array{};
};

// A named element with its values and the elements inside its braces.
struct Element {
  std::string_view name;
  std::vector<Value> values{};
  std::vector<Element> children{};

  // Returns the first child of this name, or null.
  const Element* child(std::string_view wanted) const;
  // Returns the text of a value, or empty text where there is none.
  std::string_view text(std::size_t index) const;
  // Returns the integer of a value, or `otherwise` where there is none.
  std::int64_t integer(std::size_t index, std::int64_t otherwise = 0) const;
};

// A parsed file. The top elements are the children of `root`.
struct Document {
  bool binary = false;
  std::int64_t version = 0;  // 7400 for FBX 7.4
  Element root;
};

// Throws InputError for a version that no function here reads.
void require_new(std::int64_t version, bool binary);

// Parses a whole file. The document points into `bytes`, which must outlive it. Throws InputError for a
// file that is no FBX file, for versions before 7100, and for damage.
Document parse(std::string_view bytes);

// Return the numbers of an element's first value, which is an array, or a plain list in old text files.
// Throw InputError for damage and for more than `most` numbers; `what` names the array in the error.
std::vector<double> reals(const Element& element, std::size_t most, const std::string& what);
std::vector<std::int64_t> integers(const Element& element, std::size_t most, const std::string& what);

// A number, and whether a text file writes it as an integer.
struct WrittenNumber {
  double real;
  std::int64_t integer;
  bool is_integer;
};
// As reals(), with the form of each number.
std::vector<WrittenNumber> written_numbers(const Element& element, std::size_t most, const std::string& what);

// Parse the two kinds of files. Only parse() calls these functions.
Document parse_binary(std::string_view bytes);
Document parse_text(std::string_view bytes);

// Reads one number of a text file. Words such as "nan" and "1.#INF" become numbers that are not finite.
// Returns false if the word is no number.
bool read_number(std::string_view word, WrittenNumber& number);

// Trees that are deeper than any program writes are refused, because reading them recurses.
constexpr int kDeepest = 64;

}  // namespace cscd::scenes::fbx
