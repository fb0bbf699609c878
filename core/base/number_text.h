#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

// Numbers as texts and messages say them.
namespace cscd {

// In as few digits as tell the number from every other one.
inline std::string exact_text(double number) {
#ifdef __wasm__
  // libc++'s std::to_chars() would bring tables of 100 kB. As there, the shorter notation is chosen.
  char text[32], fixed[400];
  int digits = 0;
  do std::snprintf(text, sizeof text, "%.*e", digits, number);
  while (std::strtod(text, nullptr) != number && ++digits < 17);
  if (!std::isfinite(number)) return text;
  std::snprintf(fixed, sizeof fixed, "%.*f", std::max(0, digits - std::atoi(std::strchr(text, 'e') + 1)),
                number);
  return std::strlen(fixed) <= std::strlen(text) ? fixed : text;
#else
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
#endif
}

// Rounded to so many significant digits; all digits before the point stand in any case, up to a size of 1e15.
inline std::string rounded_text(double number, int digits) {
  char text[32];
  const double size = std::abs(number);
  if (size >= std::pow(10, digits) - 0.5 && size < 1e15)
    std::snprintf(text, sizeof text, "%.0f", number);
  else
    std::snprintf(text, sizeof text, "%.*g", digits, number);
  return text;
}

// A figure as people read it, with commas between thousands: in a table or on a page rounded to three digits.
inline std::string figure_text(double number, int digits = 3) {
  std::string text = rounded_text(number, digits);
  const std::size_t begin = text.starts_with('-') ? 1 : 0;
  if (text.find_first_not_of("0123456789", begin) != std::string::npos) return text;
  for (std::size_t at = text.size(); at > begin + 3;) text.insert(at -= 3, ",");
  return text;
}

// In a sentence, rounded to four digits.
inline std::string short_text(double number) {
  return figure_text(number, 4);
}

// "1 frame", "2 frames", "3 vertices".
inline std::string many(std::size_t count, const std::string& one) {
  if (one == "vertex" && count != 1) return std::to_string(count) + " vertices";
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace cscd
