#include "core/elementary/exact/polynomial.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace cscd::exact {

Dyadic dyadic(double x) {
  assert(std::isfinite(x));
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  Integer numerator = static_cast<std::int64_t>(std::ldexp(fraction, 53));
  exponent -= 53;
  if (exponent >= 0) {
    numerator <<= static_cast<unsigned long>(exponent);
    return {std::move(numerator), 0};
  }
  // Make the numerator short, so that all numbers computed from it are short.
  unsigned long places = static_cast<unsigned long>(-exponent);
  if (numerator == 0) return {};
  const unsigned long spare = std::min(trailing_zeros(numerator), places);
  numerator >>= spare;
  return {std::move(numerator), places - spare};
}

int compare(const Dyadic& a, const Dyadic& b) {
  if (a.exponent == b.exponent) return a.numerator.compare(b.numerator);
  if (a.exponent < b.exponent) return Integer(a.numerator << (b.exponent - a.exponent)).compare(b.numerator);
  return a.numerator.compare(Integer(b.numerator << (a.exponent - b.exponent)));
}

Dyadic midpoint(const Dyadic& a, const Dyadic& b) {
  const unsigned long exponent = std::max(a.exponent, b.exponent);
  Dyadic middle{(a.numerator << (exponent - a.exponent)) + (b.numerator << (exponent - b.exponent)),
                exponent + 1};
  if (middle.numerator == 0) return {};
  const unsigned long spare = std::min(trailing_zeros(middle.numerator), middle.exponent);
  middle.numerator >>= spare;
  middle.exponent -= spare;
  return middle;
}

double double_below(const Dyadic& x) {
  long exponent = 0;
  const double fraction = truncated(x.numerator, exponent);
  const double near = std::ldexp(fraction, static_cast<int>(exponent - static_cast<long>(x.exponent)));
  // ldexp rounds only a subnormal result, possibly upwards.
  return compare(dyadic(near), x) > 0 ? std::nextafter(near, -std::numeric_limits<double>::infinity()) : near;
}

double double_above(const Dyadic& x) {
  const double below = double_below(x);
  return compare(dyadic(below), x) == 0 ? below
                                        : std::nextafter(below, std::numeric_limits<double>::infinity());
}

Polynomial::Polynomial(Integer constant) {
  c_[0] = std::move(constant);
  trim();
}

Polynomial::Polynomial(Integer constant, Integer slope) {
  c_[0] = std::move(constant);
  c_[1] = std::move(slope);
  trim();
}

Polynomial::Polynomial(Integer c0, Integer c1, Integer c2, Integer c3)
    : c_{std::move(c0), std::move(c1), std::move(c2), std::move(c3)} {
  trim();
}

void Polynomial::trim() {
  degree_ = kMaxDegree;
  while (degree_ >= 0 && (*this)[degree_] == 0) --degree_;
}

Polynomial operator+(const Polynomial& a, const Polynomial& b) {
  Polynomial sum;
  for (int i = std::max(a.degree_, b.degree_); i >= 0; --i) sum.at(i) = a[i] + b[i];
  sum.trim();
  return sum;
}

Polynomial operator-(const Polynomial& a, const Polynomial& b) {
  Polynomial difference;
  for (int i = std::max(a.degree_, b.degree_); i >= 0; --i) difference.at(i) = a[i] - b[i];
  difference.trim();
  return difference;
}

Polynomial operator*(const Polynomial& a, const Polynomial& b) {
  Polynomial product;
  product.add_product(a, b);
  return product;
}

void Polynomial::add_product(const Polynomial& a, const Polynomial& b) {
  assert(a.degree_ < 0 || b.degree_ < 0 || a.degree_ + b.degree_ <= kMaxDegree);
  for (int i = 0; i <= a.degree_; ++i)
    for (int j = 0; j <= b.degree_; ++j) at(i + j) += a[i] * b[j];
  trim();
}

void Polynomial::subtract_product(const Polynomial& a, const Polynomial& b) {
  assert(a.degree_ < 0 || b.degree_ < 0 || a.degree_ + b.degree_ <= kMaxDegree);
  for (int i = 0; i <= a.degree_; ++i)
    for (int j = 0; j <= b.degree_; ++j) at(i + j) -= a[i] * b[j];
  trim();
}

Polynomial Polynomial::stretched(const Dyadic& from, const Dyadic& to) const {
  if (degree_ <= 0) return *this;
  const unsigned long k = std::max(from.exponent, to.exponent);
  const Integer a = from.numerator << (k - from.exponent);
  const Integer width = (to.numerator << (k - to.exponent)) - a;
  if (k == 0 && a == 0 && width == 1) return *this;
  Polynomial result;
  for (int i = 0; i <= degree_; ++i)
    result.at(i) = (*this)[i] << (k * static_cast<unsigned long>(degree_ - i));
  // Shift the argument by a (Taylor shift by synthetic division), then replace s by width s.
  if (a != 0)
    for (int i = 0; i < degree_; ++i)
      for (int j = degree_ - 1; j >= i; --j) result.at(j) += a * result[j + 1];
  Integer scale = width;
  for (int i = 1; i <= degree_; ++i) {
    result.at(i) *= scale;
    scale *= width;
  }
  result.trim();
  return result;
}

Polynomial Polynomial::derivative() const {
  Polynomial result;
  for (int i = 1; i <= degree_; ++i) result.at(i - 1) = i * (*this)[i];
  result.trim();
  return result;
}

Polynomial Polynomial::primitive_part() const {
  if (degree_ < 0) return *this;
  Integer content;
  for (int i = 0; i <= degree_; ++i) content = gcd(content, (*this)[i]);
  Polynomial result;
  for (int i = 0; i <= degree_; ++i) result.at(i) = (*this)[i] / content;
  result.trim();
  return result;
}

Polynomial greatest_common_divisor(Polynomial a, Polynomial b) {
  a = a.primitive_part();
  b = b.primitive_part();
  if (a.degree_ < b.degree_) std::swap(a, b);
  // This is Euclid's algorithm on primitive pseudo-remainders.
  while (!b.is_zero()) {
    while (a.degree_ >= b.degree_) {
      const int shift = a.degree_ - b.degree_;
      const Integer lead_a = a[a.degree_], lead_b = b[b.degree_];
      for (int i = 0; i <= a.degree_; ++i) a.at(i) *= lead_b;
      for (int i = 0; i <= b.degree_; ++i) a.at(i + shift) -= lead_a * b[i];
      a.trim();
    }
    a = a.primitive_part();
    std::swap(a, b);
  }
  return a;
}

Polynomial exact_quotient(const Polynomial& p, const Polynomial& divisor) {
  assert(!divisor.is_zero());
  Polynomial rest = p, quotient;
  while (rest.degree_ >= divisor.degree_) {
    const int shift = rest.degree_ - divisor.degree_;
    Integer& term = quotient.at(shift);
    term = rest[rest.degree_] / divisor[divisor.degree_];
    for (int i = 0; i <= divisor.degree_; ++i) rest.at(i + shift) -= term * divisor[i];
    rest.trim();
  }
  assert(rest.is_zero());
  quotient.trim();
  return quotient;
}

int sign_at(const Polynomial& p, const Dyadic& t) {
  if (p.is_zero()) return 0;
  // Compute 2^(exponent degree) p(t) by Horner's scheme.
  Integer value = p[p.degree()];
  for (int i = p.degree() - 1; i >= 0; --i) {
    value *= t.numerator;
    value += p[i] << (t.exponent * static_cast<unsigned long>(p.degree() - i));
  }
  return value.sign();
}

UnitIntervalSigns signs_on_unit_interval(const Polynomial& p) {
  // The Bernstein coefficient of number j, times C(n, j), is the sum of C(n - i, j - i) c_i over i <= j.
  const int n = p.degree();
  UnitIntervalSigns result{0, 0};
  Integer coefficient;
  for (int j = 0; j <= n; ++j) {
    coefficient = p[j];
    unsigned long binomial = 1;
    for (int i = j - 1; i >= 0; --i) {
      binomial = binomial * static_cast<unsigned long>(n - i) / static_cast<unsigned long>(j - i);
      coefficient += p[i] * binomial;
    }
    const int s = coefficient.sign();
    if (s == 0) continue;
    if (result.sign != 0 && s != result.sign) ++result.variations;
    result.sign = s;
  }
  return result;
}

}  // namespace cscd::exact
