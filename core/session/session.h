#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/stopwatch.h"
#include "core/detect/contact.h"
#include "core/detect/detector.h"
#include "core/detect/start/crossings.h"
#include "core/detect/start/rest_crossings.h"
#include "core/detect/strategy.h"
#include "core/session/known_starts.h"
#include "core/session/near_pairs.h"

namespace cscd {

// The answer to one step. Contacts and crossings that the caller ignores stand in lists of their own, and
// those that crossings at rest explain (see RestCrossings) are left out of everything but the two counts that
// say so. What crosses at rest and has parted in the meantime is no longer left out, so answers depend on the
// steps before.
struct StepAnswer {
  ContactSet found;               // sorted
  Crossings start;                // pairs of triangles that cross at the start
  std::size_t rest_pairs = 0;     // of the pairs that cross at rest, how many cross at this start
  std::size_t rest_contacts = 0;  // contacts left out, as a pair that crosses at rest carries them
  std::vector<CrossingPair> explained_pairs;  // sorted; those `rest_pairs`
  std::vector<CrossingPair> ignored_pairs;  // sorted; those that cross at the start (SessionOptions::ignored)
  ContactSet ignored;                       // sorted; contacts, likewise
  bool starts_embedded = true;              // nothing at all crosses at the start, whether left out or not
  // The start is embedded, and with a thickness it is also proven that no pair is close there. What is close
  // at the start has time 0 among the contacts. With StrategyInput::exclusions this is about other pairs.
  bool starts_clear = true;
  const Strategy* strategy = nullptr;  // that answered
  bool proven = false;  // contacts and time are right by the strategy's guarantee and the elementary test
  Report report;
  double embedding_ms = 0;  // what it took to know which triangles cross at the start
  double wall_ms = 0;       // from the question to the answer

  std::optional<double> time() const;  // of the earliest decided contact
};

struct SessionOptions {
  bool first = false;                // only the contacts of the earliest time
  bool unproven = false;             // no fallback where the strategy's guarantee is void
  bool keep_rest_crossings = false;  // nothing is left out
  // Pairs of triangles, and the feature pairs that they alone carry, that are no part of answers; null for
  // none. Strategies know nothing of them, so that what a step proves still says how the next one starts.
  // Where anything touches, a strategy that promises all contacts answers. Must outlive the session.
  const Exclusions* ignored = nullptr;
  // Says nothing of crossings at starts: `start` stays empty and `starts_embedded` true. For complete
  // strategies, whose contacts are right from any start.
  bool ignore_starts = false;
  // Throws InputError for positions that are not finite, before anything is changed.
  bool check_finite = false;
  // Answers small steps from what is near; null to ask the strategies about every step. Several sessions of
  // one surface and thickness may share it. Must outlive the session.
  NearPairs* near = nullptr;
  // How near features may come before they count as contacts. Above 0, both strategies and the elementary
  // test have to know distances. What it refers to must outlive the session.
  Thickness thickness = {};
};

// Answers one step after another of one surface, from any start. A strategy that promises the first contact
// of an embedded start answers where the start is embedded, and a complete strategy, the fallback, answers
// where it is not. What one step proves says which triangles cross at the start of the next (KnownStarts), so
// steps are best asked for in the order of the motion.
//
// With a thickness, contacts are close pairs, and a *clear* start, embedded and without close pairs, takes
// the place of an embedded one. Whether a start is clear is known from the step before, or from a way to it
// from a clear pose; where neither says so, a complete strategy answers.
class Session {
 public:
  // Prepares the strategy. `setup.first_only` is not looked at. With exclusions, give a complete strategy.
  // `rest`, [vertices], is the pose whose crossings are left out. Throws InputError, with `name` before the
  // text, where the set-up lacks what the strategy needs, where a strategy or the test has no proof for the
  // thickness, and where too many triangles cross at rest. The
  // strategies, and what `setup` refers to, must outlive the session.
  Session(const std::string& name, const StrategyInput& setup, const Strategy& strategy,
          const Strategy& fallback, std::span<const Vec3> rest, const SessionOptions& options);

  // Answers one step. Positions have to be finite, unless the options ask for that to be checked. `bones`
  // holds the skeleton at both ends; null for a mesh without a rig. The answer is written into `out`, whose
  // memory is used again. A session that was asked for the first contact may answer with any contact of a
  // step that is not free, or with any of the earliest time to a share of 2^-42 (Step::time_alone), if that
  // is sought.
  enum class Sought { contacts, any_contact, time };
  void step(const Motion& motion, const Rig::Interval* bones, StepAnswer& out,
            Sought sought = Sought::contacts);

  // Returns what preparing the strategy has found out (StrategyInput::preparation); empty where it saves
  // nothing.
  std::vector<std::byte> saved_preparation() const { return main_.detector->saved_preparation(); }
  // Milliseconds that it took to prepare the strategy and to find what crosses at rest.
  double preparation_ms() const { return preparation_ms_ + rest_ms_; }
  // How many triangles the preparation of the set-up did not know.
  std::size_t new_triangles() const { return main_.new_triangles; }
  // The triangles that cross at rest, which are left out of answers until they part, with those that
  // touch beside them; and those that only touch at rest, which are not left out.
  const Crossings& rest_crossings() const { return rest_.crossing; }
  const Crossings& rest_touching() const { return rest_.touching; }
  int threads() const { return main_.threads; }

 private:
  struct PreparedStrategy {
    const Strategy* strategy = nullptr;
    std::unique_ptr<Detector> detector;
    int threads = 1;
    std::size_t new_triangles = 0;
  };
  PreparedStrategy make(const Strategy& strategy) const;
  // Finds what crosses at rest, and what that explains. A main strategy that sees starts has to be made
  // before.
  void find_rest_crossings(const std::string& name, std::span<const Vec3> rest);
  void take_touching_of_crossing();
  PreparedStrategy& fallback();
  // Whether only the contacts of the earliest time are asked of strategies.
  bool first_only() const { return options_.first && left_out_.empty() && options_.ignored == nullptr; }
  bool is_thick() const { return !options_.thickness.is_zero(); }
  // Whether the contacts of a step say what crosses at its end.
  bool can_follow() const { return setup_.elementary.apart_is_proof && setup_.exclusions == nullptr; }
  // What the strategy's contacts of a motion from the known pose say for sure.
  Certainty certainty_of(const Strategy& strategy) const;
  // Whether the strategy promises nothing from a start that is not embedded, or with a thickness clear, and
  // the fallback is to answer there.
  bool needs_start() const { return needs_embedded_start(main_.strategy->guarantee) && !options_.unproven; }
  void begin(const Motion& motion);
  PreparedStrategy& choose(const Motion& motion, const Rig::Interval* bones);
  bool is_near(const Motion& motion);
  bool fallback_pays() const;
  // Whether a way from an embedded pose and a step from its end take less time than the main strategy takes
  // to see the start.
  bool signs_pay() const;
  // Finds from nothing which triangles cross in a pose. `bones` holds the skeleton in it, at its start.
  void find_crossings(std::span<const Vec3> pose, const Rig::Interval* bones);
  void ask(PreparedStrategy& asked, const Motion& motion, const Rig::Interval* bones, StepAnswer& out);
  // Says what of the start is known before anything is left out of the answer, and remembers it.
  void say_start(StepAnswer& out);
  void leave_out(StepAnswer& out) const;

  StrategyInput setup_;
  const Strategy& fallback_strategy_;
  SessionOptions options_;
  PreparedStrategy main_;
  std::optional<PreparedStrategy> fallback_, near_;
  double preparation_ms_ = 0;  // of the strategy
  KnownStarts starts_;
  double rest_ms_ = 0;  // that the search of the pose at rest took
  Meetings rest_;
  RestCrossings left_out_;
  int small_steps_ = 0;        // before the fallback finds what is near
  bool touched_last_ = false;  // something did in the step before
  Sought sought_ = Sought::contacts;
  bool start_known_ = false;  // what crosses at the start of the step that is being answered is known
};

}  // namespace cscd
