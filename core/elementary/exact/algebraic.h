#pragma once

#include <vector>

#include "core/elementary/exact/polynomial.h"
#include "core/elementary/exact/time_enclosure.h"

namespace cscd::exact {

// A real algebraic number in [0, 1]: either a dyadic rational or the only root, a simple one, of a polynomial
// in an open interval with dyadic ends, at which the polynomial is not zero. Questions about the number may
// narrow the interval, never change the number.
class AlgebraicNumber {
 public:
  explicit AlgebraicNumber(Dyadic value);
  AlgebraicNumber(Polynomial polynomial, Dyadic lower, Dyadic upper);

  // The exact sign of p at this number. Cost: microseconds, more if p has a root very near.
  int sign_of(const Polynomial& p);
  // Neighbouring doubles round the number, or twice the number itself where it is a double.
  TimeEnclosure enclosure();
  // Does the number lie below (-1), at (0) or above (+1) the dyadic t?
  int compare_to(const Dyadic& t) const;
  // The order of two numbers whose intervals, if both have one, do not overlap.
  bool isolated_below(const AlgebraicNumber& other) const;

 private:
  bool is_dyadic() const { return polynomial_.is_zero(); }
  void become(Dyadic value);
  void move_end(const Dyadic& to, int sign_there);  // `to` inside the interval
  double guess() const;
  void tighten();
  void bisect();

  Polynomial polynomial_;  // zero for a dyadic number
  Dyadic lower_, upper_;
  int sign_below_ = 0;  // of the polynomial at the lower end
  bool tight_ = false;
  TimeEnclosure enclosure_{0, 1};
};

// The distinct roots in [0, 1] of a polynomial that is not zero, ascending.
std::vector<AlgebraicNumber> roots_in_unit_interval(const Polynomial& polynomial);

}  // namespace cscd::exact
