#pragma once

// Boost 1.74 includes <iostream>, and libstdc++ then constructs an object before main(), which no copy of the
// engine may (scripts/cmake/instruction_sets.cmake). Boost needs no more of it than these two, so here it is
// taken to be included.
#include <istream>
#include <ostream>
#ifdef _GLIBCXX_IOSTREAM
#include <boost/multiprecision/cpp_int.hpp>
#else
#define _GLIBCXX_IOSTREAM
#include <boost/multiprecision/cpp_int.hpp>
#undef _GLIBCXX_IOSTREAM
#endif

namespace cscd::exact {

// An integer of any size. Up to 512 bits, which nearly all queries need, lie in the object itself.
using Integer =
    boost::multiprecision::number<boost::multiprecision::cpp_int_backend<512>, boost::multiprecision::et_off>;

// Returns the number of zero bits below the lowest bit that is set. x must not be 0.
inline unsigned long trailing_zeros(const Integer& x) {
  return boost::multiprecision::lsb(abs(x));
}

// Splits x into a fraction and a power of two: returns the fraction, rounded towards 0 to a double, and sets
// `exponent`, so that x is about fraction * 2^exponent. The magnitude of the fraction lies in [1/2, 1); it is
// 0 for x = 0.
double truncated(const Integer& x, long& exponent);

}  // namespace cscd::exact
