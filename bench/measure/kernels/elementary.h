#pragma once

namespace cscd::bench {

// The benchmarks elementary/SCENE/... and, where CSCD_QUERIES names the query set, elementary/queries/....
void register_elementary();

}  // namespace cscd::bench
