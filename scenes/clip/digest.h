#pragma once

#include <cstdint>
#include <string>

#include "core/base/digest.h"
#include "scenes/clip/clip.h"

namespace cscd::scenes {

// The 64-bit FNV-1a hash of the bits of frames. Each frame adds its positions, then its bones, then its
// prediction if it has one.
class FrameDigest {
 public:
  void add(const FrameView& frame, const FrameView* predicted = nullptr);
  std::string text() const;  // 16 hex digits

 private:
  std::uint64_t state_ = kDigestOfNothing;
};

// The 64-bit FNV-1a hash of bytes, as 16 hex digits.
std::string digest(const std::string& bytes);

// A sink that keeps only the digest of its frames.
class DigestSink final : public FrameSink {
 public:
  void append(const FrameView& frame, const FrameView* predicted) override { digest_.add(frame, predicted); }
  std::string text() const { return digest_.text(); }

 private:
  FrameDigest digest_;
};

}  // namespace cscd::scenes
