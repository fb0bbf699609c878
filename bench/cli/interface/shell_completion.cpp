#include "bench/cli/interface/shell_completion.h"

#include "bench/command_line/usage.h"
#include "scenes/base/joined.h"

namespace cscd::bench {
namespace {

// What the names of a section are asked by; "all" are the sections, and the names of each.
std::string asking_for(const std::string& section) {
  return section == "all" ? "cscd list --names; cscd list | grep -x '[a-z]*'"
                          : "cscd list " + section + " --names";
}

std::string head_of(const std::string& shell, const std::string& sign) {
  return sign + "completion of cscd " + version_number() + " by " + shell + "; `cscd completion " + shell +
         "` wrote this\n";
}

// In bash, the function `offer` takes what there is to choose from; `files` adds files, `joined` takes what
// stands behind the last comma.
std::string bash_offer(const Values& values) {
  std::string words = joined(values.words, " ");
  if (!values.section.empty()) words += "$({ " + asking_for(values.section) + "; } 2>/dev/null)";
  if (words.empty() && !values.files) return "";
  return std::string(values.are_joined ? "joined" : "offer") + " \"" + words + "\"" +
         (values.files ? " files" : "") + "; ";
}

std::string in_single_quotes(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

// zsh reads a specification up to a bracket or a colon.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

// A blank before an action keeps zsh from adding arguments of its own to it.
std::string zsh_action(const Values& values) {
  if (!values.words.empty())
    return values.are_joined ? " _sequence compadd - " + joined(values.words, " ")
                             : "(" + joined(values.words, " ") + ")";
  if (values.section.empty()) return values.files ? "_files" : " ";
  return std::string(values.are_joined ? " _cscd_joined" : " _cscd_names") +
         (values.files ? "_or_files " : " ") + values.section;
}

std::string zsh_argument(const OptionWords& words, const std::string& name) {
  return ":" + zsh_text(name) + ":" + zsh_action(words.values);
}

std::string zsh_function(const CommandWords& command) {
  return "_cscd" + (command.path.empty() ? "" : "_" + joined(command.path, "_"));
}

}  // namespace

std::string bash_completion(const std::vector<CommandWords>& tree) {
  std::string out = head_of("bash", "# ");
  out += R"sh(_cscd() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command='' i
  # bash takes --option=value for three words.
  if [[ $before == = ]]; then before=${COMP_WORDS[COMP_CWORD - 2]}; fi
  if [[ $current == = ]]; then current=''; fi
  COMPREPLY=()
  # offer WORDS [files]: what the current word may become.
  offer() {
    mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current"; [ "${2:-}" != files ] || compgen -f -- "$current")
    [ "${2:-}" != files ] || compopt -o filenames 2>/dev/null
  }
  # joined WORDS [files]: likewise for what stands behind the last comma.
  joined() {
    local whole=$current kept=''
    [[ $current != *,* ]] || kept=${current%,*},
    current=${current##*,}
    offer "$@"
    current=$whole
    COMPREPLY=("${COMPREPLY[@]/#/$kept}")
  }
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "$command ${COMP_WORDS[i]}" in
)sh";
  for (const CommandWords& command : tree)
    if (!command.path.empty()) {
      std::vector<std::string> above(command.path.begin(), command.path.end() - 1);
      out += "      '" + joined(above, "/") + " " + command.path.back() +
             "') command=" + joined(command.path, "/") + " ;;\n";
    }
  out += "    esac\n  done\n  if [[ $current != -* ]]; then\n    case \"$command $before\" in\n";
  for (const CommandWords& command : tree)
    for (const OptionWords& option : command.options) {
      if (!option.takes_value) continue;
      std::vector<std::string> patterns;
      for (const std::string& name : option.names)
        patterns.push_back("'" + joined(command.path, "/") + " " + name + "'");
      out += "      " + joined(patterns, " | ") + ") " + bash_offer(option.values) + "return ;;\n";
    }
  out += "    esac\n  fi\n  case \"$command\" in\n";
  for (const CommandWords& command : tree) {
    std::vector<std::string> options, below;
    for (const OptionWords& option : command.options)
      options.insert(options.end(), option.names.begin(), option.names.end());
    for (const std::size_t place : command.commands) below.push_back(tree[place].path.back());
    const std::string of_options = "offer \"" + joined(options, " ") + "\"; ";
    std::string otherwise = below.empty() ? "" : "offer \"" + joined(below, " ") + "\"; ";
    if (!command.arguments.empty()) otherwise = bash_offer(command.arguments.front().values);
    out += "    '" + joined(command.path, "/") + "') if [[ $current == -* ]]; then " + of_options + "else " +
           (otherwise.empty() ? of_options : otherwise) + "fi ;;\n";
  }
  return out + "  esac\n}\ncomplete -F _cscd cscd\n";
}

std::string zsh_completion(const std::vector<CommandWords>& tree) {
  std::string out = "#compdef cscd\n" + head_of("zsh", "# ");
  out += R"sh(_cscd_names() {
  local -a names
  names=(${(f)"$(cscd list ${1:#all} --names 2>/dev/null)"})
  [[ $1 != all ]] || names+=(${(f)"$(cscd list | grep -x '[a-z]*')"})
  compadd -a names
}
_cscd_joined() {
  local -a names
  names=(${(f)"$(cscd list $1 --names 2>/dev/null)"})
  _sequence compadd - $names
}
_cscd_names_or_files() { _alternative "names:name: _cscd_names $1" "files:file:_files" }
_cscd_joined_or_files() { _alternative "names:name: _cscd_joined $1" "files:file:_files" }
)sh";
  for (const CommandWords& command : tree) {
    out += zsh_function(command) + "() {\n";
    if (!command.commands.empty()) out += "  local line state\n";
    out += std::string("  _arguments") + (command.commands.empty() ? "" : " -C");
    for (const OptionWords& option : command.options)
      for (const std::string& name : option.names) {
        const bool takes_equals = option.takes_value && name.starts_with("--");  // --option=value, too
        std::string text = (option.may_repeat ? "*" : "") + name + (takes_equals ? "=" : "") + "[" +
                           zsh_text(option.meaning) + "]";
        if (option.takes_value) text += zsh_argument(option, name);
        out += " \\\n    " + in_single_quotes(text);
      }
    if (!command.commands.empty()) {
      out +=
          " \\\n    '1: :->command' '*:: :->rest'\n  case $state in\n    command)\n      local -a commands=(";
      for (const std::size_t place : command.commands)
        out += "\n        " + in_single_quotes(zsh_text(tree[place].path.back()) + ":" + tree[place].meaning);
      out += ")\n      _describe command commands ;;\n    rest)\n      case $line[1] in";
      for (const std::size_t place : command.commands)
        out += "\n        " + tree[place].path.back() + ") " + zsh_function(tree[place]) + " ;;";
      out += "\n      esac ;;\n  esac\n}\n";
      continue;
    }
    for (const OptionWords& argument : command.arguments)
      out += " \\\n    " + in_single_quotes((argument.may_repeat ? "*" : "") +
                                            zsh_argument(argument, argument.names.front()));
    out += "\n}\n";
  }
  return out + "_cscd \"$@\"\n";
}

}  // namespace cscd::bench
