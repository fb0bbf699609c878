#pragma once

#include "core/elementary/certified/integer_polynomial.h"

// Roots of integer polynomials in [0, 1], and exact signs of other polynomials at these roots.
// integer_roots.cpp explains how roots are found, and integer_signs.cpp explains how signs are found.
namespace cscd::integer {

// An exact root in [0, 1]. It is either a *fraction*, or an *isolated* root: the only root, of odd order, of
// a polynomial between two bounds.
struct Root {
  double low = 0, high = 0;  // doubles round the root; equal or neighbours after `tighten`
  // For an isolated root: its polynomial, and the sign of the polynomial just above `low`. For a fraction the
  // pointer is null.
  const Polynomial* polynomial = nullptr;
  int sign_below = 0;
  // numerator / denominator, with denominator > 0. For a fraction this is the root. For an isolated root with
  // `cut` other than 0 it is a number that the root is certainly above (cut = 1) or below (cut = -1); this
  // tells apart two roots between the same neighbouring doubles.
  Wide numerator, denominator;
  int cut = 0;
};

// The turn of a polynomial of degree 2 or 3: the place where it turns between two close roots, or where it
// would turn between them if it had them.
struct Turn {
  int discriminant = 0;  // the sign of the discriminant; positive if all roots are real and different
  // The turn is numerator / denominator. It is the double root if the discriminant is zero, and lies near any
  // pair of close roots.
  Wide numerator, denominator;
};

// A number that a root is above or below: a double, or a fraction.
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

  // Calls visit(Root&) for the roots in [0, 1] in ascending order until `visit` returns true. The polynomial
  // must not be zero and must outlive the roots. A root of even order is visited once.
  template <class Visit>
  void for_each_root(const Polynomial& p, Visit&& visit) {
    Root roots[3];
    const int count = find_roots(p, roots);
    for (int i = 0; i < count && !gave_up_; ++i)
      if (visit(roots[i])) return;
  }
  // Writes the roots in [0, 1] in ascending order to `roots`, which has room for three. Returns their number.
  int find_roots(const Polynomial& p, Root* roots);
  // Returns the only root of p between two doubles at which p has opposite signs.
  Root isolated_root(const Polynomial& p, double low, double high);

  // Makes root.low the largest double that is not above the root.
  void tighten(Root& root);
  // The exact sign of q at the root. The degree of q is at most 2. The call is quicker after `tighten`.
  int sign_at(const Polynomial& q, const Root& root);

 private:
  // The solver gives up in any of these if numbers are too long.
  int sign_at_double(const Polynomial& p, double t);
  int sign_at_fraction(const Polynomial& p, const Wide& numerator, const Wide& denominator);
  Polynomial stretched(const Polynomial& p, double low, double high);
  bool fits(int bits);  // gives up and returns false if numbers of so many bits are too long
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
