#include "bench/measure/studies/scale_summary.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "bench/measure/studies/scaling.h"
#include "bench/statistics/statistics.h"

namespace cscd::bench {

using nlohmann::ordered_json;

namespace {

const ordered_json* row_named(const ordered_json& rows, const std::string& name) {
  for (const ordered_json& row : rows)
    if (row.at("name") == name) return &row;
  return nullptr;
}

// The median of one row's repetitions over that of another's; both were interleaved.
ordered_json ratio_of(const ordered_json& row, const ordered_json& unit, const char* samples) {
  const auto a = row.at(samples).get<std::vector<double>>();
  const auto b = unit.at(samples).get<std::vector<double>>();
  if (a.size() != b.size())
    return {{"ratio", median(a) / median(b)}};  // one of them was too slow to be repeated
  const Estimate interval = bootstrap_ratio_of_medians(a, b);
  return {{"ratio", interval.value}, {"low", interval.low}, {"high", interval.high}};
}

// What each step costs as a ratio to the step `unit`, row by row. `key` is what the steps differ in; a step
// in which it is 0, touching alone, is left out.
void add_ratios(const ordered_json& subject, const ordered_json& unit, const char* key, ordered_json& out) {
  for (const ordered_json& step : subject.at("steps"))
    for (const ordered_json& row : step.at("strategies")) {
      const ordered_json& own = *row_named(unit.at("strategies"), row.at("name"));
      if (step.at(key) == 0 || !row.contains("ms") || !own.contains("ms")) continue;
      out.push_back({{"scene", subject.at("scene")}, {"strategy", row.at("name")}, {key, step.at(key)}});
      out.back().update(ratio_of(row, own, "total_samples"));
    }
}

}  // namespace

ordered_json fits(const ordered_json& subjects) {
  struct Series {
    std::vector<double> x, y;
  };
  // In order of their first appearance: study, scene, strategy, quantity.
  std::vector<std::pair<std::array<std::string, 4>, Series>> series;
  for (const ordered_json& subject : subjects) {
    const std::string study = subject.at("study");
    if (study == "step" || study == "contacts" || study == "thickness" || study == "small") continue;
    const double x = subject.at(study == "size" ? "triangles" : study);
    const auto add = [&](const std::string& strategy, const std::string& quantity, double y) {
      const std::array<std::string, 4> key = {study, subject.at("scene"), strategy, quantity};
      auto place = std::ranges::find(series, key, [](const auto& entry) { return entry.first; });
      if (place == series.end()) place = series.insert(series.end(), {key, {}});
      place->second.x.push_back(x);
      place->second.y.push_back(y);
    };
    for (const ordered_json& strategy : subject.at("strategies")) {
      const std::string name = strategy.at("name");
      for (const char* quantity : {"make_ms", "held_bytes", "peak_bytes"})
        if (strategy.contains(quantity)) add(name, quantity, strategy.at(quantity));
      const ordered_json& row = *row_named(subject.at("steps").at(0).at("strategies"), name);
      for (const char* quantity : {"bvot", "pctp"})
        if (row.at("counts").contains(quantity)) add(name, quantity, row.at("counts").at(quantity));
      if (row.contains("ms"))
        for (const auto& [stage, ms] : row.at("ms").items())
          if (stage != "median_interval") add(name, stage, ms);
    }
  }
  ordered_json out = ordered_json::array();
  for (const auto& [key, one] : series) {
    ordered_json row = {{"study", key[0]}, {"scene", key[1]}, {"strategy", key[2]}, {"quantity", key[3]}};
    if (const auto law = fit_power_law(one.x, one.y))
      row.update({{"exponent", law->exponent}, {"factor", law->factor}, {"points", law->points}});
    else
      row["exponent"] = nullptr;  // fewer than three positive values
    out.push_back(std::move(row));
  }
  return out;
}

ordered_json step_ratios(const ordered_json& subjects) {
  ordered_json out = ordered_json::array();
  for (const ordered_json& subject : subjects) {
    if (subject.at("study") != "step") continue;
    const auto& steps = subject.at("steps");
    const auto one =
        std::ranges::find_if(steps, [](const ordered_json& step) { return step.at("step") == 1; });
    if (one != steps.end()) add_ratios(subject, *one, "step", out);
  }
  return out;
}

ordered_json thickness_ratios(const ordered_json& subjects) {
  ordered_json out = ordered_json::array();
  for (const ordered_json& subject : subjects)
    if (subject.at("study") == "thickness") add_ratios(subject, subject.at("steps").at(0), "thickness", out);
  return out;
}

ordered_json contact_ratios(const ordered_json& subjects) {
  ordered_json out = ordered_json::array();
  for (const ordered_json& subject : subjects) {
    if (subject.at("study") != "contacts") continue;
    const ordered_json &plain = subject.at("steps").at(0), &with = subject.at("steps").at(1);
    for (const ordered_json& row : with.at("strategies")) {
      const ordered_json& unit = *row_named(plain.at("strategies"), row.at("name"));
      if (!row.contains("ms") || !unit.contains("ms")) continue;
      for (const std::string of : {"median_interval", "total"}) {
        out.push_back({{"scene", plain.at("scene")},
                       {"with", with.at("scene")},
                       {"strategy", row.at("name")},
                       {"of", of}});
        out.back().update(ratio_of(row, unit, (of + "_samples").c_str()));
      }
    }
  }
  return out;
}

}  // namespace cscd::bench
