#pragma once

#include <stdexcept>
#include <string>

namespace cscd {

// The input cannot be used. The text says in one line what is wrong, where (file, element, frame) and how to
// mend it; the program prints it as it is and ends with status 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace cscd
