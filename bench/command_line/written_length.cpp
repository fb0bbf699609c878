#include "bench/command_line/written_length.h"

#include <charconv>
#include <cmath>

#include "core/base/error.h"

namespace cscd::bench {

WrittenLength parse_length(const std::string& option, const std::string& text) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(
        option + " " + text + ": " + what +
        "; write 0.01 for a length in the units of the input, or 0.2e for mean edges of its pose "
        "at rest");
  };
  WrittenLength out{text};
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, out.number);
  if (error == std::errc::result_out_of_range) refuse("is no number that a double holds");
  out.in_edges = end != last && *end == 'e';
  if (error != std::errc{} || end + out.in_edges != last) refuse("is no length");
  if (!std::isfinite(out.number)) refuse("is not finite");
  if (out.number < 0) refuse("is negative");
  return out;
}

}  // namespace cscd::bench
