#include <CLI/App.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench/commands/command.h"
#include "bench/output/output.h"
#include "bench/rows/catalogue.h"
#include "core/elementary/catalogue.h"
#include "scenes/catalog/scene.h"
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

json strategies_json() {
  json rows = json::array();
  for (const Strategy& strategy : strategies()) {
    rows.push_back({{"name", strategy.name},
                    {"source", strategy.source},
                    {"guarantee", to_string(strategy.guarantee)},
                    {"needs_rig", strategy.needs.bones},
                    {"needs_closed_mesh", strategy.needs.closed_mesh}});
    if (!strategy.group.empty()) rows.back()["group"] = strategy.group;
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
  }
  return rows;
}

json effects_json() {
  json rows = json::array();
  for (const scenes::EffectRow& effect : scenes::effects())
    rows.push_back({{"name", effect.name}, {"description", effect.description}});
  return rows;
}

json families_json() {
  json rows = json::array();
  for (const scenes::hard::Family& family : scenes::hard::families())
    rows.push_back({{"name", family.name}, {"story", family.story}});
  return rows;
}

struct Section {
  const char* name;
  json (*rows)();
};
constexpr Section kSections[] = {{"scenes", scenes_json},
                                 {"strategies", strategies_json},
                                 {"tests", tests_json},
                                 {"effects", effects_json},
                                 {"families", families_json}};

std::string text(const json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string joined;
  for (const json& item : value) joined += (joined.empty() ? "" : ", ") + text(item);
  return joined;
}

void list(const std::string& only, bool as_json, bool names_only) {
  json document = {{"schema", "cscd.list/1"}};
  for (const Section& section : kSections)
    if (only.empty() || only == section.name) document[section.name] = section.rows();
  if (as_json) {
    std::printf("%s\n", document.dump(1).c_str());
    return;
  }
  if (names_only) {
    for (const Section& section : kSections)
      if (document.contains(section.name))
        for (const json& row : document[section.name]) std::printf("%s\n", text(row["name"]).c_str());
    return;
  }
  for (const Section& section : kSections) {
    if (!document.contains(section.name)) continue;
    std::printf("%s\n", section.name);
    for (const json& row : document[section.name]) {
      std::printf("  %s\n", text(row["name"]).c_str());
      for (const auto& [key, value] : row.items())
        if (key != "name") std::printf("    %s: %s\n", key.c_str(), text(value).c_str());
    }
  }
}

}  // namespace

void add_list(CLI::App& app) {
  auto only = std::make_shared<std::string>();
  auto as_json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand(
      "list",
      "Show the scenes, strategies, elementary tests, effects and families of hard queries there are.");
  command->add_option("what", *only, "one of scenes, strategies, tests, effects, families; default all")
      ->check(CLI::IsMember({"scenes", "strategies", "tests", "effects", "families"}));
  auto names_only = std::make_shared<bool>(false);
  CLI::Option* json_flag = command->add_flag("--json", *as_json, "for a machine to read");
  command->add_flag("--names", *names_only, "names alone, a line each")->excludes(json_flag);
  command->callback([only, as_json, names_only] { list(*only, *as_json, *names_only); });
}

}  // namespace cscd::bench
