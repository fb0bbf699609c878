// Records of runs.
#include "bench/records/record.h"

#include "core/base/error.h"
#include "fuzz/target.h"

namespace cscd::fuzz {

void target(Bytes bytes) {
  const InputFile file(bytes);
  try {
    bench::read_record(file.path());
  } catch (const InputError&) {
  }
}

}  // namespace cscd::fuzz
