#include "core/base/instruction_set.h"

#include <array>
#include <stdexcept>
#include <string>

#include "core/base/error.h"

#include "cscd/cscd.h"

namespace cscd {

// In a build for one instruction set there is nothing to choose. A build for all has this function once more,
// in library/dispatch/front.cpp.
std::string_view instruction_set() {
  try {
    return to_string(chosen_among(std::array{kCompiledFor}));
  } catch (const InputError& error) {
    throw std::invalid_argument(error.what());
  }
}

}  // namespace cscd
