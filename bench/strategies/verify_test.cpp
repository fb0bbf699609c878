#include "bench/strategies/verify.h"

#include <gtest/gtest.h>

namespace cscd::bench {
namespace {

Contact vf(std::int32_t vertex, std::int32_t triangle, double time, Verdict verdict = Verdict::contact) {
  return {FeaturePair::of(VertexId{vertex}, TriangleId{triangle}), verdict, time};
}
Contact ee(std::int32_t one, std::int32_t other, double time, Verdict verdict = Verdict::contact) {
  return {FeaturePair::of(EdgeId{one}, EdgeId{other}), verdict, time};
}
ContactSet set_of(std::vector<Contact> contacts) {
  ContactSet set{std::move(contacts)};
  set.sort();
  return set;
}

// Two feature pairs attain the earliest time.
const ContactSet kReference = set_of({ee(3, 4, 0.25), vf(9, 1, 0.25), ee(1, 2, 0.5), vf(1, 2, 0.75)});
constexpr auto kAll = {Guarantee::complete, Guarantee::first_contact, Guarantee::heuristic};

TEST(Verify, EqualSetsPassUnderEveryGuarantee) {
  for (const Guarantee guarantee : kAll)
    for (const bool embedded : {false, true}) {
      const Verification v = verify(kReference, kReference, guarantee, embedded);
      EXPECT_TRUE(v.ok);
      EXPECT_EQ(v.failure, "");
      EXPECT_EQ(v.reference_contacts, 4u);
      EXPECT_EQ(v.found_contacts, 4u);
      EXPECT_TRUE(verify({}, {}, guarantee, embedded).ok);
    }
}

// Rule fair-comparison, part (a): a complete strategy must report every contact.
TEST(Verify, CompleteMustNotLoseAnyPair) {
  for (std::size_t lost = 0; lost < 4; ++lost)
    for (const bool embedded : {false, true}) {
      ContactSet answer = kReference;
      answer.contacts.erase(answer.contacts.begin() + static_cast<std::ptrdiff_t>(lost));
      const Verification v = verify(kReference, answer, Guarantee::complete, embedded);
      EXPECT_FALSE(v.ok);
      EXPECT_NE(v.failure.find("lost"), std::string::npos);
      EXPECT_EQ(v.found_contacts, 3u);
    }
  EXPECT_FALSE(verify(kReference, {}, Guarantee::complete, false).ok);
}

TEST(Verify, AFailureNamesThePairAndTheTime) {
  const Verification v =
      verify(kReference, set_of({ee(3, 4, 0.25), vf(9, 1, 0.25), ee(1, 2, 0.5)}), Guarantee::complete, true);
  EXPECT_NE(v.failure.find("vertex 1, triangle 2 at t = 0.75"), std::string::npos) << v.failure;
}

// Rule fair-comparison, part (b): a first_contact strategy must report one contact of the earliest time.
TEST(Verify, FirstContactMayLoseLaterPairsAndAllButOneOfTheFirst) {
  for (const Contact& kept : {ee(3, 4, 0.25), vf(9, 1, 0.25)}) {
    const Verification v = verify(kReference, set_of({kept}), Guarantee::first_contact, true);
    EXPECT_TRUE(v.ok) << v.failure;
    EXPECT_EQ(v.found_contacts, 1u);
  }
}

TEST(Verify, FirstContactMustNotLoseAllOfTheFirstTime) {
  const ContactSet later = set_of({ee(1, 2, 0.5), vf(1, 2, 0.75)});
  const Verification v = verify(kReference, later, Guarantee::first_contact, true);
  EXPECT_FALSE(v.ok);
  EXPECT_NE(v.failure.find("vertex 9, triangle 1 at t = 0.25"), std::string::npos) << v.failure;
  EXPECT_FALSE(verify(kReference, {}, Guarantee::first_contact, true).ok);
}

// Rule embedded-start.
TEST(Verify, WithoutAnEmbeddedStartFirstContactPromisesNothing) {
  EXPECT_TRUE(verify(kReference, {}, Guarantee::first_contact, false).ok);
  EXPECT_TRUE(verify(kReference, set_of({vf(1, 2, 0.75)}), Guarantee::first_contact, false).ok);
}

TEST(Verify, HeuristicPromisesNothing) {
  EXPECT_TRUE(verify(kReference, {}, Guarantee::heuristic, true).ok);
}

TEST(Verify, APairThatTheReferenceLacksFailsUnderEveryGuarantee) {
  ContactSet more = kReference;
  more.contacts.push_back(ee(7, 8, 0.9));
  more.sort();
  ContactSet twice = kReference;
  twice.contacts.push_back(kReference.contacts.front());
  twice.sort();
  for (const Guarantee guarantee : kAll)
    for (const bool embedded : {false, true}) {
      EXPECT_FALSE(verify(kReference, more, guarantee, embedded).ok);
      EXPECT_FALSE(verify({}, more, guarantee, embedded).ok);
      EXPECT_FALSE(verify(kReference, twice, guarantee, embedded).ok);
      // A pair of the other kind with the same numbers is a different pair.
      EXPECT_FALSE(verify(set_of({vf(1, 2, 0.5)}), set_of({ee(1, 2, 0.5)}), guarantee, embedded).ok);
    }
}

// Both sets come from the same exact test, so a pair that is in both must have one time.
TEST(Verify, AWrongTimeFailsUnderEveryGuarantee) {
  ContactSet wrong = kReference;
  wrong.contacts.back().time = 0.8125;
  for (const Guarantee guarantee : kAll) {
    const Verification v = verify(kReference, wrong, guarantee, true);
    EXPECT_FALSE(v.ok);
    EXPECT_NE(v.failure.find("0.8125"), std::string::npos) << v.failure;
  }
}

TEST(Guarantee, HasAName) {
  EXPECT_EQ(to_string(Guarantee::complete), "complete");
  EXPECT_EQ(to_string(Guarantee::first_contact), "first_contact");
  EXPECT_EQ(to_string(Guarantee::heuristic), "heuristic");
}

TEST(CompareElementary, CountsEveryKindOfAnswer) {
  const ContactSet truth =
      set_of({vf(1, 1, 0.5), vf(2, 2, 0.5), vf(3, 3, 0.5), ee(4, 5, 0.5), ee(8, 9, 0.5)});
  const ContactSet claims = set_of({
      vf(1, 1, 0.5),                      // right
      vf(2, 2, 0.375),                    // right, but at another time
      vf(3, 3, 0.1, Verdict::undecided),  // could not tell
                                          // ee(4, 5) and ee(8, 9) missed
      vf(6, 6, 0.0),                      // false alarm
      ee(1, 2, 0.0),                      // false alarm
      ee(4, 6, 0.9),                      // false alarm
      ee(6, 7, 0.0, Verdict::undecided),  // could not tell about features that are apart
  });
  const Accuracy a = compare_elementary(truth, claims);
  EXPECT_EQ(a.misses, 2u);
  EXPECT_EQ(a.false_alarms, 3u);
  EXPECT_EQ(a.undecided, 2u);
  EXPECT_EQ(a.largest_time_error, 0.125);
}

TEST(CompareElementary, OfEqualSetsIsSpotless) {
  const Accuracy a = compare_elementary(kReference, kReference);
  EXPECT_EQ(a.misses + a.false_alarms + a.undecided, 0u);
  EXPECT_EQ(a.largest_time_error, 0);
  EXPECT_EQ(compare_elementary(kReference, {}).misses, 4u);
  EXPECT_EQ(compare_elementary({}, kReference).false_alarms, 4u);
}

TEST(Accuracy, AddsUp) {
  Accuracy sum{1, 2, 3, 0.5};
  sum.add({10, 20, 30, 0.25});
  EXPECT_EQ(sum.misses, 11u);
  EXPECT_EQ(sum.false_alarms, 22u);
  EXPECT_EQ(sum.undecided, 33u);
  EXPECT_EQ(sum.largest_time_error, 0.5);
  sum.add({0, 0, 0, 0.75});
  EXPECT_EQ(sum.largest_time_error, 0.75);
}

TEST(Differences, NameThePairWhatWasSaidAndWhatIsTrue) {
  EXPECT_TRUE(differences(kReference, kReference).empty());
  const std::vector<Difference> found =
      differences(kReference, set_of({ee(3, 4, 0.3), vf(9, 1, 0.25), ee(1, 2, 0.5), vf(7, 7, 0.125)}));
  ASSERT_EQ(found.size(), 2u) << "another time is no difference";
  EXPECT_EQ(found[0].pair, vf(1, 2, 0).pair);
  EXPECT_EQ(found[0].truth, 0.75);
  EXPECT_FALSE(found[0].said.has_value());
  EXPECT_EQ(found[1].pair, vf(7, 7, 0).pair);
  EXPECT_FALSE(found[1].truth.has_value());
  EXPECT_EQ(found[1].said, 0.125);
}

}  // namespace
}  // namespace cscd::bench
