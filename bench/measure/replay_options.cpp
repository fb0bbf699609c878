#include "bench/measure/replay_options.h"

#include <CLI/App.hpp>

#include "bench/query/options/model_options.h"

namespace cscd::bench {

void add_replay_options(CLI::App& command, ReplayRequest& request) {
  command.add_option("--scene,--input", request.scene, kInputHelp)->capture_default_str();
  command
      .add_option("--strategy", request.strategies,
                  "strategies or groups of them, with commas between; default all without a group")
      ->delimiter(',');
  command.add_option("--elementary", request.elementary, "the elementary test that is timed")
      ->capture_default_str();
  command
      .add_option(
          "--pipeline", request.pipeline,
          "`published` measures the paper's rows with the paper's code: scalar refit and orientation, "
          "its\nfilter alone, one feature pair after the other; `today` with this project's")
      ->capture_default_str();
  command.add_option("--repetitions", request.repetitions, "how often each interval is timed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      .add_option("--count-every", request.count_every,
                  "take the counters of each K-th interval, and of those timed or verified")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command.add_option("--time-every", request.time_every, "time each K-th interval")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command
      .add_option("--time-contacts", request.time_contacts,
                  "time at least so many intervals with contacts, where there are that many")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  command.add_option("--frames", request.frames, "A:B, the intervals between frames A and B; default all");
  command
      .add_option("--verify-every", request.verify_every,
                  "verify each K-th interval, from the first, and all that are timed")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  command.add_option("--seed", request.seed, "of the order in which strategies run")->capture_default_str();
  command.add_flag("--smoke", request.smoke,
                   "8 intervals in the middle, every 4th of them verified and timed twice");
  add_threads_option(command, request.threads);
  add_model_options(command, request.model);
}

}  // namespace cscd::bench
