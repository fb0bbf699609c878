#include "scenes/clip/digest.h"

#include <span>

namespace cscd::scenes {

void FrameDigest::add(const FrameView& frame, const FrameView* predicted) {
  state_ = digest_of(std::as_bytes(frame.bones), digest_of(std::as_bytes(frame.positions), state_));
  if (predicted) add(*predicted);
}

std::string FrameDigest::text() const {
  return hex_text(state_);
}

std::string digest(const std::string& bytes) {
  return hex_text(digest_of(std::as_bytes(std::span(bytes))));
}

}  // namespace cscd::scenes
