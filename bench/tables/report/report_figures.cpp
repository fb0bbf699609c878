#include "bench/tables/report/report_figures.h"

#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace cscd::bench {
namespace {

using nlohmann::json;

struct Sum {
  std::uint64_t queries = 0, lost = 0, invented = 0, undecided = 0, timed = 0;
  double ns = 0;  // of all timed queries, each as long as the median of its class
};

}  // namespace

json accuracy_points(const json& record) {
  std::map<std::string, bool> is_sweep;
  for (const json& row : record.at("rows")) is_sweep[row.at("name")] = row.at("sweep");
  std::map<std::pair<std::string, std::string>, Sum> sums;  // by group and test
  for (const json& workload : record.at("workloads"))
    for (const json& row : workload.at("rows")) {
      if (row.at("queries") == 0) continue;
      Sum& sum = sums[{workload.at("group"), row.at("row")}];
      const auto add = [&](std::uint64_t& to, const char* key) { to += row.at(key).get<std::uint64_t>(); };
      add(sum.queries, "queries");
      add(sum.lost, "false_negatives");
      add(sum.invented, "false_positives");
      add(sum.undecided, "undecided_contacts");
      add(sum.undecided, "undecided_apart");
      for (const json& part : row.value("ns", json::object())) {
        const auto queries = part.at("queries").get<std::uint64_t>();
        sum.timed += queries;
        sum.ns += static_cast<double>(queries) * part.at("median").get<double>();
      }
    }
  json points = json::array();
  for (const auto& [place, sum] : sums)
    points.push_back({{"group", place.first},
                      {"row", place.second},
                      {"sweep", is_sweep[place.second]},
                      {"queries", sum.queries},
                      {"lost", sum.lost},
                      {"invented", sum.invented},
                      {"undecided", sum.undecided},
                      {"ns", sum.timed > 0 ? json(sum.ns / static_cast<double>(sum.timed)) : json()}});
  return points;
}

json growth_points(const json& record) {
  json points = json::array();
  for (const json& subject : record.at("subjects")) {
    const std::string study = subject.at("study");
    if (study == "contacts") continue;  // ratios of two scenes, at one size
    for (const json& step : subject.at("steps"))
      for (const json& strategy : step.at("strategies")) {
        if (!strategy.contains("ms")) continue;  // its answers were not verified
        const json& size = study == "step"        ? step.at("step")
                           : study == "bones"     ? subject.at("bones")
                           : study == "threads"   ? subject.at("threads")
                           : study == "thickness" ? step.at("thickness")
                                                  : subject.at("triangles");
        points.push_back({{"study", study},
                          {"scene", subject.at("scene")},
                          {"strategy", strategy.at("name")},
                          {"size", size},
                          {"ms", strategy.at("ms").at("total")}});
      }
  }
  json fits = json::array();
  for (const json& fit : record.at("fits"))
    if (fit.at("quantity") == "total" && !fit.at("exponent").is_null())
      fits.push_back({{"study", fit.at("study")},
                      {"scene", fit.at("scene")},
                      {"strategy", fit.at("strategy")},
                      {"exponent", fit.at("exponent")}});
  return {{"points", std::move(points)}, {"fits", std::move(fits)}};
}

}  // namespace cscd::bench
