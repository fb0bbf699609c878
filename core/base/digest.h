#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

namespace cscd {

// One step of the 64-bit FNV-1a hash, which takes a byte. `before` is the hash of what comes before it. A
// larger word gives a hash of the same kind, but not the hash of the word's bytes.
constexpr std::uint64_t digest_step(std::uint64_t before, std::uint64_t word) {
  return (before ^ word) * 1099511628211ull;
}

// The 64-bit FNV-1a hash of bytes. To go on with more bytes, pass the hash of those before them.
inline constexpr std::uint64_t kDigestOfNothing = 14695981039346656037ull;
inline std::uint64_t digest_of(std::span<const std::byte> bytes, std::uint64_t before = kDigestOfNothing) {
  for (const std::byte byte : bytes) before = digest_step(before, static_cast<std::uint64_t>(byte));
  return before;
}

// The hash as records hold it: 16 hex digits.
inline std::string hex_text(std::uint64_t digest) {
  std::string text(16, '0');
  for (std::size_t i = 16; i-- > 0; digest >>= 4) text[i] = "0123456789abcdef"[digest & 15];
  return text;
}

// A hash of the same kind that takes eight bytes in each step instead of one, the last ones filled up with
// zeros. It is another number than digest_of() returns, and is not written into records.
inline std::uint64_t digest_of_words(std::span<const std::byte> bytes,
                                     std::uint64_t before = kDigestOfNothing) {
  for (; !bytes.empty(); bytes = bytes.subspan(std::min(bytes.size(), sizeof before))) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data(), std::min(bytes.size(), sizeof word));
    before = digest_step(before, word);
    before ^= before >> 32;  // or the upper bits of words would reach no lower ones
  }
  return before;
}

}  // namespace cscd
