#include "bench/tables/filled_tables.h"

#include <algorithm>

#include "bench/output/data.h"
#include "bench/tables/distinct.h"
#include "core/base/split.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

ordered_json of_strategy(ordered_json column, const std::string& strategy) {
  for (auto& [key, value] : column.items())
    if (value.is_string()) value = replaced(value, "{strategy}", strategy);
  return column;
}

std::vector<ordered_json> expanded_columns(const ordered_json& definition, std::span<const Record> records) {
  std::vector<std::string> strategies;
  for (const Record& record : records)
    for (const StrategyRecord& strategy : record.strategies) add_new(strategies, strategy.name);
  std::vector<ordered_json> columns;
  for (const ordered_json& column : definition.at("columns")) {
    if (column.contains("of")) {
      for (const std::string strategy : column["of"])
        for (const ordered_json& inner : column.at("columns"))
          columns.push_back(of_strategy(inner, strategy));
    } else if (column.value("each_strategy", false)) {
      for (const std::string& strategy : strategies) {
        ordered_json own = of_strategy(column, strategy);
        const bool beside_itself = own.value("over", "") == own.at("strategy").get<std::string>();
        if (!beside_itself) columns.push_back(std::move(own));
      }
    } else {
      columns.push_back(column);
    }
  }
  return columns;
}

Cell fill(const ordered_json& column, const ordered_json& published, const std::string& scene,
          std::span<const Record> records, Pipeline pipeline) {
  Cell cell;
  const Record* record = find_record(records, scene + column.value("beside", ""), pipeline);
  if (record == nullptr)
    cell.measured.reason =
        "no record of " + scene + " in the pipeline " + std::string(to_string(pipeline)) + " was given";
  else
    cell.measured = measure(column, *record);
  // A scene of the user's own is not the paper's, even if it has that name.
  if (record != nullptr && !record->scene.path.empty()) return cell;
  for (const std::string path : column.value("published", ordered_json::array()))
    if (const ordered_json* figure = find_published(published, path, scene)) {
      cell.published = figure->get<double>();
      break;
    }
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
    const std::string unit = definition.value("unit", "");
    filled.column = {definition.value("key", ""), definition.at("title"), unit, pipeline,
                     definition.value("empty", "")};
    if (definition.contains("head")) filled.column.head = definition["head"];
    filled.column.group = definition.value("group", "");
    filled.column.short_unit = definition.value("short_unit", unit);
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

std::string_view pipeline_text(const Column& column) {
  return column.pipeline ? to_string(*column.pipeline) : "both";
}

std::vector<Pipeline> pipelines_of(std::span<const Record> records) {
  std::vector<Pipeline> pipelines;
  for (const Pipeline pipeline : {Pipeline::published, Pipeline::vectorised})
    if (std::ranges::any_of(records, [&](const Record& r) { return r.pipeline == pipeline; }))
      pipelines.push_back(pipeline);
  if (pipelines.empty()) pipelines.push_back(Pipeline::vectorised);
  return pipelines;
}

const Record* find_record(std::span<const Record> records, const std::string& scene, Pipeline pipeline) {
  const auto record = std::ranges::find_if(records, [&](const Record& candidate) {
    return candidate.scene.name == scene && candidate.pipeline == pipeline;
  });
  return record == records.end() ? nullptr : &*record;
}

bool is_of_kind(const Record& record, const std::string& kind) {
  if (kind == "truth") return record.verification.truth.has_value();
  return kind == "all" || record.scene.name.ends_with("_contact") == (kind == "contacts");
}

FilledTable filled_table(const ordered_json& definition, const ordered_json& published,
                         std::span<const Record> records, const std::string& kind) {
  std::vector<std::string> scenes;
  for (const Record& record : records)
    if (is_of_kind(record, kind)) add_new(scenes, record.scene.name);
  FilledTable table{
      definition.at("id"), definition.value("title", ""), definition.value("legend", ""), {}, {}};
  for (const std::string& scene : scenes) table.rows.push_back({scene, {}});
  for (const ordered_json& column : expanded_columns(definition, records)) {
    if (column.value("only", kind) != kind) continue;
    for (Filled& filled : by_pipeline(column, published, scenes, records)) {
      table.columns.push_back(std::move(filled.column));
      for (std::size_t row = 0; row < scenes.size(); ++row)
        table.rows[row].cells.push_back(std::move(filled.cells[row]));
    }
  }
  return table;
}

std::vector<FilledTable> filled_tables(const ordered_json& definitions, const ordered_json& published,
                                       std::span<const Record> records) {
  std::vector<FilledTable> tables;
  for (const ordered_json& definition : definitions.at("tables"))
    tables.push_back(filled_table(definition, published, records, definition.value("scenes", "all")));
  return tables;
}

std::vector<FilledTable> filled_tables(std::span<const Record> records) {
  return filled_tables(data_json("table_definitions.json"), data_json("published.json"), records);
}

}  // namespace cscd::bench
