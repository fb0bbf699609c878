#include "bench/command_line/written_length.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>

#include "core/base/error.h"

namespace cscd::bench {
namespace {

struct Unit {
  std::string_view name;
  double centimetres;
};
constexpr Unit kUnits[] = {{"mm", 0.1}, {"cm", 1}, {"m", 100}, {"in", 2.54}};

}  // namespace

WrittenLength parse_length(const std::string& option, const std::string& text) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(
        option + " " + text + ": " + what +
        "; write 0.01 for a length in the units of the input, 5mm, 1cm, 0.1m or 0.5in where it tells its "
        "unit, or 0.2e for mean edges of its pose at rest");
  };
  WrittenLength out{text};
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, out.number);
  if (error == std::errc::result_out_of_range) refuse("is no number that a double holds");
  const std::string_view unit(end, last);
  const auto known = std::ranges::find(kUnits, unit, &Unit::name);
  out.in_edges = unit == "e";
  if (known != std::end(kUnits)) out.centimetres = known->centimetres;
  const bool is_read = unit.empty() || out.in_edges || out.centimetres > 0;
  if (error != std::errc{} || !is_read) refuse("is no length");
  if (!std::isfinite(out.number)) refuse("is not finite");
  if (out.number < 0) refuse("is negative");
  return out;
}

}  // namespace cscd::bench
