#include "bench/records/record.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>

#include "bench/output/gzip.h"
#include "bench/output/json_text.h"
#include "bench/output/schema.h"
#include "core/base/error.h"

namespace cscd::bench {

using nlohmann::ordered_json;

bool VerificationRecord::ok() const {
  if (truth && !truth->ok()) return false;
  return std::ranges::all_of(strategies,
                             [](const VerifiedStrategy& strategy) { return strategy.failures.empty(); });
}

const VerifiedStrategy* VerificationRecord::strategy(std::string_view name) const {
  const auto row = std::ranges::find(strategies, name, &VerifiedStrategy::name);
  return row == strategies.end() ? nullptr : &*row;
}

const StrategyRecord* Record::strategy(std::string_view name) const {
  const auto row = std::ranges::find(strategies, name, &StrategyRecord::name);
  return row == strategies.end() ? nullptr : &*row;
}

void leave_out_measurements(StrategyRecord& strategy) {
  strategy.footprint = {};
  strategy.counts.clear();
  strategy.digests.clear();
  strategy.first_times.clear();
  strategy.ms.clear();
}

void append_counts(const Report& report, const ContactSet& found, CountColumns& columns) {
  const nlohmann::json counts = counts_json(report);
  for (const auto& [key, value] : counts.items()) columns[key].push_back(value.get<std::uint64_t>());
  const auto undecided = static_cast<std::uint64_t>(std::ranges::count_if(
      found.contacts, [](const Contact& contact) { return contact.verdict == Verdict::undecided; }));
  columns["contacts"].push_back(found.contacts.size() - undecided);
  columns["undecided"].push_back(undecided);
}

void append_time(const char* stage, double milliseconds, TimeColumns& columns, std::size_t repetition) {
  auto& repetitions = columns[stage];
  repetitions.resize(repetition + 1);
  repetitions.back().push_back(std::round(milliseconds * 1e6) / 1e6);  // the clock ticks in nanoseconds
}

void append_times(const StageTimes& ms, TimeColumns& columns, std::size_t repetition) {
  const auto add = [&](const char* stage, double milliseconds) {
    append_time(stage, milliseconds, columns, repetition);
  };
  add("refit", ms.refit);
  if (ms.classify) add("rv_update", *ms.classify);
  add("traversal", ms.traversal);
  add("elementary", ms.elementary);
}

std::vector<std::vector<double>> query_times(const TimeColumns& columns) {
  std::vector<std::vector<double>> sums;
  for (const std::string_view stage : kQueryStages) {
    const auto column = columns.find(std::string(stage));
    if (column == columns.end()) continue;
    sums.resize(column->second.size());
    for (std::size_t r = 0; r < sums.size(); ++r) {
      sums[r].resize(column->second[r].size(), 0);
      std::ranges::transform(sums[r], column->second[r], sums[r].begin(), std::plus());
    }
  }
  return sums;
}

namespace {

ordered_json to_json(const VerificationRecord& v) {
  ordered_json strategies = ordered_json::array();
  for (const VerifiedStrategy& s : v.strategies)
    strategies.push_back({{"name", s.name},
                          {"guarantee", s.guarantee},
                          {"ok", s.failures.empty()},
                          {"contacts_expected", s.contacts_expected},
                          {"contacts_found", s.contacts_found},
                          {"intervals_promised", s.intervals_promised},
                          {"failures", s.failures}});
  ordered_json out = {{"ok", v.ok()},
                      {"reference", v.reference},
                      {"elementary", v.elementary},
                      {"intervals", v.intervals},
                      {"unembedded", v.unembedded},
                      {"colliding", v.colliding},
                      {"disagreeing", v.disagreeing},
                      {"excused", v.excused},
                      {"strategies", strategies},
                      {"accuracy",
                       {{"misses", v.accuracy.misses},
                        {"false_alarms", v.accuracy.false_alarms},
                        {"undecided", v.accuracy.undecided},
                        {"largest_time_error", v.accuracy.largest_time_error},
                        {"tests", v.accuracy_tests}}},
                      {"seconds", v.seconds}};
  if (!v.own_tests.empty()) out["own_tests"] = v.own_tests;
  if (v.truth)
    out["truth"] = {{"file", v.truth->file},         {"pairs", v.truth->pairs},
                    {"contacts", v.truth->contacts}, {"missed", v.truth->missed},
                    {"invented", v.truth->invented}, {"differences", v.truth->differences}};
  return out;
}

ordered_json to_json(const StrategyRecord& s) {
  ordered_json preparation = ordered_json::object();
  if (!s.preparation.distance_and_heat_ms.empty())
    preparation["distance_and_heat_ms"] = s.preparation.distance_and_heat_ms;
  if (!s.preparation.decomposition_ms.empty())
    preparation["decomposition_ms"] = s.preparation.decomposition_ms;
  if (s.preparation.atomic_clusters) preparation["atomic_clusters"] = *s.preparation.atomic_clusters;
  ordered_json footprint = ordered_json::object();
  if (s.footprint.peak_bytes) footprint["peak_bytes"] = *s.footprint.peak_bytes;
  if (s.footprint.held_bytes) footprint["held_bytes"] = *s.footprint.held_bytes;
  if (s.footprint.instructions) footprint["instructions"] = *s.footprint.instructions;
  ordered_json out = {{"name", s.name},
                      {"source", s.source},
                      {"guarantee", s.guarantee},
                      {"threads", s.threads},
                      {"preparation", std::move(preparation)},
                      {"footprint", std::move(footprint)},
                      {"counts", s.counts},
                      {"digests", s.digests}};
  if (s.lead > 0) out["lead"] = s.lead;
  if (!s.first_times.empty()) {
    ordered_json& times = out["first_times"] = ordered_json::array();
    for (const std::optional<double>& time : s.first_times)
      times.push_back(time ? ordered_json(*time) : nullptr);
  }
  if (!s.ms.empty()) out["ms"] = s.ms;
  return out;
}

VerificationRecord verification_from(const ordered_json& v) {
  VerificationRecord out;
  out.reference = v.at("reference");
  out.elementary = v.at("elementary");
  out.intervals = v.at("intervals").get<std::vector<std::size_t>>();
  out.unembedded = v.at("unembedded").get<std::vector<std::size_t>>();
  out.colliding = v.at("colliding").get<std::vector<std::size_t>>();
  out.disagreeing = v.value("disagreeing", std::vector<std::size_t>());
  out.excused = v.value("excused", std::vector<std::size_t>());
  for (const ordered_json& s : v.at("strategies"))
    out.strategies.push_back({s.at("name"), s.at("guarantee"), s.at("contacts_expected"),
                              s.at("contacts_found"), s.at("intervals_promised"),
                              s.at("failures").get<std::vector<std::string>>()});
  const ordered_json& accuracy = v.at("accuracy");
  out.accuracy = {accuracy.at("misses"), accuracy.at("false_alarms"), accuracy.at("undecided"),
                  accuracy.at("largest_time_error")};
  out.accuracy_tests = accuracy.at("tests");
  out.own_tests = v.value("own_tests", ordered_json::array());
  if (v.contains("truth")) {
    const ordered_json& truth = v["truth"];
    out.truth = {truth.at("file"),     truth.at("pairs"),
                 truth.at("contacts"), truth.at("missed"),
                 truth.at("invented"), truth.at("differences").get<std::vector<std::string>>()};
  }
  out.seconds = v.at("seconds");
  return out;
}

StrategyRecord strategy_from(const ordered_json& s) {
  StrategyRecord out;
  out.name = s.at("name");
  out.source = s.at("source");
  out.guarantee = s.at("guarantee");
  out.threads = s.value("threads", 1);
  out.lead = s.value("lead", std::size_t{0});
  const ordered_json& preparation = s.at("preparation");
  out.preparation.distance_and_heat_ms = preparation.value("distance_and_heat_ms", std::vector<double>());
  out.preparation.decomposition_ms = preparation.value("decomposition_ms", std::vector<double>());
  if (preparation.contains("atomic_clusters"))
    out.preparation.atomic_clusters = preparation["atomic_clusters"];
  const ordered_json& footprint = s.at("footprint");
  if (footprint.contains("peak_bytes")) out.footprint.peak_bytes = footprint["peak_bytes"];
  if (footprint.contains("held_bytes")) out.footprint.held_bytes = footprint["held_bytes"];
  if (footprint.contains("instructions")) out.footprint.instructions = footprint["instructions"];
  out.counts = s.at("counts").get<CountColumns>();
  out.digests = s.at("digests").get<std::vector<std::string>>();
  if (s.contains("first_times"))
    for (const ordered_json& time : s["first_times"])
      out.first_times.push_back(time.is_null() ? std::nullopt : std::optional(time.get<double>()));
  if (s.contains("ms")) out.ms = s["ms"].get<TimeColumns>();
  return out;
}

constexpr std::size_t kMostBytes = std::size_t{1} << 30;  // of a record, unpacked

// Every column has one number an interval, every stage the same repetitions.
void require_whole(const Record& record) {
  for (const StrategyRecord& strategy : record.strategies) {
    for (const auto& [key, column] : strategy.counts)
      if (column.size() != record.counted_intervals.size())
        throw InputError("strategy " + strategy.name + ": counts of " + key +
                         " are not one a counted interval");
    if (!strategy.first_times.empty() && strategy.first_times.size() != record.counted_intervals.size())
      throw InputError("strategy " + strategy.name + ": first times are not one a counted interval");
    if (!strategy.digests.empty() && strategy.digests.size() != record.counted_intervals.size())
      throw InputError("strategy " + strategy.name + ": digests are not one a counted interval");
    for (const auto& [stage, repetitions] : strategy.ms)
      for (const std::vector<double>& row : repetitions)
        if (row.size() != record.timed_intervals.size() ||
            repetitions.size() != strategy.ms.begin()->second.size())
          throw InputError("strategy " + strategy.name + ": times of " + stage +
                           " are not one a timed interval in every repetition");
  }
}

}  // namespace

ordered_json to_json(const Record& record) {
  ordered_json effects = ordered_json::array();
  for (const scenes::EffectCost& effect : record.scene.effects)
    effects.push_back({{"name", effect.name}, {"evaluations", effect.evaluations}, {"ms", effect.ms}});
  ordered_json strategies = ordered_json::array();
  for (const StrategyRecord& strategy : record.strategies) strategies.push_back(to_json(strategy));
  const SceneRecord& scene = record.scene;
  ordered_json scene_json = {{"name", scene.name},           {"story", scene.story},
                             {"digest", scene.digest},       {"vertices", scene.vertices},
                             {"triangles", scene.triangles}, {"bones", scene.bones},
                             {"frames", scene.frames},       {"effects", std::move(effects)}};
  if (!scene.path.empty()) scene_json["path"] = scene.path;
  ordered_json out = {{"schema", kRunSchema},
                      {"environment", record.environment},
                      {"command", record.command},
                      {"seed", record.seed},
                      {"scene", std::move(scene_json)},
                      {"pipeline", to_string(record.pipeline)},
                      {"elementary", record.elementary},
                      {"intervals", record.intervals},
                      {"counted_intervals", record.counted_intervals},
                      {"timed_intervals", record.timed_intervals},
                      {"verification", to_json(record.verification)},
                      {"strategies", std::move(strategies)}};
  if (record.processes > 1) out["processes"] = record.processes;
  if (record.thickness > 0) out["thickness"] = record.thickness;
  return out;
}

Record record_from(const ordered_json& document, const std::string& where) {
  try {
    if (const std::string schema = document.at("schema"); schema != kRunSchema)
      throw InputError("its schema is " + schema + ", not " + std::string(kRunSchema));
    if (const std::string violation = schema_violation(document, "run.schema.json"); !violation.empty())
      throw InputError("does not follow its schema at " + violation);
    Record out;
    out.environment = document.at("environment");
    out.command = document.at("command").get<std::vector<std::string>>();
    out.seed = document.at("seed");
    const ordered_json& scene = document.at("scene");
    out.scene = {scene.at("name"),      scene.at("story"), scene.at("digest"), scene.at("vertices"),
                 scene.at("triangles"), scene.at("bones"), scene.at("frames")};
    for (const ordered_json& effect : scene.at("effects"))
      out.scene.effects.push_back({effect.at("name"), effect.at("evaluations"), effect.at("ms")});
    out.scene.path = scene.value("path", "");
    out.thickness = document.value("thickness", 0.0);
    out.pipeline = pipeline_named(document.value("pipeline", to_string(Pipeline::vectorised)));
    out.elementary = document.at("elementary");
    out.intervals = document.at("intervals");
    out.counted_intervals = document.at("counted_intervals").get<std::vector<std::size_t>>();
    out.timed_intervals = document.at("timed_intervals").get<std::vector<std::size_t>>();
    out.verification = verification_from(document.at("verification"));
    for (const ordered_json& strategy : document.at("strategies"))
      out.strategies.push_back(strategy_from(strategy));
    out.processes = document.value("processes", std::size_t{1});
    require_whole(out);
    return out;
  } catch (const nlohmann::json::exception& error) {
    throw InputError("record " + where + ": is not what `cscd run` writes (" + error.what() + ")");
  } catch (const InputError& error) {
    throw InputError("record " + where + ": " + error.what() + "; write it anew with `cscd run`");
  }
}

ordered_json read_document(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf()))
    throw InputError("record " + path.string() + ": cannot be read; name a file that cscd wrote");
  ordered_json document =
      ordered_json::parse(without_gzip(text.str(), "record " + path.string(), kMostBytes), nullptr, false);
  if (document.is_discarded())
    throw InputError("record " + path.string() + ": is no JSON and so no record; name what cscd run wrote");
  return document;
}

Record read_record(const std::filesystem::path& path) {
  return record_from(read_document(path), path.string());
}

}  // namespace cscd::bench
