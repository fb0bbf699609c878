#include "bench/output/json_text.h"

#include <algorithm>

namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

void write(const ordered_json& value, std::size_t depth, std::string& out) {
  const bool flat =
      value.empty() || !value.is_structured() ||
      (value.is_array() && std::none_of(value.begin(), value.end(),
                                        [](const ordered_json& item) { return item.is_structured(); }));
  if (flat) {
    out += value.dump();
    return;
  }
  bool first = true;
  out += value.is_object() ? '{' : '[';
  for (const auto& [key, item] : value.items()) {
    if (!first) out += ',';
    first = false;
    out.append("\n").append(depth + 1, ' ');
    if (value.is_object()) out.append(ordered_json(key).dump()).append(": ");
    write(item, depth + 1, out);
  }
  out.append("\n").append(depth, ' ');
  out += value.is_object() ? '}' : ']';
}

}  // namespace

std::string json_text(const ordered_json& value) {
  std::string out;
  write(value, 0, out);
  return out + "\n";
}

nlohmann::json counts_json(const Report& report) {
  nlohmann::json out = {{"pctp", report.cull.pctp},
                        {"adjacent_pctp", report.pairs.adjacent_pctp},
                        {"relative_dropped", report.pairs.relative_dropped},
                        {"feature_pairs", report.pairs.feature_pairs},
                        {"elementary_tests", report.pairs.elementary_tests}};
  if (report.cull.bvot) out["bvot"] = *report.cull.bvot;
  if (report.cull.contour_box_tests) out["contour_box_tests"] = *report.cull.contour_box_tests;
  if (const auto& radial = report.cull.radial)
    out.update({{"positive", radial->positive},
                {"negative", radial->negative},
                {"uncertain", radial->uncertain},
                {"clusters", radial->clusters}});
  return out;
}

nlohmann::json milliseconds_json(const StageTimes& ms) {
  nlohmann::json out = {
      {"refit", ms.refit}, {"traversal", ms.traversal}, {"elementary", ms.elementary}, {"total", ms.total()}};
  if (ms.classify) out["rv_update"] = *ms.classify;
  return out;
}

}  // namespace cscd::bench
