#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

// Options of a command as rows. What the command line takes (bench/command_line/add_options.h) and what a
// record says that it took follow from the same row.
namespace cscd::bench {

template <class Owner>
struct OptionRow {
  const char* name;  // with its dashes
  std::variant<bool Owner::*, int Owner::*, std::size_t Owner::*, std::optional<std::size_t> Owner::*,
               std::string Owner::*, std::vector<std::string> Owner::*, std::vector<std::size_t> Owner::*,
               std::vector<double> Owner::*>
      member;
  const char* help;
  std::optional<std::pair<double, double>> range = std::nullopt;  // of a number, or of each of a list
};

// Numbers are written as JSON writes them, and items of lists with commas between them. An absent number is
// empty.
template <class T>
std::string option_text(const T& value) {
  if constexpr (std::is_same_v<T, std::string>) {
    return value;
  } else if constexpr (std::is_same_v<T, std::optional<std::size_t>>) {
    return value ? option_text(*value) : "";
  } else if constexpr (requires { value.size(); }) {
    std::string text;
    for (const auto& item : value) text += (text.empty() ? "" : ",") + option_text(item);
    return text;
  } else {
    return nlohmann::json(value).dump();
  }
}

// Appends the options that are not empty to a command line.
template <class Owner>
void echo_options(std::span<const OptionRow<Owner>> rows, const Owner& owner,
                  std::vector<std::string>& command) {
  for (const OptionRow<Owner>& row : rows)
    std::visit(
        [&](const auto& member) {
          if constexpr (std::is_same_v<std::decay_t<decltype(owner.*member)>, bool>) {
            if (owner.*member) command.emplace_back(row.name);
          } else if (const std::string text = option_text(owner.*member); !text.empty()) {
            command.insert(command.end(), {row.name, text});
          }
        },
        row.member);
}

}  // namespace cscd::bench
