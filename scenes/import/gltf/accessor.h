#pragma once

#include <array>
#include <map>
#include <span>

#include "scenes/import/gltf/document.h"

namespace cscd::scenes::gltf {

// Sets of component types, as far as an accessor's purpose allows them.
enum Components : unsigned {
  bytes = 1,            // BYTE
  unsigned_bytes = 2,   // UNSIGNED_BYTE
  shorts = 4,           // SHORT
  unsigned_shorts = 8,  // UNSIGNED_SHORT
  unsigned_ints = 32,   // UNSIGNED_INT
  floats = 64           // FLOAT
};
constexpr Components operator|(Components a, Components b) {
  return static_cast<Components>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}

// The properties that a reader expects of an accessor.
struct Expected {
  std::string what;             // begins error texts: "positions of mesh 3"
  int type;                     // TINYGLTF_TYPE_...
  Components components;        // the types allowed
  bool must_normalize = false;  // true: integers may only stand for fractions
  std::size_t most = 0;         // largest number of elements
};

// An accessor's numbers. Integers that the file calls normalized are given as fractions of the largest
// value of their type.
struct Numbers {
  std::size_t count = 0, width = 0;  // number of elements, and of numbers in each element
  std::vector<double> values;        // [count * width]

  std::span<const double> operator[](std::size_t i) const {
    return std::span(values).subspan(i * width, width);
  }
};

// Reads accessors and buffer views, and caches the buffer views that it had to decompress. Throws
// InputError wherever an accessor differs from what is expected of it or reaches beyond its bytes; memory
// for its numbers is allocated only after these checks.
class Accessors {
 public:
  explicit Accessors(const Document& document) : document_(document) {}

  // Returns the accessor of this index once it has passed the checks that need no data.
  const tinygltf::Accessor& checked(int accessor, const Expected& expected) const;
  // Returns the numbers of an accessor; its sparse part replaces some of them.
  Numbers read(int accessor, const Expected& expected);
  // Returns the bytes of a buffer view, decompressed if they are compressed.
  std::span<const unsigned char> view(int index, const std::string& what);

 private:
  void overwrite_sparse(const tinygltf::Accessor& accessor, const std::string& what, Numbers& numbers);

  const Document& document_;
  std::map<int, Bytes> decompressed_;
};

// Reads one number of a component type from the bytes at which it starts.
double number_at(const unsigned char* bytes, int component_type, bool normalized);

}  // namespace cscd::scenes::gltf
