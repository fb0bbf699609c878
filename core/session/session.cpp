#include "core/session/session.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/detect/exclusions.h"

namespace cscd {
namespace {

// The most crossing pairs that are kept of one pose, eight bytes each. A surface with more has collapsed.
constexpr std::size_t kMostCrossings = std::size_t{1} << 22;
// Each pair that crosses at rest explains its neighbourhood, which takes a few hundred bytes.
constexpr std::size_t kMostLeftOut = 500'000;
// From more contacts than this it is quicker to look at the whole surface again.
constexpr std::size_t kMostFollowed = 20'000;
// Preparing the stand-in takes about as long as this many plain searches for crossings, or twice as many.
constexpr std::size_t kPlainSearches = 16;

}  // namespace

std::optional<double> StepAnswer::time() const {
  const auto first = std::ranges::find(found.contacts, Verdict::contact, &Contact::verdict);
  return first == found.contacts.end() ? std::nullopt : std::optional(first->time);
}

Session::Session(const std::string& name, const Setup& setup, const Strategy& strategy,
                 const Strategy& stand_in, std::span<const Vec3> rest, const SessionOptions& options)
    : setup_(setup),
      stand_in_strategy_(stand_in),
      options_(options),
      poses_({setup.mesh, setup.reference}, kMostCrossings) {
  if (!strategy.sees_start) find_rest_crossings(name, rest);
  const Stopwatch preparing;
  main_ = make(strategy);
  preparation_ms_ = preparing.milliseconds();
  if (!strategy.sees_start) return;
  find_rest_crossings(name, rest);
  if (options.first && !left_out_.empty()) main_ = make(strategy);  // to be asked for all contacts instead
}

void Session::find_rest_crossings(const std::string& name, std::span<const Vec3> rest) {
  const Stopwatch searching;
  if (!options_.ignore_starts) find_crossings(rest, nullptr);
  rest_ = poses_.crossings();
  rest_ms_ = searching.milliseconds();
  if (options_.keep_rest_crossings) return;
  if (rest_.total > kMostLeftOut)
    throw InputError(name + ": " + std::to_string(rest_.total) +
                     " pairs of triangles cross at rest, too many to leave out; repair the surface, or pass "
                     "--keep-rest-crossings");
  left_out_ = RestCrossings(setup_.mesh, rest_);
}

Session::Row Session::make(const Strategy& strategy) const {
  // With pairs left out, the earliest contact may be one of theirs, and then later contacts are asked for.
  Setup setup = setup_;
  setup.first_only = first_only();
  Prepared prepared = strategy.make(setup);
  return {&strategy, std::move(prepared.detector), prepared.preparation.threads,
          prepared.preparation.new_triangles};
}

Session::Row& Session::stand_in() {
  if (!stand_in_) stand_in_ = make(stand_in_strategy_);
  return *stand_in_;
}

bool Session::finds_all(const Row& row) const {
  return promises_all(row.strategy->guarantee, poses_.crossings().total == 0) && !row.strategy->own_test &&
         can_follow() && !first_only();
}

// Chooses the row that answers a step, and sees to it that what crosses at the start is known, or that the
// row finds it with its answer.
Session::Row& Session::row_for(const Motion& motion, const Rig::Interval* bones) {
  start_known_ = options_.ignore_starts || moved_on_ || poses_.knows(motion.start());
  if (options_.ignore_starts) return main_;
  const bool sees_start = main_.strategy->sees_start;
  const bool worth_following = !sees_start || signs_pay();
  if (!start_known_ && !(worth_following && follow_to(motion.start(), bones))) {
    if (sees_start) return main_;
    if (needs_start() && stand_in_pays()) return stand_in();
    find_crossings(motion.start(), bones);
  }
  start_known_ = true;
  return needs_start() && poses_.crossings().total > 0 ? stand_in() : main_;
}

bool Session::signs_pay() const {
  return main_.strategy->looks_by_signs && setup_.mesh.closed_and_oriented();
}

// A complete row that sees starts answers from a start that is not known in less time than it takes to search
// that start apart. It is prepared for that after so many plain searches that they have taken about as long
// as its preparation. So a clip whose starts are nearly all known from the steps before them is spared the
// preparation, and no clip takes much more than twice the time that the better choice would take. Searches
// are counted and not timed, so that the same questions get the same answers from the same row.
bool Session::stand_in_pays() const {
  return stand_in_strategy_.sees_start && (stand_in_ || searches_ >= kPlainSearches);
}

void Session::find_crossings(std::span<const Vec3> pose, const Rig::Interval* bones) {
  const bool by_main = main_.detector && main_.strategy->sees_start;
  if (by_main || stand_in_pays()) {
    Row& row = by_main ? main_ : stand_in();
    std::optional<Rig::Interval> rest;
    if (bones != nullptr && setup_.rig != nullptr) rest = Rig::Interval{bones->start, bones->start};
    row.detector->detect({.motion = Motion(pose, pose),
                          .bones = rest ? &*rest : nullptr,
                          .crossings = &seen_,
                          .most_crossings = poses_.most()},
                         touched_);
    poses_.know(pose, seen_);
  } else {
    poses_.find(pose);
  }
  ++searches_;
}

// Finds what crosses at the start from the straight way that leads there from the last known pose. Returns
// false where that way proves nothing, or where so much touches on it that a search is cheaper.
bool Session::follow_to(std::span<const Vec3> start, const Rig::Interval* bones) {
  const bool embedded = poses_.crossings().total == 0;
  const bool provable = can_follow() && !main_.strategy->own_test &&
                        (finds_all(main_) || (embedded && main_.strategy->guarantee != Guarantee::heuristic));
  const bool has_bones = bones == nullptr || pose_bones_.size() == bones->start.size();
  if (!provable || !has_bones || same_bits(touched_end_, start)) return false;
  std::optional<Rig::Interval> way;
  if (bones != nullptr && setup_.rig != nullptr) way = Rig::Interval{pose_bones_, bones->start};
  const Motion motion(poses_.positions(), start);
  main_.detector->detect({motion, way ? &*way : nullptr, embedded}, touched_);
  const bool all_known = touched_.contacts.empty() || finds_all(main_);
  if (!all_known || touched_.contacts.size() > kMostFollowed) return false;
  poses_.follow(start, touched_);
  return true;
}

// Keeps what a step proves about its end. `found` holds everything that the row found.
void Session::know_end(const Motion& motion, const Rig::Interval* bones, const Row& row,
                       const ContactSet& found) {
  const bool embedded = poses_.crossings().total == 0;
  const bool nothing_touched = found.contacts.empty() && embedded && can_follow() &&
                               !row.strategy->own_test && row.strategy->guarantee != Guarantee::heuristic;
  if (moved_on_ && !nothing_touched) {
    poses_.go_back(motion.start());
    moved_on_ = false;
  }
  if (nothing_touched || (finds_all(row) && found.contacts.size() <= kMostFollowed)) {
    if (!moved_on_) poses_.follow(motion.end(), found);
    touched_end_.clear();
    if (bones != nullptr) pose_bones_.assign(bones->end.begin(), bones->end.end());
  } else {
    touched_end_.assign(motion.end().begin(), motion.end().end());
  }
}

void Session::leave_out(StepAnswer& out) const {
  out.ignored.clear();
  out.rest_contacts = 0;
  if (options_.ignored == nullptr && left_out_.empty()) return;
  std::erase_if(out.found.contacts, [&](const Contact& contact) {
    const bool ignored = options_.ignored != nullptr && options_.ignored->excludes(setup_.mesh, contact.pair);
    if (ignored) out.ignored.contacts.push_back(contact);
    const bool explained = !ignored && left_out_.explains(contact.pair);
    out.rest_contacts += explained;
    return ignored || explained;
  });
}

// Asks a row, which finds what crosses at the start where that is not known.
void Session::ask(Row& row, const Motion& motion, const Rig::Interval* bones, StepAnswer& out) {
  Step asked{motion, setup_.rig != nullptr ? bones : nullptr};
  out.strategy = row.strategy;
  if (start_known_) {
    // Two looks find all contacts of a step from an embedded start, the second one only where something
    // touches. After a step in which something did, that is likely again, and one look for all is quicker.
    // For the first contact alone there is one look in either case.
    const bool embedded = !options_.ignore_starts && poses_.crossings().total == 0 && can_follow();
    asked.starts_embedded = embedded && (!touched_last_ || first_only());
    out.report = row.detector->detect(asked, out.found);
  } else {
    asked.crossings = &seen_;
    asked.most_crossings = poses_.most();
    out.report = row.detector->detect(asked, out.found);
    poses_.know(motion.start(), seen_);
    start_known_ = true;
    out.embedding_ms += out.report.start_ms;
  }
  touched_last_ = !out.found.contacts.empty();
  if (!options_.ignore_starts) {
    if (bones != nullptr) pose_bones_.assign(bones->start.begin(), bones->start.end());
    say_start(out);
    know_end(motion, bones, row, out.found);
  }
  leave_out(out);
}

void Session::say_start(StepAnswer& out) const {
  out.start = poses_.crossings();
  out.starts_embedded = out.start.total == 0;
  if (setup_.exclusions != nullptr)
    out.start.total -= std::erase_if(out.start.pairs, [&](const CrossingPair& pair) {
      return setup_.exclusions->excludes(setup_.mesh, TrianglePair{pair.first, pair.second});
    });
  out.ignored_pairs.clear();
  out.rest_pairs = 0;
  out.start.total -= std::erase_if(out.start.pairs, [&](const CrossingPair& pair) {
    const bool ignored = options_.ignored != nullptr &&
                         options_.ignored->excludes(setup_.mesh, TrianglePair{pair.first, pair.second});
    if (ignored) out.ignored_pairs.push_back(pair);
    const bool explained = !ignored && left_out_.explains(pair);
    out.rest_pairs += explained;
    return ignored || explained;
  });
}

void Session::move_on(const Motion& motion) {
  bool finite = true;
  moved_on_ = !options_.ignore_starts && poses_.move_on(motion.start(), motion.end(), finite);
  if (!options_.check_finite || (moved_on_ && finite)) return;
  if (moved_on_) poses_.go_back(motion.start());
  require_finite(motion.start(), "start positions");
  require_finite(motion.end(), "end positions");
}

void Session::step(const Motion& motion, const Rig::Interval* bones, StepAnswer& out) {
  const Stopwatch whole;
  move_on(motion);
  try {
    Row& row = row_for(motion, bones);
    out.embedding_ms = whole.milliseconds();
    ask(row, motion, bones, out);
    // A row that promises the first contact may miss those after it. If that first one is left out as a
    // crossing at rest, the answer has to come from a complete row. So it has to where something touches and
    // the caller ignores pairs, because the caller is told how many contacts are ignored.
    const bool later_missing =
        out.rest_contacts > 0 ||
        (options_.ignored != nullptr && out.found.contacts.size() + out.ignored.contacts.size() > 0);
    if (row.strategy->guarantee == Guarantee::first_contact && needs_start() && &row == &main_ &&
        later_missing)
      ask(stand_in(), motion, bones, out);
  } catch (...) {  // nothing is known of the end then
    if (moved_on_) poses_.go_back(motion.start());
    throw;
  }

  out.found.sort();
  out.ignored.sort();
  if (options_.first) keep_first(out.found);
  const Guarantee guarantee = out.strategy->guarantee;
  out.proven =
      setup_.elementary.apart_is_proof && (promises_all(guarantee, out.starts_embedded) ||
                                           (guarantee == Guarantee::first_contact && out.starts_embedded &&
                                            out.rest_contacts == 0 && out.ignored.contacts.empty()));
  out.wall_ms = whole.milliseconds();
}

}  // namespace cscd
