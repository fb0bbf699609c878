#pragma once

#include <array>

#include "core/elementary/exact/integer.h"

namespace cscd::exact {

// The number numerator / 2^exponent.
struct Dyadic {
  Integer numerator;
  unsigned long exponent = 0;
};
Dyadic dyadic(double x);                        // exact, for any finite x
int compare(const Dyadic& a, const Dyadic& b);  // negative, zero or positive, as a is below, at or above b
Dyadic midpoint(const Dyadic& a, const Dyadic& b);
// The nearest doubles on either side of x; both are x if x is a double. x is at least 0 and at most the
// largest double.
double double_below(const Dyadic& x);
double double_above(const Dyadic& x);

// An integer polynomial c[0] + c[1] t + ... + c[6] t^6. For points in linear motion, degree 3 suffices for
// contact and degree 6 for squared distances.
class Polynomial {
 public:
  static constexpr int kMaxDegree = 6;

  Polynomial() = default;  // zero
  explicit Polynomial(Integer constant);
  Polynomial(Integer constant, Integer slope);
  Polynomial(Integer c0, Integer c1, Integer c2, Integer c3);

  int degree() const { return degree_; }  // -1 for zero
  bool is_zero() const { return degree_ < 0; }
  const Integer& operator[](int power) const { return c_[static_cast<std::size_t>(power)]; }

  friend bool operator==(const Polynomial& a, const Polynomial& b) { return a.c_ == b.c_; }
  friend Polynomial operator+(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b);
  // In a product the degrees may sum up to kMaxDegree.
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b);
  void add_product(const Polynomial& a, const Polynomial& b);       // *this += a b
  void subtract_product(const Polynomial& a, const Polynomial& b);  // *this -= a b

  // The polynomial 2^(k degree) p((a + (b - a) s) / 2^k) in s, for from = a / 2^k and to = b / 2^k. It has
  // the same signs on [0, 1] as this polynomial, p, has on [from, to].
  Polynomial stretched(const Dyadic& from, const Dyadic& to) const;
  Polynomial derivative() const;
  Polynomial primitive_part() const;  // divided by the common divisor of the coefficients

  friend Polynomial greatest_common_divisor(Polynomial a, Polynomial b);
  // p / divisor. The divisor must be primitive and must divide p.
  friend Polynomial exact_quotient(const Polynomial& p, const Polynomial& divisor);

 private:
  Integer& at(int power) { return c_[static_cast<std::size_t>(power)]; }
  void trim();  // finds the degree from the coefficients

  std::array<Integer, kMaxDegree + 1> c_;
  int degree_ = -1;
};

int sign_at(const Polynomial& p, const Dyadic& t);

// The signs of the Bernstein coefficients of p on [0, 1]. By Descartes' rule for an interval, the number of
// roots in the open interval, with multiplicity, is `variations` or less by an even number. If there is no
// variation, p has the sign `sign` everywhere in the open interval (0 only for the zero polynomial).
struct UnitIntervalSigns {
  int variations;
  int sign;
};
UnitIntervalSigns signs_on_unit_interval(const Polynomial& p);

}  // namespace cscd::exact
