#pragma once

#include <stdexcept>
#include <string>

namespace cscd {

// Thrown when the input cannot be used. The text says in one line what is wrong, where it is wrong (file,
// element, frame) and how to mend it. The program prints the text as it is and ends with exit status 2. Users
// of the library catch the standard class below it.
class InputError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace cscd
