#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/detect/contact.h"
#include "core/detect/strategy.h"

namespace cscd::bench {

// How a strategy did on one interval against a complete reference, both with an elementary test that is
// always right. Comparing numbers of contacts would be wrong, because a strategy may report fewer where its
// guarantee allows it (rule fair-comparison, core/soundness.md).
struct Verification {
  bool ok = true;
  std::string failure;  // empty when ok: which pair is missing or wrong, and at what time
  std::uint64_t reference_contacts = 0;
  std::uint64_t found_contacts = 0;  // contacts of the reference that the strategy found too
};

// Judges an answer; both sets have to be sorted. `starts_embedded` matters for the guarantees that promise
// nothing without it.
Verification verify(const ContactSet& reference, const ContactSet& answer, Guarantee guarantee,
                    bool starts_embedded);

// How an inexact elementary test answered the feature pairs that a complete culler passed on, compared with
// the oracle's answers for the same pairs.
struct Accuracy {
  std::uint64_t misses = 0;        // the oracle says contact, the test says apart
  std::uint64_t false_alarms = 0;  // the oracle says apart, the test says contact
  std::uint64_t undecided = 0;
  double largest_time_error = 0;  // in intervals, over pairs that both call a contact

  void add(const Accuracy& other);
};
Accuracy compare_elementary(const ContactSet& oracle, const ContactSet& test);

// A feature pair that one of the oracle and the test calls a contact and the other
// apart. A missing time means apart.
struct Difference {
  FeaturePair pair;
  std::optional<double> truth, said;
};
std::vector<Difference> differences(const ContactSet& oracle, const ContactSet& test);

}  // namespace cscd::bench
