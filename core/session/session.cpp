#include "core/session/session.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/detect/exclusions.h"

namespace cscd {
namespace {

// Each pair that crosses at rest explains its neighbourhood, which takes a few hundred bytes.
constexpr std::size_t kMostLeftOut = 500'000;
// Preparing the fallback takes about as long as this many plain searches for crossings, or twice as many.
constexpr std::size_t kPlainSearches = 16;
// And about as long as this many small steps of the strategy that promises the first contact.
constexpr int kSmallSteps = 256;

// Whether something touches, or is close, at t = 0 already, or may be.
bool has_contact_at_start(const ContactSet& found) {
  return std::ranges::any_of(found.contacts, [](const Contact& contact) { return contact.time <= 0; });
}

void require_proof_for_distance(const std::string& name, const StrategyInput& setup, const Strategy& strategy,
                                const Strategy& fallback, const Thickness& thickness) {
  for (const Strategy* asked : {&strategy, &fallback}) {
    if (!asked->knows_distance)
      throw InputError(name + ": strategy " + std::string(asked->name) +
                       " has no proof for a thickness above 0; take drvbc_fast or drvbc_fast_complete");
    if (!thickness.is_uniform() && asked->guarantee == Guarantee::first_contact)
      throw InputError(name + ": strategy " + std::string(asked->name) +
                       " has no proof for pairs of different thickness; take drvbc_fast_complete");
  }
  if (!setup.elementary.knows_distance())
    throw InputError(name + ": test " + std::string(setup.elementary.name) +
                     " knows no thickness above 0; take filtered_exact");
}

}  // namespace

std::optional<double> StepAnswer::time() const {
  const auto first = std::ranges::find(found.contacts, Verdict::contact, &Contact::verdict);
  return first == found.contacts.end() ? std::nullopt : std::optional(first->time);
}

Session::Session(const std::string& name, const StrategyInput& setup, const Strategy& strategy,
                 const Strategy& fallback, std::span<const Vec3> rest, const SessionOptions& options)
    : setup_(setup),
      fallback_strategy_(fallback),
      options_(options),
      starts_(setup.mesh, setup.reference, setup.rig != nullptr, options.thickness) {
  if (is_thick()) require_proof_for_distance(name, setup, strategy, fallback, options.thickness);
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
  rest_.crossing = starts_.crossings();
  if (rest_.crossing.all_kept()) rest_ = tell_meetings_apart(setup_.mesh, rest, rest_.crossing);
  if (!options_.keep_rest_crossings) {
    if (rest_.crossing.total > kMostLeftOut)
      throw InputError(
          name + ": " + std::to_string(rest_.crossing.total) +
          " pairs of triangles cross at rest, too many to leave out; repair the surface, or pass "
          "--keep-rest-crossings");
    left_out_ = RestCrossings(setup_.mesh, rest_.crossing);
    take_touching_of_crossing();
  }
  rest_ms_ = searching.milliseconds();
}

// What touches where something crosses is left out with it, and so counts as crossing.
void Session::take_touching_of_crossing() {
  std::vector<CrossingPair>&crossing = rest_.crossing.pairs, &touching = rest_.touching.pairs;
  const auto first = std::stable_partition(
      touching.begin(), touching.end(), [&](const CrossingPair& pair) { return !left_out_.explains(pair); });
  const auto explained = static_cast<std::size_t>(touching.end() - first);
  crossing.insert(crossing.end(), first, touching.end());
  std::ranges::sort(crossing);
  rest_.crossing.total += explained;
  rest_.touching.total -= explained;
  touching.erase(first, touching.end());
}

Session::PreparedStrategy Session::make(const Strategy& strategy) const {
  // With pairs left out, the earliest contact may be one of theirs, and then later contacts are asked for.
  StrategyInput setup = setup_;
  setup.first_only = first_only();
  Prepared prepared = strategy.make(setup);
  return {&strategy, std::move(prepared.detector), prepared.preparation.threads,
          prepared.preparation.new_triangles};
}

Session::PreparedStrategy& Session::fallback() {
  if (!fallback_) fallback_ = make(fallback_strategy_);
  return *fallback_;
}

Certainty Session::certainty_of(const Strategy& strategy) const {
  if (strategy.own_test || !can_follow()) return {};
  const bool whether = starts_.clear() ? strategy.guarantee != Guarantee::heuristic
                                       : strategy.guarantee == Guarantee::complete;
  return {.all = promises_all(strategy.guarantee, starts_.clear()) && !first_only(),
          .whether = starts_.embedded() && whether};
}

// Chooses the strategy that answers a step, and sees to it that what crosses at the start is known, or that
// the strategy finds it with its answer.
Session::PreparedStrategy& Session::choose(const Motion& motion, const Rig::Interval* bones) {
  start_known_ = options_.ignore_starts || starts_.knows(motion.start());
  if (is_near(motion)) return *near_;
  if (options_.ignore_starts) return main_;
  const bool sees_start = main_.strategy->sees_start;
  // A way from a pose that is not clear proves no other pose clear.
  const bool worth_following = (!sees_start || signs_pay()) && (!is_thick() || starts_.clear());
  if (!start_known_ && !(worth_following && starts_.follow_to(motion.start(), bones, *main_.detector,
                                                              certainty_of(*main_.strategy)))) {
    if (sees_start) return main_;
    // With a thickness, no search of the start can spare the fallback.
    if (needs_start() && (is_thick() ? fallback_strategy_.sees_start : fallback_pays())) return fallback();
    find_crossings(motion.start(), bones);
  }
  start_known_ = true;
  return needs_start() && !starts_.clear() ? fallback() : main_;
}

// Whether what is near (NearPairs) answers a step, and finds what crosses at its start. A complete strategy
// finds what is near; where another one answers, the fallback is prepared for that only after so many small
// steps that they have taken about as long.
bool Session::is_near(const Motion& motion) {
  if (options_.near == nullptr || !fallback_strategy_.sees_start) return false;
  const auto complete = [&]() -> Detector* {
    if (main_.strategy->guarantee == Guarantee::complete && main_.strategy->sees_start)
      return main_.detector.get();
    if (!fallback_ && ++small_steps_ < kSmallSteps) return nullptr;
    return fallback().detector.get();
  };
  if (!options_.near->covers(motion, complete)) return false;
  if (!near_) {
    StrategyInput setup = setup_;
    setup.first_only = first_only();
    near_ = {&fallback_strategy_, make_near_detector(*options_.near, setup), setup.threads};
  }
  return true;
}

bool Session::signs_pay() const {
  return main_.strategy->drops_by_signs && setup_.mesh.closed_and_oriented();
}

// A complete strategy that sees starts answers from a start that is not known in less time than it takes to
// search that start apart. It is prepared for that after so many plain searches that they have taken about as
// long as its preparation. So a clip whose starts are nearly all known from the steps before them is spared
// the preparation, and no clip takes much more than twice the time that the better choice would take.
// Searches are counted and not timed, so that the same questions get the same answers from the same strategy.
bool Session::fallback_pays() const {
  return fallback_strategy_.sees_start && (fallback_ || starts_.searches() >= kPlainSearches);
}

void Session::find_crossings(std::span<const Vec3> pose, const Rig::Interval* bones) {
  const bool by_main = main_.detector && main_.strategy->sees_start;
  Detector* const detector = by_main           ? main_.detector.get()
                             : fallback_pays() ? fallback().detector.get()
                                               : nullptr;
  starts_.search(pose, bones, detector);
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

// Asks a strategy, which finds what crosses at the start where that is not known.
void Session::ask(PreparedStrategy& asked, const Motion& motion, const Rig::Interval* bones,
                  StepAnswer& out) {
  Step step{
      .motion = motion, .bones = setup_.rig != nullptr ? bones : nullptr, .thickness = options_.thickness};
  step.time_alone = sought_ == Sought::time;
  out.strategy = asked.strategy;
  if (start_known_) {
    // Two passes find all contacts of a step from an embedded start, the second one only where something
    // touches. After a step in which something did, that is likely again, and one pass for all is quicker.
    // For the first contact alone there is one pass in either case.
    const bool clear = !options_.ignore_starts && starts_.clear() && can_follow();
    step.starts_embedded = clear && (!touched_last_ || first_only());
    // Where it is not known whether the start is clear, the first contact says so, and no other does.
    step.any_contact = sought_ == Sought::any_contact && first_only() && (!is_thick() || clear);
    out.report = asked.detector->detect(step, out.found);
  } else {
    out.report = starts_.see(*asked.detector, step, out.found);
    start_known_ = true;
    out.embedding_ms += out.report.start_ms;
  }
  if (options_.near != nullptr && !(near_ && &asked == &*near_)) options_.near->note_work(out.report.cull);
  touched_last_ = !out.found.contacts.empty();
  say_start(out);
  if (!options_.ignore_starts) {
    starts_.learn_end(motion, bones, certainty_of(*asked.strategy), out.found);
  }
  leave_out(out);
}

void Session::say_start(StepAnswer& out) {
  if (!options_.ignore_starts) {
    out.start = starts_.crossings();
    out.starts_embedded = out.start.total == 0;
  }
  out.starts_clear = out.starts_embedded;
  if (is_thick()) {
    // Whoever lets starts be ignored vouches for them.
    const bool sees_close_pairs = options_.ignore_starts || (out.strategy->guarantee == Guarantee::complete &&
                                                             setup_.elementary.apart_is_proof);
    const bool known = !options_.ignore_starts && starts_.clear();
    const bool none_close = known || (sees_close_pairs && !has_contact_at_start(out.found));
    out.starts_clear = out.starts_embedded && none_close;
    starts_.learn_clear(none_close && can_follow());
  }
  if (options_.ignore_starts) return;
  if (setup_.exclusions != nullptr)
    out.start.total -= std::erase_if(out.start.pairs, [&](const CrossingPair& pair) {
      return setup_.exclusions->excludes(setup_.mesh, TrianglePair{pair.first, pair.second});
    });
  left_out_.follow(starts_.crossings());
  out.ignored_pairs.clear();
  out.explained_pairs.clear();
  out.start.total -= std::erase_if(out.start.pairs, [&](const CrossingPair& pair) {
    const bool ignored = options_.ignored != nullptr &&
                         options_.ignored->excludes(setup_.mesh, TrianglePair{pair.first, pair.second});
    if (ignored) out.ignored_pairs.push_back(pair);
    const bool explained = !ignored && left_out_.explains(pair);
    if (explained) out.explained_pairs.push_back(pair);
    return ignored || explained;
  });
  out.rest_pairs = out.explained_pairs.size();
}

void Session::begin(const Motion& motion) {
  bool finite = true;
  const bool known = !options_.ignore_starts && starts_.begin(motion, finite);
  if (!options_.check_finite || (known && finite)) return;
  if (known) starts_.abandon(motion);
  require_finite(motion.start(), "start positions");
  require_finite(motion.end(), "end positions");
}

// A step asks the known starts four times, each time about what the last answer has changed: whether it
// begins in a known pose; if not, whether a way leads there, which decides who answers; what the detector saw
// at the start; and, once all contacts are known, what they prove of the end.
void Session::step(const Motion& motion, const Rig::Interval* bones, StepAnswer& out, Sought sought) {
  sought_ = sought;
  const Stopwatch whole;
  begin(motion);
  try {
    PreparedStrategy& chosen = choose(motion, bones);
    out.embedding_ms = whole.milliseconds();
    ask(chosen, motion, bones, out);
    // A strategy that promises the first contact may miss those after it. If that first one is left out as a
    // crossing at rest, the answer has to come from the fallback. So it has to where something touches and
    // the caller ignores pairs, because the caller is told how many contacts are ignored.
    const bool later_missing =
        out.rest_contacts > 0 ||
        (options_.ignored != nullptr && out.found.contacts.size() + out.ignored.contacts.size() > 0);
    if (chosen.strategy->guarantee == Guarantee::first_contact && needs_start() && &chosen == &main_ &&
        later_missing)
      ask(fallback(), motion, bones, out);
  } catch (...) {  // nothing is known of the end then
    starts_.abandon(motion);
    throw;
  }

  out.found.sort();
  out.ignored.sort();
  if (options_.first) keep_first(out.found);
  const Guarantee guarantee = out.strategy->guarantee;
  out.proven =
      setup_.elementary.apart_is_proof && (promises_all(guarantee, out.starts_clear) ||
                                           (guarantee == Guarantee::first_contact && out.starts_clear &&
                                            out.rest_contacts == 0 && out.ignored.contacts.empty()));
  out.wall_ms = whole.milliseconds();
}

}  // namespace cscd
