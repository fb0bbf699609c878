#include "bench/paper_tables.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "bench/catalogue.h"
#include "bench/data.h"

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

// "table1.{scene}.rvbc.DfHd" in the published figures; null when nothing stands there.
const ordered_json* find_published(const ordered_json& published, std::string path,
                                   const std::string& scene) {
  const std::string wildcard = "{scene}";
  if (const std::size_t at = path.find(wildcard); at != std::string::npos)
    path.replace(at, wildcard.size(), scene);
  const ordered_json* place = &published;
  for (const std::string& key : split(path, '.')) {
    if (!place->is_object() || !place->contains(key)) return nullptr;
    place = &(*place)[key];
  }
  return place;
}

// Why a cell stays empty.
struct Missing {
  std::string reason;
};

double summary(const std::vector<double>& samples, const std::string& statistic) {
  if (statistic == "mean") return mean(samples);
  if (statistic == "median") return median(samples);
  if (statistic == "min") return *std::min_element(samples.begin(), samples.end());
  if (statistic == "max") return *std::max_element(samples.begin(), samples.end());
  throw std::logic_error("unknown statistic " + statistic);
}

// One number a repetition: the statistic over the intervals of the sum of the named stages. A stage that the
// strategy does not have takes no time, but all of them cannot be missing.
std::vector<double> by_repetition(const StrategyRecord& strategy, const std::string& stages,
                                  const std::string& statistic) {
  std::vector<std::vector<double>> sums;
  for (const std::string& stage : split(stages, '+')) {
    const auto column = strategy.ms.find(stage);
    if (column == strategy.ms.end()) continue;
    if (sums.empty()) sums.assign(column->second.size(), std::vector<double>(column->second.front().size()));
    for (std::size_t r = 0; r < sums.size(); ++r)
      for (std::size_t i = 0; i < sums[r].size(); ++i) sums[r][i] += column->second[r][i];
  }
  if (sums.empty()) throw Missing{strategy.name + ": has no stage " + stages};
  std::vector<double> summaries;
  for (const std::vector<double>& repetition : sums) summaries.push_back(summary(repetition, statistic));
  return summaries;
}

std::vector<double> count_column(const StrategyRecord& strategy, const std::string& counter) {
  const auto column = strategy.counts.find(counter);
  if (column == strategy.counts.end()) throw Missing{strategy.name + ": does not count " + counter};
  return {column->second.begin(), column->second.end()};
}

const StrategyRecord& strategy_of(const Record& record, const std::string& name) {
  if (const StrategyRecord* strategy = record.strategy(name)) return *strategy;
  const auto rows = strategies();
  const bool built =
      std::any_of(rows.begin(), rows.end(), [&](const Strategy& row) { return row.name == name; });
  throw Missing{name + (built ? ": not run in this record" : ": not built yet")};
}

Cell exactly(double value) {
  return {{}, value, {}, {}};
}

Cell estimated(const Estimate& estimate, double scale) {
  return {{},
          estimate.value * scale,
          Estimate{estimate.value * scale, estimate.low * scale, estimate.high * scale},
          {}};
}

Cell scene_cell(const SceneRecord& scene, const std::string& what) {
  if (what == "triangles") return exactly(static_cast<double>(scene.triangles));
  if (what == "vertices") return exactly(static_cast<double>(scene.vertices));
  throw std::logic_error("unknown scene quantity " + what);
}

Cell preparation_cell(const StrategyRecord& strategy, const std::string& what, double scale) {
  const PreparationRecord& preparation = strategy.preparation;
  if (what == "atomic_clusters") {
    if (!preparation.atomic_clusters) throw Missing{strategy.name + ": has no clusters"};
    return exactly(*preparation.atomic_clusters);
  }
  const std::vector<double>& samples =
      what == "distance_and_heat_ms" ? preparation.distance_and_heat_ms : preparation.decomposition_ms;
  if (samples.empty()) throw Missing{strategy.name + ": has no such preparation"};
  return estimated(bootstrap_median(samples), scale);
}

// A column: `quantity` of `strategy`, divided by that of `over` if there is one.
Cell measure(const ordered_json& column, const Record& record) {
  const std::string quantity = column.at("quantity"), statistic = column.value("statistic", "mean");
  const std::size_t dot = quantity.find('.');
  const std::string kind = quantity.substr(0, dot), what = quantity.substr(dot + 1);
  if (kind == "scene") return scene_cell(record.scene, what);

  const StrategyRecord& strategy = strategy_of(record, column.at("strategy"));
  const StrategyRecord* over = column.contains("over") ? &strategy_of(record, column["over"]) : nullptr;
  const double scale = column.value("scale", 1.0);
  if (kind == "preparation") return preparation_cell(strategy, what, scale);
  if (kind == "counts") {
    const double value = summary(count_column(strategy, what), statistic) * scale;
    if (over == nullptr) return exactly(value);
    const double divisor = summary(count_column(*over, what), statistic) * scale;
    if (divisor == 0) throw Missing{over->name + ": counts no " + what};
    return exactly(value / divisor);
  }
  if (kind == "ms") {
    const std::vector<double> times = by_repetition(strategy, what, statistic);
    if (over == nullptr) return estimated(bootstrap_median(times), scale);
    return estimated(bootstrap_ratio_of_medians(times, by_repetition(*over, what, statistic)), scale);
  }
  throw std::logic_error("unknown quantity " + quantity);
}

Cell fill(const ordered_json& column, const ordered_json& published, const std::string& scene,
          const Record* record) {
  Cell cell;
  try {
    if (record == nullptr) throw Missing{"no record of " + scene + " was given"};
    cell = measure(column, *record);
  } catch (const Missing& missing) {
    cell.reason = missing.reason;
  }
  if (column.contains("published"))
    if (const ordered_json* figure = find_published(published, column["published"], scene))
      cell.published = figure->get<double>();
  return cell;
}

}  // namespace

std::vector<PaperTable> paper_tables(const ordered_json& definitions, const ordered_json& published,
                                     std::span<const Record> records, const std::string& only_scene) {
  std::vector<PaperTable> tables;
  for (const ordered_json& definition : definitions.at("tables")) {
    PaperTable& table = tables.emplace_back();
    table.id = definition.at("id");
    table.title = definition.at("title");
    for (const ordered_json& column : definition.at("columns"))
      table.columns.push_back({column.at("key"), column.at("title"), column.value("unit", "")});

    std::vector<std::string> scenes;
    if (const ordered_json* rows = find_published(published, definition.at("scenes"), ""))
      for (const auto& [scene, figures] : rows->items()) scenes.push_back(scene);
    for (const Record& record : records)
      if (std::find(scenes.begin(), scenes.end(), record.scene.name) == scenes.end())
        scenes.push_back(record.scene.name);
    if (!only_scene.empty())
      std::erase_if(scenes, [&](const std::string& scene) { return scene != only_scene; });

    for (const std::string& scene : scenes) {
      const auto record = std::find_if(records.begin(), records.end(), [&](const Record& candidate) {
        return candidate.scene.name == scene;
      });
      Row& row = table.rows.emplace_back();
      row.scene = scene;
      for (const ordered_json& column : definition["columns"])
        row.cells.push_back(fill(column, published, scene, record == records.end() ? nullptr : &*record));
    }
  }
  return tables;
}

std::vector<PaperTable> paper_tables(std::span<const Record> records, const std::string& only_scene) {
  return paper_tables(data_json("paper_tables.json"), data_json("published.json"), records, only_scene);
}

}  // namespace cscd::bench
