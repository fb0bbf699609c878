#include "bench/tables/tables_json.h"

#include "bench/output/data.h"
#include "bench/tables/provenance.h"
#include "bench/tables/tables_text.h"
#include "core/base/number_text.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

std::string number(const std::optional<double>& value) {
  return value ? rounded_text(*value, 4) : "";  // commas part the columns
}

std::string interval(const Measured& measured) {
  if (!measured.interval) return ",";
  return number(measured.interval->low) + "," + number(measured.interval->high);
}

ordered_json number_or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : nullptr;
}

ordered_json cell_json(const Column& column, const Cell& cell) {
  ordered_json out = {{"key", column.key},
                      {"title", column.title},
                      {"unit", column.unit},
                      {"pipeline", pipeline_text(column)},
                      {"published", number_or_null(cell.published)},
                      {"measured", number_or_null(cell.measured.value)},
                      {"text", text_of(cell.measured, true)}};
  if (cell.measured.interval) out["interval"] = {cell.measured.interval->low, cell.measured.interval->high};
  if (cell.measured.marked) out["marked"] = true;
  if (!cell.measured.reason.empty()) out["reason"] = cell.measured.reason;
  return out;
}

ordered_json source_json(const Record& record) {
  const VerificationRecord& v = record.verification;
  return {{"scene", record.scene.name},
          {"pipeline", to_string(record.pipeline)},
          {"digest", record.scene.digest},
          {"command", record.command},
          {"environment", record.environment},
          {"measured", environments({&record, 1}).front()},
          {"threads", threads_text(record)},
          {"intervals", record.intervals},
          {"counted_intervals", record.counted_intervals.size()},
          {"timed_intervals", record.timed_intervals.size()},
          {"timed_verified_intervals", timed_among(v.intervals, record)},
          {"timed_colliding_intervals", timed_among(v.colliding, record)},
          {"verified_intervals", v.intervals.size()},
          {"unembedded_intervals", v.unembedded.size()},
          {"colliding_intervals", v.colliding.size()}};
}

std::string quoted(const std::string& field) {
  if (field.find_first_of(",\"\n") == std::string::npos) return field;
  std::string out = "\"";
  for (const char c : field) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

}  // namespace

ordered_json tables_json(std::span<const FilledTable> tables, std::span<const ShapedTable> shaped,
                         std::span<const ClaimResult> claims, std::span<const Record> records) {
  ordered_json sources = ordered_json::array(), out_tables = ordered_json::array(),
               said = ordered_json::array();
  for (const Record& record : records) sources.push_back(source_json(record));
  for (const FilledTable& table : tables) {
    ordered_json rows = ordered_json::array();
    for (const Row& row : table.rows) {
      ordered_json cells = ordered_json::array();
      for (std::size_t i = 0; i < row.cells.size(); ++i)
        cells.push_back(cell_json(table.columns[i], row.cells[i]));
      rows.push_back({{"scene", row.scene}, {"cells", std::move(cells)}});
    }
    out_tables.push_back({{"id", table.id}, {"title", table.title}, {"rows", std::move(rows)}});
  }
  for (const Remark& one : remarks(shaped, claims, records))
    said.push_back({{"name", one.name}, {"text", one.text}});
  ordered_json all_shaped = shaped_json(shaped);
  for (ordered_json& list : shaped_json(page_lists(records))) all_shaped.push_back(std::move(list));
  const ordered_json published = data_json("published.json");
  return {{"schema", kTablesSchema},
          {"published", {{"source", published.at("source")}, {"machine", published.at("machine")}}},
          {"records", std::move(sources)},
          {"remarks", std::move(said)},
          {"mark_note", kShortfallMeaning},
          {"shaped", std::move(all_shaped)},
          {"tables", std::move(out_tables)},
          {"claims", claims_json(claims)}};
}

std::string tables_csv(std::span<const FilledTable> tables) {
  std::string out = "table,scene,key,title,unit,published,measured,low,high,reason,pipeline,marked\n";
  for (const FilledTable& table : tables)
    for (const Row& row : table.rows)
      for (std::size_t i = 0; i < row.cells.size(); ++i) {
        const Cell& cell = row.cells[i];
        const Column& column = table.columns[i];
        out += table.id + "," + row.scene + "," + column.key + "," + quoted(column.title) + "," +
               column.unit + "," + number(cell.published) + "," + number(cell.measured.value) + "," +
               interval(cell.measured) + "," + quoted(cell.measured.reason) + "," +
               std::string(pipeline_text(column)) + (cell.measured.marked ? ",yes\n" : ",\n");
      }
  return out;
}

}  // namespace cscd::bench
