#include "bench/tables/paper_tables.h"

#include <algorithm>

#include "bench/output/data.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

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
                                 std::span<const Record> records, const TableChoice& choice) {
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
  std::erase_if(scenes, [&](const std::string& scene) { return !choice.wants_scene(scene); });
  return scenes;
}

Cell fill(const ordered_json& column, const ordered_json& published, const std::string& scene,
          std::span<const Record> records, Pipeline pipeline) {
  Cell cell;
  const auto record = std::find_if(records.begin(), records.end(), [&](const Record& candidate) {
    return candidate.scene.name == scene && candidate.pipeline == pipeline;
  });
  if (record == records.end())
    cell.measured.reason =
        "no record of " + scene +
        (pipelines_of(records).size() == 2 ? " in the pipeline " + std::string(to_string(pipeline)) : "") +
        " was given";
  else
    cell.measured = measure(column, *record);
  // A scene of the user's own is not the paper's, even if it has that name.
  const bool own = record != records.end() && !record->scene.path.empty();
  if (column.contains("published") && !own)
    if (const ordered_json* figure = find_published(published, column["published"], scene))
      cell.published = figure->get<double>();
  return cell;
}

// One column of a table, for all rows.
struct Filled {
  Column column;
  std::vector<Cell> cells;

  bool has_figures() const {
    return std::ranges::any_of(cells, [](const Cell& cell) { return cell.measured.value.has_value(); });
  }
};

// Whether two pipelines have the same figures, as far as both have them. What has noise is never the same.
bool agree(const Filled& a, const Filled& b) {
  for (std::size_t i = 0; i < a.cells.size(); ++i) {
    const Measured &x = a.cells[i].measured, &y = b.cells[i].measured;
    if (x.value && y.value && (x.interval || y.interval || *x.value != *y.value)) return false;
  }
  return true;
}

Filled both(Filled a, const Filled& b) {
  a.column.pipeline = std::nullopt;
  for (std::size_t i = 0; i < a.cells.size(); ++i)
    if (!a.cells[i].measured.value) a.cells[i] = b.cells[i];
  return a;
}

// The same column as measured in each pipeline; one column where they agree.
std::vector<Filled> by_pipeline(const ordered_json& definition, const ordered_json& published,
                                std::span<const std::string> scenes, std::span<const Record> records) {
  std::vector<Filled> columns;
  for (const Pipeline pipeline : pipelines_of(records)) {
    Filled& filled = columns.emplace_back();
    filled.column = {definition.at("key"), definition.at("title"), definition.value("unit", ""), pipeline};
    for (const std::string& scene : scenes)
      filled.cells.push_back(fill(definition, published, scene, records, pipeline));
  }
  if (columns.size() == 2) {
    // Preparation is the same code in both pipelines, and its noise would only fill the page.
    const bool prepares = definition.at("quantity").get<std::string>().starts_with("preparation.");
    if (!columns[0].has_figures())
      columns.erase(columns.begin());
    else if (!columns[1].has_figures())
      columns.pop_back();
    else if (prepares || agree(columns[0], columns[1]))
      columns = {both(columns[0], columns[1])};
  }
  return columns;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

}  // namespace

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

const ordered_json* find_published(const ordered_json& published, const std::string& path,
                                   const std::string& scene) {
  const ordered_json* place = &published;
  for (const std::string& key : split(replaced(path, "{scene}", scene), '.')) {
    if (!place->is_object() || !place->contains(key)) return nullptr;
    place = &(*place)[key];
  }
  return place;
}

std::optional<Pipeline> only_pipeline(const PaperTable& table) {
  for (const Column& column : table.columns)
    if (column.pipeline != table.columns.front().pipeline) return std::nullopt;
  return table.columns.empty() ? std::nullopt : table.columns.front().pipeline;
}

std::string_view pipeline_text(const Column& column) {
  return column.pipeline ? to_string(*column.pipeline) : "both";
}

std::vector<Pipeline> pipelines_of(std::span<const Record> records) {
  std::vector<Pipeline> pipelines;
  for (const Pipeline pipeline : {Pipeline::published, Pipeline::today})
    if (std::ranges::any_of(records, [&](const Record& r) { return r.pipeline == pipeline; }))
      pipelines.push_back(pipeline);
  if (pipelines.empty()) pipelines.push_back(Pipeline::today);
  return pipelines;
}

bool TableChoice::wants(const ordered_json& column) const {
  const std::string key = column.at("key");
  const auto named = [&](const std::string& part) { return key.find(part) != std::string::npos; };
  if (!columns.empty() && std::ranges::none_of(columns, named)) return false;
  if (strategies.empty() || !column.contains("strategy")) return true;
  return contains(strategies, column["strategy"]) &&
         (!column.contains("over") || contains(strategies, column["over"]));
}

bool TableChoice::wants_scene(const std::string& scene) const {
  return scenes.empty() || contains(scenes, scene);
}

std::vector<PaperTable> paper_tables(const ordered_json& definitions, const ordered_json& published,
                                     std::span<const Record> records, const TableChoice& choice) {
  std::vector<PaperTable> tables;
  for (const ordered_json& definition : definitions.at("tables")) {
    PaperTable table{definition.at("id"), definition.at("title"), {}, {}};
    const std::vector<std::string> scenes = rows_of(definition, published, records, choice);
    for (const std::string& scene : scenes) table.rows.push_back({scene, {}});
    for (const ordered_json& column : expanded_columns(definition, records)) {
      if (!choice.wants(column)) continue;
      for (Filled& filled : by_pipeline(column, published, scenes, records)) {
        table.columns.push_back(std::move(filled.column));
        for (std::size_t row = 0; row < scenes.size(); ++row)
          table.rows[row].cells.push_back(std::move(filled.cells[row]));
      }
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

std::vector<PaperTable> paper_tables(std::span<const Record> records, const TableChoice& choice) {
  return paper_tables(data_json("paper_tables.json"), data_json("published.json"), records, choice);
}

}  // namespace cscd::bench
