#include "scenes/shape/shape.h"

#include <algorithm>
#include <cmath>

namespace cscd::scenes {

double scaled_count(int count, double factor, int least) {
  return std::max(static_cast<double>(least), std::round(count * factor));
}

}  // namespace cscd::scenes
