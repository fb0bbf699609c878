#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
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
};

struct Row {
  std::string scene;
  std::vector<Cell> cells;  // one a column
};

struct PaperTable {
  std::string id, title;
  std::vector<Column> columns;
  std::vector<Row> rows;
};

// At most one record a scene. Rows are the scenes that the table was published for; a table without published
// rows has those of the records. `only_scene`, unless empty, leaves the others out. A column with
// `each_strategy` stands for one a strategy of the records, whose name replaces {strategy}.
std::vector<PaperTable> paper_tables(std::span<const Record> records, const std::string& only_scene = {});
// The same from other definitions and figures.
std::vector<PaperTable> paper_tables(const nlohmann::ordered_json& definitions,
                                     const nlohmann::ordered_json& published, std::span<const Record> records,
                                     const std::string& only_scene = {});

}  // namespace cscd::bench
