#pragma once

#include <stdexcept>
#include <string>

namespace cscd {

// Thrown when the input cannot be used. The text says in one line what is wrong, where it is wrong (file,
// element, frame) and how to mend it. The program prints the text as it is and ends with exit status 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace cscd
