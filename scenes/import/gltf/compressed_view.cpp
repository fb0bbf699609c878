#include "scenes/import/gltf/compressed_view.h"

#include <meshoptimizer.h>

namespace cscd::scenes::gltf {
namespace {

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

}  // namespace

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

}  // namespace cscd::scenes::gltf
