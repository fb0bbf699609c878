#pragma once

#include <vector>

#include "core/elementary/exact/polynomial.h"
#include "core/elementary/exact/time_enclosure.h"

namespace cscd::exact {

// A real algebraic number in [0, 1]. It is either a dyadic rational, or the only root of a polynomial in an
// open interval with dyadic ends. That root is simple, and the polynomial is not zero at the ends. Questions
// about the number may narrow the interval, but they never change the number.
class AlgebraicNumber {
 public:
  explicit AlgebraicNumber(Dyadic value);
  AlgebraicNumber(Polynomial polynomial, Dyadic lower, Dyadic upper);

  // The exact sign of p at this number. It takes microseconds, and longer if p has a root very near.
  int sign_of(const Polynomial& p);
  // Two neighbouring doubles round the number. If the number is a double, both ends are the number itself.
  TimeEnclosure enclosure();
  // Tells whether the number lies below (-1), at (0) or above (+1) the dyadic t.
  int compare_to(const Dyadic& t) const;
  // True if this number is below `other`. If both numbers have intervals, the intervals must not overlap.
  bool isolated_below(const AlgebraicNumber& other) const;

 private:
  bool is_dyadic() const { return polynomial_.is_zero(); }
  void become(Dyadic value);
  void move_end(const Dyadic& to, int sign_there);  // `to` is inside the interval
  double guess() const;                             // an approximation of the number, without any promise
  void tighten();                                   // computes enclosure_
  void bisect();

  Polynomial polynomial_;  // zero for a dyadic number
  Dyadic lower_, upper_;
  int sign_below_ = 0;  // the sign of the polynomial at the lower end
  bool tight_ = false;  // enclosure_ is computed
  TimeEnclosure enclosure_{0, 1};
};

// Returns the distinct roots in [0, 1] in ascending order. The polynomial must not be zero.
std::vector<AlgebraicNumber> roots_in_unit_interval(const Polynomial& polynomial);

}  // namespace cscd::exact
