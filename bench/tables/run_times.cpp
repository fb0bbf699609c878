#include "bench/tables/run_times.h"

#include <algorithm>
#include <cstdio>

#include "bench/tables/quantity.h"

namespace cscd::bench {
namespace {

constexpr char kReference[] = "base";

std::string beside_reference(const std::string& strategy, const Record& record) {
  if (strategy == kReference || record.strategy(kReference) == nullptr) return "";
  const Measured faster = measure({{"quantity", "ms.refit+rv_update+traversal+elementary"},
                                   {"strategy", kReference},
                                   {"over", strategy},
                                   {"statistic", "median"}},
                                  record);
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
  bool any_marked = false;
  for (const StrategyRecord& strategy : record.strategies) width = std::max(width, strategy.name.size());
  for (const StrategyRecord& strategy : record.strategies) {
    const Measured total = median_query(strategy.name, record);
    if (!total.value) continue;
    char text[128];
    std::snprintf(text, sizeof text, "  %-*s %10.4g ms%s", static_cast<int>(width), strategy.name.c_str(),
                  *total.value, total.marked ? "*" : "");
    any_marked = any_marked || total.marked;
    rows += text + beside_reference(strategy.name, record) + "\n";
  }
  if (any_marked) rows += std::string(kMarkNote) + "\n";
  return rows.empty() ? "" : "median total of an interval, with refit:\n" + rows;
}

}  // namespace cscd::bench
