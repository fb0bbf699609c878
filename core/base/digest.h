#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace cscd {

// The 64-bit FNV-1a hash of bytes. To go on with more bytes, pass the hash of those before them.
inline constexpr std::uint64_t kDigestOfNothing = 14695981039346656037ull;
inline std::uint64_t digest_of(std::span<const std::byte> bytes, std::uint64_t before = kDigestOfNothing) {
  for (const std::byte byte : bytes) before = (before ^ static_cast<std::uint64_t>(byte)) * 1099511628211ull;
  return before;
}

// A hash of the same kind that takes eight bytes in each step instead of one, the last ones filled up with
// zeros. It is another number than digest_of() returns, and is not written into records.
inline std::uint64_t digest_of_words(std::span<const std::byte> bytes,
                                     std::uint64_t before = kDigestOfNothing) {
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(bytes.size(), sizeof before))) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), std::min(bytes.size(), sizeof word));
    before = (before ^ word) * 1099511628211ull;
    before ^= before >> 32;  // or the upper bits of words would reach no lower ones
  }
  return before;
}

}  // namespace cscd
