#include "bench/cli/command_line/completion.h"

#include <algorithm>
#include <map>

#include "scenes/base/joined.h"

namespace cscd::bench {
namespace {

// The section of `cscd list` whose names an option or a positional argument takes.
std::string section_of(const OptionRow& option) {
  static const std::map<std::string, std::string> kSections = {
      {"--scene", "scenes"},        {"--knobs", "scenes"},     {"input", "scenes"},
      {"--strategy", "strategies"}, {"--elementary", "tests"}, {"--sweep", "tests"}};
  for (const std::string& name : option.names)
    if (const auto section = kSections.find(name); section != kSections.end()) return section->second;
  return "";
}

std::string quoted(const std::string& text) {
  return "'" + text + "'";
}

// The words that may stand for an option's value, as an argument of the shell; empty where any file may.
std::string words_of(const OptionRow& option) {
  if (!option.choices.empty()) return quoted(joined(option.choices, " "));
  if (option.positional && option.names.front() == "what")  // of `list`
    return "\"scenes strategies tests shapes effects families scene-file $(_cscd_names '')\"";
  const std::string section = section_of(option);
  return section.empty() ? "" : "\"$(_cscd_names " + section + ")\"";
}

// Branches that say which option's value is being written.
std::string value_branches(std::span<const CommandRow> commands) {
  std::string out;
  for (const CommandRow& command : commands)
    for (const OptionRow& option : command.options) {
      if (option.positional || !option.takes_value) continue;
      std::string pattern;
      for (const std::string& name : option.names)
        pattern += (pattern.empty() ? "" : "|") + quoted(joined(command.words, " ") + ":" + name);
      const std::string words = words_of(option);
      out += "    " + pattern + ") " + (words.empty() ? "" : "_cscd_reply " + words + "; ") + "return ;;\n";
    }
  return out;
}

std::string option_branches(std::span<const CommandRow> commands) {
  std::string out;
  for (const CommandRow& command : commands) {
    std::vector<std::string> names;
    for (const OptionRow& option : command.options)
      if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
    out += "      " + quoted(joined(command.words, " ")) + ") _cscd_reply " + quoted(joined(names, " ")) +
           " ;;\n";
  }
  return out;
}

std::string argument_branches(std::span<const CommandRow> commands) {
  std::string out;
  for (const CommandRow& command : commands) {
    std::string words = command.commands.empty() ? "" : quoted(joined(command.commands, " "));
    const auto argument = std::find_if(command.options.begin(), command.options.end(),
                                       [](const OptionRow& option) { return option.positional; });
    if (words.empty() && argument != command.options.end()) words = words_of(*argument);
    if (!words.empty())
      out += "      " + quoted(joined(command.words, " ")) + ") _cscd_reply " + words + " ;;\n";
  }
  return out;
}

std::string command_branches(std::span<const CommandRow> commands) {
  std::string out;
  for (const CommandRow& command : commands) {
    if (command.words.empty()) continue;
    const std::vector<std::string> above(command.words.begin(), command.words.end() - 1);
    out += "      " + quoted(joined(above, " ") + ":" + command.words.back()) +
           ") command=" + quoted(joined(command.words, " ")) + " ;;\n";
  }
  return out;
}

}  // namespace

std::string bash_completion(std::span<const CommandRow> commands) {
  return R"(# Completion of cscd for bash, made by `cscd completion bash`.
_cscd_names() { "${COMP_WORDS[0]}" list "$1" --names 2>/dev/null; }

# Offers those of the given words that begin with what follows the last comma.
_cscd_reply() {
  local before=${cur%"${cur##*,}"}
  mapfile -t COMPREPLY < <(compgen -P "$before" -W "$1" -- "${cur##*,}")
}

_cscd() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} command= i
  if [[ $cur == = ]]; then  # bash takes --option=value for three words
    cur=
  elif [[ $prev == = ]]; then
    prev=${COMP_WORDS[COMP_CWORD-2]}
  fi
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$command:${COMP_WORDS[i]}" in
)" + command_branches(commands) +
         R"(    esac
  done
  COMPREPLY=()
  case "$command:$prev" in
)" + value_branches(commands) +
         R"(  esac
  if [[ $cur == -* ]]; then
    case "$command" in
)" + option_branches(commands) +
         R"(    esac
  else
    case "$command" in
)" + argument_branches(commands) +
         R"(    esac
  fi
}
complete -o bashdefault -o default -F _cscd cscd
)";
}

}  // namespace cscd::bench
