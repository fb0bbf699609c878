#include "scenes/clip/digest.h"

#include <span>

namespace cscd::scenes {
namespace {

std::uint64_t fnv(std::uint64_t state, std::span<const std::byte> bytes) {
  for (const std::byte byte : bytes) state = (state ^ static_cast<std::uint64_t>(byte)) * 1099511628211ull;
  return state;
}

std::string hex(std::uint64_t value) {
  std::string text(16, '0');
  for (std::size_t i = 16; i-- > 0; value >>= 4) text[i] = "0123456789abcdef"[value & 15];
  return text;
}

}  // namespace

void FrameDigest::add(const FrameView& frame, const FrameView* predicted) {
  state_ = fnv(fnv(state_, std::as_bytes(frame.positions)), std::as_bytes(frame.bones));
  if (predicted) add(*predicted);
}

std::string FrameDigest::text() const {
  return hex(state_);
}

std::string digest(const std::string& bytes) {
  return hex(fnv(14695981039346656037ull, std::as_bytes(std::span(bytes))));
}

}  // namespace cscd::scenes
