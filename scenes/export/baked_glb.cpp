#include "scenes/export/baked_glb.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <type_traits>
#include <vector>

#include "core/base/error.h"
#include "scenes/export/glb_container.h"

namespace cscd::scenes {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

constexpr int kFloat = 5126, kUnsigned = 5125;  // the specification's component types

// The buffer, and the accessors of it; each has a view of its own.
struct BakedBuffer {
  std::string bytes;
  Json views = Json::array(), accessors = Json::array();

  template <class Value>
  std::size_t add(std::span<const Value> values, std::size_t width, const char* type) {
    views.push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size_bytes()}});
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
    accessors.push_back({{"bufferView", views.size() - 1},
                         {"componentType", std::is_same_v<Value, float> ? kFloat : kUnsigned},
                         {"count", values.size() / width},
                         {"type", type}});
    return accessors.size() - 1;
  }

  // Positions need their bounds, of the rounded numbers (glTF 2.0, section 3.7.2.1).
  std::size_t add_positions(const std::vector<float>& values) {
    const std::size_t accessor = add(std::span<const float>(values), 3, "VEC3");
    std::array<float, 3> low{values[0], values[1], values[2]}, high = low;
    for (std::size_t i = 0; i < values.size(); ++i) {
      low[i % 3] = std::min(low[i % 3], values[i]);
      high[i % 3] = std::max(high[i % 3], values[i]);
    }
    accessors[accessor]["min"] = low;
    accessors[accessor]["max"] = high;
    return accessor;
  }
};

std::vector<float> rounded(std::span<const Vec3> positions, std::span<const Vec3> base) {
  std::vector<float> out;
  out.reserve(3 * positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      out.push_back(static_cast<float>(positions[v][axis] - (base.empty() ? 0 : base[v][axis])));
  return out;
}

}  // namespace

std::string baked_glb(ClipSource& clip, const std::string& name, double fps) {
  const std::size_t frames = clip.frame_count(), targets = frames - 1;
  if (12 * clip.header().vertex_count * frames > UINT32_MAX)
    throw InputError("the frames are more than the 4 GiB of a .glb file; export them as .pc2 or .h5");
  BakedBuffer buffer;
  std::vector<std::uint32_t> corners;
  for (const Triangle& triangle : clip.header().triangles)
    for (const VertexId v : triangle) corners.push_back(static_cast<std::uint32_t>(v));
  Json primitive;
  const std::span<const Vec3> first = clip.load_frame(0).positions;
  const std::vector<Vec3> base(first.begin(), first.end());
  primitive["attributes"]["POSITION"] = buffer.add_positions(rounded(base, {}));
  primitive["indices"] = buffer.add(std::span<const std::uint32_t>(corners), 1, "SCALAR");
  for (std::size_t f = 1; f < frames; ++f)
    primitive["targets"].push_back(
        {{"POSITION", buffer.add_positions(rounded(clip.load_frame(f).positions, base))}});
  std::vector<float> times, weights(frames * targets, 0.0F);
  for (std::size_t f = 0; f < frames; ++f) {
    times.push_back(static_cast<float>(static_cast<double>(f) / fps));
    if (f > 0) weights[f * targets + f - 1] = 1;
  }
  const std::size_t input = buffer.add(std::span<const float>(times), 1, "SCALAR");
  buffer.accessors[input]["min"] = {times.front()};
  buffer.accessors[input]["max"] = {times.back()};
  const std::size_t output = buffer.add(std::span<const float>(weights), 1, "SCALAR");

  Json file{{"asset", {{"version", "2.0"}, {"generator", "cscd"}}},
            {"scene", 0},
            {"scenes", Json::array({{{"nodes", Json::array({0})}}})},
            {"nodes", Json::array({{{"name", name}, {"mesh", 0}}})},
            {"meshes", Json::array({{{"name", name},
                                     {"primitives", Json::array({std::move(primitive)})},
                                     {"weights", std::vector<int>(targets, 0)}}})}};
  file["animations"] = Json::array(
      {{{"name", "frames"},
        {"samplers", Json::array({{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}})},
        {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}})}}});
  file["accessors"] = std::move(buffer.accessors);
  file["bufferViews"] = std::move(buffer.views);
  file["buffers"] = Json::array({{{"byteLength", buffer.bytes.size()}}});
  return glb_container(file.dump(-1, ' ', false, Json::error_handler_t::replace), buffer.bytes);
}

}  // namespace cscd::scenes
