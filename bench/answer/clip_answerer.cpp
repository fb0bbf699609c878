#include "bench/answer/clip_answerer.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "bench/inputs/ignore.h"
#include "bench/inputs/thickness.h"
#include "bench/output/output.h"
#include "bench/output/progress.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/base/stopwatch.h"

namespace cscd::bench {
namespace {

// The seconds that one interval of an imported file may take, unless the user sets a limit. Scenes and point
// caches were made for this program and have no limit.
constexpr double kImportedIntervalSeconds = 60;

double patience_of(const AnswerRequest& request, const Input& input) {
  return request.interval_seconds.value_or(input.import ? kImportedIntervalSeconds : 0);
}

// The one pose of a file is asked about as it is, whatever is left out of motions. Of a clip of one pose
// beside clips that move, what crosses at rest is left out as of those.
AnswerRequest as_input_allows(AnswerRequest request, const Input& input) {
  const auto moves = [](const scenes::ImportReport::Clip& clip) { return clip.frames > 1; };
  const bool has_rest =
      input.import && !input.clip->header().rest.empty() && std::ranges::any_of(input.import->clips, moves);
  if (input.is_one_pose && !has_rest) request.answers.keep_rest_crossings = true;
  return request;
}

// Returns what an earlier run left in the file; nothing if there is no such file yet.
std::vector<std::byte> read_preparation(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (file.bad()) throw InputError("--preparation " + path + ": cannot be read");
  const auto bytes = std::as_bytes(std::span(text));
  if (bytes.empty()) throw InputError("--preparation " + path + ": is empty; remove it");
  return {bytes.begin(), bytes.end()};
}

Input as_asked(Input input, const AnswerRequest& request) {
  input.threads = request.threads;
  ignore(input, request.ignored);
  set_thickness(input, request.thickness);
  if (!request.preparation.empty()) input.preparation = read_preparation(request.preparation);
  return input;
}

std::vector<const Strategy*> strategies_of(const AnswerRequest& request, const Input& input) {
  if (request.strategies.empty()) return {&default_strategy(input, request.answers.first)};
  std::vector<const Strategy*> out;
  for (const std::string& name : request.strategies) out.push_back(&strategy_named(name));
  return out;
}

// All strategies see the same starts, and the true motion is the same beside all of them.
void share_start(const Input& input, const IntervalAnswer& first, IntervalAnswer& answer) {
  answer.start = first.start;
  answer.start_touching = first.start_touching;
  answer.motion = first.motion;
  answer.verdict = verdict_of(answer, input.thickness.length > 0);
}

}  // namespace

ClipAnswerer::ClipAnswerer(const AnswerRequest& request, Input input)
    : request_(as_input_allows(request, input)),
      input_(as_asked(std::move(input), request_)),
      elementary_(elementary_test_named(request_.elementary)),
      names_(input_),
      range_(parse_frames(request_.frames, input_)),
      watchdog_(patience_of(request_, input_), "cscd: " + request_.input +
                                                   ": an interval, or the preparation, took more than " +
                                                   nlohmann::json(patience_of(request_, input_)).dump() +
                                                   " s; raise --interval-seconds to wait longer") {
  const std::vector<const Strategy*> strategies = strategies_of(request_, input_);
  answerers_.reserve(strategies.size());
  for (const Strategy* strategy : strategies) {
    watchdog_.restart();
    answerers_.push_back(prepare(*strategy));
    answers_.push_back(
        prepared_answer(input_, names_, *strategy, elementary_, request_.answers, answerers_.back()));
  }
  if (!request_.preparation.empty()) keep_preparation();
  const Answerer& first = answerers_.front();
  if (input_.motion)
    true_motion_.emplace(input_, elementary_, first.rest_crossings(), request_.answers, request_.resolution);
  events_.emplace(input_, names_, first);
}

// The engine knows what is wrong with a kept preparation, but not in which file that is.
Answerer ClipAnswerer::prepare(const Strategy& strategy) {
  constexpr std::string_view kBegin = "preparation: ";
  try {
    return Answerer(input_, strategy, elementary_, request_.answers);
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (input_.preparation.empty() || !what.starts_with(kBegin)) throw;
    throw InputError("--preparation " + request_.preparation + ": " + what.substr(kBegin.size()));
  }
}

void ClipAnswerer::keep_preparation() const {
  const Answerer& answerer = answerers_.front();
  const std::string& path = request_.preparation;
  if (input_.preparation.empty()) {
    const std::vector<std::byte> bytes = answerer.saved_preparation();
    if (bytes.empty())
      throw InputError("--preparation " + path + ": strategy " + std::string(answers_.front().strategy.name) +
                       " has no preparation worth keeping; leave the option out");
    OutputFile(path, false, ".preparation")
        .commit({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  if (answerer.new_triangles() > 0)
    std::printf("preparation %s: %zu of %zu triangles are new since it was kept, and were prepared now\n",
                path.c_str(), answerer.new_triangles(), input_.mesh.triangle_count());
}

void ClipAnswerer::answer_all(const std::string& task, bool with_displacements,
                              const std::function<void(const AnsweredPose&)>& visit) {
  Progress progress(task, range_.last - range_.first);
  for (std::size_t i = range_.first; i < range_.last; ++i) {
    const Stopwatch loading;
    const scenes::ClipInterval interval = input_.clip->load(i);
    const double load_ms = loading.milliseconds();
    std::vector<IntervalAnswer> answers;
    OverlapEvents::Here here;
    for (std::size_t s = 0; s < answerers_.size(); ++s) {
      watchdog_.restart();
      IntervalAnswer& answer = answers.emplace_back(answerers_[s].answer(i, interval));
      answer.load_ms = load_ms;
      if (s == 0) {
        here = events_->add(answer, interval.motion.start(),
                            {.displacements = with_displacements, .pieces = request_.new_contacts});
        if (true_motion_) true_motion_->answer(interval.motion, answer);
      } else {
        share_start(input_, answers.front(), answer);
      }
    }
    for (std::size_t s = 0; s < answers.size(); ++s) {
      if (request_.new_contacts) keep_new(input_, here.pieces, answers[s]);
      answers_[s].true_motion.add(answers[s], names_);
      answers_[s].summary.add(answers[s], interval.motion, names_);
    }
    visit({i, interval, answers, here, answers.front().start});
    progress.advance();
  }
  watchdog_.restart();
  const scenes::FrameView pose = input_.clip->load_frame(range_.last);
  scenes::ClipInterval resting{Motion(pose.positions, pose.positions), std::nullopt};
  if (!pose.bones.empty()) resting.bones = Rig::Interval{pose.bones, pose.bones};
  IntervalAnswer last;
  OverlapEvents::Here here;
  if (!input_.is_one_pose) {  // else the intervals start in that pose
    last = answerers_.front().answer(range_.last, resting);
    last.found.contacts.clear();  // those of the pose are no contacts of an interval
    last.touching.clear();
    here = events_->add(last, pose.positions,
                        {.displacements = with_displacements, .pieces = request_.new_contacts});
    if (request_.new_contacts) keep_new(input_, here.pieces, last);
  }
  for (ClipAnswer& answer : answers_) {
    if (!input_.is_one_pose) answer.last_pose = last;
    answer.events = events_->all();
    answer.not_measured = events_->not_measured();
    answer.summary.overlap_ms = events_->milliseconds();
  }
  visit({range_.last, resting, {}, here, last.start});
}

void for_each_clip(const AnswerRequest& request, Input first,
                   const std::function<void(std::size_t, Input)>& take,
                   const std::function<void(std::size_t)>& pass_over) {
  const std::vector<scenes::ImportReport::Clip> clips = first.import->clips;
  const long opened = first.import->chosen_clip;
  const char* const kRemedy = "; name one with --clip (cscd inspect lists them)";
  if (!request.frames.empty())
    throw InputError("--frames " + request.frames + ": is for one clip, and " + request.input + " has " +
                     std::to_string(clips.size()) + kRemedy);
  if (!request.preparation.empty()) throw InputError("--preparation: is for one clip" + std::string(kRemedy));
  ModelOptions model = request.model;
  model.import.clip.clear();
  const auto moves = [&](const scenes::ImportReport::Clip& clip) {
    return clip.frames > 1 || model.import.from_bind_pose;
  };
  const bool something_moves = std::ranges::any_of(clips, moves);
  for (std::size_t clip = 0; clip < clips.size(); ++clip) {
    if (model.true_motion && something_moves && !moves(clips[clip])) {
      pass_over(clip);
      continue;
    }
    model.import.clip_number = clip;
    name_input(request.input, [&] {
      take(clip, opened == static_cast<long>(clip) ? std::move(first) : open_input(request.input, model));
    });
  }
}

}  // namespace cscd::bench
