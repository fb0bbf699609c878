#pragma once

#include <cstddef>
#include <cstdint>

namespace cscd {

// Indices as types of their own, so that they cannot be mixed up. Unary plus turns an id into a
// plain index: positions[+vertex].
enum class VertexId : std::int32_t {};
enum class EdgeId : std::int32_t {};
enum class TriangleId : std::int32_t {};
enum class BoneId : std::int32_t {};  // -1 stands for "no bone": the parent of a root

constexpr std::size_t operator+(VertexId id) {
  return static_cast<std::size_t>(id);
}
constexpr std::size_t operator+(EdgeId id) {
  return static_cast<std::size_t>(id);
}
constexpr std::size_t operator+(TriangleId id) {
  return static_cast<std::size_t>(id);
}
constexpr std::size_t operator+(BoneId id) {
  return static_cast<std::size_t>(id);
}

}  // namespace cscd
