#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/record/record.h"
#include "bench/tables/quantity.h"

// The tables of the paper with published figures beside measured ones. What a column is,
// bench/tables/paper_tables.json says; what was published, bench/tables/published.json. No strategy is known
// by name here.
namespace cscd::bench {

struct Cell {
  std::optional<double> published;
  Measured measured;
};

struct Column {
  std::string key, title, unit;
  // The pipeline in which the figures were measured. None if records of both pipelines have the same figures,
  // as for counters, and for preparation, which is the same code in both and is shown as the first of them
  // has it.
  std::optional<Pipeline> pipeline = Pipeline::today;
};
// "today", "published", or "both".
std::string_view pipeline_text(const Column& column);

struct Row {
  std::string scene;
  std::vector<Cell> cells;  // one a column
};

struct PaperTable {
  std::string id, title;
  std::vector<Column> columns;
  std::vector<Row> rows;
};

// The pipeline of all columns; none if they differ, or if it is both.
std::optional<Pipeline> only_pipeline(const PaperTable& table);

// The text with every `what` replaced.
std::string replaced(std::string text, const std::string& what, const std::string& by);
// "table1.{scene}.rvbc.DfHd" in the published figures; null when nothing stands there.
const nlohmann::ordered_json* find_published(const nlohmann::ordered_json& published, const std::string& path,
                                             const std::string& scene);

// The pipelines of the records, `published` first; `today` where there is no record.
std::vector<Pipeline> pipelines_of(std::span<const Record> records);

// What of the tables is wanted. An empty list leaves nothing out.
struct TableChoice {
  std::vector<std::string> scenes, strategies;
  std::vector<std::string> columns;  // keys, or parts of keys

  bool wants(const nlohmann::ordered_json& column) const;
  bool wants_scene(const std::string& scene) const;
};

// At most one record a scene and pipeline. Rows are the scenes that the table was published for; a table
// without published rows has those of the records. A column with `each_strategy` stands for one a strategy of
// the records, whose name replaces {strategy}. Where there are records of both pipelines, a column stands
// once for each, unless the figures are the same, and a pipeline in which none was measured has no column.
std::vector<PaperTable> paper_tables(std::span<const Record> records, const TableChoice& choice = {});
// The same from other definitions and figures.
std::vector<PaperTable> paper_tables(const nlohmann::ordered_json& definitions,
                                     const nlohmann::ordered_json& published, std::span<const Record> records,
                                     const TableChoice& choice = {});

}  // namespace cscd::bench
