#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bench/answer/answer.h"
#include "bench/answer/joints.h"
#include "bench/answer/overlap_events.h"
#include "bench/answer/true_answer.h"
#include "bench/inputs/input.h"
#include "bench/inputs/surface_names.h"

namespace cscd::bench {

// A moment of a clip: inside interval `interval`, at the share `time` of it.
struct ClipMoment {
  std::size_t interval = 0;
  double time = 0;
};

// Returns the number by which people know the moment. Of a model file, frames are those of the file's time
// line (frame_at); of other inputs, they count from frame 0.
double frame_of(const Input& input, const ClipMoment& moment);
// Returns the seconds from the clip's start; nothing where the input does not tell its rate.
std::optional<double> second_of(const Input& input, const ClipMoment& moment);

// Sums up the answers to the intervals of a clip.
struct AnswerSummary {
  VerdictCounts verdicts;
  std::map<std::string, std::size_t> strategies;  // how many intervals each answered
  std::size_t proven = 0;
  std::size_t with_left_out = 0;                // intervals from which something was left out
  std::size_t left_out_contacts = 0;            // of what crosses at rest
  bool moves = false;                           // more than by rounding
  std::size_t first_index = 0, last_index = 0;  // of the intervals, which come in growing order
  // The first moment at which something touches, crosses, or comes within the thickness, and the names of
  // what meets.
  struct Meeting {
    ClipMoment moment;
    IntervalVerdict how = IntervalVerdict::touches;  // or intersects_at_start, or close
    NamePair names;
  };
  std::optional<Meeting> first;
  // The first one after an interval in which nothing met, where something had met before.
  std::optional<Meeting> first_after_parting;
  // The interval in which most goes wrong: most pairs of triangles that cross at its start, or, where none
  // cross anywhere, most contacts.
  struct Worst {
    ClipMoment moment;
    std::size_t start_pairs = 0, contacts = 0;
  };
  std::optional<Worst> worst;
  // Bones, or else parts, that met.
  struct Met {
    Meeting first;
    std::size_t intervals = 0, contacts = 0;
    std::size_t start_pairs = 0;  // of triangles that cross; where none do, they only touch or come close
  };
  std::map<NamePair, Met> met;
  // What is ignored, by bones or else parts.
  struct IgnoredHere {
    std::size_t intervals = 0, start_pairs = 0, contacts = 0;
  };
  std::map<NamePair, IgnoredHere> ignored;
  std::size_t with_ignored = 0;  // intervals in which something is
  // With --new-contacts: what is left out because it lies within events, and from how many intervals.
  std::size_t old_pairs = 0, old_contacts = 0, with_old = 0;
  // With a thickness: pairs that are close at the starts of intervals, and the number of such intervals.
  std::size_t close_at_start = 0, with_close_at_start = 0;
  bool is_thick = false;  // a contact is a close pair
  double embedding_ms = 0, query_ms = 0, load_ms = 0, wall_ms = 0, overlap_ms = 0;

  std::size_t intervals() const { return verdicts.total(); }
  IntervalVerdict verdict() const { return verdicts.worst(); }
  // `motion` is that of the interval.
  void add(const IntervalAnswer& answer, const Motion& motion, const SurfaceNames& names);

 private:
  void add_ignored(const IntervalAnswer& answer, const SurfaceNames& names);

  bool parted_ = false;  // an interval after `first` is clear
};

// What one strategy answers to a clip, or to some intervals of it. Texts (answer_text.h) and JSON
// (answer_json.h) are written from this alone.
struct ClipAnswer {
  const Input& input;
  const SurfaceNames& names;
  const Strategy& strategy;
  const ElementaryTest& elementary;
  bool first_only = false, rest_left_out = true;  // as was asked
  int threads = 1;
  double preparation_ms = 0;
  Crossings rest = {}, rest_touching = {};  // what crosses at rest, and what only touches there
  // Pairs of features that are close at rest and not left out by InputThickness; counted only where some may
  // be left out. Those are not decided.
  std::size_t kept_at_rest = 0;
  AnswerSummary summary = {};
  std::vector<OverlapEvent> events = {};  // in the order in which they begin
  std::size_t not_measured = 0;           // starts of which events say nothing (OverlapEvents)
  TrueSummary true_motion = {};           // of no interval where it was not asked for
  Joints joints = {};
  // Of the frame in which the last interval ends, as an interval that starts there; none of a file of one
  // pose.
  std::optional<IntervalAnswer> last_pose = {};

  // The worst verdict of any interval: in its true motion, where that was asked for.
  IntervalVerdict verdict() const { return input.motion ? true_motion.verdict() : summary.verdict(); }
  // Whether all that is known to meet between two places folds at a joint.
  bool only_folds(const NamePair& both) const;
  // The meeting that a verdict names: the first one, of those between places that do not only fold where
  // there are such. Nothing where nothing meets.
  const AnswerSummary::Meeting* first_named() const;
};

// How many triangles of a surface have the same three corners as another one. Two such triangles share all
// that they have, so that nothing is said of them against each other.
std::size_t identical_triangles(const TriangleMesh& mesh);

// Returns the answer of which no interval is known yet. The arguments must outlive it.
ClipAnswer prepared_answer(const Input& input, const SurfaceNames& names, const Strategy& strategy,
                           const ElementaryTest& elementary, const AnswerOptions& options,
                           const Answerer& answerer);

}  // namespace cscd::bench
