#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bench/strategies/verify.h"
#include "core/base/pipeline.h"
#include "core/detect/detector.h"
#include "scenes/catalog/generate.h"

// What one run of the harness keeps (schema cscd.run/2): every raw sample of every stage of every interval of
// every repetition, beside the counters, the digests and the verdict without which there are no samples.
// Tables and figures are made from records alone.
namespace cscd::bench {

inline constexpr std::string_view kRunSchema = "cscd.run/2";

// One number an interval. A counter that a strategy does not have has no column.
using CountColumns = std::map<std::string, std::vector<std::uint64_t>>;
// [repetition][timed interval], milliseconds. A stage that a strategy does not have has no column.
// `streaming` is no stage: it is what streaming all positions once from memory took before the query.
// `embedding`, of rows that rely on an embedded start, is outside the query too: what deciding exactly took
// whether the start is embedded, which those rows rely on. All of them share its samples. `start`, of the
// complete row that answers where the start is not known, is what finding the crossings at the start adds to
// its query.
using TimeColumns = std::map<std::string, std::vector<std::vector<double>>>;

// The columns that a query consists of. The others are beside it.
inline constexpr std::array<std::string_view, 4> kQueryStages = {"refit", "rv_update", "traversal",
                                                                 "elementary"};
// Returns what whole queries took, [repetition][timed interval].
std::vector<std::vector<double>> query_times(const TimeColumns& columns);

struct PreparationRecord {  // one sample for every time that the strategy was made
  std::vector<double> distance_and_heat_ms, decomposition_ms;
  std::optional<int> atomic_clusters;
};

// What a strategy needs beside time.
struct Footprint {
  // Resident memory over that before the strategy was made: at most while it was made and answered twice, and
  // what it kept then. Absent where the kernel does not say.
  std::optional<std::uint64_t> peak_bytes, held_bytes;
  // User-mode instructions of a query, mean over the intervals. Absent where the machine does not count them,
  // as most virtual machines do not, and where several threads share the work.
  std::optional<double> instructions;
};

struct StrategyRecord {
  std::string name, source, guarantee;
  int threads = 1;
  // So many intervals are played to the strategy before each measured one
  // (bench/harness/contestant.h); 0 for a strategy whose counters do not depend on what it was asked
  // before.
  std::size_t lead = 0;
  PreparationRecord preparation;
  Footprint footprint;
  CountColumns counts;
  std::vector<std::string> digests;  // of the contacts, one an interval
  // Time of the earliest contact in [0, 1], one an interval; none without a contact. Older records have no
  // such list.
  std::vector<std::optional<double>> first_times = {};
  TimeColumns ms;
};

struct VerifiedStrategy {
  std::string name, guarantee;
  std::uint64_t contacts_expected = 0, contacts_found = 0;  // of the reference's, over the verified intervals
  std::uint64_t intervals_promised = 0;  // verified ones in which the guarantee promises a contact
  std::vector<std::string> failures;
};

// How the reference's contacts differ from a table of truth from outside (bench/inputs/outside_truth.h).
struct TruthRecord {
  std::string file;
  std::uint64_t pairs = 0, contacts = 0;      // that the table judges, and that touch by its word
  std::uint64_t missed = 0, invented = 0;     // by the reference
  std::vector<std::string> differences = {};  // the first of them

  bool ok() const { return missed == 0 && invented == 0; }
};

struct VerificationRecord {
  std::string reference, elementary;   // the complete strategy and the exact test
  std::vector<std::size_t> intervals;  // those verified
  // Those of them whose start is not embedded, or with a thickness, not clear: nothing is then promised by
  // rows that promise the first contact, or all from an embedded start.
  std::vector<std::size_t> unembedded;
  std::vector<std::size_t> colliding;  // those of them on which the reference found a contact
  // Verified intervals on which the answers of two rows had differed when all counted intervals were answered
  // with the timed elementary test.
  std::vector<std::size_t> disagreeing;
  // Counted intervals on which rows that promise the first contact told different first times, as they may,
  // because the start is not embedded.
  std::vector<std::size_t> excused;
  std::vector<VerifiedStrategy> strategies;
  Accuracy accuracy;  // of the timed elementary test, on the reference's pairs
  std::uint64_t accuracy_tests = 0;
  // One entry for each strategy that brings its own elementary test: how its contacts differ from the
  // oracle's, and the first differences with the pair, the strategy's answer and the true one. Empty without
  // such a strategy.
  nlohmann::ordered_json own_tests = nlohmann::ordered_json::array();
  std::optional<TruthRecord> truth = std::nullopt;  // of an input with such a table beside it
  double seconds = 0;

  bool ok() const;
  const VerifiedStrategy* strategy(std::string_view name) const;  // null when it was not verified
};

struct SceneRecord {
  std::string name, story, digest;
  std::size_t vertices = 0, triangles = 0, bones = 0, frames = 0;
  std::vector<scenes::EffectCost> effects = {};  // as its frames were generated; empty for files
  std::string path = {};  // of what the user gave by its path: a cache, a model or a scene file of their own
};

struct Record {
  nlohmann::ordered_json environment;
  std::vector<std::string> command;
  std::uint64_t seed = 0;
  SceneRecord scene;
  Pipeline pipeline = Pipeline::vectorised;  // older records do not say
  double thickness = 0;                      // length within which features count as contacts; 0 for touching
  std::string elementary;                    // the timed one
  std::size_t intervals = 0;                 // that the command spans
  std::vector<std::size_t> counted_intervals;  // those of them that have counters and digests, ascending
  std::vector<std::size_t> timed_intervals;    // those of these that were timed, ascending
  VerificationRecord verification;
  std::vector<StrategyRecord> strategies;
  std::size_t processes = 1;  // that measured it, each some of the intervals

  const StrategyRecord* strategy(std::string_view name) const;  // null when it was not run
};

// Leaves what was prepared alone, as where some strategy broke its promise.
void leave_out_measurements(StrategyRecord& strategy);

// Adds one interval's counters as one row.
void append_counts(const Report& report, const ContactSet& found, CountColumns& columns);
// Adds one interval's time, or all of its stages', to the last repetition.
void append_time(const char* stage, double milliseconds, TimeColumns& columns, std::size_t repetition);
void append_times(const StageTimes& ms, TimeColumns& columns, std::size_t repetition);

nlohmann::ordered_json to_json(const Record& record);

// Returns the JSON of a record of any kind; a gzip file is unpacked first. Throws InputError, naming the
// file, if it cannot be read or unpacked, or holds no JSON.
nlohmann::ordered_json read_document(const std::filesystem::path& path);

// Throws InputError, naming the file, unless it is a whole record of this schema.
Record read_record(const std::filesystem::path& path);
// The same from the JSON of a file; `where` begins the error texts.
Record record_from(const nlohmann::ordered_json& document, const std::string& where);

}  // namespace cscd::bench
