#pragma once

#include <cstdint>

#include "core/elementary/certified/wide.h"

// Polynomials of degree at most 3 with integer coefficients and their signs on [0, 1]; their roots there, and
// exact signs of other polynomials at these roots.
// integer_roots.cpp explains how roots are found, and integer_signs.cpp explains how signs are found.
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
