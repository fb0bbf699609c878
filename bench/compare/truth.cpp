#include "bench/compare/truth.h"

#include <algorithm>
#include <set>

#include "bench/compare/settings.h"
#include "bench/compare/side.h"
#include "bench/records/shortfall.h"
#include "core/base/number_text.h"

namespace cscd::bench {
namespace {

using Findings = std::vector<TruthFinding>;

constexpr std::string_view kComplete = "complete", kFirstContact = "first_contact",
                           kAllFromEmbedded = "all_from_embedded";

bool has_own_test(const Record& record, const std::string& row) {
  return std::ranges::any_of(record.verification.own_tests, [&](const nlohmann::ordered_json& own) {
    return own.value("strategy", "") == row;
  });
}

// "3 intervals (4, 7, 9)"; at most five are listed.
std::string listed(const std::vector<std::size_t>& intervals) {
  std::string out = many(intervals.size(), "interval") + " (";
  for (std::size_t i = 0; i < std::min<std::size_t>(intervals.size(), 5); ++i)
    out += (i > 0 ? ", " : "") + std::to_string(intervals[i]);
  return out + (intervals.size() > 5 ? ", ...)" : ")");
}

bool has_contact(const StrategyRecord& row, std::size_t place) {
  const auto contacts = row.counts.find("contacts");
  return contacts != row.counts.end() && contacts->second[place] > 0;
}

// Whether rows of first_contact promise nothing on an interval, because its start is not embedded.
bool promises_nothing(const Record& record, std::size_t interval) {
  const auto among = [&](const std::vector<std::size_t>& intervals) {
    return std::ranges::find(intervals, interval) != intervals.end();
  };
  return among(record.verification.unembedded) || among(record.verification.excused);
}

void compare_verification(const Record& before, const Record& after, Findings& out) {
  const std::string& scene = after.scene.name;
  for (const VerifiedStrategy& row : after.verification.strategies)
    for (const std::string& failure : row.failures)
      out.push_back({scene, row.name, "verification failed: " + failure, true});
  for (const VerifiedStrategy& row : before.verification.strategies) {
    const VerifiedStrategy* now = after.verification.strategy(row.name);
    if (!row.failures.empty() && now != nullptr && now->failures.empty())
      out.push_back({scene, row.name, "verification succeeds, which failed in OLD", false});
  }
  if (!before.verification.intervals.empty() && after.verification.intervals.empty())
    out.push_back({scene, "", "NEW verified no interval", true});
}

// Whether both records verified the same intervals of the same frames, with equal settings. The timed
// elementary test is no setting of the verification, which has a test of its own.
bool verify_the_same(const Record& before, const Record& after) {
  Settings old_settings = settings_of(before), new_settings = settings_of(after);
  for (Settings* settings : {&old_settings, &new_settings}) settings->erase("--elementary");
  return before.verification.intervals == after.verification.intervals &&
         before.scene.digest == after.scene.digest && old_settings == new_settings;
}

// The counts of verification are over all verified intervals, so they say something only where these are the
// same and the timed test is the same.
void compare_accuracy(const Record& before, const Record& after, Findings& out) {
  const VerificationRecord &old_v = before.verification, &new_v = after.verification;
  if (!verify_the_same(before, after)) return;
  const std::string& scene = after.scene.name;
  if (before.elementary == after.elementary && old_v.reference == new_v.reference) {
    const auto compare = [&](const char* what, double old_value, double new_value) {
      if (old_value == new_value) return;
      out.push_back({scene, "",
                     "elementary test " + after.elementary + ": " + what + " " + exact_text(new_value) +
                         ", in OLD " + exact_text(old_value),
                     new_value > old_value});
    };
    const Accuracy &a = old_v.accuracy, &b = new_v.accuracy;
    compare("contacts missed", static_cast<double>(a.misses), static_cast<double>(b.misses));
    compare("contacts invented", static_cast<double>(a.false_alarms), static_cast<double>(b.false_alarms));
    compare("pairs left undecided", static_cast<double>(a.undecided), static_cast<double>(b.undecided));
    compare("largest error of a time", a.largest_time_error, b.largest_time_error);
  }
  for (const VerifiedStrategy& row : new_v.strategies) {
    const VerifiedStrategy* old_row = old_v.strategy(row.name);
    if (old_row == nullptr || old_row->contacts_found == row.contacts_found) continue;
    if (old_row->contacts_expected != row.contacts_expected) {
      out.push_back({scene, row.name,
                     "the reference's contacts have changed from " +
                         std::to_string(old_row->contacts_expected) + " to " +
                         std::to_string(row.contacts_expected),
                     true});
      continue;
    }
    // Which later contacts a row of first_contact keeps is chance.
    const bool lost = row.guarantee != kFirstContact && row.contacts_found < old_row->contacts_found;
    out.push_back({scene, row.name,
                   "found " + std::to_string(row.contacts_found) + " of " +
                       std::to_string(row.contacts_expected) + " contacts, in OLD " +
                       std::to_string(old_row->contacts_found),
                   lost});
  }
}

void compare_complete(const Record& before, const StrategyRecord& old_row, const Record& after,
                      const StrategyRecord& new_row, Findings& out) {
  std::vector<std::size_t> differ;
  for (const SharedInterval& i : shared_intervals(before.counted_intervals, after.counted_intervals))
    if (old_row.digests[i.before] != new_row.digests[i.after]) differ.push_back(i.interval);
  if (!differ.empty())
    out.push_back({after.scene.name, new_row.name, "finds other contacts on " + listed(differ), true});
}

// For rows that promise nothing where a start is not embedded.
void compare_from_embedded(const Record& before, const StrategyRecord& old_row, const Record& after,
                           const StrategyRecord& new_row, Findings& out) {
  std::vector<std::size_t> lost, allowed, later;
  const bool all = old_row.guarantee == kAllFromEmbedded && new_row.guarantee == kAllFromEmbedded;
  const bool have_times = !all && !old_row.first_times.empty() && !new_row.first_times.empty();
  for (const SharedInterval& i : shared_intervals(before.counted_intervals, after.counted_intervals)) {
    const bool same = all          ? old_row.digests[i.before] == new_row.digests[i.after]
                      : have_times ? old_row.first_times[i.before] == new_row.first_times[i.after]
                                   : has_contact(old_row, i.before) == has_contact(new_row, i.after);
    if (!same && !promises_nothing(before, i.interval) && !promises_nothing(after, i.interval))
      lost.push_back(i.interval);
    else if (!same)
      allowed.push_back(i.interval);
    else if (old_row.digests[i.before] != new_row.digests[i.after])
      later.push_back(i.interval);
  }
  const std::string what = all          ? "finds other contacts on "
                           : have_times ? "tells another first time on "
                                        : "disagrees on whether there is contact on ";
  if (!lost.empty()) out.push_back({after.scene.name, new_row.name, what + listed(lost), true});
  if (!allowed.empty())
    out.push_back({after.scene.name, new_row.name,
                   what + listed(allowed) + ", where the start is not embedded and nothing is promised",
                   false});
  if (!later.empty())
    out.push_back({after.scene.name, new_row.name,
                   "finds other contacts on " + listed(later) +
                       (have_times ? ", with the same first time" : "; these records hold no first times"),
                   false});
}

// Calls `each` with the two rows of every name that both records have answers of, to the same questions.
template <class Each>
void for_each_answering_row(const Record& before, const Record& after, const Each& each) {
  if (before.scene.digest != after.scene.digest || !other_settings(before, after).empty()) return;
  for (const StrategyRecord& new_row : after.strategies) {
    const StrategyRecord* old_row = before.strategy(new_row.name);
    if (old_row != nullptr && !old_row->digests.empty() && !new_row.digests.empty()) each(*old_row, new_row);
  }
}

enum class Judged { not_by_answers, as_complete, from_embedded };

Judged judged(const Record& before, const StrategyRecord& old_row, const Record& after,
              const StrategyRecord& new_row) {
  if (has_own_test(before, new_row.name) || has_own_test(after, new_row.name)) return Judged::not_by_answers;
  if (old_row.guarantee == kComplete && new_row.guarantee == kComplete) return Judged::as_complete;
  return needs_embedded_start(new_row.guarantee) ? Judged::from_embedded : Judged::not_by_answers;
}

void compare_rows(const Record& before, const Record& after, Findings& out) {
  for_each_answering_row(before, after, [&](const StrategyRecord& old_row, const StrategyRecord& new_row) {
    if (old_row.guarantee == kComplete && new_row.guarantee != kComplete)
      out.push_back({after.scene.name, new_row.name, "promises less: " + new_row.guarantee, true});
    const Judged how = judged(before, old_row, after, new_row);
    if (how == Judged::as_complete) compare_complete(before, old_row, after, new_row, out);
    if (how == Judged::from_embedded) compare_from_embedded(before, old_row, after, new_row, out);
  });
}

bool answers_alike(const Record& one, const Record& other) {
  for (const StrategyRecord& row : one.strategies) {
    const StrategyRecord* same = other.strategy(row.name);
    if (same == nullptr || row.digests.empty() || same->digests.empty()) continue;
    for (const SharedInterval& i : shared_intervals(one.counted_intervals, other.counted_intervals))
      if (row.digests[i.before] != same->digests[i.after]) return false;
  }
  return true;
}

}  // namespace

std::size_t compared_answers(const Record& before, const Record& after) {
  const std::size_t intervals = shared_intervals(before.counted_intervals, after.counted_intervals).size();
  std::size_t count = 0;
  for_each_answering_row(before, after, [&](const StrategyRecord& old_row, const StrategyRecord& new_row) {
    if (judged(before, old_row, after, new_row) != Judged::not_by_answers) count += intervals;
  });
  return count;
}

std::vector<TruthFinding> compare_truth(std::span<const Record> before, std::span<const Record> after) {
  Findings out;
  const std::string& scene = after.front().scene.name;
  std::set<std::string> said;  // processes that answer alike have the same findings
  for (const Record& record : after) {
    Findings found;
    compare_verification(before.front(), record, found);
    compare_accuracy(before.front(), record, found);
    compare_rows(before.front(), record, found);
    for (TruthFinding& finding : found)
      if (said.insert(finding.row + "\n" + finding.text).second) out.push_back(std::move(finding));
  }
  for (const Record& record : before.subspan(1))
    if (!answers_alike(before.front(), record)) {
      out.push_back({scene, "", "processes of OLD answer differently from each other", false});
      break;
    }
  for (const Record& record : after.subspan(1))
    if (!answers_alike(after.front(), record)) {
      out.push_back({scene, "", "processes of NEW answer differently from each other", true});
      break;
    }
  return out;
}

}  // namespace cscd::bench
