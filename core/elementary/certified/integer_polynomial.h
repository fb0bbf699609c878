#pragma once

#include <cstdint>

#include "core/elementary/certified/wide.h"

// Polynomials of degree at most 3 with integer coefficients, and the signs of such a polynomial on [0, 1].
namespace cscd::integer {

struct Polynomial {
  Wide c[4];        // by ascending power
  int degree = -1;  // -1 for the zero polynomial

  // Finds the degree from the coefficients.
  void trim() {
    degree = 3;
    while (degree >= 0 && c[degree].sign() == 0) --degree;
  }
  bool is_zero() const { return degree < 0; }
  int bits() const;  // the number of bits of the longest coefficient
};

// The double numerator / 2^places.
struct Dyadic {
  std::int64_t numerator;
  int places;
};
Dyadic dyadic(double t);  // 0 <= t <= 1
// The order of numerator / denominator and t: -1 if the fraction is below t, 0 if they are equal, 1 if the
// fraction is above t. The denominator is positive.
int compare(const Wide& numerator, const Wide& denominator, const Dyadic& t);

// The polynomial 2^(places degree) p((numerator + width s) / 2^places) in s.
Polynomial stretched_by(const Polynomial& p, const Wide& numerator, const Wide& width, int places);

// What the Bernstein coefficients on [0, 1] say.
struct Signs {
  int variations = 0, first = 0;
  bool zero_end = false;  // the polynomial is zero at 0 or at 1
};
Signs bernstein_signs(const Polynomial& p);

// Returns the coefficients as doubles times a common power of two.
struct Rounded {
  double c[4] = {0, 0, 0, 0};
};
Rounded rounded(const Polynomial& p);

}  // namespace cscd::integer
