#include "bench/tables/studies_json.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "bench/records/shortfall.h"
#include "core/base/number_text.h"

namespace cscd::bench {
namespace {

using nlohmann::json;

// One elementary test over several workloads.
struct Sum {
  std::uint64_t queries = 0, contacts = 0, lost = 0, invented = 0, undecided = 0;
  std::map<std::string, std::pair<double, double>> timed = {};  // by class: queries, and nanoseconds of all
  std::map<std::string, double> largest = {};                   // by error

  void add(const json& row) {
    const auto count = [&](std::uint64_t& to, const char* key) { to += row.at(key).get<std::uint64_t>(); };
    count(queries, "queries");
    count(contacts, "contacts");
    count(lost, "false_negatives");
    count(invented, "false_positives");
    count(undecided, "undecided_contacts");
    count(undecided, "undecided_apart");
    const json ns = row.value("ns", json::object());
    for (const auto& [name, cell] : ns.items()) {
      const double queries_timed = cell.at("queries");  // each as long as the median of its class
      for (const std::string& key : {std::string("ns"), "ns_" + name}) {
        timed[key].first += queries_timed;
        timed[key].second += queries_timed * cell.at("median").get<double>();
      }
    }
    const auto enlarge = [&](const char* part, const char* key, const char* name) {
      if (row.contains(part)) largest[name] = std::max(largest[name], row.at(part).at(key).get<double>());
    };
    enlarge("time_error", "largest_late", "late");
    enlarge("time_error", "largest_early", "early");
    enlarge("time_error", "p99", "p99");
    enlarge("false_positive_distance", "largest", "distance");
  }

  json as_json() const {
    json out = {{"queries", queries},
                {"contacts", contacts},
                {"lost", lost},
                {"invented", invented},
                {"undecided", undecided}};
    for (const auto& [key, sum] : timed) out[key] = sum.second / sum.first;
    for (const auto& [key, error] : largest) out[key] = error;
    return out;
  }
};

// What a workload has in common with others.
std::vector<std::string> kinds_of(const json& workload) {
  const std::string group = workload.at("group");
  std::vector<std::string> kinds = {"all", "group " + group};
  if (workload.contains("hardness")) kinds.push_back("hardness " + short_text(workload.at("hardness")));
  if (group == "hard") kinds.push_back("family " + workload.at("name").get<std::string>());
  if (group == "hard" || group == "open") kinds.emplace_back("sweep");
  return kinds;
}

// The guarantee of a row of a subject of `cscd scale`.
std::string guarantee_of(const json& subject, const json& row) {
  for (const json& strategy : subject.at("strategies"))
    if (strategy.at("name") == row.at("name")) return strategy.at("guarantee");
  return "";
}

bool is_first(const json& row) {  // is asked for no later contact
  return row.at("name").get<std::string>().ends_with(" --first");
}

// All contacts that a row counted in its intervals, of which the record keeps the mean.
std::uint64_t contacts_of(const json& row) {
  const double mean = row.at("counts").value("contacts", 0.0);
  return static_cast<std::uint64_t>(std::llround(mean * row.at("intervals").get<double>()));
}

// What the answers of a row lack in a step of a record of cscd.scale/1, in words; empty where nothing is
// lacking. Such a record does not say it: it follows from the contacts that complete rows count in as many
// intervals, and from starts from which the row promises nothing.
std::string derived_shortfall(const json& subject, const json& step, const json& row) {
  constexpr std::string_view kComplete = "complete";
  const std::string guarantee = guarantee_of(subject, row);
  if (guarantee == kComplete) return "";
  const std::size_t starts = step.at("starts").size(),
                    good = step.value("clear", step.at("embedded").get<std::size_t>());
  Shortfall lacking{0, contacts_of(row), starts, needs_embedded_start(guarantee) ? starts - good : 0};
  for (const json& other : step.at("strategies"))
    if (!is_first(row) && !is_first(other) && guarantee_of(subject, other) == kComplete &&
        other.at("intervals") == row.at("intervals"))
      lacking.contacts_expected = std::max(lacking.contacts_expected, contacts_of(other));
  return shortfall_text(lacking);
}

const json& size_of(const std::string& study, const json& subject, const json& step) {
  if (study == "step" || study == "thickness") return step.at(study);
  if (study == "small") return step.at("moves");
  return subject.at(study == "bones" || study == "threads" ? study : "triangles");
}

}  // namespace

json accuracy_json(const json& record) {
  std::map<std::string, std::map<std::string, Sum>> sums;
  std::map<std::string, std::map<std::string, std::uint64_t>> stages;
  for (const json& workload : record.at("workloads")) {
    for (const json& row : workload.at("rows"))
      if (row.at("queries") > 0)
        for (const std::string& kind : kinds_of(workload)) sums[kind][row.at("row")].add(row);
    const std::string group = workload.at("group"), name = workload.at("name");
    const json reached = workload.value("stages", json::object());
    for (const auto& [stage, count] : reached.items())
      for (const std::string& kind : {"group " + group, group + " " + name})
        stages[kind][stage] += count.get<std::uint64_t>();
  }
  json out = {{"stages", stages}};
  for (const auto& [kind, rows] : sums)
    for (const auto& [row, sum] : rows) out[kind][row] = sum.as_json();
  return out;
}

json growth_json(const json& record) {
  const bool has_shortfalls = record.at("schema") != "cscd.scale/1";
  json points = json::array(), fits = json::array(), shortfalls = json::array();
  for (const json& subject : record.at("subjects")) {
    const std::string study = subject.at("study");
    json& of_subject = shortfalls.emplace_back(json::array());
    for (const json& step : subject.at("steps")) {
      json& of_step = of_subject.emplace_back(json::object());
      for (const json& row : step.at("strategies")) {
        if (!row.contains("ms")) continue;  // its answers were not verified
        const std::string lacking =
            has_shortfalls ? row.value("shortfall", "") : derived_shortfall(subject, step, row);
        if (!lacking.empty()) of_step[row.at("name").get<std::string>()] = lacking;
        if (study == "contacts") continue;  // ratios of two scenes, at one size
        // Of small steps, a chart shows the plainest: those that follow each other, where touching counts.
        if (study == "small" && (step.at("series") != "substeps" || step.at("thickness") != 0)) continue;
        points.push_back({{"study", study},
                          {"scene", subject.at("scene")},
                          {"strategy", row.at("name")},
                          {"size", size_of(study, subject, step)},
                          {"ms", row.at("ms").at("total")},
                          {"marked", !lacking.empty()}});
      }
    }
  }
  for (const json& fit : record.at("fits"))
    if (fit.at("quantity") == "total" && !fit.at("exponent").is_null())
      fits.push_back({{"study", fit.at("study")},
                      {"scene", fit.at("scene")},
                      {"strategy", fit.at("strategy")},
                      {"exponent", fit.at("exponent")}});
  return {{"points", std::move(points)},
          {"fits", std::move(fits)},
          {"shortfalls", std::move(shortfalls)},
          {"shortfall_meaning", kShortfallMeaning}};
}

}  // namespace cscd::bench
