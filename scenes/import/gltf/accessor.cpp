#include "scenes/import/gltf/accessor.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <meshoptimizer.h>
#include <span>
#include <string>

#include "scenes/import/gltf/document.h"
#include "scenes/import/gltf/extensions.h"

namespace cscd::scenes::gltf {
namespace {

// Tells where EXT_meshopt_compression keeps the bytes of a buffer view, and how they are packed.
struct CompressedView {
  std::size_t buffer = 0, offset = 0, length = 0;  // place and number of the compressed bytes
  std::size_t stride = 0, count = 0;               // bytes from element to element, and number of elements
  enum class Mode { attributes, triangles, indices } mode = Mode::attributes;
  enum class Filter { none, octahedral, quaternion, exponential } filter = Filter::none;
};

using Mode = CompressedView::Mode;
using Filter = CompressedView::Filter;

// One compressed byte holds at most this many bytes. A byte of attributes can stand for four groups of
// sixteen equal bytes, and a byte of triangles for three indices.
constexpr std::size_t kDensest = 64;

[[noreturn]] void refuse_compressed(const std::string& what, const std::string& why) {
  throw InputError(what + ": their EXT_meshopt_compression " + why + "; export it again");
}

std::size_t whole(const tinygltf::Value& extension, const char* member, bool required,
                  const std::string& what) {
  // json.cpp has checked that a member of this name is a whole number.
  if (extension.Has(member)) return static_cast<std::size_t>(extension.Get(member).GetNumberAsInt());
  if (required) refuse_compressed(what, std::string("has no ") + member);
  return 0;
}

std::string word(const tinygltf::Value& extension, const char* member) {
  if (!extension.Has(member) || !extension.Get(member).IsString()) return {};
  return extension.Get(member).Get<std::string>();
}

Mode mode_of(const std::string& name, const std::string& what) {
  if (name == "ATTRIBUTES") return Mode::attributes;
  if (name == "TRIANGLES") return Mode::triangles;
  if (name == "INDICES") return Mode::indices;
  refuse_compressed(what, "has the unknown mode '" + name + "'");
}

Filter filter_of(const std::string& name, const std::string& what) {
  if (name.empty() || name == "NONE") return Filter::none;
  if (name == "OCTAHEDRAL") return Filter::octahedral;
  if (name == "QUATERNION") return Filter::quaternion;
  if (name == "EXPONENTIAL") return Filter::exponential;
  refuse_compressed(what, "has the unknown filter '" + name + "'");
}

// Checks what the decompressing library only asserts, because the library is built without assertions.
bool consistent(const CompressedView& view) {
  const std::size_t stride = view.stride;
  if (view.mode != Mode::attributes) {
    const bool whole_triangles = view.mode == Mode::indices || view.count % 3 == 0;
    return (stride == 2 || stride == 4) && view.filter == Filter::none && whole_triangles;
  }
  if (stride < 4 || stride > 256 || stride % 4 != 0) return false;
  if (view.filter == Filter::octahedral) return stride == 4 || stride == 8;
  return view.filter != Filter::quaternion || stride == 8;
}

// Reads the extension of a buffer view. `view_length` is the number of bytes that the view has once it is
// decompressed; `what` names what lies in the view, for error texts. Throws InputError for members that are
// missing, contradict each other or contradict `view_length`.
CompressedView compressed_view(const tinygltf::Value& extension, std::size_t view_length,
                               const std::string& what) {
  CompressedView view;
  view.buffer = whole(extension, "buffer", true, what);
  view.offset = whole(extension, "byteOffset", false, what);
  view.length = whole(extension, "byteLength", true, what);
  view.stride = whole(extension, "byteStride", true, what);
  view.count = whole(extension, "count", true, what);
  view.mode = mode_of(word(extension, "mode"), what);
  view.filter = filter_of(word(extension, "filter"), what);
  if (!consistent(view))
    refuse_compressed(what, "has a byteStride or count that does not fit its mode and filter");
  if (view.stride * view.count != view_length)
    refuse_compressed(what, "does not have as many bytes as its buffer view");
  return view;
}

// Decompresses a view. Throws InputError for damaged data, and for data that cannot hold
// as much as the view says.
Bytes decompress(const CompressedView& view, std::span<const unsigned char> compressed,
                 const std::string& what) {
  if (view.count * view.stride / kDensest > compressed.size())
    refuse_compressed(what, "holds fewer elements than it says");
  Bytes out(view.count * view.stride);
  using Decode = int(void*, std::size_t, std::size_t, const unsigned char*, std::size_t);
  Decode* decode = meshopt_decodeVertexBuffer;
  if (view.mode == Mode::triangles) decode = meshopt_decodeIndexBuffer;
  if (view.mode == Mode::indices) decode = meshopt_decodeIndexSequence;
  if (decode(out.data(), view.count, view.stride, compressed.data(), compressed.size()) != 0)
    refuse_compressed(what, "is damaged");
  if (view.filter == Filter::octahedral) meshopt_decodeFilterOct(out.data(), view.count, view.stride);
  if (view.filter == Filter::quaternion) meshopt_decodeFilterQuat(out.data(), view.count, view.stride);
  if (view.filter == Filter::exponential) meshopt_decodeFilterExp(out.data(), view.count, view.stride);
  return out;
}

std::size_t size_of(int component_type) {
  return static_cast<std::size_t>(
      tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component_type)));
}

template <class Number>
double number_of(const unsigned char* bytes, double largest) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  const auto value = static_cast<double>(number);
  return largest > 0 ? std::max(value / largest, -1.0) : value;
}

const char* name_of(int component_type) {
  constexpr std::array kNames = {"BYTE", "UNSIGNED_BYTE", "SHORT", "UNSIGNED_SHORT",
                                 "INT",  "UNSIGNED_INT",  "FLOAT"};
  const auto i = static_cast<std::size_t>(component_type - TINYGLTF_COMPONENT_TYPE_BYTE);
  return i < kNames.size() ? kNames[i] : "unknown";
}

// Returns where `count` elements of `size` bytes start in a view, `stride` bytes apart. Throws InputError
// if they reach beyond the view.
const unsigned char* elements(std::span<const unsigned char> view, std::size_t offset, std::size_t count,
                              std::size_t stride, std::size_t size, const std::string& what) {
  if (stride < size) throw InputError(what + ": elements overlap by their byteStride; repair the file");
  // No product overflows: all factors are below 2^31, which json.cpp has checked.
  if (count > 0 && (offset > view.size() || (count - 1) * stride + size > view.size() - offset))
    throw InputError(what + ": " + std::to_string(count) + " elements of " + std::to_string(size) +
                     " bytes reach beyond their buffer view of " + std::to_string(view.size()) +
                     " bytes; export it again");
  return view.data() + offset;
}

}  // namespace

double number_at(const unsigned char* bytes, int component_type, bool normalized) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return number_of<std::int8_t>(bytes, normalized ? 127 : 0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return number_of<std::uint8_t>(bytes, normalized ? 255 : 0);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return number_of<std::int16_t>(bytes, normalized ? 32767 : 0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return number_of<std::uint16_t>(bytes, normalized ? 65535 : 0);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return number_of<std::uint32_t>(bytes, 0);
    default:
      return number_of<float>(bytes, 0);
  }
}

const tinygltf::Accessor& Accessors::checked(int index, const Expected& expected) const {
  const tinygltf::Accessor& accessor = at(document_.model.accessors, index, "accessor");
  const std::string& what = expected.what;
  if (accessor.type != expected.type) throw InputError(what + ": have a wrong type; repair the file");
  const int component = accessor.componentType;
  const int bit = component - TINYGLTF_COMPONENT_TYPE_BYTE;
  if (bit < 0 || bit > 6 || (expected.components & (1u << bit)) == 0)
    throw InputError(what + ": are of the component type " + name_of(component) +
                     ", which glTF does not allow for them; export it again");
  if (expected.must_normalize && !accessor.normalized && component != TINYGLTF_COMPONENT_TYPE_FLOAT)
    throw InputError(what + ": are integers without being normalized; export it again");
  if (accessor.count > expected.most)
    throw InputError(what + ": are " + std::to_string(accessor.count) + ", more than the " +
                     std::to_string(expected.most) + " that are supported here; simplify the model");
  return accessor;
}

std::span<const unsigned char> Accessors::view(int index, const std::string& what) {
  const tinygltf::BufferView& view = at(document_.model.bufferViews, index, "buffer view");
  const auto slice = [&](std::size_t buffer, std::size_t offset, std::size_t length) {
    const std::optional<Bytes>& bytes = at(document_.buffers, static_cast<int>(buffer), "buffer");
    if (!bytes) throw InputError(what + ": lie in a buffer that holds nothing; export it again");
    if (offset > bytes->size() || length > bytes->size() - offset)
      throw InputError(what + ": buffer view " + std::to_string(index) +
                       " reaches beyond its buffer; export it again");
    return std::span(*bytes).subspan(offset, length);
  };
  const auto compressed = view.extensions.find(kMeshopt);
  if (compressed == view.extensions.end())
    return slice(static_cast<std::size_t>(view.buffer), view.byteOffset, view.byteLength);
  auto known = decompressed_.find(index);
  if (known == decompressed_.end()) {
    const CompressedView facts = compressed_view(compressed->second, view.byteLength, what);
    known =
        decompressed_.emplace(index, decompress(facts, slice(facts.buffer, facts.offset, facts.length), what))
            .first;
  }
  return known->second;
}

Numbers Accessors::read(int index, const Expected& expected) {
  const tinygltf::Accessor& accessor = checked(index, expected);
  Numbers numbers;
  numbers.count = accessor.count;
  numbers.width =
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
  const std::size_t component = size_of(accessor.componentType), size = numbers.width * component;
  if (accessor.bufferView >= 0) {
    const std::span<const unsigned char> bytes = view(accessor.bufferView, expected.what);
    const tinygltf::BufferView& described = at(document_.model.bufferViews, accessor.bufferView, "view");
    const std::size_t stride = described.byteStride > 0 ? described.byteStride : size;
    const unsigned char* first =
        elements(bytes, accessor.byteOffset, numbers.count, stride, size, expected.what);
    numbers.values.resize(numbers.count * numbers.width);
    for (std::size_t i = 0; i < numbers.count; ++i)
      for (std::size_t k = 0; k < numbers.width; ++k)
        numbers.values[i * numbers.width + k] =
            number_at(first + i * stride + k * component, accessor.componentType, accessor.normalized);
  } else {
    // Without a buffer view all numbers are 0, except those that the sparse part gives.
    numbers.values.assign(numbers.count * numbers.width, 0);
  }
  if (accessor.sparse.isSparse) overwrite_sparse(accessor, expected.what, numbers);
  return numbers;
}

void Accessors::overwrite_sparse(const tinygltf::Accessor& accessor, const std::string& what,
                                 Numbers& numbers) {
  const auto& sparse = accessor.sparse;
  const int index_type = sparse.indices.componentType;
  if (index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
      index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
      index_type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
    throw InputError(what + ": their sparse indices are of the component type " + name_of(index_type) +
                     "; export it again");
  const std::string those = what + ", sparse part";
  const auto count = static_cast<std::size_t>(sparse.count);
  const std::size_t component = size_of(accessor.componentType), size = numbers.width * component;
  const unsigned char* indices =
      elements(view(sparse.indices.bufferView, those), static_cast<std::size_t>(sparse.indices.byteOffset),
               count, size_of(index_type), size_of(index_type), those);
  const unsigned char* values =
      elements(view(sparse.values.bufferView, those), static_cast<std::size_t>(sparse.values.byteOffset),
               count, size, size, those);
  for (std::size_t i = 0; i < count; ++i) {
    const auto element =
        static_cast<std::size_t>(number_at(indices + i * size_of(index_type), index_type, false));
    if (element >= numbers.count)
      throw InputError(those + ": replaces element " + std::to_string(element) + " of " +
                       std::to_string(numbers.count) + "; export it again");
    for (std::size_t k = 0; k < numbers.width; ++k)
      numbers.values[element * numbers.width + k] =
          number_at(values + i * size + k * component, accessor.componentType, accessor.normalized);
  }
}

}  // namespace cscd::scenes::gltf
