#include "bench/tables/shaped_table.h"

#include <algorithm>
#include <cmath>

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

struct Figure {
  std::string measured, low, high, published;
};

// `whole`: to the nearest whole number.
Figure figure_of(const Cell* cell, bool whole = false) {
  Figure figure;
  if (cell == nullptr) return figure;
  if (cell->measured.value) {
    figure.measured = short_text(whole ? std::round(*cell->measured.value) : *cell->measured.value);
    if (cell->measured.marked) figure.measured += kShortfallMark;
  }
  if (cell->measured.interval) {
    figure.low = short_text(cell->measured.interval->low);
    figure.high = short_text(cell->measured.interval->high);
  }
  if (cell->published) figure.published = number_text(*cell->published);
  return figure;
}

// "38", or "38 [2, 76]" of three figures.
std::string with_range(const std::vector<Figure>& figures, std::string Figure::*text) {
  const std::string first = figures[0].*text;
  if (figures.size() < 3 || first.empty()) return first;
  return first + " [" + figures[1].*text + ", " + figures[2].*text + "]";
}

const Cell* find_cell(const FilledTable& table, const Row& row, const std::string& key, Pipeline pipeline) {
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const Column& column = table.columns[i];
    if (column.key == key && column.pipeline.value_or(pipeline) == pipeline) return &row.cells[i];
  }
  return nullptr;
}

bool has_figure(const ShapedTable::Line& line) {
  return std::ranges::any_of(line.cells, [](const std::string& cell) { return !cell.empty(); });
}

// The figures of one scene or strategy as lines: measured, the ends of intervals, published.
void add_lines(const std::string& name, const std::vector<std::vector<Figure>>& cells, bool intervals,
               bool of_today, ShapedTable& table) {
  ShapedTable::Line measured{name, "", {}, of_today}, low{"", "low", {}, of_today},
      high{"", "high", {}, of_today}, published{"", "published", {}, of_today};
  for (const std::vector<Figure>& figures : cells) {
    measured.cells.push_back(with_range(figures, &Figure::measured));
    low.cells.push_back(figures[0].low);
    high.cells.push_back(figures[0].high);
    published.cells.push_back(with_range(figures, &Figure::published));
  }
  const bool has_intervals = intervals && has_figure(low), was_published = has_figure(published);
  if (has_intervals || was_published) measured.kind = "measured";
  table.lines.push_back(std::move(measured));
  if (has_intervals) {
    table.lines.push_back(std::move(low));
    table.lines.push_back(std::move(high));
  }
  if (was_published) table.lines.push_back(std::move(published));
}

ShapedTable shaped(const FilledTable& table, std::span<const Record> records, bool intervals) {
  ShapedTable out{table.id, table.title, table.legend, {}, {}, {}};
  for (const ordered_json& group : table.shape) {
    out.groups.push_back({group.at("title"), group.at("columns").size()});
    for (const ordered_json& column : group.at("columns"))
      out.columns.push_back({column.at("head"), column.at("unit")});
  }
  for (const Pipeline pipeline : {Pipeline::published, Pipeline::vectorised})
    for (const Row& row : table.rows) {
      const bool has_published = find_record(records, row.scene, Pipeline::published) != nullptr;
      if (has_published != (pipeline == Pipeline::published)) continue;
      std::vector<std::vector<Figure>> cells;
      for (const ordered_json& group : table.shape)
        for (const ordered_json& column : group.at("columns")) {
          std::vector<Figure>& figures = cells.emplace_back();
          for (const std::string key : column.at("keys"))
            figures.push_back(figure_of(find_cell(table, row, key, pipeline), column.at("keys").size() > 1));
        }
      add_lines(row.scene, cells, intervals, pipeline == Pipeline::vectorised, out);
    }
  return out;
}

// "octopus_contact" stands in two lines, because a dozen of such names is too wide for a page.
ShapedTable::Column column_of(const std::string& scene) {
  const std::size_t end = scene.rfind("_contact");
  if (end == std::string::npos || end + 8 < scene.size()) return {scene, ""};
  return {scene.substr(0, end), scene.substr(end + 1)};
}

// Whether anything was measured in a group that has a title; sizes of scenes stand in one without.
bool has_measured(const ShapedTable& table) {
  std::size_t first = 0;
  for (const ShapedTable::Group& group : table.groups) {
    if (!group.title.empty())
      for (const ShapedTable::Line& line : table.lines)
        for (std::size_t i = first; i < first + group.columns; ++i)
          if (line.kind != "published" && !line.cells[i].empty()) return true;
    first += group.columns;
  }
  return false;
}

}  // namespace

bool ShapedTable::begins_today(std::size_t i) const {
  return i > 0 && lines[i].of_today && !lines[i - 1].of_today;
}

bool ShapedTable::has_marks() const {
  return std::ranges::any_of(lines, [](const Line& line) {
    return std::ranges::any_of(line.cells,
                               [](const std::string& cell) { return cell.ends_with(kShortfallMark); });
  });
}

std::vector<ShapedTable> shaped_tables(std::span<const FilledTable> tables, std::span<const Record> records,
                                       bool intervals) {
  std::vector<ShapedTable> out;
  for (const FilledTable& table : tables) {
    if (table.shape.is_null()) continue;
    ShapedTable one = shaped(table, records, intervals);
    if (has_measured(one)) out.push_back(std::move(one));
  }
  return out;
}

ShapedTable times_of_strategies(std::span<const Record> records, bool intervals) {
  ShapedTable table{
      "strategies",
      "One query with refit: the fast engine, the paper's methods and today's packages",
      "Milliseconds, the median interval, this project's code around every method (pipeline today).",
      {},
      {},
      {}};
  std::vector<const Record*> shown;
  std::vector<std::string> strategies;
  for (const Record& record : records) {
    if (record.pipeline != Pipeline::vectorised) continue;
    shown.push_back(&record);
    table.groups.push_back({"", 1});
    table.columns.push_back(column_of(record.scene.name));
    for (const StrategyRecord& strategy : record.strategies)
      if (std::ranges::find(strategies, strategy.name) == strategies.end())
        strategies.push_back(strategy.name);
  }
  for (const std::string& strategy : strategies) {
    std::vector<std::vector<Figure>> cells;
    for (const Record* record : shown) {
      const Cell cell{{}, median_query(strategy, *record)};
      cells.push_back({figure_of(&cell)});
    }
    add_lines(strategy, cells, intervals, true, table);
    if (!has_figure(table.lines.back())) table.lines.pop_back();
  }
  return table;
}

ordered_json shaped_json(std::span<const ShapedTable> tables) {
  ordered_json out = ordered_json::array();
  for (const ShapedTable& table : tables) {
    ordered_json groups = ordered_json::array(), columns = ordered_json::array(),
                 lines = ordered_json::array();
    for (const auto& group : table.groups)
      groups.push_back({{"title", group.title}, {"columns", group.columns}});
    for (const auto& column : table.columns)
      columns.push_back({{"head", column.head}, {"unit", column.unit}});
    for (std::size_t i = 0; i < table.lines.size(); ++i) {
      const auto& line = table.lines[i];
      lines.push_back({{"scene", line.scene}, {"kind", line.kind}, {"cells", line.cells}});
      if (table.begins_today(i)) lines.back()["note"] = kTodayNote;
    }
    out.push_back({{"id", table.id},
                   {"title", table.title},
                   {"legend", table.legend},
                   {"note", table.has_marks() ? kMarkNote : ""},
                   {"groups", std::move(groups)},
                   {"columns", std::move(columns)},
                   {"lines", std::move(lines)}});
  }
  return out;
}

}  // namespace cscd::bench
