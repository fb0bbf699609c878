#include "core/session/session.h"

#include <algorithm>
#include <cstring>

#include "core/base/error.h"
#include "core/detect/exclusions.h"
#include "core/fast/embedding.h"

namespace cscd {
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
  if (!options.ignore_starts) find_crossings(rest);
  rest_ = poses_.crossings();
  rest_ms_ = searched_ms_;
  if (!options.keep_rest_crossings) {
    if (rest_.total > kMostLeftOut)
      throw InputError(
          name + ": " + std::to_string(rest_.total) +
          " pairs of triangles cross at rest, too many to leave out; repair the surface, or pass "
          "--keep-rest-crossings");
    left_out_ = RestCrossings(setup.mesh, rest_);
  }
  const Stopwatch preparing;
  main_ = make(strategy);
  preparation_ms_ = preparing.milliseconds();
}

Session::Row Session::make(const Strategy& strategy) const {
  // With pairs left out, the earliest contact may be one of theirs, and then later contacts are asked for.
  Setup setup = setup_;
  setup.first_only = first_only();
  Prepared prepared = strategy.make(setup);
  return {&strategy, std::move(prepared.detector), prepared.preparation.threads};
}

Session::Row& Session::stand_in() {
  if (!stand_in_) stand_in_ = make(stand_in_strategy_);
  return *stand_in_;
}

bool Session::finds_all(const Row& row) const {
  return row.strategy->guarantee == Guarantee::complete && !row.strategy->own_test && can_follow() &&
         !first_only();
}

// The fast test is prepared once the plain one has taken as long as that preparation may take, which is about
// as long as the strategy's. So a clip whose starts are nearly all known from the steps before them is spared
// the preparation, and no clip takes more than twice the time that the better choice would take.
void Session::find_crossings(std::span<const Vec3> pose) {
  if (!searches_fast_ && main_.detector && searched_ms_ > preparation_ms_) {
    poses_.use(make_embedding_test(setup_));
    searches_fast_ = true;
  }
  const Stopwatch searching;
  poses_.find(pose);
  searched_ms_ += searching.milliseconds();
}

// Finds which triangles cross at the start. The step before may have left that known. Otherwise it follows
// from the straight way that leads here from the last known pose, if little touches on that way, or it is
// found from nothing.
void Session::know_start(std::span<const Vec3> start, const Rig::Interval* bones) {
  if (!moved_on_ && !poses_.knows(start)) follow_to(start, bones);
  if (bones != nullptr) pose_bones_.assign(bones->start.begin(), bones->start.end());
}

void Session::follow_to(std::span<const Vec3> start, const Rig::Interval* bones) {
  const bool embedded = poses_.crossings().total == 0;
  const bool provable = can_follow() && !main_.strategy->own_test &&
                        (finds_all(main_) || (embedded && main_.strategy->guarantee != Guarantee::heuristic));
  const bool has_bones = bones == nullptr || pose_bones_.size() == bones->start.size();
  if (!provable || !has_bones || same_bits(touched_end_, start)) return find_crossings(start);
  std::optional<Rig::Interval> way;
  if (bones != nullptr && setup_.rig != nullptr) way = Rig::Interval{pose_bones_, bones->start};
  main_.detector->detect(Motion(poses_.positions(), start), way ? &*way : nullptr, touched_);
  const bool all_known = touched_.contacts.empty() || finds_all(main_);
  if (all_known && touched_.contacts.size() <= kMostFollowed)
    poses_.follow(start, touched_);
  else
    find_crossings(start);
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

std::size_t Session::leave_out(ContactSet& found) const {
  if (left_out_.empty()) return 0;
  return std::erase_if(found.contacts,
                       [&](const Contact& contact) { return left_out_.explains(contact.pair); });
}

const Session::Row& Session::ask(Row& row, const Motion& motion, const Rig::Interval* bones,
                                 StepAnswer& out) {
  out.strategy = row.strategy;
  out.report = row.detector->detect(motion, setup_.rig != nullptr ? bones : nullptr, out.found);
  if (!options_.ignore_starts) know_end(motion, bones, row, out.found);
  out.rest_contacts = leave_out(out.found);
  return row;
}

void Session::look_at_start(const Motion& motion, const Rig::Interval* bones, StepAnswer& out) {
  know_start(motion.start(), bones);
  out.start = poses_.crossings();
  out.starts_embedded = out.start.total == 0;
  if (setup_.exclusions != nullptr)
    out.start.total -= std::erase_if(out.start.pairs, [&](const CrossingPair& pair) {
      return setup_.exclusions->excludes(setup_.mesh, TrianglePair{pair.first, pair.second});
    });
  out.rest_pairs =
      std::erase_if(out.start.pairs, [&](const CrossingPair& pair) { return left_out_.explains(pair); });
  out.start.total -= out.rest_pairs;
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
  if (!options_.ignore_starts) look_at_start(motion, bones, out);
  out.embedding_ms = whole.milliseconds();

  const bool needs_start = main_.strategy->guarantee == Guarantee::first_contact && !options_.unproven;
  const Row* row = &ask(needs_start && !out.starts_embedded ? stand_in() : main_, motion, bones, out);
  // A row that promises the first contact may miss those after it. If that first one is left out as a
  // crossing at rest, the answer has to come from a complete row.
  if (needs_start && out.rest_contacts > 0 && row == &main_) row = &ask(stand_in(), motion, bones, out);

  out.found.sort();
  if (options_.first) keep_first(out.found);
  const Guarantee guarantee = row->strategy->guarantee;
  out.proven = setup_.elementary.apart_is_proof &&
               (guarantee == Guarantee::complete ||
                (guarantee == Guarantee::first_contact && out.starts_embedded && out.rest_contacts == 0));
  out.wall_ms = whole.milliseconds();
}

}  // namespace cscd
