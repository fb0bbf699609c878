#pragma once

#include <cstdint>
#include <string>

#include "scenes/clip/clip.h"

namespace cscd::scenes {

// 64-bit FNV-1a over the bits of frames: for each, positions, then bones, then the prediction if there is
// one.
class FrameDigest {
 public:
  void add(const FrameView& frame, const FrameView* predicted = nullptr);
  std::string text() const;  // 16 hex digits

 private:
  std::uint64_t state_ = 14695981039346656037ull;
};

// 64-bit FNV-1a over bytes, as 16 hex digits.
std::string digest(const std::string& bytes);

// Takes frames for nothing but their digest.
class DigestSink final : public FrameSink {
 public:
  void append(const FrameView& frame, const FrameView* predicted) override { digest_.add(frame, predicted); }
  std::string text() const { return digest_.text(); }

 private:
  FrameDigest digest_;
};

}  // namespace cscd::scenes
