#include "bench/tables/tables_text.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

#include "bench/output/data.h"
#include "bench/output/markdown.h"
#include "core/base/joined.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

std::string interval(const Measured& measured, const char* between) {
  if (!measured.interval) return "";
  return number_text(measured.interval->low) + between + number_text(measured.interval->high);
}

std::string number(const std::optional<double>& value) {
  return value ? number_text(*value) : "";
}

constexpr std::size_t kScenesAcross = 6;  // more make a page too wide to read

std::string title(const PaperTable& table) {
  const std::optional<Pipeline> pipeline = only_pipeline(table);
  return table.title + (pipeline ? " (pipeline `" + std::string(to_string(*pipeline)) + "`)" : "");
}

std::string title(const PaperTable& table, const Column& column) {
  std::string out = column.unit.empty() ? column.title : column.title + " (" + column.unit + ")";
  if (column.pipeline && !only_pipeline(table)) out += ", `" + std::string(to_string(*column.pipeline)) + "`";
  return out;
}

// "4.4 [3.8, 4.5] (28.4)", or the reason why nothing was measured.
std::string plain(const Cell& cell) {
  std::string out = cell.measured.value ? number_text(*cell.measured.value) : cell.measured.reason;
  if (cell.measured.interval) out += " [" + interval(cell.measured, ", ") + "]";
  if (cell.published) out += " (" + number_text(*cell.published) + ")";
  return out;
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
                      {"measured", number_or_null(cell.measured.value)}};
  if (cell.measured.interval) out["interval"] = {cell.measured.interval->low, cell.measured.interval->high};
  if (!cell.measured.reason.empty()) out["reason"] = cell.measured.reason;
  return out;
}

std::string text(const ordered_json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string threads(const Record& record) {
  int most = 1;
  std::vector<std::string> sharing;
  for (const StrategyRecord& strategy : record.strategies)
    if (strategy.threads > 1) {
      most = strategy.threads;
      sharing.push_back(strategy.name);
    }
  return most == 1
             ? "one thread"
             : std::to_string(most) + " threads for " + joined(sharing) + ", one for every other strategy";
}

// How many of the timed intervals are among the given ones.
std::size_t timed_and(const std::vector<std::size_t>& intervals, const Record& record) {
  return static_cast<std::size_t>(std::ranges::count_if(
      record.timed_intervals, [&](std::size_t i) { return std::ranges::binary_search(intervals, i); }));
}

ordered_json source_json(const Record& record) {
  const VerificationRecord& v = record.verification;
  return {{"scene", record.scene.name},
          {"pipeline", to_string(record.pipeline)},
          {"digest", record.scene.digest},
          {"command", record.command},
          {"environment", record.environment},
          {"threads", threads(record)},
          {"intervals", record.intervals},
          {"counted_intervals", record.counted_intervals.size()},
          {"timed_intervals", record.timed_intervals.size()},
          {"timed_verified_intervals", timed_and(v.intervals, record)},
          {"timed_colliding_intervals", timed_and(v.colliding, record)},
          {"verified_intervals", v.intervals.size()},
          {"unembedded_intervals", v.unembedded.size()},
          {"colliding_intervals", v.colliding.size()}};
}

// A command as a shell takes it: a word that holds more than letters, digits and a few signs stands in
// quotes.
std::string shell_line(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) {
    const bool plain = std::all_of(word.begin(), word.end(), [](unsigned char c) {
      return c >= 0x80 || std::isalnum(c) != 0 ||
             std::string_view("_-+=:,./@%").find(static_cast<char>(c)) != std::string_view::npos;
    });
    out += out.empty() ? "" : " ";
    out += plain && !word.empty() ? word : "'" + word + "'";
  }
  return out;
}

std::size_t repetitions(const Record& record) {
  return record.strategies.empty() || record.strategies.front().ms.empty()
             ? 0
             : record.strategies.front().ms.begin()->second.size();
}

// Where the numbers come from and what stands behind them.
std::string provenance(const Record& record) {
  const ordered_json& e = record.environment;
  const VerificationRecord& v = record.verification;
  const auto get = [&](const char* key) { return text(e.value(key, ordered_json("unknown"))); };
  std::string out = "**" + record.scene.name + "**, pipeline `" + std::string(to_string(record.pipeline)) +
                    "`: " + get("cpu") + ", " + get("cores") + " cores, " + threads(record) + "; " +
                    get("compiler") + ", " + get("build_type") +
                    (e.contains("instruction_set") ? ", " + get("instruction_set") : "") + "; commit " +
                    get("commit").substr(0, 12) + (e.value("dirty", false) ? " with changes" : "") + "; " +
                    get("date") + ".\n";
  out += "Made by `" + shell_line(record.command) + "`.\n";
  const std::size_t timed = record.timed_intervals.size(), verified = timed_and(v.intervals, record);
  out += std::to_string(timed) + " of " + std::to_string(record.intervals) + " intervals timed, " +
         (verified == timed ? "all of them" : std::to_string(verified) + " of them") + " verified and " +
         std::to_string(timed_and(v.colliding, record)) + " with contacts, " +
         std::to_string(repetitions(record)) + " repetitions, interleaved" +
         (record.processes > 1 ? ", by " + std::to_string(record.processes) + " processes" : "") +
         "; counters of " +
         (record.counted_intervals.size() == record.intervals
              ? "all"
              : std::to_string(record.counted_intervals.size())) +
         ". ";
  out += "Answers verified on " + std::to_string(v.intervals.size()) + " intervals against `" + v.reference +
         "` with the elementary test `" + v.elementary + "`: no strategy failed its guarantee";
  out += v.unembedded.empty() ? ", every start was embedded.\n"
                              : "; " + std::to_string(v.unembedded.size()) +
                                    " starts were not embedded, where `first_contact` promises nothing.\n";
  if (!v.disagreeing.empty())
    out += "On " + std::to_string(v.disagreeing.size()) +
           " of the verified intervals rows had differed with the timed elementary test.\n";
  out += v.colliding.empty() ? "None of them has a contact: here a strategy can fail by inventing one only.\n"
                             : std::to_string(v.colliding.size()) + " of them have contacts to be lost.\n";
  out += "The timed test `" + record.elementary + "` on " + std::to_string(v.accuracy_tests) +
         " feature pairs of these: " + std::to_string(v.accuracy.misses) + " misses, " +
         std::to_string(v.accuracy.false_alarms) + " false alarms, " + std::to_string(v.accuracy.undecided) +
         " undecided.\n";
  return out;
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

ordered_json tables_json(std::span<const PaperTable> tables, std::span<const ClaimResult> claims,
                         std::span<const Record> records) {
  ordered_json sources = ordered_json::array(), out_tables = ordered_json::array();
  for (const Record& record : records) sources.push_back(source_json(record));
  for (const PaperTable& table : tables) {
    ordered_json rows = ordered_json::array();
    for (const Row& row : table.rows) {
      ordered_json cells = ordered_json::array();
      for (std::size_t i = 0; i < row.cells.size(); ++i)
        cells.push_back(cell_json(table.columns[i], row.cells[i]));
      rows.push_back({{"scene", row.scene}, {"cells", std::move(cells)}});
    }
    out_tables.push_back({{"id", table.id}, {"title", table.title}, {"rows", std::move(rows)}});
  }
  const ordered_json published = data_json("published.json");
  return {{"schema", kTablesSchema},
          {"published", {{"source", published.at("source")}, {"machine", published.at("machine")}}},
          {"records", std::move(sources)},
          {"tables", std::move(out_tables)},
          {"claims", claims_json(claims)}};
}

std::string tables_markdown(std::span<const PaperTable> tables, std::span<const Record> records) {
  const ordered_json published = data_json("published.json");
  std::string out;
  for (const Record& record : records) out += provenance(record) + "\n";
  out += "Published: " + text(published.at("machine")) +
         ".\n\nA cell is the measured figure, its 95 % interval in ";
  out += "brackets where it has noise, and the published figure in parentheses where there is one.\n";
  if (pipelines_of(records).size() == 2)
    out +=
        "\nA row that ends in `published` was measured with the paper's code around every method: scalar "
        "refit "
        "and\norientation classes, its filter alone, feature pairs one by one. A row that ends in `today` "
        "was "
        "measured with\nthis project's. Preparation is the same code in both and is shown from the record of "
        "`published`. The figures of\nother rows are the same in both.\n";
  for (const PaperTable& table : tables) {
    if (table.rows.empty() || table.columns.empty()) continue;
    out += "\n### " + title(table) + "\n";
    for (std::size_t first = 0; first < table.rows.size(); first += kScenesAcross) {
      const auto rows =
          std::span(table.rows).subspan(first, std::min(kScenesAcross, table.rows.size() - first));
      std::vector<std::string> head(1);
      for (const Row& row : rows) head.push_back(row.scene);
      std::vector<std::vector<std::string>> lines;
      for (std::size_t i = 0; i < table.columns.size(); ++i) {
        std::vector<std::string>& line = lines.emplace_back(1, title(table, table.columns[i]));
        for (const Row& row : rows) line.push_back(plain(row.cells[i]));
      }
      out += "\n" + markdown_table(head, lines);
    }
  }
  return out;
}

std::string tables_csv(std::span<const PaperTable> tables) {
  std::string out = "table,scene,key,title,unit,published,measured,low,high,reason,pipeline\n";
  for (const PaperTable& table : tables)
    for (const Row& row : table.rows)
      for (std::size_t i = 0; i < row.cells.size(); ++i) {
        const Cell& cell = row.cells[i];
        const Column& column = table.columns[i];
        out += table.id + "," + row.scene + "," + column.key + "," + quoted(column.title) + "," +
               column.unit + "," + number(cell.published) + "," + number(cell.measured.value) + "," +
               (cell.measured.interval ? interval(cell.measured, ",") : std::string(",")) + "," +
               quoted(cell.measured.reason) + "," + std::string(pipeline_text(column)) + "\n";
      }
  return out;
}

}  // namespace cscd::bench
