#include "bench/strategies/verify.h"

#include <algorithm>
#include <cmath>

#include "core/base/number_text.h"

namespace cscd::bench {
namespace {

bool by_pair(const Contact& x, const Contact& y) {
  return x.pair < y.pair;
}

std::vector<Contact> sorted_by_pair(const ContactSet& set) {
  std::vector<Contact> contacts = set.contacts;
  std::ranges::sort(contacts, by_pair);
  return contacts;
}

std::string describe(const Contact& contact) {
  const bool vf = contact.pair.kind == FeaturePair::Kind::vertex_face;
  return (vf ? "vertex " : "edge ") + std::to_string(contact.pair.a) + (vf ? ", triangle " : ", edge ") +
         std::to_string(contact.pair.b) + " at t = " + exact_text(contact.time);
}

}  // namespace

Verification verify(const ContactSet& reference, const ContactSet& answer, Guarantee guarantee,
                    bool starts_embedded) {
  const std::vector<Contact> expected = sorted_by_pair(reference), found = sorted_by_pair(answer);
  Verification result;
  result.reference_contacts = expected.size();

  // Both sets are the oracle's answers, so a contact that the complete reference
  // lacks is a fault of the reference.
  std::vector<Contact> missing, surplus;
  std::set_difference(expected.begin(), expected.end(), found.begin(), found.end(),
                      std::back_inserter(missing), by_pair);
  std::set_difference(found.begin(), found.end(), expected.begin(), expected.end(),
                      std::back_inserter(surplus), by_pair);
  result.found_contacts = expected.size() - missing.size();
  // Both sets come from the same elementary test, so a feature pair must have the same time in both.
  const auto wrong = std::ranges::find_if(found, [&](const Contact& contact) {
    const auto same = std::ranges::lower_bound(expected, contact, by_pair);
    return same != expected.end() && same->pair == contact.pair && same->time != contact.time;
  });
  const auto fail = [&](std::string text) {
    result.ok = false;
    result.failure = std::move(text);
  };

  if (!surplus.empty()) {
    fail("the reference lacks " + describe(surplus.front()));
  } else if (wrong != found.end()) {
    fail("wrong time: " + describe(*wrong));
  } else if (!missing.empty() && promises_all(guarantee, starts_embedded)) {
    fail("lost " + describe(missing.front()) + " (guarantee " + std::string(to_string(guarantee)) + ")");
  } else if (guarantee == Guarantee::first_contact && starts_embedded && !expected.empty()) {
    const double first = reference.contacts.front().time;
    const bool kept =
        std::ranges::any_of(answer.contacts, [&](const Contact& contact) { return contact.time == first; });
    if (!kept) fail("lost the first contact: " + describe(reference.contacts.front()));
  }
  return result;
}

void Accuracy::add(const Accuracy& other) {
  misses += other.misses;
  false_alarms += other.false_alarms;
  undecided += other.undecided;
  largest_time_error = std::max(largest_time_error, other.largest_time_error);
}

Accuracy compare_elementary(const ContactSet& oracle, const ContactSet& test) {
  const std::vector<Contact> truth = sorted_by_pair(oracle), claims = sorted_by_pair(test);
  Accuracy result;
  auto t = truth.begin();
  auto c = claims.begin();
  while (t != truth.end() || c != claims.end()) {
    if (c == claims.end() || (t != truth.end() && by_pair(*t, *c))) {
      ++result.misses, ++t;
      continue;
    }
    const bool both = t != truth.end() && !by_pair(*c, *t);
    if (c->verdict == Verdict::undecided)
      ++result.undecided;
    else if (!both)
      ++result.false_alarms;
    else
      result.largest_time_error = std::max(result.largest_time_error, std::abs(t->time - c->time));
    ++c;
    if (both) ++t;
  }
  return result;
}

std::vector<Difference> differences(const ContactSet& oracle, const ContactSet& test) {
  const std::vector<Contact> truth = sorted_by_pair(oracle), claims = sorted_by_pair(test);
  std::vector<Contact> missed, invented;
  std::set_difference(truth.begin(), truth.end(), claims.begin(), claims.end(), std::back_inserter(missed),
                      by_pair);
  std::set_difference(claims.begin(), claims.end(), truth.begin(), truth.end(), std::back_inserter(invented),
                      by_pair);
  std::vector<Difference> result;
  for (const Contact& contact : missed) result.push_back({contact.pair, contact.time, std::nullopt});
  for (const Contact& contact : invented) result.push_back({contact.pair, std::nullopt, contact.time});
  return result;
}

}  // namespace cscd::bench
