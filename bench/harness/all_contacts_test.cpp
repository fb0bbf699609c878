// All contacts from starts that are known to be embedded ("Theorem: signs first, and all contacts where
// anything touches" in core/soundness.md), against all pairs.

#include <gtest/gtest.h>

#include "baselines/plain.h"
#include "bench/testing/random_step.h"
#include "core/detect/contact_geometry.h"
#include "core/detect/exclusions.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"

namespace cscd::bench {
namespace {

const DrvbcFastOptions kAll{.name = "drvbc_fast_all", .complete = true, .starts_embedded = true};
const ElementaryTest& exact() {
  return *find_elementary_test("exact");
}

// CSCD_ALL_CONTACTS tries another number of intervals.
std::uint64_t contact_seeds() {
  return test::steps_asked("CSCD_ALL_CONTACTS", 100);
}

struct EmbeddedStep : test::RandomStep {
  using RandomStep::RandomStep;
  StrategyInput setup(const ElementaryTest& test = exact(), const Exclusions* exclusions = nullptr) const {
    return {.mesh = mesh, .reference = start, .rig = nullptr, .elementary = test, .exclusions = exclusions};
  }
  ContactSet ask(const Prepared& prepared, Report* report = nullptr) const {
    ContactSet found;
    const Report own = prepared.detector->detect({motion()}, found);
    if (report != nullptr) *report = own;
    found.sort();
    return found;
  }
};

// Calls visit(step, seed) for random steps that start embedded.
template <class Visit>
void for_each_embedded(std::uint64_t count, const Visit& visit) {
  for (std::uint64_t seed = 1; seed <= count; ++seed) {
    const EmbeddedStep step(seed);
    if (step.starts_embedded()) visit(step, seed);
  }
}

// Mutations: the rest is never asked for; it is asked for by signs again.
TEST(AllContacts, AreFoundBySignsAndCaps) {
  std::size_t touching = 0, later = 0, spared = 0;
  for_each_embedded(contact_seeds(), [&](const EmbeddedStep& step, std::uint64_t seed) {
    const ContactSet truth = step.ask(make_brute(step.setup()));
    Report by_signs, by_caps;
    const Prepared all = make_drvbc_fast(step.setup(), kAll);
    for (int asked = 0; asked < 2; ++asked)
      EXPECT_EQ(digest(step.ask(all, &by_signs)), digest(truth)) << "seed " << seed;
    step.ask(make_drvbc_fast(step.setup(), {.complete = true}), &by_caps);
    touching += !truth.contacts.empty();
    later += step.ask(make_drvbc_fast(step.setup())).contacts.size() < truth.contacts.size();
    spared += by_signs.cull.bvot != by_caps.cull.bvot;
  });
  EXPECT_GT(touching, contact_seeds() / 4);
  EXPECT_GT(later, 10u) << "signs alone lose nothing here";
  EXPECT_GT(spared, 10u) << "signs are not asked first";
}

// The first contact is excluded with everything that its vertices are in. Mutation: signs are asked first
// with exclusions too.
TEST(AllContacts, OfAnExcludedFirstContactAreKept) {
  std::size_t left = 0;
  for_each_embedded(contact_seeds(), [&](const EmbeddedStep& step, std::uint64_t seed) {
    const ContactSet truth = step.ask(make_brute(step.setup()));
    if (truth.contacts.empty()) return;
    const auto [a, b, c, d] = vertices_of(step.mesh, truth.contacts.front().pair);
    std::vector<std::pair<VertexId, VertexId>> pairs;
    for (const VertexId u : {a, b, c, d})
      for (std::size_t v = 0; v < step.mesh.vertex_count(); ++v)
        if (const VertexId other{static_cast<std::int32_t>(v)}; other != u) pairs.emplace_back(u, other);
    Exclusions exclusions;
    exclusions.exclude(step.mesh, pairs);
    const StrategyInput setup = step.setup(exact(), &exclusions);
    const ContactSet expected = step.ask(make_brute(setup));
    EXPECT_EQ(digest(step.ask(make_drvbc_fast(setup, kAll))), digest(expected)) << "seed " << seed;
    left += !expected.contacts.empty();
  });
  EXPECT_GT(left, 20u);
}

// Decides nothing where there is a contact.
template <auto test, class Query>
Answer hesitant(const Query& query) {
  const Answer answer = (exact().*test)(query);
  return answer.verdict == Verdict::contact ? Answer{Verdict::undecided, 0} : answer;
}
constexpr ElementaryTest kHesitant{"hesitant",
                                   "",
                                   true,
                                   true,
                                   one_by_one<hesitant<&ElementaryTest::vertex_face, MovingVertexFace>>,
                                   one_by_one<hesitant<&ElementaryTest::edge_edge, MovingEdgeEdge>>};

// Mutation: the rest is asked for only after a decided contact.
TEST(AllContacts, AreLookedForWhereTheTestIsUndecided) {
  std::size_t touching = 0;
  for_each_embedded(60, [&](const EmbeddedStep& step, std::uint64_t seed) {
    const ContactSet truth = step.ask(make_brute(step.setup(kHesitant)));
    EXPECT_EQ(digest(step.ask(make_drvbc_fast(step.setup(kHesitant), kAll))), digest(truth))
        << "seed " << seed;
    touching += !truth.contacts.empty();
  });
  EXPECT_GT(touching, 15u);
}

// Signs pass on the first contact, so whoever asks for no other is spared the second look.
TEST(AllContacts, AreNotLookedForByWhoWantsTheFirst) {
  std::size_t touching = 0, spared = 0;
  for_each_embedded(60, [&](const EmbeddedStep& step, std::uint64_t seed) {
    StrategyInput setup = step.setup();
    Report all, first;
    ContactSet found = step.ask(make_drvbc_fast(setup, kAll), &all);
    setup.first_only = true;
    ContactSet earliest = step.ask(make_drvbc_fast(setup, kAll), &first);
    keep_first(found), keep_first(earliest);
    EXPECT_EQ(digest(earliest), digest(found)) << "seed " << seed;
    touching += !found.contacts.empty();
    spared += *first.cull.bvot < *all.cull.bvot;
  });
  EXPECT_GT(spared, touching / 2);
}

}  // namespace
}  // namespace cscd::bench
