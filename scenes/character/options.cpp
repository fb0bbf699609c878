#include "scenes/character/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <variant>

#include "core/base/error.h"
#include "core/base/number_text.h"

namespace cscd::scenes {
namespace {

struct Row {
  std::string_view name;
  std::variant<bool ImportOptions::*, std::string ImportOptions::*,
               std::optional<std::size_t> ImportOptions::*, std::optional<double> ImportOptions::*>
      member;
};
constexpr Row kRows[] = {{"--component", &ImportOptions::component},
                         {"--fps", &ImportOptions::fps},
                         {"--clip", &ImportOptions::clip},
                         {"--clip-number", &ImportOptions::clip_number},
                         {"--fill-holes", &ImportOptions::fill_holes},
                         {"--weld", &ImportOptions::weld},
                         {"--from-bind-pose", &ImportOptions::from_bind_pose},
                         {"--flip-inward", &ImportOptions::flip_inward},
                         {"--survey", &ImportOptions::survey},
                         {"--one-pose", &ImportOptions::one_pose},
                         {"--motion", &ImportOptions::motion}};

template <class Number>
Number number(const std::string& option, const std::string& digits) {
  Number value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size())
    throw InputError(option + " " + digits + ": is not a number it can use; give another");
  return value;
}

void check(const ImportOptions& options) {
  if (options.fps && !(*options.fps > 0 && *options.fps <= 10'000))
    throw InputError("--fps " + exact_text(*options.fps) + ": give a number above 0 and up to 10000");
  if (options.weld && !(*options.weld >= 0 && *options.weld <= 0.01))
    throw InputError("--weld " + exact_text(*options.weld) + ": give a share of the diagonal from 0 to 0.01");
}

}  // namespace

std::vector<std::string> to_arguments(const ImportOptions& options) {
  std::vector<std::string> words;
  for (const Row& row : kRows)
    std::visit(
        [&](const auto member) {
          const auto& value = options.*member;
          using Value = std::decay_t<decltype(value)>;
          if constexpr (std::is_same_v<Value, bool>) {
            if (value) words.emplace_back(row.name);
          } else if constexpr (std::is_same_v<Value, std::string>) {
            if (!value.empty()) words.insert(words.end(), {std::string(row.name), value});
          } else {
            if (value) words.insert(words.end(), {std::string(row.name), exact_text(*value)});
          }
        },
        row.member);
  return words;
}

ImportOptions parse_arguments(std::span<const std::string> arguments) {
  ImportOptions options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& name = arguments[i];
    const auto row = std::ranges::find(kRows, name, &Row::name);
    if (row == std::end(kRows)) throw InputError("option " + name + " is not known");
    const auto value = [&]() -> const std::string& {
      if (++i >= arguments.size()) throw InputError(name + ": needs a value");
      return arguments[i];
    };
    std::visit(
        [&](const auto member) {
          auto& taken = options.*member;
          using Value = std::decay_t<decltype(taken)>;
          if constexpr (std::is_same_v<Value, bool>)
            taken = true;
          else if constexpr (std::is_same_v<Value, std::string>)
            taken = value();
          else
            taken = number<typename Value::value_type>(name, value());
        },
        row->member);
  }
  check(options);
  return options;
}

}  // namespace cscd::scenes
