#pragma once

#include <string>
#include <string_view>

namespace cscd {

// Returns the texts of a range one after the other, with `between` from each to the next.
template <class Texts>
std::string joined(const Texts& texts, std::string_view between = ", ") {
  std::string out;
  bool first = true;
  for (const auto& text : texts) {
    if (!first) out += between;
    out += text;
    first = false;
  }
  return out;
}

}  // namespace cscd
