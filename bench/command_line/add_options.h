#pragma once

#include <CLI/App.hpp>

#include "bench/command_line/option_rows.h"

namespace cscd::bench {

// Adds the options of rows to a command, in a group of its help. `owner` must live as long as the command.
// Help names the default of an option unless it is empty, or zero where the row does not say that zero is
// meant: these stand for a default that depends on other options.
template <class Owner>
void add_options(CLI::App& command, std::span<const OptionRow<Owner>> rows, Owner& owner,
                 const std::string& group = "Options") {
  for (const OptionRow<Owner>& row : rows)
    std::visit(
        [&](const auto& member) {
          auto& value = owner.*member;
          using Value = std::decay_t<decltype(value)>;
          CLI::Option* option = nullptr;
          if constexpr (std::is_same_v<Value, bool>) {
            option = command.add_flag(row.name, value, row.help);
          } else if constexpr (std::is_same_v<Value, WrittenLength>) {
            const auto take = [&value, name = row.name](const std::string& text) {
              value = parse_length(name, text);
            };
            option = command.add_option_function<std::string>(row.name, take, row.help);
          } else {
            constexpr bool is_real = std::is_same_v<Value, double> ||
                                     std::is_same_v<Value, std::optional<double>> ||
                                     std::is_same_v<Value, std::vector<double>>;
            using Number = std::conditional_t<is_real, double, int>;
            option = command.add_option(row.name, value, row.help);
            if (row.range)
              option->check(
                  CLI::Range(static_cast<Number>(row.range->first), static_cast<Number>(row.range->second)));
            if (!row.choices.empty()) option->check(CLI::IsMember(row.choices));
            if (row.repeats)
              option->allow_extra_args(false);
            else if constexpr (requires { value.front(); } && !std::is_same_v<Value, std::string>)
              if (!option->get_positional()) option->delimiter(',');
            if (row.names_zero || value != Value{}) option->capture_default_str();
          }
          if (row.type != nullptr) option->type_name(row.type);
          option->group(group)->required(row.required);
        },
        row.member);
}

// Adds --json, the place of the owner's `output`, and --force.
template <class Owner>
void add_output_options(CLI::App& command, Owner& owner, const char* help, bool required = false) {
  const OptionRow<Owner> rows[] = {
      {.name = "--json", .member = &Owner::output, .help = help, .required = required},
      {"--force", &Owner::force, "replace the output if it exists"}};
  add_options<Owner>(command, rows, owner);
}

}  // namespace cscd::bench
