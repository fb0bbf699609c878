#include "bench/measure/cell_limits.h"

#include <CLI/App.hpp>

namespace cscd::bench {

void add_cell_limits(CLI::App& command, CellLimits& limits) {
  command
      .add_option("--cell-seconds", limits.seconds,
                  "seconds that a cell may take, of the clock and of processor time")
      ->check(CLI::Range(0.001, 1e8));
  command.add_option("--cell-memory", limits.memory_mib, "MiB of address space that a cell may take")
      ->check(CLI::Range(64, 1 << 24));
}

}  // namespace cscd::bench
