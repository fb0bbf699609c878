// Long steps, which drvbc_fast looks at in parts ("Theorem: an interval in parts" in core/soundness.md),
// against the same steps looked at as a whole.

#include <gtest/gtest.h>

#include "bench/rows/catalogue.h"
#include "core/detect/start/embedding.h"
#include "core/fast/drvbc_fast.h"
#include "scenes/clip/clip.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

constexpr std::uint32_t kAlways = 0, kNever = DrvbcFastOptions::kNever;

struct Step {
  scenes::RandomInterval random;
  TriangleMesh mesh;
  scenes::ClipInterval interval;

  explicit Step(std::uint64_t seed)
      : random(scenes::make_random_interval(seed)),
        mesh(random.clip.header().triangles, random.clip.header().vertex_count),
        interval(random.clip.interval(0)) {}
  Prepared prepared(const DrvbcFastOptions& options, int threads = 1) const {
    return make_drvbc_fast(
        {mesh, random.clip.frame(0).positions, nullptr, elementary_test_named("exact"), threads}, options);
  }
};

void expect_same(const ContactSet& a, const ContactSet& b, std::uint64_t seed) {
  ASSERT_EQ(a.contacts.size(), b.contacts.size()) << "seed " << seed;
  for (std::size_t i = 0; i < a.contacts.size(); ++i) {
    EXPECT_EQ(a.contacts[i].pair, b.contacts[i].pair) << "seed " << seed;
    EXPECT_EQ(a.contacts[i].time, b.contacts[i].time);
  }
}

// Mutations: the last part is left out; pairs of a part whose descent was broken off are kept in place of
// those of its halves; a pair that several parts find is passed on several times.
TEST(Parts, KeepEveryContactOfLongSteps) {
  std::size_t in_parts = 0, contacts = 0, crossings = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Step step(seed);
    ContactSet found[2];
    Crossings crossing[2];
    Report report[2];
    for (const bool in_two : {false, true}) {
      const auto detector =
          step.prepared({.follows = false, .long_descent = in_two ? kAlways : kNever, .complete = true})
              .detector;
      report[in_two] = detector->detect_and_see_start(step.interval.motion, nullptr, found[in_two], 1 << 20,
                                                      crossing[in_two]);
      found[in_two].sort();
      std::ranges::sort(crossing[in_two].pairs);
    }
    expect_same(found[0], found[1], seed);
    EXPECT_EQ(crossing[0].total, crossing[1].total);
    EXPECT_EQ(crossing[0].pairs, crossing[1].pairs);
    in_parts += report[0].cull.bvot != report[1].cull.bvot;
    contacts += found[0].contacts.size();
    crossings += crossing[0].total;
  }
  EXPECT_GT(in_parts, 20u);
  EXPECT_GT(contacts, 1000u);
}

// Mutation: a part is looked at from the observers of the part before it.
TEST(Parts, KeepTheFirstContactOfLongSteps) {
  std::size_t in_parts = 0, touching = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Step step(seed);
    if (!step.mesh.closed_and_oriented() ||
        !EmbeddingTest(step.mesh, step.random.clip.frame(0).positions).embedded(step.interval.motion.start()))
      continue;
    ContactSet whole, found;
    step.prepared({.long_descent = kNever, .complete = true})
        .detector->detect(step.interval.motion, nullptr, whole);
    const Report in = step.prepared({.follows = false, .long_descent = kAlways})
                          .detector->detect(step.interval.motion, nullptr, found);
    ContactSet unsplit;
    const Report out = step.prepared({.follows = false, .long_descent = kNever})
                           .detector->detect(step.interval.motion, nullptr, unsplit);
    whole.sort(), found.sort();
    keep_first(whole), keep_first(found);
    EXPECT_EQ(whole.contacts.empty(), found.contacts.empty()) << "seed " << seed;
    if (!whole.contacts.empty() && !found.contacts.empty()) {
      EXPECT_EQ(whole.contacts.front().time, found.contacts.front().time) << "seed " << seed;
    }
    touching += !whole.contacts.empty();
    in_parts += in.cull.bvot != out.cull.bvot;
  }
  EXPECT_GT(in_parts, 20u);
  EXPECT_GT(touching, 50u);
}

// Mutation: the tests of a descent that was broken off are counted as far as its threads came.
TEST(Parts, AreTheSameOnAnyNumberOfThreads) {
  std::size_t in_parts = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Step step(seed);
    ContactSet alone, both, whole;
    const Report one = step.prepared({.long_descent = kAlways, .complete = true}, 1)
                           .detector->detect(step.interval.motion, nullptr, alone);
    const Report two = step.prepared({.long_descent = kAlways, .complete = true}, 2)
                           .detector->detect(step.interval.motion, nullptr, both);
    const Report other = step.prepared({.long_descent = kNever, .complete = true})
                             .detector->detect(step.interval.motion, nullptr, whole);
    EXPECT_EQ(one.cull.bvot, two.cull.bvot) << "seed " << seed;
    EXPECT_EQ(one.cull.pctp, two.cull.pctp) << "seed " << seed;
    expect_same(alone, both, seed);
    in_parts += one.cull.bvot != other.cull.bvot;
  }
  EXPECT_GT(in_parts, 5u);
}

}  // namespace
}  // namespace cscd::bench
