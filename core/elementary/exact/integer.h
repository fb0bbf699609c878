#pragma once

#include <boost/multiprecision/cpp_int.hpp>

namespace cscd::exact {

// An integer of any size. Up to 512 bits, which nearly all queries need, lie in the object itself.
using Integer =
    boost::multiprecision::number<boost::multiprecision::cpp_int_backend<512>, boost::multiprecision::et_off>;

// Returns the number of zero bits below the lowest bit that is set. x must not be 0.
inline unsigned long trailing_zeros(const Integer& x) {
  return boost::multiprecision::lsb(abs(x));
}

// x is about the returned fraction times 2^exponent, rounded towards 0. The fraction is 0 for 0, and
// otherwise its magnitude lies in [1/2, 1).
double truncated(const Integer& x, long& exponent);

}  // namespace cscd::exact
