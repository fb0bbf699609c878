#pragma once

#include <cstdint>
#include <string>
#include <string_view>

// Numbers as bytes of a file, whatever this machine's order of bytes is.
namespace cscd::scenes {

// Returns the bits of up to eight bytes; `big` says that the highest byte comes first.
inline std::uint64_t bits_of(std::string_view bytes, bool big) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bits = bits << 8 | static_cast<std::uint8_t>(bytes[big ? i : bytes.size() - 1 - i]);
  return bits;
}

// Appends the lowest `count` bytes of `bits`.
inline void append_bits(std::uint64_t bits, std::size_t count, bool big, std::string& out) {
  for (std::size_t i = 0; i < count; ++i)
    out += static_cast<char>(static_cast<std::uint8_t>(bits >> 8 * (big ? count - 1 - i : i)));
}

}  // namespace cscd::scenes
