#include "core/elementary/exact/integer.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace cscd::exact {

double truncated(const Integer& x, long& exponent) {
  constexpr long kDigits = std::numeric_limits<double>::digits;
  exponent = 0;
  if (x == 0) return 0;
  const Integer size = abs(x);
  exponent = static_cast<long>(msb(size)) + 1;
  const long spare = exponent - kDigits;
  const auto digits = static_cast<std::int64_t>(spare > 0 ? size >> spare : size << -spare);
  return std::ldexp(static_cast<double>(x.sign() * digits), -static_cast<int>(kDigits));
}

}  // namespace cscd::exact
