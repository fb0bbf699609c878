#include "core/fast/drvbc_fast.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

#include "core/base/error.h"
#include "core/elementary/catalogue.h"
#include "core/fast/clusters/surface_clusters.h"
#include "core/fast/fast_culler.h"
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
  Report detect(const DrvbcFastOptions& options, ContactSet& found) const {
    return make_drvbc_fast(setup(1), options).detector->detect({motion()}, found);
  }
};

void expect_same_pairs(const ContactSet& found, const ContactSet& expected) {
  EXPECT_FALSE(expected.contacts.empty());
  EXPECT_TRUE(std::ranges::equal(found.contacts, expected.contacts, {}, &Contact::pair, &Contact::pair));
}

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

// A surface that faces inward costs what it costs facing outward. Mutation: it is looked at as it is, from
// behind, and then nothing of it is certified by caps.
TEST(DrvbcFast, DoesNotAskWhichSideIsTheOutside) {
  Scene outward(0.1), inward(0.1);
  std::vector<Triangle> triangles = inward.shape.triangles;
  for (Triangle& t : triangles) std::swap(t[1], t[2]);
  inward.mesh = TriangleMesh(triangles, inward.shape.positions.size());
  for (const bool complete : {false, true}) {
    ContactSet expected, found;
    const Report a = outward.detect({.complete = complete}, expected),
                 b = inward.detect({.complete = complete}, found);
    EXPECT_EQ(a.cull.bvot, b.cull.bvot);
    EXPECT_EQ(a.cull.radial->positive, b.cull.radial->positive);
    EXPECT_FALSE(expected.contacts.empty());
    EXPECT_EQ(expected.contacts.size(), found.contacts.size());
  }
}

// Without one of its ideas it finds the same contacts, and passes on more pairs. Mutations: what is left out
// is asked, and what is not is left out.
TEST(DrvbcFast, FindsTheSameWithoutAnyOfItsIdeas) {
  const Scene scene(0.1);
  ContactSet all;
  const std::uint64_t passed_on = scene.detect({.complete = true}, all).cull.pctp;
  all.sort();
  for (const DrvbcFastOptions& options : {DrvbcFastOptions{.time_linear = false, .complete = true},
                                          DrvbcFastOptions{.one_rings = false, .complete = true},
                                          DrvbcFastOptions{.planes = false, .complete = true}}) {
    ContactSet found;
    EXPECT_GT(scene.detect(options, found).cull.pctp, passed_on);
    found.sort();
    expect_same_pairs(found, all);
  }
}

// A surface that flies a million units finds what it finds where it is, for as much. Mutation: its origin
// rests, so that nothing is known of how its places lie to each other.
TEST(DrvbcFast, CostsTheSameWhereTheSurfaceFlies) {
  const Scene rests(0.1);
  Scene flies(0.1);
  for (Vec3& p : flies.end) p += Vec3(0x1p20, -0x1p21, 0x1p19);
  for (const bool complete : {false, true}) {
    ContactSet expected, found;
    const CullCounts here = rests.detect({.complete = complete}, expected).cull,
                     away = flies.detect({.complete = complete}, found).cull;
    expected.sort(), found.sort();
    EXPECT_NEAR(static_cast<double>(*away.bvot), static_cast<double>(*here.bvot), 0.02 * *here.bvot);
    EXPECT_NEAR(static_cast<double>(away.pctp), static_cast<double>(here.pctp), 0.02 * here.pctp);
    expect_same_pairs(found, expected);
  }
}

TEST(DrvbcFast, NeedsAThread) {
  const Scene scene(0);
  for (const int threads : {0, -1}) EXPECT_THROW(make_drvbc_fast(scene.setup(threads)), InputError);
}

// A tube whose vertices fly apart, so that thousands of features touch. Mutations: the interval is cut a
// little too early; pairs are not passed on again after the cut; the number of threads decides where it is.
TEST(CutShort, FindsTheSameFirstContactForLess) {
  std::uint64_t short_tests = 0, whole_tests = 0;
  for (int seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    // Short descents are not stopped; a small surface flies so far that it is looked at in parts.
    const bool far = seed % 4 == 0;
    test::Shape shape = far ? test::uneven_tube(12, 70, 15, [](double) { return 0.8; })
                            : test::uneven_tube(48, 180, 15, [](double) { return 0.8; });
    const Vec3 origin = seed % 2 ? Vec3::Zero() : Vec3(3e4, -2e4, 1e5);
    const double scale = seed % 3 ? 1 : 1e-3;
    for (Vec3& p : shape.positions) p = origin + scale * p;
    const TriangleMesh mesh = shape.mesh();
    std::mt19937 random(static_cast<unsigned>(seed));
    std::uniform_real_distribution<double> unit(-1, 1);
    std::vector<Vec3> end;
    for (const Vec3& p : shape.positions)
      end.push_back(p + scale * (far ? 30 : 0.3) * Vec3(unit(random), unit(random), unit(random)));
    const Motion motion(shape.positions, end);
    for (const bool complete : {false, true}) {
      const auto found = [&](bool first, int threads, std::uint32_t long_descent, Report& report) {
        StrategyInput setup{mesh, shape.positions, nullptr, *find_elementary_test("filtered_exact"), threads};
        setup.first_only = first;
        ContactSet contacts;
        report = make_drvbc_fast(setup, {.long_descent = long_descent, .complete = complete})
                     .detector->detect({.motion = motion, .starts_embedded = true}, contacts);
        contacts.sort();
        keep_first(contacts);
        return contacts.contacts;
      };
      Report all, cut, on_two, whole;
      const std::uint32_t usual = DrvbcFastOptions().long_descent;
      const std::vector<Contact> truth = found(false, 1, usual, all);
      ASSERT_FALSE(truth.empty());
      const auto same = [&](const std::vector<Contact>& contacts) {
        return std::ranges::equal(contacts, truth, [](const Contact& a, const Contact& b) {
          return a.pair == b.pair && a.time == b.time;
        });
      };
      EXPECT_TRUE(same(found(true, 1, usual, cut)));
      EXPECT_TRUE(same(found(true, 2, usual, on_two)));
      EXPECT_TRUE(same(found(true, 1, DrvbcFastOptions::kNever, whole)));
      EXPECT_EQ(*on_two.cull.bvot, *cut.cull.bvot);
      EXPECT_EQ(on_two.cull.pctp, cut.cull.pctp);
      EXPECT_EQ(on_two.pairs.elementary_tests, cut.pairs.elementary_tests);
      short_tests += *cut.cull.bvot;
      whole_tests += *all.cull.bvot;
    }
  }
  EXPECT_LT(2 * short_tests, whole_tests);
}

// A tube that goes from pose to pose, with jumps, steps that are asked again and steps back. Mutations:
// feature pairs that touched in the step before are taken for contacts without a test; the step is looked at
// until a little before the earliest of them touches; any contact is enough where the first one, or all, are
// asked for after a step of which any was enough.
TEST(Remembered, ChangesNoFirstContact) {
  const test::Shape shape = test::uneven_tube(24, 60, 15, [](double) { return 0.8; });
  const TriangleMesh mesh = shape.mesh();
  std::mt19937 random(57);
  std::uniform_real_distribution<double> unit(-1, 1);
  StrategyInput setup{mesh, shape.positions, nullptr, *find_elementary_test("filtered_exact")};
  setup.first_only = true;
  for (const bool complete : {false, true}) {
    const DrvbcFastOptions options{.complete = complete};
    const std::unique_ptr<Detector> seasoned = make_drvbc_fast(setup, options).detector;
    const std::unique_ptr<Detector> fresh = make_drvbc_fast(setup, options).detector;
    setup.first_only = false;
    const std::unique_ptr<Detector> all = make_drvbc_fast(setup, options).detector;
    setup.first_only = true;
    const auto first = [&](Detector& detector, const Motion& motion, Report& report) {
      ContactSet contacts;
      report = detector.detect({.motion = motion, .starts_embedded = true}, contacts);
      contacts.sort();
      keep_first(contacts);
      return contacts;
    };
    std::vector<Vec3> pose = shape.positions, before = pose, trial = pose;
    std::uint64_t tests = 0, fresh_tests = 0, any_tests = 0, all_tests = 0;
    int touched = 0;
    for (int i = 0; i < 60; ++i) {
      SCOPED_TRACE(i);
      if (i % 5 == 4) pose = shape.positions;  // a jump
      if (i % 7 == 6)
        trial = before;     // a step back
      else if (i % 3 != 2)  // another step, or one to the same end again
        for (std::size_t v = 0; v < pose.size(); ++v)
          trial[v] = pose[v] + (i % 4 == 0 ? 0.02 : 0.5) * Vec3(unit(random), unit(random), unit(random));
      const Motion motion(pose, trial);
      Report report, other;
      const ContactSet found = first(*seasoned, motion, report);
      fresh->forget();
      EXPECT_EQ(digest(found), digest(first(*fresh, motion, other)));
      tests += *report.cull.bvot, fresh_tests += *other.cull.bvot;
      ContactSet any;
      seasoned->detect({.motion = motion, .starts_embedded = true, .any_contact = true}, any);
      EXPECT_EQ(any.contacts.empty(), found.contacts.empty());
      any_tests += all->detect({.motion = motion, .starts_embedded = true, .any_contact = true}, any)
                       .pairs.elementary_tests;
      EXPECT_EQ(any.contacts.empty(), found.contacts.empty());
      ContactSet every = {};
      all_tests += all->detect({.motion = motion, .starts_embedded = true}, every).pairs.elementary_tests;
      EXPECT_GE(every.contacts.size(), found.contacts.size());
      every.sort();
      keep_first(every);
      EXPECT_EQ(digest(every), digest(found));
      touched += !any.contacts.empty();
      before = pose;  // the next pose is embedded, too
      const double share = found.contacts.empty() ? 1 : found.contacts[0].time / 2;
      for (std::size_t v = 0; v < pose.size(); ++v) pose[v] += share * (trial[v] - pose[v]);
    }
    EXPECT_GT(touched, 20);
    EXPECT_LT(tests, fresh_tests);
    EXPECT_LT(10 * any_tests, all_tests);
  }
}

using test::Shape;

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

StrategyInput setup_of(const TriangleMesh& mesh, std::span<const Vec3> reference, int threads = 1) {
  return {mesh, reference, nullptr, *find_elementary_test("filtered_exact"), threads};
}

// A test of the start that culls as `drvbc_fast` does, by signs alone.
EmbeddingTest by_signs(const TriangleMesh& mesh, std::span<const Vec3> reference) {
  return {mesh, std::make_unique<fast::FastCuller>(
                    setup_of(mesh, reference),
                    fast::cut_surface(mesh, reference, fast::surface_clusters(mesh, reference)),
                    DrvbcFastOptions{})};
}

// Shapes whose poses are compared. They are closed but for the last one.
std::vector<Shape> shapes() {
  const auto radius = [](double x) { return 0.5 + 0.1 * std::sin(2 * x); };
  return {test::icosphere(2),
          test::torus(),
          test::uneven_tube(8, 60, 12, radius),
          test::uneven_tube(12, 120, 40, radius),
          test::together(test::icosphere(1), test::moved(test::icosphere(2), {2.2, 0.1, 0.2})),
          test::together(test::octahedron(), test::octahedron(0.5)),
          test::ramp(24, 1.25, 1, 2, 1)};
}

// Throws a pose: winds the x axis into part of a circle or several turns of one, and shakes all vertices.
std::vector<Vec3> thrown(const Shape& shape, std::mt19937& random) {
  const auto dice = [&] { return static_cast<double>(random() >> 8) * 0x1p-23 - 1; };
  Eigen::AlignedBox3d box;
  for (const Vec3& p : shape.positions) box.extend(p);
  const double length = box.sizes().x(), angle = 2.5 * std::numbers::pi * (1 + dice());
  const double noise = 0.05 * std::pow(0.5 * (1 + dice()), 3), pitch = 0.5 * dice();
  std::vector<Vec3> pose;
  for (const Vec3& p : shape.positions) {
    const double at = angle * (p.x() - box.min().x()) / length, r = length / angle + p.y();
    pose.emplace_back(r * std::sin(at), r * std::cos(at), p.z() + pitch * at);
    pose.back() += noise * Vec3(dice(), dice(), dice());
  }
  return pose;
}

// The pairs that the fast test finds are those of the plain test, on any pose of any surface. Mutations that
// die here: the ray is not counted; what is clear in one pose counts as clear in the next.
TEST(FastEmbedding, SaysOfEveryPoseWhatThePlainTestSays) {
  std::size_t embedded = 0, crossing = 0;
  for (const Shape& shape : shapes()) {
    const TriangleMesh mesh = shape.mesh();
    EmbeddingTest plain(mesh, shape.positions),
        fast = make_embedding_test(setup_of(mesh, shape.positions)),
        shared = make_embedding_test(setup_of(mesh, shape.positions, 2));
    std::mt19937 random(5);
    for (int i = 0; i < 60; ++i) {
      const std::vector<Vec3> pose = thrown(shape, random);
      const Crossings expected = plain.find_all(pose, kAll);
      ASSERT_EQ(fast.find_all(pose, kAll).pairs, expected.pairs) << i;
      ASSERT_EQ(shared.find_all(pose, kAll).pairs, expected.pairs) << i;
      EXPECT_EQ(fast.embedded(pose), expected.total == 0) << i;
      ++(expected.total == 0 ? embedded : crossing);
    }
  }
  EXPECT_GT(embedded, 80u);
  EXPECT_GT(crossing, 80u);
}

// What crosses at a start is found along the way of a query, whatever happens after the start. Mutations that
// die here: the pairs at the end of the interval are tested; pairs that the filter dropped are left out.
TEST(FastEmbedding, AQuerySeesAtItsStartWhatThePlainTestSees) {
  std::size_t seen = 0;
  for (const Shape& shape : shapes()) {
    const TriangleMesh mesh = shape.mesh();
    EmbeddingTest plain(mesh, shape.positions);
    const std::unique_ptr<Detector> complete =
        make_drvbc_fast(setup_of(mesh, shape.positions), {.name = "complete", .complete = true}).detector;
    std::mt19937 random(5);
    ContactSet found, alone;
    Crossings start;
    for (int i = 0; i < 20; ++i) {
      const std::vector<Vec3> from = thrown(shape, random), toward = thrown(shape, random);
      std::vector<Vec3> to = from;  // a long step would spend the time on contacts
      for (std::size_t v = 0; v < to.size(); ++v) to[v] += 0.01 * (toward[v] - from[v]);
      const Motion motion(from, to);
      complete->detect({.motion = motion, .crossings = &start, .most_crossings = kAll}, found);
      ASSERT_EQ(start.pairs, plain.find_all(from, kAll).pairs) << i;
      EXPECT_EQ(start.total, start.pairs.size());
      seen += start.total;
      complete->detect({motion}, alone);
      found.sort(), alone.sort();
      EXPECT_EQ(digest(found), digest(alone)) << i;
    }
  }
  EXPECT_GT(seen, 500u);
}

// Why the start needs more than signs: pairs of triangles that cross, though both lie in one cluster and have
// one sign.
TEST(FastEmbedding, SignsAloneLoseCrossings) {
  std::size_t lost = 0;
  for (const Shape& shape : shapes()) {
    const TriangleMesh mesh = shape.mesh();
    if (!mesh.closed_and_oriented()) continue;
    EmbeddingTest plain(mesh, shape.positions), signs = by_signs(mesh, shape.positions);
    std::mt19937 random(5);
    for (int i = 0; i < 60; ++i) {
      const std::vector<Vec3> pose = thrown(shape, random);
      const Crossings expected = plain.find_all(pose, kAll), found = signs.find_all(pose, kAll);
      lost += expected.total - found.total;
    }
  }
  EXPECT_GT(lost, 100u);
}

TEST(FastEmbedding, FindsAFaceThatIsPiercedThoughNoFeaturePairTouches) {
  // The tip of a long spike of one sphere stands in the middle of a face of another sphere.
  Shape shape = test::together(test::icosphere(2), test::moved(test::icosphere(2), {4, 0, 0}));
  const TriangleMesh mesh = shape.mesh();
  EmbeddingTest fast = make_embedding_test(setup_of(mesh, shape.positions));
  EXPECT_TRUE(fast.embedded(shape.positions));
  const auto second = static_cast<std::size_t>(shape.positions.size() / 2);
  const auto tip = std::ranges::min_element(shape.positions.begin() + static_cast<std::ptrdiff_t>(second),
                                            shape.positions.end(), {}, [](const Vec3& p) { return p.x(); });
  const Triangle& face = mesh.triangles()[7];
  const Vec3 middle = (shape.positions[+face[0]] + shape.positions[+face[1]] + shape.positions[+face[2]]) / 3;
  *tip = 0.9 * middle;
  EXPECT_FALSE(fast.embedded(shape.positions));
  EmbeddingTest plain(mesh, shape.positions);
  EXPECT_EQ(fast.find_all(shape.positions, kAll).pairs, plain.find_all(shape.positions, kAll).pairs);
}

// Poses in which nothing has an extent. The first pair that is found ends the search.
TEST(FastEmbedding, TakesPosesThatHaveCollapsed) {
  const Shape shape = test::icosphere(1);
  const TriangleMesh mesh = shape.mesh();
  EmbeddingTest plain(mesh, shape.positions), fast = make_embedding_test(setup_of(mesh, shape.positions));
  const std::vector<Vec3> point(shape.positions.size(), Vec3(1, 2, 3));
  std::vector<Vec3> flat = shape.positions, line = shape.positions, huge = shape.positions;
  for (Vec3& p : flat) p.z() = 0;
  for (Vec3& p : line) p.y() = p.z() = 0;
  for (Vec3& p : huge) p *= 1e300;
  for (const std::vector<Vec3>& pose : {point, flat, line, huge}) {
    EXPECT_EQ(fast.find_all(pose, kAll).pairs, plain.find_all(pose, kAll).pairs);
    EXPECT_EQ(fast.embedded(pose), plain.embedded(pose));
    if (!fast.embedded(pose)) {
      EXPECT_LE(fast.pairs_tested(), 64u);
    }
  }
}

}  // namespace

}  // namespace cscd
