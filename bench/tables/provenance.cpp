#include "bench/tables/provenance.h"

#include <algorithm>

#include "bench/compare/side.h"
#include "bench/output/markdown.h"
#include "bench/tables/distinct.h"
#include "scenes/base/joined.h"

namespace cscd::bench {
namespace {

std::string place_and_program(const Record& record) {
  const auto get = [&](const char* key) { return environment_text(record, key); };
  std::string out =
      get("cpu") + ", " + get("cores") + " cores; " + get("compiler") + ", " + get("build_type");
  if (record.environment.contains("instruction_set")) out += ", " + get("instruction_set");
  out += "; commit " + get("commit").substr(0, 12);
  if (record.environment.value("dirty", false)) out += " with changes";
  return out + "; " + get("date").substr(0, 10);
}

std::string repetitions(const Record& record) {
  const bool has_times = !record.strategies.empty() && !record.strategies.front().ms.empty();
  const std::size_t count = has_times ? record.strategies.front().ms.begin()->second.size() : 0;
  return std::to_string(count) +
         (record.processes > 1 ? " by " + std::to_string(record.processes) + " processes" : "");
}

}  // namespace

std::vector<std::string> environments(std::span<const Record> records) {
  return distinct(records, place_and_program);
}

std::string threads_text(const Record& record) {
  int most = 1;
  std::vector<std::string> sharing;
  for (const StrategyRecord& strategy : record.strategies)
    if (strategy.threads > 1) {
      most = strategy.threads;
      sharing.push_back(strategy.name);
    }
  return most == 1
             ? "one thread"
             : std::to_string(most) + " threads for " + joined(sharing) + ", one for every other strategy";
}

std::size_t timed_among(const std::vector<std::size_t>& intervals, const Record& record) {
  return static_cast<std::size_t>(std::ranges::count_if(
      record.timed_intervals, [&](std::size_t i) { return std::ranges::binary_search(intervals, i); }));
}

std::string how_measured(std::span<const Record> records) {
  const std::vector<std::string> references = distinct(records, [](const Record& record) {
    return "`" + record.verification.reference + "` with the elementary test `" +
           record.verification.elementary + "`";
  });
  std::string out = "Machine and program: " + joined(environments(records), "; and ") +
                    ". Threads: " + joined(distinct(records, threads_text), "; or ") +
                    ".\nAnswers were verified against " + joined(references, ", or ") +
                    ", and no strategy broke its promise there. Repetitions are interleaved.\n" +
                    "*Differing*: verified intervals on which strategies differed with the timed elementary "
                    "test. *Errors*: contacts that\nthis test missed, contacts that it invented and feature "
                    "pairs that it left undecided, of all pairs that it was asked.\n\n";
  std::vector<std::vector<std::string>> rows;
  const auto text = [](std::size_t count) { return std::to_string(count); };
  for (const Record& record : records) {
    const VerificationRecord& v = record.verification;
    const std::size_t timed = record.timed_intervals.size(), verified = timed_among(v.intervals, record);
    rows.push_back({record.scene.name + ", " + std::string(to_string(record.pipeline)),
                    text(record.intervals), text(record.counted_intervals.size()),
                    text(timed) + (verified == timed ? "" : " (" + text(verified) + " verified)"),
                    text(timed_among(v.colliding, record)), repetitions(record), text(v.intervals.size()),
                    text(v.colliding.size()), text(v.unembedded.size()), text(v.disagreeing.size()),
                    "`" + record.elementary + "`: " + text(v.accuracy.misses) + ", " +
                        text(v.accuracy.false_alarms) + ", " + text(v.accuracy.undecided) + " of " +
                        text(v.accuracy_tests)});
  }
  const std::vector<std::string> head = {"scene, pipeline",    "intervals",   "counted",  "timed",
                                         "with contacts",      "repetitions", "verified", "with contacts",
                                         "start not embedded", "differing",   "errors"};
  return out + markdown_table(head, rows);
}

}  // namespace cscd::bench
