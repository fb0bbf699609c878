#include "bench/cli/output/report_json.h"

namespace cscd::bench {

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
