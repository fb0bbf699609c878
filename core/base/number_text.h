#pragma once

#include <charconv>
#include <cstddef>
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

// "1 frame", "2 frames", "3 vertices".
inline std::string many(std::size_t count, const std::string& one) {
  if (one == "vertex" && count != 1) return std::to_string(count) + " vertices";
  return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

}  // namespace cscd
