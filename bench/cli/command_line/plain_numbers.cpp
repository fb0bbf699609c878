#include "bench/cli/command_line/plain_numbers.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

namespace cscd::bench {
namespace {

enum class Kind { none, natural, whole, real };

// CLI11 names the type of an option's value, and adds ranges behind the name.
Kind kind_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (option.get_items_expected_max() == 0) return Kind::none;  // a flag
  if (type.starts_with("UINT")) return Kind::natural;
  if (type.starts_with("INT")) return Kind::whole;
  return type.starts_with("FLOAT") ? Kind::real : Kind::none;
}

template <class Number>
std::errc read(const std::string& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end != text.data() + text.size() ? std::errc::invalid_argument : error;
}

// Returns why the text is no number of that kind, or nothing.
std::string fault_of(const std::string& text, Kind kind) {
  std::errc error{};
  double real = 0;
  std::uint64_t natural = 0;
  std::int64_t whole = 0;
  if (kind == Kind::natural) error = read(text, natural);
  if (kind == Kind::whole) error = read(text, whole);
  if (kind == Kind::real) error = read(text, real);
  if (error == std::errc::result_out_of_range) return text + " is beyond all numbers that fit; give another";
  if (error == std::errc{} && std::isfinite(real)) return {};
  const char* const what = kind == Kind::natural ? "no whole number of 0 or more"
                           : kind == Kind::whole ? "no whole number"
                                                 : "no finite number";
  return text + " is " + what + "; give one";
}

}  // namespace

void require_plain_numbers(CLI::App& program) {
  for (CLI::Option* option : program.get_options())
    if (const Kind kind = kind_of(*option); kind != Kind::none)
      option->check([kind](const std::string& text) { return fault_of(text, kind); }, "");
  for (CLI::App* command : program.get_subcommands([](CLI::App*) { return true; }))
    require_plain_numbers(*command);
}

}  // namespace cscd::bench
