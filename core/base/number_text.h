#pragma once

#include <charconv>
#include <cstdio>
#include <string>

// Numbers as texts and messages say them.
namespace cscd {

// In as few digits as tell the number from every other one.
inline std::string exact_text(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

// Rounded to four digits.
inline std::string short_text(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", number);
  return text;
}

}  // namespace cscd
