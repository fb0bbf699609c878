#include "bench/answer/clip_answer.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "bench/inputs/thickness.h"

namespace cscd::bench {
namespace {

NamePair in_order(std::string a, std::string b) {
  if (b < a) std::swap(a, b);
  return {std::move(a), std::move(b)};
}

// Whether any vertex moves by more than rounding. A clip may drive a camera alone, or hold a pose.
bool is_moving(const Motion& motion) {
  constexpr double kRounding = 1e-9;  // of the largest coordinate
  double most = 0, farthest = 0;
  for (std::size_t v = 0; v < motion.start().size(); ++v) {
    most = std::max(most, motion.start()[v].cwiseAbs().maxCoeff());
    farthest = std::max(farthest, (motion.end()[v] - motion.start()[v]).cwiseAbs().maxCoeff());
  }
  return farthest > kRounding * most;
}

}  // namespace

std::optional<double> second_of(const Input& input, const ClipMoment& moment) {
  if (!input.import) return std::nullopt;
  const std::size_t frames = input.clip->frame_count();
  const double from = second_of_frame(*input.import, moment.interval, frames);
  const double to = second_of_frame(*input.import, moment.interval + 1, frames);
  return (1 - moment.time) * from + moment.time * to;
}

double frame_of(const Input& input, const ClipMoment& moment) {
  const std::optional<double> seconds = second_of(input, moment);
  return seconds ? frame_at(*input.import, *seconds) : static_cast<double>(moment.interval) + moment.time;
}

void AnswerSummary::add(const IntervalAnswer& answer, const Motion& motion, const SurfaceNames& names) {
  moves = moves || is_moving(motion);
  if (intervals() == 0) first_index = answer.index;
  last_index = answer.index;
  verdicts.add(answer.verdict);
  ++strategies[std::string(answer.strategy->name)];
  proven += answer.proven;
  with_left_out += answer.rest_pairs + answer.rest_contacts > 0;
  left_out_contacts += answer.rest_contacts;
  old_pairs += answer.old_pairs;
  old_contacts += answer.old_contacts;
  with_old += answer.old_pairs + answer.old_contacts > 0;
  close_at_start += answer.close_at_start;
  with_close_at_start += answer.close_at_start > 0;
  add_ignored(answer, names);
  embedding_ms += answer.embedding_ms;
  query_ms += answer.report.ms.total();
  load_ms += answer.load_ms;
  wall_ms += answer.wall_ms;
  if (answer.verdict == IntervalVerdict::clear && first) parted_ = true;
  if (answer.verdict == IntervalVerdict::clear || answer.verdict == IntervalVerdict::undecided) return;

  const bool meets_at_start = answer.start.total + answer.start_touching.total > 0;
  const ClipMoment moment{answer.index, meets_at_start ? 0 : answer.time().value_or(0)};
  if (first && !meets_at_start && moment.time > 0) parted_ = true;
  // With a thickness, what touches later is close first.
  const bool is_close_first = !meets_at_start && !answer.touching.empty();
  const IntervalVerdict how = is_close_first ? IntervalVerdict::close : answer.verdict;
  const std::size_t contacts =
      static_cast<std::size_t>(std::count_if(answer.found.contacts.begin(), answer.found.contacts.end(),
                                             [](const Contact& c) { return c.verdict == Verdict::contact; }));
  if (!worst || std::tie(answer.start.total, contacts) > std::tie(worst->start_pairs, worst->contacts))
    worst = Worst{moment, answer.start.total, contacts};

  std::set<NamePair> here;
  const auto meet = [&](std::string x, std::string y, double time, IntervalVerdict manner) -> Met& {
    if (!first) first = Meeting{moment, how, {x, y}};
    if (parted_ && !first_after_parting) first_after_parting = Meeting{moment, how, {x, y}};
    const Meeting meeting{{answer.index, time}, manner, {x, y}};
    NamePair both = in_order(std::move(x), std::move(y));
    Met& entry = met.try_emplace(both, Met{.first = meeting}).first->second;
    if (entry.first.moment.interval == answer.index && time < entry.first.moment.time) entry.first = meeting;
    entry.intervals += here.insert(std::move(both)).second;
    return entry;
  };
  for (const CrossingPair& pair : answer.start.pairs)
    ++meet(names.place_of(pair.first), names.place_of(pair.second), 0, IntervalVerdict::intersects_at_start)
          .start_pairs;
  for (const CrossingPair& pair : answer.start_touching.pairs)
    meet(names.place_of(pair.first), names.place_of(pair.second), 0, IntervalVerdict::touches);
  for (const Contact& contact : answer.found.contacts)
    if (contact.verdict == Verdict::contact)
      ++meet(names.place_of(contact.pair, false), names.place_of(contact.pair, true), contact.time,
             is_thick ? IntervalVerdict::close : IntervalVerdict::touches)
            .contacts;
  if (!first) first = Meeting{moment, how, {"the surface", "the surface"}};
}

void AnswerSummary::add_ignored(const IntervalAnswer& answer, const SurfaceNames& names) {
  std::set<NamePair> here;
  const auto meet = [&](std::string x, std::string y) -> IgnoredHere& {
    const auto [one, added] = here.insert(in_order(std::move(x), std::move(y)));
    IgnoredHere& entry = ignored[*one];
    entry.intervals += added;
    return entry;
  };
  for (const CrossingPair& pair : answer.ignored_pairs)
    ++meet(names.place_of(pair.first), names.place_of(pair.second)).start_pairs;
  for (const Contact& contact : answer.ignored.contacts)
    if (contact.verdict == Verdict::contact)
      ++meet(names.place_of(contact.pair, false), names.place_of(contact.pair, true)).contacts;
  with_ignored += !here.empty();
}

bool ClipAnswer::only_folds(const NamePair& both) const {
  if (!joints.join(both)) return false;
  const NamePair swapped{both.second, both.first};
  return std::ranges::none_of(events, [&](const OverlapEvent& event) {
    return (event.names == both || event.names == swapped) && !joints.fold(event);
  });
}

const AnswerSummary::Meeting* ClipAnswer::first_named() const {
  if (!summary.first || !only_folds(summary.first->names)) return summary.first ? &*summary.first : nullptr;
  const AnswerSummary::Meeting* found = nullptr;
  const auto when = [](const AnswerSummary::Meeting* meeting) {
    return std::pair(meeting->moment.interval, meeting->moment.time);
  };
  for (const auto& [both, here] : summary.met)
    if (!only_folds(both) && (found == nullptr || when(&here.first) < when(found))) found = &here.first;
  return found != nullptr ? found : &*summary.first;
}

std::size_t identical_triangles(const TriangleMesh& mesh) {
  const auto found =
      std::ranges::find(mesh.defects(), Defect::duplicate_triangle, &TriangleMesh::DefectReport::kind);
  return found == mesh.defects().end() ? 0 : found->count;
}

ClipAnswer prepared_answer(const Input& input, const SurfaceNames& names, const Strategy& strategy,
                           const ElementaryTest& elementary, const AnswerOptions& options,
                           const Answerer& answerer) {
  ClipAnswer out{input,
                 names,
                 strategy,
                 elementary,
                 options.first,
                 !options.keep_rest_crossings,
                 answerer.threads(),
                 answerer.preparation_ms(),
                 answerer.rest_crossings(),
                 answerer.rest_touching()};
  if (const Exclusions* const left_out = input.thickness.left_out.get())
    out.kept_at_rest = close_at_rest(input, left_out).contacts.size();
  out.summary.is_thick = input.thickness.length > 0;
  out.joints = Joints(input, names);
  return out;
}

}  // namespace cscd::bench
