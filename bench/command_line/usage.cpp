#include "bench/command_line/usage.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/output/glossary.h"
#include "bench/records/environment.h"
#include "core/base/error.h"
#include "core/base/instruction_set.h"
#include "scenes/base/closest_name.h"

#include "build_info.h"

namespace cscd::bench {

std::string version_number() {
  return build_info::kCscd;
}

std::string version_text() {
  const nlohmann::ordered_json build = build_environment();
  const auto get = [&](const char* key) { return build.at(key).get<std::string>(); };
  std::string out = "cscd " + version_number() + "\n";
  out += "commit: " + get("commit") + (build.at("dirty").get<bool>() ? " with changes" : "") + "\n";
  out += "compiler: " + get("compiler") + ", " + get("build_type") + ", flags " + get("flags") + "\n";
  out += "instruction set: " + get("instruction_set") + " (CSCD_ISA=" + std::string(to_string(engine_set())) +
         "); the program is built for " + build_info::kInstructionSets + "\n";
  out += "libraries:";
  for (const auto& [name, number] : build.at("libraries").items())
    out += " " + name + " " + number.get<std::string>() + ",";
  const std::pair<std::string, std::string> others[] = {
      {"tbb", build_info::kTbb},       {"embree", build_info::kEmbree},
      {"fcl", build_info::kFcl},       {"cgal", build_info::kCgal},
      {"assimp", build_info::kAssimp}, {"meshoptimizer", build_info::kMeshoptimizer},
      {"zlib", build_info::kZlib},     {"pugixml", build_info::kPugixml}};
  for (const auto& [name, number] : others)
    out += " " + name + " " + (number.empty() ? "none" : number) + ",";
  out.back() = '\n';
  return out;
}

namespace {

// The innermost command that was named, and how it is called.
struct Named {
  const CLI::App* command;
  std::string words;
};

Named named_command(const CLI::App& program) {
  Named named{&program, "cscd"};
  for (;;) {
    const std::vector<CLI::App*> used = named.command->get_subcommands();
    if (used.empty()) return named;
    named = {used.front(), named.words + " " + used.front()->get_name()};
  }
}

std::string hint(const std::string& word, const std::vector<std::string>& names) {
  const std::vector<std::string_view> views(names.begin(), names.end());
  return did_you_mean(word, views);
}

std::string unknown_option(const CLI::App& command, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& known : option->get_lnames()) names.push_back("--" + known);
  return "unknown option " + name + hint(name, names);
}

// Returns the option by which a command takes its input, where it takes none by position: --scene or nothing.
std::string input_option(const CLI::App& command) {
  bool has_scene = false;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) return "";
    has_scene = has_scene || option->check_lname("scene");
  }
  return has_scene ? "--scene" : "";
}

// The options that a command cannot do without and that were not given, as they are to be written.
std::string missing_options(const CLI::App& command) {
  std::string out;
  for (const CLI::Option* option : command.get_options())
    if (option->get_required() && option->count() == 0)
      out += " " + option->get_name() + " " + option->get_type_name();
  return out;
}

std::string unexpected(const Named& named, const std::vector<std::string>& words) {
  const CLI::App& command = *named.command;
  std::vector<std::string> below;
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; }))
    below.push_back(sub->get_name());
  if (!below.empty() && words.front()[0] != '-')
    return "unknown command " + words.front() + hint(words.front(), below);
  for (const std::string& word : words)
    if (word.size() > 1 && word[0] == '-') return unknown_option(command, word);
  if (const std::string option = input_option(command); !option.empty())
    return words.front() + ": this command takes its input by an option; write " + named.words + " " +
           option + " " + words.front() + missing_options(command);
  return "one argument too many: " + words.front();
}

// Of a text in UTF-8: whether it holds a control character, or one that embeds, overrides or isolates a
// direction of writing.
bool controls_a_terminal(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0; };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (byte(i) < 0x20 || byte(i) == 0x7f) return true;
    if (byte(i) == 0xc2 && byte(i + 1) < 0xa0) return true;  // U+0080 to U+009F
    if (byte(i) != 0xe2) continue;
    if (byte(i + 1) == 0x80 && byte(i + 2) >= 0xaa && byte(i + 2) <= 0xae) return true;  // U+202A to U+202E
    if (byte(i + 1) == 0x81 && byte(i + 2) >= 0xa6 && byte(i + 2) <= 0xa9) return true;  // U+2066 to U+2069
  }
  return false;
}

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

std::string HelpFormat::make_footer(const CLI::App* command) const {
  std::string said = command->get_description();
  for (const CLI::Option* option : command->get_options())
    said += "\n" + option->get_type_name() + " " + option->get_description();
  for (const CLI::App* below : command->get_subcommands([](const CLI::App*) { return true; })) {
    const std::string text =
        below->get_description();  // of which the list of commands has the first paragraph
    said += "\n" + text.substr(0, text.find("\n\n"));
  }
  const std::vector<std::string> found = words_in(said);
  std::string out = CLI::Formatter::make_footer(command);
  if (found.empty()) return out;
  constexpr std::size_t kWidth = 100;
  std::string line = "Words that `cscd list WORD` explains:";
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::string word = found[i] + (i + 1 < found.size() ? "," : ".");
    if (line.size() + 1 + word.size() > kWidth) {
      out += line + "\n";
      line = " ";
    }
    line += " " + word;
  }
  return out + line + "\n";
}

void require_plain_numbers(CLI::App& program) {
  for (CLI::Option* option : program.get_options())
    if (const Kind kind = kind_of(*option); kind != Kind::none)
      option->check([kind](const std::string& text) { return fault_of(text, kind); }, "");
  for (CLI::App* command : program.get_subcommands([](CLI::App*) { return true; }))
    require_plain_numbers(*command);
}

std::string usage_error(const CLI::App& program, const CLI::ParseError& error) {
  const Named named = named_command(program);
  std::vector<std::string> unknown = named.command->remaining();
  std::erase(unknown, "");
  const bool about_presence = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr ||
                              dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  std::string text = about_presence && !unknown.empty() ? unexpected(named, unknown) : error.what();
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text + "; see " + named.words + " --help";
}

void require_text(int count, const char* const* words) {
  for (int i = 1; i < count; ++i) {
    const std::string argument = "argument " + std::to_string(i);
    // What a script writes for a variable that is not set.
    if (words[i][0] == '\0')
      throw InputError(argument + (i > 1 ? ", after " + std::string(words[i - 1]) + "," : "") +
                       " is empty; give a value, or leave the option out");
    try {
      nlohmann::json(words[i]).dump();
    } catch (const nlohmann::json::exception&) {
      throw InputError(argument + " is not UTF-8; give the file another name");
    }
    if (controls_a_terminal(words[i]))
      throw InputError(argument +
                       " holds a character that controls a terminal or the direction of writing; "
                       "give the file another name");
  }
}

}  // namespace cscd::bench
