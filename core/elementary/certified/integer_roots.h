#pragma once

#include "core/elementary/certified/integer_polynomial.h"

// Roots of integer polynomials in [0, 1], and exact signs at those. How they are found stands in
// integer_roots.cpp, how signs are in integer_signs.cpp.
namespace cscd::integer {

// An exact root in [0, 1]: a fraction, or the only root, of odd order, of a polynomial between two doubles.
struct Root {
  double low = 0, high = 0;  // around the root; after `tighten` the same or neighbours
  // The isolated root of *polynomial, which has this sign just above `low`; null for a fraction.
  const Polynomial* polynomial = nullptr;
  int sign_below = 0;
  // Numerator / denominator, denominator > 0: a fraction itself; or for an isolated root, where `cut` is not
  // 0, what it is certainly above (1) or below (-1), between neighbouring doubles that enclose two.
  Wide numerator, denominator;
  int cut = 0;
};

// Where a polynomial of degree 2 or 3 turns between two roots that are close, or would if it had them.
struct Turn {
  int discriminant = 0;         // its sign: positive where all roots are real and different
  Wide numerator, denominator;  // the double root where the discriminant is zero; near a pair that is close
};

// What a root is above or below: a double, or a fraction.
struct Bound {
  double at = 0;
  bool is_fraction = false;
  Wide numerator = {}, denominator = {};
};

// Answers questions about the roots. Numbers too long for Wide, and three roots as near to each other as
// neighbouring doubles, are given up; answers after that mean nothing.
class RootSolver {
 public:
  bool gave_up() const { return gave_up_; }

  // Calls visit(Root&) for the roots in [0, 1] in ascending order until it returns true. The polynomial, not
  // zero, must outlive the roots. Roots of even order are visited once.
  template <class Visit>
  void for_each_root(const Polynomial& p, Visit&& visit) {
    Root roots[3];
    const int count = find_roots(p, roots);
    for (int i = 0; i < count && !gave_up_; ++i)
      if (visit(roots[i])) return;
  }
  // At most three. Ascending.
  int find_roots(const Polynomial& p, Root* roots);
  // Returns the only root of p between two doubles at which p has opposite signs.
  Root isolated_root(const Polynomial& p, double low, double high);

  // Makes `low` the largest double that is not above the root.
  void tighten(Root& root);
  // The exact sign of q, of degree 2 at most, at the root. Quicker after `tighten`.
  int sign_at(const Polynomial& q, const Root& root);

 private:
  int sign_at_double(const Polynomial& p, double t);
  int sign_at_fraction(const Polynomial& p, const Wide& numerator, const Wide& denominator);
  Polynomial stretched(const Polynomial& p, double low, double high);
  bool fits(int bits);
  void add_fraction(Wide numerator, Wide denominator, Root* roots, int& count);
  void find_fractions(const Polynomial& p, const Turn& turn, Root* roots, int& count);
  void search(const Polynomial& p, const Turn& turn, double low, double high, Root* roots, int& count,
              int depth);
  void cut_in_two(const Polynomial& p, const Turn& turn, double low, double high, int sign_below, Root* roots,
                  int& count);
  Turn turn_of(const Polynomial& p);
  int compared(const Wide& numerator, const Wide& denominator, const Bound& bound);
  int sign_at_bound(const Polynomial& p, const Bound& bound);
  int sign_at_side(const Polynomial& q, const Root& root, const Bound& low, const Bound& high);

  bool gave_up_ = false;
};

}  // namespace cscd::integer
