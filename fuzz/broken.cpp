#include <cstdio>
#include <cstdlib>

#include "fuzz/target.h"

namespace cscd::fuzz {

void broken(const std::string& promise) {
  std::fprintf(stderr, "broken: %s\n", promise.c_str());
  std::abort();
}

}  // namespace cscd::fuzz
