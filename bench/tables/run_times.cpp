#include "bench/tables/run_times.h"

#include <algorithm>
#include <cstdio>

#include "bench/tables/quantity.h"

namespace cscd::bench {
namespace {

constexpr char kReference[] = "base";

nlohmann::ordered_json total_of(const std::string& strategy) {
  return {{"quantity", "ms.refit+rv_update+traversal+elementary"},
          {"strategy", strategy},
          {"statistic", "median"}};
}

std::string beside_reference(const std::string& strategy, const Record& record) {
  if (strategy == kReference || record.strategy(kReference) == nullptr) return "";
  nlohmann::ordered_json definition = total_of(kReference);
  definition["over"] = strategy;
  const Measured faster = measure(definition, record);
  if (!faster.value || *faster.value <= 0) return "";
  const bool slower = *faster.value < 1;
  char text[64];
  std::snprintf(text, sizeof text, "  %.3g times %s than %s", slower ? 1 / *faster.value : *faster.value,
                slower ? "slower" : "faster", kReference);
  return text;
}

}  // namespace

std::string run_times_text(const Record& record) {
  std::size_t width = 0;
  std::string rows;
  for (const StrategyRecord& strategy : record.strategies) width = std::max(width, strategy.name.size());
  for (const StrategyRecord& strategy : record.strategies) {
    const Measured total = measure(total_of(strategy.name), record);
    if (!total.value) continue;
    char text[128];
    std::snprintf(text, sizeof text, "  %-*s %10.4g ms", static_cast<int>(width), strategy.name.c_str(),
                  *total.value);
    rows += text + beside_reference(strategy.name, record) + "\n";
  }
  return rows.empty() ? "" : "median total of an interval, with refit:\n" + rows;
}

}  // namespace cscd::bench
