#include <CLI/App.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

#include "bench/cli/scene_file.h"
#include "bench/command_line/add_options.h"
#include "bench/command_line/command.h"
#include "bench/output/glossary.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/elementary/catalogue.h"
#include "scenes/base/closest_name.h"
#include "scenes/base/joined.h"
#include "scenes/catalog/scene.h"
#include "scenes/catalog/shapes.h"
#include "scenes/effects/effect.h"
#include "scenes/hard/family.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

json scenes_json() {
  json rows = json::array();
  for (const scenes::SceneSummary& scene : scenes::list_scenes()) {
    json& row = rows.emplace_back(json{{"name", scene.name}});
    if (!scene.fault.empty()) {
      row["fault"] = scene.fault;
      continue;
    }
    row.update({{"story", scene.story}, {"frames", scene.frames}, {"effects", scene.effects}});
    if (scene.expected.vertices) row["vertices"] = *scene.expected.vertices;
    if (scene.expected.triangles) row["triangles"] = *scene.expected.triangles;
    if (scene.expected.bones) row["bones"] = *scene.expected.bones;
  }
  return rows;
}

// What a row is, in two sentences, where the glossary says it.
void add_meaning(json& row) {
  if (const auto means = meaning_of_name(row.at("name").get<std::string>())) row["means"] = *means;
}

json strategies_json() {
  json rows = json::array();
  for (const Strategy& strategy : strategies()) {
    rows.push_back({{"name", strategy.name},
                    {"source", strategy.source},
                    {"guarantee", to_string(strategy.guarantee)},
                    {"needs_rig", strategy.needs == Needs::closed_mesh_with_bones},
                    {"needs_closed_mesh", strategy.needs != Needs::any_mesh}});
    if (!strategy.group.empty()) rows.back()["group"] = strategy.group;
    add_meaning(rows.back());
  }
  return rows;
}

json tests_json() {
  json rows = json::array();
  for (const ElementaryTest& test : all_elementary_tests()) {
    rows.push_back({{"name", test.name},
                    {"source", test.source},
                    {"apart_is_proof", test.apart_is_proof},
                    {"contact_is_proof", test.contact_is_proof}});
    if (test.parameters.tolerance >= 0) rows.back()["tolerance"] = test.parameters.tolerance;
    if (test.parameters.tolerance >= 0) rows.back()["tolerance_is"] = test.tolerance;
    if (test.parameters.steps >= 0) rows.back()["steps"] = test.parameters.steps;
    add_meaning(rows.back());
  }
  return rows;
}

json parameters_json(std::span<const scenes::ParameterRow> parameters) {
  json rows = json::array();
  for (const scenes::ParameterRow& parameter : parameters) {
    json& row = rows.emplace_back(json{{"name", parameter.name},
                                       {"type", to_string(parameter.kind)},
                                       {"unit", parameter.unit},
                                       {"meaning", parameter.meaning},
                                       {"required", parameter.required}});
    if (parameter.range.least != std::numeric_limits<double>::lowest())
      row.update({{"least", parameter.range.least}, {"most", parameter.range.most}});
    if (parameter.columns > 0) row["columns"] = parameter.columns;
    if (!parameter.otherwise.empty()) row["default"] = parameter.otherwise;
    if (!parameter.items.empty()) row["items"] = parameters_json(parameter.items);
  }
  return rows;
}

// Of shapes or effects.
template <auto all>
json described_json() {
  json rows = json::array();
  for (const auto& row : all())
    rows.push_back({{"name", row.name},
                    {"description", row.description},
                    {"parameters", parameters_json(row.parameters)}});
  return rows;
}

json families_json() {
  json rows = json::array();
  for (const scenes::hard::Family& family : scenes::hard::families())
    rows.push_back({{"name", family.name}, {"story", family.story}});
  return rows;
}

json words_json() {
  json rows = json::array();
  for (const Word& word : words()) {
    rows.push_back({{"name", word.name}, {"means", word.means}});
    if (!word.also.empty()) rows.back()["also"] = word.also;
  }
  return rows;
}

constexpr std::string_view kSceneFile = "scene-file";
constexpr std::size_t kWidth = 110;  // of a line

std::string text(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string joined;
  for (const json& item : value) joined += (joined.empty() ? "" : ", ") + text(item);
  return joined;
}

std::string first_sentence(const std::string& story) {
  const std::size_t end = story.find(". ");
  return end == std::string::npos ? story : story.substr(0, end + 1);
}

// What a line says of a row behind its name.
std::string scene_line(const json& row) {
  if (row.contains("fault")) return "FAULT: " + text(row["fault"]);
  std::string out = row.contains("triangles") ? text(row["triangles"]) + " triangles, " : "";
  return out + text(row["frames"]) + " frames. " + first_sentence(text(row["story"]));
}
std::string strategy_line(const json& row) {
  const std::string needs = row["needs_rig"] ? "bones" : row["needs_closed_mesh"] ? "closed" : "any";
  char columns[64];
  std::snprintf(columns, sizeof columns, "%-17s %-7s ", text(row["guarantee"]).c_str(), needs.c_str());
  return columns + text(row["source"]);
}
std::string source_line(const json& row) {
  return text(row["source"]);
}
std::string description_line(const json& row) {
  return text(row["description"]);
}
std::string word_line(const json& row) {
  return first_sentence(text(row["means"]));
}
std::string story_line(const json& row) {
  return first_sentence(text(row["story"]));
}

struct Section {
  const char *name, *one;
  json (*rows)();
  std::string (*line)(const json& row);
};
constexpr Section kSections[] = {{"scenes", "scene", scenes_json, scene_line},
                                 {"strategies", "strategy", strategies_json, strategy_line},
                                 {"tests", "elementary test", tests_json, source_line},
                                 {"shapes", "shape", described_json<scenes::shapes>, description_line},
                                 {"effects", "effect", described_json<scenes::effects>, description_line},
                                 {"families", "family of hard queries", families_json, story_line},
                                 {"words", "word", words_json, word_line}};

// A line that ends at a blank before the width, with "..." where it was longer. Counts bytes, so a line with
// letters of several bytes ends earlier.
std::string cut(const std::string& line) {
  if (line.size() <= kWidth) return line;
  return line.substr(0, line.find_last_of(' ', kWidth - 4)) + " ...";
}

void print_lines(const Section& section, const json& rows) {
  std::size_t width = 0;
  for (const json& row : rows) width = std::max(width, text(row["name"]).size());
  for (const json& row : rows) {
    const std::string name = text(row["name"]);
    std::printf("%s\n",
                cut("  " + name + std::string(width + 2 - name.size(), ' ') + section.line(row)).c_str());
  }
}

void print_whole(const Section& section, const json& row) {
  const std::string name = text(row["name"]);
  std::printf("%s %s\n", section.one, name.c_str());
  if (row.contains("means")) std::printf("  %s\n", text(row["means"]).c_str());
  for (const auto& [key, value] : row.items())
    if (key != "name" && key != "parameters" && key != "means")
      std::printf("  %s: %s\n", key.c_str(), text(value).c_str());
  const auto print_parameters = [&](const auto& all) {
    for (const auto& described : all)
      if (described.name == name) std::printf("%s", parameters_text(described.parameters, 2).c_str());
  };
  if (section.rows == described_json<scenes::shapes>) print_parameters(scenes::shapes());
  if (section.rows == described_json<scenes::effects>) print_parameters(scenes::effects());
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// The sections that were asked for, by their own name or by that of a row; then with that row alone.
json asked_for(const std::string& what) {
  json document = json::object();
  std::vector<std::string> names = {std::string(kSceneFile)};
  for (const Section& section : kSections) {
    names.emplace_back(section.name);
    if (!what.empty() && what != section.name) continue;
    document[section.name] = section.rows();
  }
  if (!document.empty()) return document;
  const Word* word = word_called(what);  // in any of its forms
  for (const Section& section : kSections)
    for (json& row : section.rows()) {
      names.push_back(text(row["name"]));
      const bool is_named = lower_case(names.back()) == lower_case(what);  // as DRVBC
      const bool is_word = word != nullptr && section.rows == words_json && names.back() == word->name;
      if (is_named || is_word) document[section.name].push_back(std::move(row));
    }
  const std::vector<std::string_view> known(names.begin(), names.end());
  if (document.empty())
    throw InputError("list " + what + ": nothing has that name" + did_you_mean(what, known) +
                     "; cscd list shows what there is");
  return document;
}

struct ListOptions {
  std::vector<std::string> asked;  // the words of one name, such as mega cluster
  std::string what;
  bool json = false, names = false, markdown = false;
};

void list(ListOptions options) {
  options.what = joined(options.asked, " ");
  if (options.what == kSceneFile) {
    std::fputs((options.markdown ? scene_file_markdown() : scene_file_text()).c_str(), stdout);
    return;
  }
  if (options.markdown)
    throw InputError("list --markdown: writes the page of scene files alone; say list scene-file");
  json document = asked_for(options.what);
  if (options.json) {
    document["schema"] = "cscd.list/1";
    std::printf("%s\n", document.dump(1).c_str());
    return;
  }
  bool several = false;
  for (const Section& section : kSections) {
    if (!document.contains(section.name)) continue;
    const json& rows = document[section.name];
    if (options.names) {
      for (const json& row : rows) std::printf("%s\n", text(row["name"]).c_str());
      continue;
    }
    if (several) std::printf("\n");
    several = true;
    if (!options.what.empty() && options.what != section.name) {
      for (const json& row : rows) print_whole(section, row);
      continue;
    }
    std::printf("%s\n", section.name);
    print_lines(section, rows);
  }
  if (options.what.empty() && !options.names)
    std::printf(
        "\nAll about one, or what a word means: cscd list NAME. What a scene file may hold: cscd list "
        "scene-file.\n");
}

}  // namespace

void add_list(CLI::App& app) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* command = app.add_subcommand(
      "list",
      "Show the scenes, strategies, elementary tests, shapes, effects and families of hard queries there "
      "are,\nand explain words.\n\n"
      "  cscd list                one line for each\n"
      "  cscd list strategies     one section\n"
      "  cscd list rope           all about one: a scene's story, the parameters of a shape or an effect\n"
      "  cscd list embedded       what a word means that help, answers or records use\n"
      "  cscd list scene-file     what a scene file may hold");
  using L = ListOptions;
  static const OptionRow<L> rows[] = {
      {"what", &L::asked,
       "scenes, strategies, tests, shapes, effects, families, words, scene-file, or a name; default all "
       "sections"},
      {"--json", &L::json, "for a machine to read"},
      {"--names", &L::names, "names alone, a line each"},
      {"--markdown", &L::markdown, "with scene-file: the page scenes/README.md"}};
  add_options<L>(*command, rows, *options);
  command->get_option("--json")->excludes("--names")->excludes("--markdown");
  command->callback([options] { list(*options); });
}

}  // namespace cscd::bench
