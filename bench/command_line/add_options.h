#pragma once

#include <CLI/App.hpp>

#include "bench/records/option_rows.h"

namespace cscd::bench {

// Adds the options of rows to a command. `owner` must live as long as the command. Help names the default of
// an option unless it is empty or zero, which stands for one that depends on other options.
template <class Owner>
void add_options(CLI::App& command, std::span<const OptionRow<Owner>> rows, Owner& owner) {
  for (const OptionRow<Owner>& row : rows)
    std::visit(
        [&](const auto& member) {
          auto& value = owner.*member;
          using Value = std::decay_t<decltype(value)>;
          if constexpr (std::is_same_v<Value, bool>) {
            command.add_flag(row.name, value, row.help);
          } else {
            CLI::Option* option = command.add_option(row.name, value, row.help);
            if constexpr (std::is_same_v<Value, std::vector<double>>) {
              if (row.range) option->check(CLI::Range(row.range->first, row.range->second));
            } else if (row.range) {
              option->check(
                  CLI::Range(static_cast<int>(row.range->first), static_cast<int>(row.range->second)));
            }
            if constexpr (requires { value.front(); } && !std::is_same_v<Value, std::string>)
              option->delimiter(',');
            if (value != Value{}) option->capture_default_str();
          }
        },
        row.member);
}

}  // namespace cscd::bench
