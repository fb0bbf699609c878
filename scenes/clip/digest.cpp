#include "scenes/clip/digest.h"

#include <span>

namespace cscd::scenes {
namespace {

std::string hex(std::uint64_t value) {
  std::string text(16, '0');
  for (std::size_t i = 16; i-- > 0; value >>= 4) text[i] = "0123456789abcdef"[value & 15];
  return text;
}

}  // namespace

void FrameDigest::add(const FrameView& frame, const FrameView* predicted) {
  state_ = digest_of(std::as_bytes(frame.bones), digest_of(std::as_bytes(frame.positions), state_));
  if (predicted) add(*predicted);
}

std::string FrameDigest::text() const {
  return hex(state_);
}

std::string digest(const std::string& bytes) {
  return hex(digest_of(std::as_bytes(std::span(bytes))));
}

}  // namespace cscd::scenes
