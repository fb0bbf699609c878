#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "bench/harness/contestant.h"
#include "bench/inputs/input.h"
#include "bench/records/record.h"
#include "core/detect/start/embedding.h"

// The one way in which strategies are run, checked and timed. `cscd run`, the study of growing work and the
// public benchmark's entry say which intervals are measured, by whom and how often, and each makes its own
// record of the results.
namespace cscd::bench {

// Intervals that are measured alike. Lists of intervals ascend.
struct Section {
  std::vector<std::size_t> counted;   // answered once with the timed test: counters, digests, first times
  std::vector<std::size_t> verified;  // those of them that are judged in any case
  std::vector<std::size_t> timed;     // those of them that are timed
  double thickness = 0;               // length within which features count as contacts; 0 for touching
  std::vector<bool> asked = {};       // [contestants]; empty: all of them
  // False: the reference answers the verified intervals alone, even where it is a contestant.
  bool reference_answers_all = true;
};

// What one contestant answered when an interval was counted.
struct Counted {
  Report report;
  std::string digest;
};

struct SectionResult {
  Section section;
  VerificationRecord verification;
  std::vector<StrategyRecord> rows;  // [contestants]: all that a record keeps of them
  // [contestants][counted intervals]; none where a contestant was not asked.
  std::vector<std::vector<std::optional<Counted>>> counted;
  // [counted intervals]: the earliest contact, by the reference where it judged, and else by the first
  // contestant that was asked.
  std::vector<std::optional<double>> first_times;

  // What a query took in the mean when it was counted; 0 where the contestant was never asked.
  double mean_ms(std::size_t contestant) const;
};

struct Timing {
  std::size_t repetitions;
  std::mt19937_64& random;  // draws the order of the contestants
  // Times tests of starts, and counts instructions, beside the queries.
  bool beside_queries = false;
  // A contestant whose queries took more milliseconds than this in the mean when they were counted is not
  // timed: it has no times but those.
  double most_ms = std::numeric_limits<double>::infinity();
};

// Says which intervals lead up to each interval of a clip whose intervals follow each other.
std::vector<IntervalRange> leads_in_clip(std::size_t intervals);

// Culling must not depend on the elementary test behind it; otherwise the verified strategy is not the timed
// one. A row that looks for the first contact alone culls by the times that the test finds. How many feature
// pairs the filter leaves is not compared: the filter runs in the precision that the test can take
// (ElementaryTest::single_precision_first).
bool same_culling(const Report& a, const Report& b);

class Measurement {
 public:
  // `where` names an interval at the beginning of a failure's text. `leads`, [intervals], holds for each
  // interval those that warm adaptive strategies up for it.
  struct Setup {
    Input& input;
    std::span<Contestant> contestants;  // made for the input with these tests
    const ElementaryTest &exact, &timed;
    std::vector<IntervalRange> leads = leads_in_clip(input.clip->interval_count());
    std::function<std::string(std::size_t interval)> where = [](std::size_t interval) {
      return "interval " + std::to_string(interval);
    };
  };
  using Visit = std::function<void(std::size_t contestant, std::size_t interval, const ContactSet& found)>;

  // Everything given must outlive the measurement.
  explicit Measurement(Setup setup);
  Measurement(const Measurement&) = delete;
  Measurement& operator=(const Measurement&) = delete;

  // Asks the contestants about all counted intervals with the timed test, which takes counters and digests
  // and brings caches into the state of a strategy in use. Judges the verified intervals, and those on which
  // two contestants answered otherwise where both promise the same: complete rows have to find the same
  // contacts; they and, from a clear start, rows that promise the first contact have to find the same first
  // time. The timed test may be to blame for that, so such intervals are judged with the exact one. The
  // counters of a judged interval have to be those of the timed one. `visit` sees every counted answer. The
  // result stays valid.
  SectionResult& count(Section section, const Visit& visit = {});

  // Times the sections that were counted since the last call and have no failures. Each timed interval is
  // given to all contestants in turn, in a random order drawn anew every time, so that drift of the machine
  // hits all alike. A section ends with a failure at the first contestant whose contacts or counters differ
  // from those that were counted. Before each timed query all positions are streamed; how long that took is
  // the column `streaming`. After all queries, the exact test whether the start is embedded is timed as
  // often, where the timing asks for it. What it took is the stage `embedding` of the rows that rely on an
  // embedded start. The stage `start` of the row that answers from starts that are not known is what its own
  // exact test of the pairs that may cross there takes, beside its query. Throws InputError where an interval
  // is to be timed that was not counted.
  void time(const Timing& timing);

  // Whether an interval starts embedded, by a test that shares no culling with the timed one.
  bool starts_embedded(std::size_t interval);

 private:
  using Answers = std::vector<std::optional<Answered>>;  // [contestants]; none where one was not asked

  bool is_reference(std::size_t contestant) const { return &setup_.contestants[contestant] == reference_; }
  bool is_asked(const Section& section, std::size_t contestant, bool is_verified) const;
  // A record in which nothing is judged.
  VerificationRecord unjudged() const;
  // Adds one interval to a record: the contestants against the complete reference, both with the exact test,
  // and the timed test on the reference's pairs. The reference itself is held against truth from outside
  // where the input has some. `answers` are those with the timed test. Returns the time of the reference's
  // first contact.
  std::optional<double> verify(std::size_t interval, const Answers& answers, VerificationRecord& record);
  // Warms the detector up; the clip then holds the interval.
  scenes::ClipInterval lead_to(std::size_t interval, const StrategyRow& row, Detector& detector);
  void time_queries(SectionResult& result, std::size_t interval, std::size_t repetition,
                    const std::vector<std::size_t>& contestants, std::mt19937_64& random);
  void time_starts(SectionResult& result, std::size_t repetition, EmbeddingTest& test);
  void count_instructions(SectionResult& result);
  void expect_verified(bool embedded, std::size_t interval);

  Setup setup_;
  // A contestant where the reference takes part in the pipeline `today`, which drops no contact; otherwise
  // made for the occasion.
  std::optional<Contestant> own_reference_;
  Contestant* reference_;
  EmbeddingTest embedding_;
  std::map<std::size_t, bool> embedded_;  // by interval
  std::deque<SectionResult> results_;
  std::size_t timed_results_ = 0;  // of the first of them
  Answered timed_;                 // the last timed answer, which keeps its memory
};

}  // namespace cscd::bench
