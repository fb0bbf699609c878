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

#include "bench/command_line/written_length.h"

// Options of a command as rows. What the command line takes, with its help
// (bench/command_line/add_options.h), and what a record or a text says that it took follow from the same row.
namespace cscd::bench {

template <class Owner>
struct OptionRow {
  const char* name;  // as on the command line: with its dashes, or without for a word by its position
  std::variant<bool Owner::*, int Owner::*, std::size_t Owner::*, double Owner::*,
               std::optional<int> Owner::*, std::optional<std::size_t> Owner::*,
               std::optional<double> Owner::*, std::string Owner::*, WrittenLength Owner::*,
               std::vector<std::string> Owner::*, std::vector<std::size_t> Owner::*,
               std::vector<double> Owner::*>
      member;
  const char* help;
  std::optional<std::pair<double, double>> range = std::nullopt;  // of a number, or of each of a list
  std::vector<std::string> choices = {};                          // of a text, or of each of a list
  const char* type = nullptr;  // what help calls the value; null for the name of its type
  bool repeats = false;        // a list of which each item has the option's name before it
  bool required = false;
  bool names_zero = false;  // help names the default also where it is zero
};

template <class Owner>
OptionRow<Owner> required(OptionRow<Owner> row) {
  row.required = true;
  return row;
}

// Numbers are written as JSON writes them, and items of lists with commas between them. An absent number is
// empty.
template <class T>
std::string option_text(const T& value) {
  if constexpr (std::is_same_v<T, std::string>) {
    return value;
  } else if constexpr (std::is_same_v<T, WrittenLength>) {
    return value.text;
  } else if constexpr (requires { value.has_value(); }) {
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
  const auto add = [&](const char* name, const std::string& text) {
    if (!text.empty()) command.insert(command.end(), {name, text});
  };
  for (const OptionRow<Owner>& row : rows)
    std::visit(
        [&](const auto& member) {
          const auto& value = owner.*member;
          if constexpr (std::is_same_v<std::decay_t<decltype(value)>, bool>) {
            if (value) command.emplace_back(row.name);
          } else if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::vector<std::string>>) {
            if (row.repeats)
              for (const std::string& item : value) add(row.name, item);
            else
              add(row.name, option_text(value));
          } else {
            add(row.name, option_text(value));
          }
        },
        row.member);
}

}  // namespace cscd::bench
