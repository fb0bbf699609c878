#include <gtest/gtest.h>

#include "bench/harness/random_verification.h"
#include "bench/strategies/catalogue.h"
#include "bench/testing/saboteurs.h"
#include "core/mesh/test_shapes.h"
#include "scenes/random/random_interval.h"

// Tests of the verification itself: strategies with one flaw each, which `cscd verify` has to catch on the
// random intervals, beside sound twins that it has to pass.
namespace cscd::bench {
namespace {

using test::Flaw;

Strategy plain(const char* name, Prepared (*make)(const StrategyInput&)) {
  return {name, "for tests", Guarantee::complete, Needs::any_mesh, StrategyKind::fixed, make};
}
Strategy first_contact(const char* name, Prepared (*make)(const StrategyInput&)) {
  return {name, "for tests", Guarantee::first_contact, Needs::closed_mesh_with_bones, StrategyKind::fixed,
          make};
}

// Verifies on `intervals` random intervals and returns how many failed.
std::map<std::string, std::size_t> failures(std::span<const Strategy> strategies, std::size_t intervals) {
  std::map<std::string, std::size_t> count;
  for (const Strategy& strategy : strategies) count[std::string(strategy.name)] = 0;
  const RandomVerification plan{intervals, 1, intervals};  // the first one by all pairs
  for (const RandomFailure& failure : verify_random(plan, rows_of(strategies)).failures)
    ++count[failure.strategy];
  for (const auto& [name, failed] : count) testing::Test::RecordProperty(name, static_cast<int>(failed));
  return count;
}

TEST(Saboteurs, PlainStrategiesThatLosePairsAreCaught) {
  const Strategy strategies[] = {
      plain("sound", test::make_plain<Flaw::none>),
      plain("forgetful", test::make_plain<Flaw::one_feature_pair_in_10000_lost>),
      plain("one_ulp_tighter", test::make_plain<Flaw::bounds_one_ulp_too_tight>),
      plain("skips_last_leaf", test::make_plain<Flaw::last_leaf_skipped>),
  };
  const auto failed = failures(strategies, 400);
  EXPECT_EQ(failed.at("sound"), 0u);
  EXPECT_GT(failed.at("forgetful"), 0u);
  EXPECT_GT(failed.at("one_ulp_tighter"), 0u);
  EXPECT_GT(failed.at("skips_last_leaf"), 0u);
}

// On a closed surface a feature pair is carried by at least four triangle pairs, so that the contacts do not
// tell that one was lost: the number passed on does, beside that of all pairs of overlapping bounds.
TEST(Saboteurs, ACullerThatLosesOneTrianglePairIn10000IsCaught) {
  std::uint64_t expected = 0, base = 0, sound = 0, forgetful = 0;
  std::size_t contacts_differ = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const scenes::RandomInterval random = scenes::make_random_interval(seed);
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    const Motion motion = random.clip.interval(0).motion;
    std::vector<Kdop16> bounds;
    for (const Triangle& c : mesh.triangles())
      bounds.push_back(united(united(kdop_of(motion[c[0]]), kdop_of(motion[c[1]])), kdop_of(motion[c[2]])));
    for (std::size_t i = 0; i < bounds.size(); ++i)
      for (std::size_t j = i + 1; j < bounds.size(); ++j) expected += overlap(bounds[i], bounds[j]);

    const StrategyInput setup{mesh, motion.start(), nullptr, elementary_test_named("newton")};
    ContactSet found[3];
    base += complete_reference().make(setup).detector->detect({motion}, found[0]).cull.pctp;
    sound += test::make_plain<Flaw::none>(setup).detector->detect({motion}, found[1]).cull.pctp;
    forgetful += test::make_plain<Flaw::one_triangle_pair_in_10000_lost>(setup)
                     .detector->detect({motion}, found[2])
                     .cull.pctp;
    for (ContactSet& set : found) set.sort();
    contacts_differ += digest(found[2]) != digest(found[0]);
  }
  EXPECT_EQ(base, expected);
  EXPECT_EQ(sound, expected);
  EXPECT_EQ(forgetful, expected - expected / 10000);
  EXPECT_GE(expected, 20000u);
  EXPECT_EQ(contacts_differ, 0u);
}

// An open ramp that faces up all along winds over itself and is squeezed: only its contour shows that its two
// storeys meet.
TEST(Saboteurs, NormalConesWithoutTheContourTestLoseAnOpenSpiral) {
  for (const double turns : {0.75, 1.25, 1.75}) {
    const test::Shape shape = test::ramp(24, turns, 1, 2, 1);
    std::vector<Vec3> end = shape.positions;
    for (std::size_t i = 0; i < end.size(); ++i) end[i].z() *= -0.1 - 0.01 * static_cast<double>(i % 5);
    const TriangleMesh mesh = shape.mesh();
    const StrategyInput setup{mesh, shape.positions, nullptr, elementary_test_named("exact")};
    const auto contacts = [&](Prepared (*make)(const StrategyInput&)) {
      ContactSet found;
      make(setup).detector->detect({Motion(shape.positions, end)}, found);
      found.sort();
      return found;
    };
    const ContactSet truth = contacts(all_pairs().make);
    EXPECT_EQ(digest(contacts(test::make_cones<Flaw::none>)), digest(truth)) << turns;
    EXPECT_EQ(digest(contacts(strategy_named("mcd").make)), digest(truth)) << turns;
    EXPECT_EQ(truth.contacts.empty(), turns < 1);
    EXPECT_TRUE(contacts(test::make_cones<Flaw::contours_not_tested>).contacts.empty()) << turns;
  }
}

template <radial::ObserverKind kind>
void expect_radial_saboteurs_are_caught(std::size_t intervals) {
  const Strategy strategies[] = {
      first_contact("sound", test::make_radial<Flaw::none, kind>),
      first_contact("representative_triangles", test::make_radial<Flaw::representative_triangles, kind>),
      first_contact("uncertain_is_positive", test::make_radial<Flaw::uncertain_called_positive, kind>),
      first_contact("segment_by_one_vertex", test::make_radial<Flaw::segment_by_one_vertex, kind>),
      first_contact("spans_components", test::make_radial<Flaw::clusters_span_components, kind>),
      first_contact("mixes_observers", test::make_radial<Flaw::observers_mixed, kind>),
  };
  const auto failed = failures(strategies, intervals);
  EXPECT_EQ(failed.at("sound"), 0u);
  EXPECT_GT(failed.at("representative_triangles"), 0u);
  EXPECT_GT(failed.at("uncertain_is_positive"), 0u);
  EXPECT_GT(failed.at("spans_components"), 0u);
  EXPECT_GT(failed.at("mixes_observers"), 0u);
  if (kind == radial::ObserverKind::bone_segment) {
    EXPECT_GT(failed.at("segment_by_one_vertex"), 0u);
  } else {
    EXPECT_EQ(failed.at("segment_by_one_vertex"), 0u) << "nothing is viewed from a segment";
  }
}

TEST(Saboteurs, RadialStrategiesThatLoseFirstContactsAreCaught) {
  expect_radial_saboteurs_are_caught<radial::ObserverKind::bone_centre>(400);
}

TEST(Saboteurs, RadialStrategiesThatLoseFirstContactsAreCaughtWithSegments) {
  expect_radial_saboteurs_are_caught<radial::ObserverKind::bone_segment>(400);
}

// Rule one-field: several observers may each certify pairs, but one must certify all triangles round both of
// a pair.
TEST(Saboteurs, RuleOneFieldOverlappingCoversThatCertifyTooLittleAreCaught) {
  const Strategy strategies[] = {
      first_contact("sound", test::make_many_covers<Flaw::none>),
      first_contact("covers_mixed", test::make_many_covers<Flaw::covers_mixed>),
      first_contact("certified_by_triangle", test::make_many_covers<Flaw::certified_by_triangle>),
  };
  const auto failed = failures(strategies, 400);
  EXPECT_EQ(failed.at("sound"), 0u);
  EXPECT_GT(failed.at("covers_mixed"), 0u);
  EXPECT_GT(failed.at("certified_by_triangle"), 0u);
}

}  // namespace
}  // namespace cscd::bench
