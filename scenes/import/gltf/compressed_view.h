#pragma once

#include <span>
#include <string>

#include "scenes/import/gltf/document.h"

namespace cscd::scenes::gltf {

// Tells where EXT_meshopt_compression keeps the bytes of a buffer view, and how they are packed.
struct CompressedView {
  std::size_t buffer = 0, offset = 0, length = 0;  // place and number of the compressed bytes
  std::size_t stride = 0, count = 0;               // bytes from element to element, and number of elements
  enum class Mode { attributes, triangles, indices } mode = Mode::attributes;
  enum class Filter { none, octahedral, quaternion, exponential } filter = Filter::none;
};

// Reads the extension of a buffer view. `view_length` is the number of bytes that the view has once it is
// decompressed; `what` names what lies in the view, for error texts. Throws InputError for members that are
// missing, contradict each other or contradict `view_length`.
CompressedView compressed_view(const tinygltf::Value& extension, std::size_t view_length,
                               const std::string& what);

// Decompresses a view. Throws InputError for damaged data, and for data that cannot hold
// as much as the view says.
Bytes decompress(const CompressedView& view, std::span<const unsigned char> compressed,
                 const std::string& what);

}  // namespace cscd::scenes::gltf
