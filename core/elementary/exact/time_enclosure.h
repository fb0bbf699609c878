#pragma once

namespace cscd::exact {

// Two doubles round a time t*, with lo <= t* <= hi and hi - lo <= 2^-50.
struct TimeEnclosure {
  double lo, hi;
};

}  // namespace cscd::exact
