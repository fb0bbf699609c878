#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/records/record.h"
#include "bench/tables/quantity.h"

// Every figure that tables have, published figures beside measured ones. What a column is,
// bench/tables/table_definitions.json says; what was published, bench/tables/published.json. No strategy is
// known by name here. How people read the paper's tables: bench/tables/shaped_table.h.
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
  std::optional<Pipeline> pipeline = Pipeline::vectorised;
  std::string empty = {};  // what stands in a list where there is no figure
  // How people read it (bench/tables/shaped_table.h): a column without a head is for machines and for the
  // report's page alone.
  std::optional<std::string> head = std::nullopt;
  std::string group = {}, short_unit = {};
};
// "today", "published", or "both".
std::string_view pipeline_text(const Column& column);

struct Row {
  std::string scene;
  std::vector<Cell> cells;  // one a column
};

struct FilledTable {
  std::string id, title, legend;
  std::vector<Column> columns;
  std::vector<Row> rows;
};

// The text with every `what` replaced.
std::string replaced(std::string text, const std::string& what, const std::string& by);
// "table1.{scene}.rvbc.DfHd" in the published figures; null when nothing stands there.
const nlohmann::ordered_json* find_published(const nlohmann::ordered_json& published, const std::string& path,
                                             const std::string& scene);

// The pipelines of the records, `published` first; `today` where there is no record.
std::vector<Pipeline> pipelines_of(std::span<const Record> records);
// The record of a scene in a pipeline; null where none was given.
const Record* find_record(std::span<const Record> records, const std::string& scene, Pipeline pipeline);

// Fills the table of a definition. `records` holds at most one record a scene and pipeline. Rows are the
// scenes of a kind, in the order of the records: "plain", "contacts", "truth" (held against truth from
// outside) or "all". A column with `each_strategy` stands for one a strategy of the records, whose name
// replaces {strategy}. Where there are records of both pipelines, a column stands once for each, unless the
// figures are the same, and a pipeline in which none was measured has no column.
FilledTable filled_table(const nlohmann::ordered_json& definition, const nlohmann::ordered_json& published,
                         std::span<const Record> records, const std::string& kind);
// The tables that ship.
std::vector<FilledTable> filled_tables(std::span<const Record> records);
// The same from other definitions and figures.
std::vector<FilledTable> filled_tables(const nlohmann::ordered_json& definitions,
                                       const nlohmann::ordered_json& published,
                                       std::span<const Record> records);

}  // namespace cscd::bench
