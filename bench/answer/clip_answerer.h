#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/answer/answer_request.h"
#include "bench/answer/clip_answer.h"
#include "bench/answer/overlap_events.h"
#include "bench/answer/true_answer.h"
#include "bench/inputs/watchdog.h"

namespace cscd::bench {

// A pose of a clip that has been answered: the start of an interval, or the end of the last one. Views are
// valid until the next pose.
struct AnsweredPose {
  std::size_t frame = 0;
  const scenes::ClipInterval& interval;     // that starts there; of the last pose, one that rests in it
  std::span<const IntervalAnswer> answers;  // [strategies]; none of the last pose
  // What overlaps in the pose. Triangles that cross are those of `crossing`.
  const OverlapEvents::Here& here;
  const Crossings& crossing;

  bool is_last() const { return answers.empty(); }
};

// Answers a clip as commands are asked about it: each interval is loaded once, whatever strategies answer it
// and whatever is made of the answers.
class ClipAnswerer {
 public:
  // Prepares the strategies, and says on standard output how much of a kept preparation was new. Throws
  // InputError.
  ClipAnswerer(const AnswerRequest& request, Input input);

  const Input& input() const { return input_; }
  const SurfaceNames& names() const { return names_; }
  const IntervalRange& range() const { return range_; }
  // [strategies], of the poses that have been answered.
  std::span<const ClipAnswer> answers() const { return answers_; }
  // Where all vertices are at a second of the clip in its true motion, which has to be asked for.
  std::span<const Vec3> true_positions_at(double seconds) { return true_motion_->positions_at(seconds); }

  // Answers all poses in order and hands each to `visit`. Progress is shown of `task`. With
  // `with_displacements`, each region holds the displacement out of the other piece for each of its vertices.
  void answer_all(const std::string& task, bool with_displacements,
                  const std::function<void(const AnsweredPose&)>& visit);

 private:
  Answerer prepare(const Strategy& strategy);
  void keep_preparation() const;

  AnswerRequest request_;
  Input input_;
  const ElementaryTest& elementary_;
  SurfaceNames names_;
  IntervalRange range_;
  Watchdog watchdog_;
  std::vector<Answerer> answerers_;  // [strategies]
  std::vector<ClipAnswer> answers_;
  std::optional<TrueAnswerer> true_motion_;
  std::optional<OverlapEvents> events_;
};

// Hands each clip of a model file to `take`, by its number and opened, in the order of the file. Where the
// true motion is asked, clips of one pose, which have none, go to `pass_over` unless all are such. `first` is
// the file with one of its clips opened, or as a survey. Throws InputError where what is asked is about one
// clip.
void for_each_clip(const AnswerRequest& request, Input first,
                   const std::function<void(std::size_t, Input)>& take,
                   const std::function<void(std::size_t)>& pass_over);

}  // namespace cscd::bench
