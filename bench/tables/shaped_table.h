#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "bench/records/record.h"
#include "bench/tables/filled_tables.h"

// Tables as people read them: every figure is a text already, and what draws them (terminal, Markdown, LaTeX,
// the report's page) knows nothing of what they say.
namespace cscd::bench {

struct ShapedTable {
  struct Group {
    std::string title;
    std::size_t columns;
  };
  struct Column {
    std::string head, unit;  // what stands beneath the head is not always a unit
  };
  struct Line {
    std::string scene, kind;  // kind: "measured", "published", "low" or "high"; empty if there is one kind
    std::vector<std::string> cells;  // one a column; empty where there is no figure
    bool of_today = false;           // measured in the pipeline `today`
  };
  std::string id, title, legend, head;  // `head` stands above the names of the lines
  std::vector<Group> groups;
  std::vector<Column> columns;
  std::vector<Line> lines;

  // Whether line i is the first of those measured in the pipeline `today`, below lines of `published`.
  bool begins_today(std::size_t i) const;
  bool has_marks() const;
};

// What stands above the line that begins_today().
inline constexpr char kTodayNote[] = "the same with this project's code around every method (pipeline today)";

// The paper's Tables 1, 2 and 3 of the scenes in the records, and that of real steps: one line a scene, and
// beneath it the published figures. A scene with a record of the pipeline `published` is shown in that one;
// other scenes stand below, in the pipeline `today`. With `intervals`, the ends of the 95 % intervals stand
// in lines of their own. A table in which no strategy was measured is left out. The last, "strategies", is
// what one query takes with every strategy of the pipeline `today`.
std::vector<ShapedTable> shaped_tables(std::span<const FilledTable> tables, std::span<const Record> records,
                                       bool intervals = false);

// The row of the fast engine that finds all contacts in these records: drvbc_fast_all where it was run on all
// scenes and promises something from every verified start, and else drvbc_fast_complete.
std::string row_of_all_contacts(std::span<const Record> records);

// The lists that pages show of records of the pipeline `today`: quantities down, scenes across. A list of
// which nothing was measured is left out; a list of scenes with contacts has the id ID_contacts.
std::vector<ShapedTable> page_lists(std::span<const Record> records);

// With each table as it stands on a page in Markdown, without its title, legend and note.
nlohmann::ordered_json shaped_json(std::span<const ShapedTable> tables);

// The table alone. Names of lines and of strategies stand in it as code.
std::string markdown_of(const ShapedTable& table);

}  // namespace cscd::bench
