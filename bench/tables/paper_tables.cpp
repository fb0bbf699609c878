#include "bench/tables/paper_tables.h"

#include <algorithm>

#include "bench/output/data.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

// "table1.{scene}.rvbc.DfHd" in the published figures; null when nothing stands there.
const ordered_json* find_published(const ordered_json& published, const std::string& path,
                                   const std::string& scene) {
  const ordered_json* place = &published;
  for (const std::string& key : split(replaced(path, "{scene}", scene), '.')) {
    if (!place->is_object() || !place->contains(key)) return nullptr;
    place = &(*place)[key];
  }
  return place;
}

template <class Name>
void add_new(std::vector<std::string>& names, const Name& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

std::vector<ordered_json> expanded_columns(const ordered_json& definition, std::span<const Record> records) {
  std::vector<std::string> strategies;
  for (const Record& record : records)
    for (const StrategyRecord& strategy : record.strategies) add_new(strategies, strategy.name);
  std::vector<ordered_json> columns;
  for (const ordered_json& column : definition.at("columns")) {
    if (!column.value("each_strategy", false)) {
      columns.push_back(column);
      continue;
    }
    for (const std::string& strategy : strategies) {
      ordered_json own = column;
      for (auto& [key, value] : own.items())
        if (value.is_string()) value = replaced(value, "{strategy}", strategy);
      const bool beside_itself = own.value("over", "") == own.at("strategy");
      if (!beside_itself) columns.push_back(std::move(own));
    }
  }
  return columns;
}

std::vector<std::string> rows_of(const ordered_json& definition, const ordered_json& published,
                                 std::span<const Record> records, const std::string& only_scene) {
  std::vector<std::string> scenes, recorded;
  for (const Record& record : records) add_new(recorded, record.scene.name);
  if (definition.contains("scenes"))
    if (const ordered_json* rows = find_published(published, definition["scenes"], ""))
      for (const auto& [scene, figures] : rows->items()) scenes.push_back(scene);
  // Where no scene of the paper's was recorded, its columns would be empty: the scenes that were take them.
  const bool of_paper = std::any_of(records.begin(), records.end(), [&](const Record& record) {
    return record.scene.path.empty() &&
           std::find(scenes.begin(), scenes.end(), record.scene.name) != scenes.end();
  });
  if (!of_paper && !records.empty()) scenes = recorded;
  if (!only_scene.empty())
    std::erase_if(scenes, [&](const std::string& scene) { return scene != only_scene; });
  return scenes;
}

Cell fill(const ordered_json& column, const ordered_json& published, const std::string& scene,
          std::span<const Record> records) {
  Cell cell;
  const auto record = std::find_if(records.begin(), records.end(),
                                   [&](const Record& candidate) { return candidate.scene.name == scene; });
  if (record == records.end())
    cell.measured.reason = "no record of " + scene + " was given";
  else
    cell.measured = measure(column, *record);
  // A scene of the user's own is not the paper's, even if it has that name.
  const bool own = record != records.end() && !record->scene.path.empty();
  if (column.contains("published") && !own)
    if (const ordered_json* figure = find_published(published, column["published"], scene))
      cell.published = figure->get<double>();
  return cell;
}

}  // namespace

std::vector<PaperTable> paper_tables(const ordered_json& definitions, const ordered_json& published,
                                     std::span<const Record> records, const std::string& only_scene) {
  std::vector<PaperTable> tables;
  for (const ordered_json& definition : definitions.at("tables")) {
    PaperTable& table = tables.emplace_back();
    table.id = definition.at("id");
    table.title = definition.at("title");
    const std::vector<ordered_json> columns = expanded_columns(definition, records);
    for (const ordered_json& column : columns)
      table.columns.push_back({column.at("key"), column.at("title"), column.value("unit", "")});
    for (const std::string& scene : rows_of(definition, published, records, only_scene)) {
      Row& row = table.rows.emplace_back();
      row.scene = scene;
      for (const ordered_json& column : columns) row.cells.push_back(fill(column, published, scene, records));
    }
  }
  return tables;
}

std::vector<PaperTable> paper_tables(std::span<const Record> records, const std::string& only_scene) {
  return paper_tables(data_json("paper_tables.json"), data_json("published.json"), records, only_scene);
}

}  // namespace cscd::bench
