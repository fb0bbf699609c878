#include "core/fast/drvbc_fast.h"

#include <gtest/gtest.h>
#include <random>

#include "core/base/error.h"
#include "core/elementary/catalogue.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

// A long tube, and the same tube bent, with so much noise that neighbours may run into each other.
struct Scene {
  test::Shape shape;
  TriangleMesh mesh = shape.mesh();
  std::vector<Vec3> end;

  explicit Scene(double noise, int around = 12, int along = 400)
      : shape(test::uneven_tube(around, along, 90, [](double x) { return 0.8 + 0.1 * std::sin(3 * x); })) {
    std::mt19937 random(1);
    const auto dice = [&] { return noise * (static_cast<double>(random() >> 8) * 0x1p-23 - 1); };
    for (const Vec3& p : shape.positions)
      end.push_back(p + Vec3(dice(), std::sin(p.x() / 3) + dice(), dice()));
  }
  StrategyInput setup(int threads) const {
    return {mesh, shape.positions, nullptr, *find_elementary_test("filtered_exact"), threads};
  }
  Motion motion() const { return Motion(shape.positions, end); }
};

// Mutations: the lists of pairs are joined from the last; the tests of one thread alone are counted; a pair
// of nodes that can be opened is passed on twice; the last range of nodes is left out; the largest coordinate
// is that of one range alone.
TEST(DrvbcFast, AnswersTheSameOnAnyNumberOfThreads) {
  struct Case {
    double noise;
    bool complete, large;
  };
  // Every stage of the large surface is shared out. The small surface keeps several threads busy only where
  // noise makes it touch itself.
  for (const auto& [noise, complete, large] : std::initializer_list<Case>{{0.0, false, false},
                                                                          {0.1, false, false},
                                                                          {0.3, false, false},
                                                                          {0.1, true, false},
                                                                          {0.04, false, true},
                                                                          {0.04, true, true}}) {
    const Scene scene = large ? Scene(noise, 32, 2100) : Scene(noise);
    ContactSet alone[2], found;
    Report reports[2];  // asked for the first time, and again, when clusters have been cut anew
    for (const int threads : {1, 2, 3, 7}) {
      const std::unique_ptr<Detector> detector =
          make_drvbc_fast(scene.setup(threads), {.complete = complete}).detector;
      for (int again = 0; again < 2; ++again) {
        const Report now = detector->detect({scene.motion()}, found);
        if (threads == 1) alone[again] = found, reports[again] = now;
        const Report& report = reports[again];
        EXPECT_EQ(now.cull.bvot, report.cull.bvot) << threads << " threads";
        EXPECT_EQ(now.cull.pctp, report.cull.pctp);
        EXPECT_EQ(now.cull.radial->positive, report.cull.radial->positive);
        EXPECT_EQ(now.cull.radial->uncertain, report.cull.radial->uncertain);
        EXPECT_EQ(now.pairs.feature_pairs, report.pairs.feature_pairs);
        EXPECT_EQ(now.pairs.elementary_tests, report.pairs.elementary_tests);
        // Contacts come in the order of the descent.
        ASSERT_EQ(found.contacts.size(), alone[again].contacts.size());
        for (std::size_t i = 0; i < found.contacts.size(); ++i) {
          ASSERT_EQ(found.contacts[i].pair, alone[again].contacts[i].pair)
              << threads << " threads, contact " << i;
          ASSERT_EQ(found.contacts[i].time, alone[again].contacts[i].time);
        }
      }
    }
    EXPECT_GT(reports[0].cull.bvot, large ? 20'000u : 500u);
    EXPECT_EQ(alone[0].contacts.size() > 1000, noise > 0.2 || large);
    EXPECT_EQ(alone[0].contacts.empty(), noise == 0);
  }
}

// Without one of its ideas it finds the same contacts, and passes on more pairs. Mutations: what is left out
// is asked, and what is not is left out.
TEST(DrvbcFast, FindsTheSameWithoutAnyOfItsIdeas) {
  const Scene scene(0.1);
  ContactSet all;
  const std::uint64_t passed_on =
      make_drvbc_fast(scene.setup(1), {.complete = true}).detector->detect({scene.motion()}, all).cull.pctp;
  all.sort();
  ASSERT_FALSE(all.contacts.empty());
  for (const DrvbcFastOptions& options : {DrvbcFastOptions{.time_linear = false, .complete = true},
                                          DrvbcFastOptions{.stars = false, .complete = true},
                                          DrvbcFastOptions{.planes = false, .complete = true}}) {
    ContactSet found;
    const Report report = make_drvbc_fast(scene.setup(1), options).detector->detect({scene.motion()}, found);
    found.sort();
    EXPECT_GT(report.cull.pctp, passed_on);
    ASSERT_EQ(found.contacts.size(), all.contacts.size());
    for (std::size_t i = 0; i < all.contacts.size(); ++i)
      EXPECT_EQ(found.contacts[i].pair, all.contacts[i].pair);
  }
}

TEST(DrvbcFast, NeedsAThread) {
  const Scene scene(0);
  for (const int threads : {0, -1}) EXPECT_THROW(make_drvbc_fast(scene.setup(threads)), InputError);
}

}  // namespace
}  // namespace cscd
