#include "bench/answer/answer.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "bench/rows/catalogue.h"
#include "core/base/error.h"
#include "core/fast/embedding.h"

namespace cscd::bench {
namespace {

// The most crossing pairs that are kept of one pose, eight bytes each. A surface with more has collapsed.
constexpr std::size_t kMostCrossings = std::size_t{1} << 22;
// Each pair that crosses at rest explains its neighbourhood, which takes a few hundred bytes.
constexpr std::size_t kMostLeftOut = 500'000;
// From more contacts than this it is quicker to look at the whole surface again.
constexpr std::size_t kMostFollowed = 20'000;

bool same_bits(std::span<const Vec3> a, std::span<const Vec3> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

class Stopwatch {
 public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - from_).count();
  }

 private:
  std::chrono::steady_clock::time_point from_ = std::chrono::steady_clock::now();
};

bool decided(const Contact& contact) {
  return contact.verdict == Verdict::contact;
}

IntervalVerdict verdict_of(const IntervalAnswer& answer) {
  if (answer.start.total > 0) return IntervalVerdict::intersects_at_start;
  if (std::any_of(answer.found.contacts.begin(), answer.found.contacts.end(), decided))
    return IntervalVerdict::touches;
  return answer.found.contacts.empty() ? IntervalVerdict::clear : IntervalVerdict::undecided;
}

}  // namespace

std::string_view to_string(IntervalVerdict verdict) {
  switch (verdict) {
    case IntervalVerdict::clear:
      return "clear";
    case IntervalVerdict::touches:
      return "touches";
    case IntervalVerdict::intersects_at_start:
      return "intersects_at_start";
    case IntervalVerdict::undecided:
      return "undecided";
  }
  return "";
}

std::optional<double> IntervalAnswer::time() const {
  const auto first = std::find_if(found.contacts.begin(), found.contacts.end(), decided);
  return first == found.contacts.end() ? std::nullopt : std::optional(first->time);
}

Answerer::Answerer(Input& input, const Strategy& strategy, const ElementaryTest& elementary,
                   const AnswerOptions& options)
    : input_(input),
      elementary_(elementary),
      options_(options),
      poses_({input.mesh, input.reference}, kMostCrossings) {
  find_crossings(input.rest());
  rest_ = poses_.crossings();
  rest_ms_ = searched_ms_;
  if (!options.keep_rest_crossings) {
    if (rest_.total > kMostLeftOut)
      throw InputError(
          input.name + ": " + std::to_string(rest_.total) +
          " pairs of triangles cross at rest, too many to leave out; repair the surface, or pass "
          "--keep-rest-crossings");
    left_out_ = RestCrossings(input.mesh, rest_);
  }
  const Stopwatch preparing;
  main_ = make(strategy);
  preparation_ms_ = preparing.milliseconds();
}

Answerer::Row Answerer::make(const Strategy& strategy) const {
  // With pairs left out, the earliest contact may be one of theirs, and then later contacts are asked for.
  Prepared prepared = strategy.make(input_.setup(elementary_, options_.first && left_out_.empty()));
  return {&strategy, std::move(prepared.detector), prepared.preparation.threads};
}

Answerer::Row& Answerer::stand_in() {
  if (!stand_in_) stand_in_ = make(complete_stand_in());
  return *stand_in_;
}

bool Answerer::finds_all(const Row& row) const {
  const bool first_only = options_.first && left_out_.empty();
  return row.strategy->guarantee == Guarantee::complete && !row.strategy->own_test &&
         elementary_.apart_is_proof && !first_only;
}

// The fast test is prepared once the plain one has taken as long as that preparation may take, which is about
// as long as the strategy's. So a clip whose starts are nearly all known from the intervals before them is
// spared the preparation, and no clip takes more than twice the time that the better choice would take.
void Answerer::find_crossings(std::span<const Vec3> pose) {
  if (!searches_fast_ && main_.detector && searched_ms_ > preparation_ms_) {
    poses_.use(make_embedding_test(input_.setup(elementary_)));
    searches_fast_ = true;
  }
  const Stopwatch searching;
  poses_.find(pose);
  searched_ms_ += searching.milliseconds();
}

// Finds which triangles cross at the start. The interval before may have left that known. Otherwise it
// follows from the straight way that leads here from the last known pose, if little touches on that way, or
// it is found from nothing.
void Answerer::know_start(const scenes::ClipInterval& interval) {
  const std::span<const Vec3> start = interval.motion.start();
  const auto keep_bones = [&] {
    if (interval.bones) pose_bones_.assign(interval.bones->start.begin(), interval.bones->start.end());
  };
  if (poses_.knows(start)) {
    keep_bones();
    return;
  }
  const bool embedded = poses_.crossings().total == 0;
  const bool provable = elementary_.apart_is_proof && !main_.strategy->own_test &&
                        (finds_all(main_) || (embedded && main_.strategy->guarantee != Guarantee::heuristic));
  const bool has_bones = !interval.bones || pose_bones_.size() == interval.bones->start.size();
  if (!provable || !has_bones || same_bits(touched_end_, start)) {
    find_crossings(start);
    keep_bones();
    return;
  }
  std::optional<Rig::Interval> bones;
  if (interval.bones) bones = Rig::Interval{pose_bones_, interval.bones->start};
  ContactSet touched;
  main_.detector->detect(Motion(poses_.positions(), start), bones && input_.use_bones ? &*bones : nullptr,
                         touched);
  const bool all_known = touched.contacts.empty() || finds_all(main_);
  if (all_known && touched.contacts.size() <= kMostFollowed)
    poses_.follow(start, touched);
  else
    find_crossings(start);
  keep_bones();
}

// Keeps what an interval proves about its end. `found` holds everything that the row found.
void Answerer::know_end(const scenes::ClipInterval& interval, const Row& row, const ContactSet& found) {
  const std::span<const Vec3> end = interval.motion.end();
  const bool embedded = poses_.crossings().total == 0;
  const bool nothing_touched = found.contacts.empty() && embedded && elementary_.apart_is_proof &&
                               !row.strategy->own_test && row.strategy->guarantee != Guarantee::heuristic;
  if (nothing_touched || (finds_all(row) && found.contacts.size() <= kMostFollowed)) {
    poses_.follow(end, found);
    touched_end_.clear();
    if (interval.bones) pose_bones_.assign(interval.bones->end.begin(), interval.bones->end.end());
  } else {
    touched_end_.assign(end.begin(), end.end());
  }
}

std::size_t Answerer::leave_out(ContactSet& found) const {
  if (left_out_.empty()) return 0;
  return std::erase_if(found.contacts,
                       [&](const Contact& contact) { return left_out_.explains(contact.pair); });
}

IntervalAnswer Answerer::answer(std::size_t index) {
  const Stopwatch loading;
  const scenes::ClipInterval interval = input_.clip->load(index);
  const Stopwatch whole;
  const Rig::Interval* bones = interval.bones && input_.use_bones ? &*interval.bones : nullptr;
  IntervalAnswer answer;
  answer.index = index;
  answer.load_ms = loading.milliseconds();

  const Stopwatch deciding;
  know_start(interval);
  answer.embedding_ms = deciding.milliseconds();
  const Crossings& crossing = poses_.crossings();
  answer.starts_embedded = crossing.total == 0;
  answer.start = crossing;
  answer.rest_pairs =
      std::erase_if(answer.start.pairs, [&](const CrossingPair& pair) { return left_out_.explains(pair); });
  answer.start.total -= answer.rest_pairs;

  const bool needs_start = main_.strategy->guarantee == Guarantee::first_contact && !options_.unproven;
  const auto ask = [&](Row& row) -> const Row& {
    answer.strategy = row.strategy;
    answer.report = row.detector->detect(interval.motion, bones, answer.found);
    know_end(interval, row, answer.found);
    answer.rest_contacts = leave_out(answer.found);
    return row;
  };
  const Row* row = &ask(needs_start && !answer.starts_embedded ? stand_in() : main_);
  // A row that promises the first contact may miss those after it. If that first one is left out as a
  // crossing at rest, the answer has to come from a complete row.
  if (needs_start && answer.rest_contacts > 0 && row == &main_) row = &ask(stand_in());

  answer.found.sort();
  if (options_.first) keep_first(answer.found);
  answer.verdict = verdict_of(answer);
  const Guarantee guarantee = row->strategy->guarantee;
  answer.proven = elementary_.apart_is_proof &&
                  (guarantee == Guarantee::complete || (guarantee == Guarantee::first_contact &&
                                                        answer.starts_embedded && answer.rest_contacts == 0));
  answer.wall_ms = whole.milliseconds();
  return answer;
}

}  // namespace cscd::bench
