#include "core/elementary/certified/integer_polynomial.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cscd::integer {

int Polynomial::bits() const {
  int longest = 0;
  for (int i = 0; i <= degree; ++i) longest = std::max(longest, c[i].bits());
  return longest;
}

Dyadic dyadic(double t) {
  if (t == 0) return {0, 0};
  int exponent = 0;
  auto numerator = static_cast<std::int64_t>(std::ldexp(std::frexp(t, &exponent), 53));
  const int spare = std::countr_zero(static_cast<std::uint64_t>(numerator));
  return {numerator >> spare, 53 - exponent - spare};
}

int compare(const Wide& numerator, const Wide& denominator, const Dyadic& t) {
  return ((numerator << t.places) - denominator * Wide(t.numerator)).sign();
}

Polynomial stretched_by(const Polynomial& p, const Wide& numerator, const Wide& width, int places) {
  Polynomial r;
  r.degree = p.degree;
  for (int i = 0; i <= p.degree; ++i) r.c[i] = p.c[i] << places * (p.degree - i);
  if (numerator.sign() != 0)
    for (int i = 0; i < p.degree; ++i)
      for (int j = p.degree - 1; j >= i; --j) r.c[j] = r.c[j] + numerator * r.c[j + 1];
  if (width.bits() == 1) return r;
  Wide scale = width;
  for (int i = 1; i <= p.degree; ++i) {
    r.c[i] = r.c[i] * scale;
    if (i < p.degree) scale = scale * width;
  }
  return r;
}

Signs bernstein_signs(const Polynomial& p) {
  int sign[4] = {p.c[0].sign(), 0, 0, 0};
  if (p.degree == 3) {
    const Wide three = p.c[0] + (p.c[0] << 1), first = three + p.c[1];
    sign[1] = first.sign();
    sign[2] = (first + p.c[1] + p.c[2]).sign();
    sign[3] = (p.c[0] + p.c[1] + p.c[2] + p.c[3]).sign();
  } else if (p.degree == 2) {
    sign[1] = ((p.c[0] << 1) + p.c[1]).sign();
    sign[2] = (p.c[0] + p.c[1] + p.c[2]).sign();
  } else if (p.degree == 1) {
    sign[1] = (p.c[0] + p.c[1]).sign();
  } else if (p.degree < 0) {
    sign[0] = 0;
  }
  Signs result;
  result.zero_end = p.degree >= 0 && (sign[0] == 0 || sign[p.degree] == 0);
  int last = 0;
  for (int i = 0; i <= p.degree; ++i) {
    if (sign[i] == 0) continue;
    if (last == 0) result.first = sign[i];
    if (last == -sign[i]) ++result.variations;
    last = sign[i];
  }
  return result;
}

Rounded rounded(const Polynomial& p) {
  Wide::Leading lead[4];
  int largest = -(1 << 20);
  for (int i = 0; i <= p.degree; ++i) {
    lead[i] = p.c[i].leading();
    if (lead[i].value != 0) largest = std::max(largest, lead[i].exponent);
  }
  Rounded r;
  for (int i = 0; i <= p.degree; ++i)
    r.c[i] = std::ldexp(lead[i].value, std::max(lead[i].exponent - largest, -1000));
  return r;
}

}  // namespace cscd::integer
