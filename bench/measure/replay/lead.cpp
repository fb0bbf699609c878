#include "bench/measure/replay/lead.h"

#include <algorithm>

namespace cscd::bench {

void lead_up(const Strategy& strategy, Detector& detector, scenes::ClipSource& clip, std::size_t interval) {
  if (strategy.kind != StrategyKind::adaptive) return;
  detector.forget();
  ContactSet ignored;
  for (std::size_t i = interval - std::min(interval, kLead); i < interval; ++i) {
    const scenes::ClipInterval before = clip.load(i);
    detector.detect({before.motion, before.bones ? &*before.bones : nullptr}, ignored);
  }
}

}  // namespace cscd::bench
