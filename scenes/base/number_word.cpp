#include "scenes/base/number_word.h"

#include <charconv>
#include <cstdlib>
#include <string>

namespace cscd::scenes {

std::optional<double> number_of(std::string_view word) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || end != word.data() + word.size() || error == std::errc::invalid_argument)
    return std::nullopt;
  // strtod tells too large from too small.
  return error == std::errc{} ? value : std::strtod(std::string(word).c_str(), nullptr);
}

}  // namespace cscd::scenes
