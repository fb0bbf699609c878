#pragma once

#include <array>
#include <map>
#include <span>

#include "scenes/import/gltf/document.h"

namespace cscd::scenes::gltf {

// Sets of component types, as an accessor's purpose allows them.
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

// What a reader expects of an accessor.
struct Expected {
  std::string what;  // "positions of mesh 3"
  int type;          // TINYGLTF_TYPE_...
  Components components;
  bool must_normalize = false;  // integers stand for fractions only
  std::size_t most = 0;         // elements
};

// An accessor's numbers: integers that the file calls normalized are fractions of their largest value.
struct Numbers {
  std::size_t count = 0, width = 0;  // elements, and numbers of each
  std::vector<double> values;        // [count * width]

  std::span<const double> operator[](std::size_t i) const {
    return std::span(values).subspan(i * width, width);
  }
};

// Reads accessors and buffer views; keeps the views that it had to decompress. Throws InputError wherever an
// accessor is not what is expected of it, or reaches beyond its bytes; nothing is allocated before that.
class Accessors {
 public:
  explicit Accessors(const Document& document) : document_(document) {}

  const tinygltf::Accessor& checked(int accessor, const Expected& expected) const;
  Numbers read(int accessor, const Expected& expected);
  std::span<const unsigned char> view(int index, const std::string& what);

 private:
  void overwrite_sparse(const tinygltf::Accessor& accessor, const std::string& what, Numbers& numbers);

  const Document& document_;
  std::map<int, Bytes> decompressed_;
};

// One number of a component type from the bytes where it stands.
double number_at(const unsigned char* bytes, int component_type, bool normalized);

}  // namespace cscd::scenes::gltf
