#pragma once

#include <cstdint>
#include <optional>

#include "bench/records/record.h"

namespace cscd::bench {

// Watches the resident memory of this process, beginning without what was freed before.
class ResidentMemory {
 public:
  ResidentMemory();
  // What came on top since then: at its peak, and now. It has no instructions.
  Footprint footprint() const;

 private:
  bool peak_is_ours_;
  std::optional<std::uint64_t> resident_;
};

// A hardware counter of the instructions of this thread.
class InstructionCounter {
 public:
  InstructionCounter();
  ~InstructionCounter();
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;

  // Nothing where the machine does not count them.
  std::optional<std::uint64_t> so_far() const;

 private:
  int descriptor_;
};

}  // namespace cscd::bench
