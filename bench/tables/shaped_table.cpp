#include "bench/tables/shaped_table.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bench/output/data.h"
#include "bench/output/markdown.h"
#include "bench/tables/run_times.h"
#include "core/base/number_text.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

struct Figure {
  std::string measured, low, high, published;
};

// As the paper prints it, but with commas between thousands.
std::string published_text(double figure) {
  return figure < 1000 ? exact_text(figure) : figure_text(figure);
}

// `whole`: to the nearest whole number.
Figure figure_of(const Cell* cell, bool whole = false) {
  Figure figure;
  if (cell == nullptr) return figure;
  Measured measured = cell->measured;
  if (whole && measured.value) measured.value = std::round(*measured.value);
  figure.measured = text_of(measured, false);
  if (measured.interval) {
    figure.low = figure_text(measured.interval->low);
    figure.high = figure_text(measured.interval->high);
  }
  if (cell->published) figure.published = published_text(*cell->published);
  return figure;
}

// With everything in the one text.
Figure bracketed(const Cell& cell) {
  Figure figure = {text_of(cell.measured, true), {}, {}, {}};
  if (cell.measured.value && cell.published) figure.measured += " (" + published_text(*cell.published) + ")";
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
  ShapedTable out{table.id, table.title, table.legend, "scene", {}, {}, {}};
  std::vector<std::vector<std::string>> keys;  // of each column
  std::string last;
  for (const Column& column : table.columns) {
    if (!column.head || column.key == last) continue;  // the same in the other pipeline
    last = column.key;
    if (column.head->empty()) {
      keys.back().push_back(column.key);
      continue;
    }
    if (out.groups.empty() || out.groups.back().title != column.group)
      out.groups.push_back({column.group, 0});
    ++out.groups.back().columns;
    out.columns.push_back({*column.head, column.short_unit});
    keys.push_back({column.key});
  }
  for (const Pipeline pipeline : {Pipeline::published, Pipeline::vectorised})
    for (const Row& row : table.rows) {
      const bool has_published = find_record(records, row.scene, Pipeline::published) != nullptr;
      if (has_published != (pipeline == Pipeline::published)) continue;
      std::vector<std::vector<Figure>> cells;
      for (const std::vector<std::string>& of_column : keys) {
        std::vector<Figure>& figures = cells.emplace_back();
        for (const std::string& key : of_column)
          figures.push_back(figure_of(find_cell(table, row, key, pipeline), of_column.size() > 1));
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

// Its columns as lines, and the scenes across. Lines without any figure are left out.
ShapedTable list_of(const FilledTable& table, const ordered_json& definition, bool intervals) {
  const bool brackets = definition.value("brackets", false);
  ShapedTable out{table.id, table.title, table.legend, definition.value("head", ""), {}, {}, {}};
  for (const Row& row : table.rows) {
    out.groups.push_back({"", 1});
    out.columns.push_back(brackets ? ShapedTable::Column{row.scene, ""} : column_of(row.scene));
  }
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    std::vector<std::vector<Figure>> cells;
    for (const Row& row : table.rows)
      cells.push_back({brackets ? bracketed(row.cells[c]) : figure_of(&row.cells[c])});
    if (std::ranges::all_of(cells, [](const auto& cell) { return cell[0].measured.empty(); })) continue;
    for (std::vector<Figure>& cell : cells)
      if (cell[0].measured.empty()) cell[0].measured = table.columns[c].empty;
    add_lines(table.columns[c].title, cells, intervals, true, out);
  }
  return out;
}

// What remains of a list where nothing is claimed of the records, so that no row is called faster.
ordered_json without_ratios_of_times(ordered_json list) {
  ordered_json& columns = list.at("columns");
  std::erase_if(columns.get_ref<ordered_json::array_t&>(), [](const ordered_json& column) {
    return column.contains("over") && column.at("quantity").get<std::string>().starts_with("ms.");
  });
  return list;
}

// The lists of a part of table_definitions.json.
std::vector<ShapedTable> lists_of(const char* part, std::span<const Record> records, bool intervals) {
  std::vector<Record> today(records.begin(), records.end());
  std::erase_if(today, [](const Record& record) { return record.pipeline != Pipeline::vectorised; });
  const bool is_claiming =
      std::ranges::all_of(today, [](const Record& record) { return no_claims_text(record).empty(); });
  const std::string definitions = data_json("table_definitions.json").at(part).dump();
  const ordered_json published = data_json("published.json");
  std::vector<ShapedTable> out;
  for (const ordered_json& definition :
       ordered_json::parse(replaced(definitions, "{all}", row_of_all_contacts(records))))
    for (const std::string kind : definition.value("scenes", ordered_json::array({"all"}))) {
      const FilledTable table = filled_table(is_claiming ? definition : without_ratios_of_times(definition),
                                             published, today, kind);
      out.push_back(list_of(table, definition, intervals));
      if (kind == "contacts") out.back().id += "_contacts";
      if (out.back().lines.empty()) out.pop_back();
    }
  return out;
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
    return std::ranges::any_of(
        line.cells, [](const std::string& cell) { return cell.find(kShortfallMark) != std::string::npos; });
  });
}

std::vector<ShapedTable> shaped_tables(std::span<const FilledTable> tables, std::span<const Record> records,
                                       bool intervals) {
  std::vector<ShapedTable> out;
  for (const FilledTable& table : tables) {
    ShapedTable one = shaped(table, records, intervals);
    if (has_measured(one)) out.push_back(std::move(one));
  }
  for (ShapedTable& list : lists_of("strategies", records, intervals)) out.push_back(std::move(list));
  return out;
}

std::string row_of_all_contacts(std::span<const Record> records) {
  constexpr char kAll[] = "drvbc_fast_all", kComplete[] = "drvbc_fast_complete";
  const bool all_promised = std::ranges::all_of(records, [&](const Record& record) {
    const std::optional<Shortfall> lacking = shortfall(record, kAll);
    return record.pipeline != Pipeline::vectorised ||
           (record.strategy(kAll) != nullptr && !(lacking && lacking->void_intervals > 0));
  });
  return all_promised ? kAll : kComplete;
}

std::vector<ShapedTable> page_lists(std::span<const Record> records) {
  return lists_of("lists", records, false);
}

std::string markdown_of(const ShapedTable& table) {
  std::vector<std::string> head = {table.head};
  for (std::size_t g = 0, i = 0; g < table.groups.size(); ++g)
    for (const std::size_t end = i + table.groups[g].columns; i < end; ++i) {
      const std::string &group = table.groups[g].title, &unit = table.columns[i].unit;
      head.push_back((group.empty() ? "" : group + " ") + table.columns[i].head +
                     (unit.empty() ? "" : " (" + unit + ")"));
    }
  std::vector<std::vector<std::string>> rows;
  for (std::size_t l = 0; l < table.lines.size(); ++l) {
    if (table.begins_today(l)) {
      rows.emplace_back(1, std::string("*") + kTodayNote + "*");
      rows.back().resize(head.size());
    }
    const ShapedTable::Line& line = table.lines[l];
    std::vector<std::string>& row =
        rows.emplace_back(1, line.scene + (line.scene.empty() || line.kind.empty() ? "" : ", ") + line.kind);
    for (const std::string& cell : line.cells) row.push_back(cell.empty() ? "–" : replaced(cell, "*", "\\*"));
  }
  return markdown_table(head, rows);
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
                   {"note", table.has_marks() ? kShortfallMeaning : ""},
                   {"groups", std::move(groups)},
                   {"columns", std::move(columns)},
                   {"lines", std::move(lines)},
                   {"markdown", markdown_of(table)}});
  }
  return out;
}

}  // namespace cscd::bench
