#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace cscd {

// The 64-bit FNV-1a hash of bytes. To go on with more bytes, pass the hash of those before them.
inline constexpr std::uint64_t kDigestOfNothing = 14695981039346656037ull;
inline std::uint64_t digest_of(std::span<const std::byte> bytes, std::uint64_t before = kDigestOfNothing) {
  for (const std::byte byte : bytes) before = (before ^ static_cast<std::uint64_t>(byte)) * 1099511628211ull;
  return before;
}

}  // namespace cscd
