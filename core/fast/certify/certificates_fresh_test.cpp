#include <algorithm>
#include <gtest/gtest.h>
#include <random>

#include "core/fast/certify/test_certificates.h"

namespace cscd::fast {
namespace {

// Takes intervals one after the other with certificates that have seen all intervals before, and with fresh
// certificates for each interval. Both must give the same results.
class FreshBesideUsed {
 public:
  explicit FreshBesideUsed(CertifiedBody& scene) : scene_(scene) {}

  // `mirrored`, [patches], marks patches that are seen from the other side.
  void take(const Motion& motion, const std::vector<bool>& mirrored, std::size_t covers) {
    scene_.local.update(motion);
    look(scene_.certificates, mirrored);
    Certificates fresh(scene_.mesh, scene_.tree, scene_.covers);
    fresh.use_covers(covers);
    look(fresh, mirrored);
    for (std::size_t p = 0; p < scene_.tree.patches.size(); ++p)
      for (std::size_t q = 0; q < scene_.tree.patches.size(); ++q) {
        const Certificates::Shared found = scene_.certificates.shared(p, q), expected = fresh.shared(p, q);
        ASSERT_TRUE(found.p == expected.p && found.q == expected.q) << p << " and " << q;
      }
    for (std::size_t a = 0; a < scene_.tree.nodes.size(); ++a)
      for (std::size_t b = a; b < scene_.tree.nodes.size(); ++b)
        ASSERT_EQ(scene_.certificates.skip(a, b), fresh.skip(a, b)) << a << " and " << b;
    const RadialCounts &found = scene_.certificates.counts(), &expected = fresh.counts();
    ASSERT_EQ(found.positive, expected.positive);
    ASSERT_EQ(found.negative, expected.negative);
    ASSERT_EQ(found.uncertain, expected.uncertain);
    positive.push_back(found.positive);
  }
  std::vector<std::uint64_t> positive;

 private:
  void look(Certificates& certificates, const std::vector<bool>& mirrored) {
    const std::span<const LocalPositions::Record> records = scene_.local.records();
    float sum = 0;
    for (const LocalPositions::Record& r : records) sum += r.at[1];
    const float twice_middle = 2 * sum / static_cast<float>(records.size());
    certificates.start(scene_.local);
    for (std::size_t p = 0; p < scene_.tree.patches.size(); ++p) {
      PatchLanes lanes = load(records, scene_.tree.patches[p].vertex);
      if (!mirrored.empty() && mirrored[p])
        for (Float16(&end)[3] : lanes.at) end[1] = twice_middle - end[1];
      certificates.look(p, lanes);
    }
    certificates.finish();
  }
  CertifiedBody& scene_;
};

// Nothing stays of the intervals before (rule fresh-detector), whether all was positive in them, or negative,
// or next to nothing. Mutations: what was seen otherwise by itself, what was spoiled, or what it was labelled
// stays where a patch is usual again; what is above a label stays; nothing is forgotten where the motion
// leaves the range or other covers are used.
TEST(Certificates, SayAfterOtherIntervalsWhatFreshOnesSay) {
  CertifiedBody scene(0.04, 3, 1);
  const CertifiedBody other(0.06, 2, 7);
  const auto scaled = [](std::vector<Vec3> points, double by) {
    for (Vec3& p : points) p *= by;
    return points;
  };
  const std::vector<Vec3>&rest = scene.shape.positions, opposite = scaled(rest, -1), far = scaled(rest, 1e10);
  const Motion intervals[] = {scene.motion(), Motion(rest, rest), other.motion(), Motion(rest, opposite),
                              Motion(far, far)};
  FreshBesideUsed both(scene);
  for (const std::size_t covers : {kCovers, std::size_t{1}, kCovers}) {
    scene.certificates.use_covers(covers);
    for (const std::size_t i : {0, 1, 2, 1, 3, 1, 4, 0, 4, 2, 0, 3, 2})
      ASSERT_NO_FATAL_FAILURE(both.take(intervals[i], {}, covers)) << "interval " << i;
  }
  std::mt19937 random(1);
  std::vector<bool> mirrored(scene.tree.patches.size());
  for (int i = 0; i < 12; ++i) {
    for (std::size_t p = 0; p < mirrored.size(); ++p) mirrored[p] = i % 2 == 0 || random() % 4 == 0;
    ASSERT_NO_FATAL_FAILURE(both.take(intervals[1], mirrored, kCovers)) << "mirrored " << i;
  }
  EXPECT_EQ(*std::min_element(both.positive.begin(), both.positive.end()), 0u);
  EXPECT_EQ(*std::max_element(both.positive.begin(), both.positive.end()), scene.mesh.triangle_count());
}

// Signs certify less near seams than capped clusters do, and other triangles. Mutation: what one of the two
// certified stays when the other takes its place.
TEST(Certificates, SayBySignsAndByCapsWhatFreshOnesSay) {
  CertifiedBody scene(0, 0, 1);
  const auto look = [&](Certificates& certificates, bool all) {
    certificates.use_contour_test(all);
    look_at_all(certificates, scene.tree, scene.local);
  };
  Certificates used = scene.with_caps();
  std::size_t different = 0;
  for (const bool all : {true, false, false, true, false}) {
    look(used, all);
    Certificates fresh = scene.with_caps(), other = scene.with_caps();
    look(fresh, all), look(other, !all);
    for (std::size_t p = 0; p < scene.tree.patches.size(); ++p)
      for (std::size_t q = 0; q < scene.tree.patches.size(); ++q) {
        const Certificates::Shared found = used.shared(p, q), expected = fresh.shared(p, q);
        ASSERT_TRUE(found.p == expected.p && found.q == expected.q) << p << " and " << q;
        different += found.p != other.shared(p, q).p;
      }
    for (std::size_t a = 0; a < scene.tree.nodes.size(); ++a)
      for (std::size_t b = a; b < scene.tree.nodes.size(); ++b)
        ASSERT_EQ(used.skip(a, b), fresh.skip(a, b)) << a << " and " << b;
  }
  EXPECT_GT(different, 100u);
}

}  // namespace
}  // namespace cscd::fast
