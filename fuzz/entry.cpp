#include "fuzz/target.h"

// What libFuzzer calls.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  cscd::fuzz::target({data, size});
  return 0;
}
