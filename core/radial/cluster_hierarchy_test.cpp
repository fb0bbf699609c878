#include "core/radial/cluster_hierarchy.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

#include "core/mesh/test_shapes.h"

namespace cscd::radial {
namespace {

using Pairs = std::vector<std::pair<TriangleId, TriangleId>>;

class Collector : public TrianglePairSink {
 public:
  Collector() : TrianglePairSink(64) {}
  Pairs sorted() {
    flush();
    std::sort(pairs_.begin(), pairs_.end());
    return pairs_;
  }

 private:
  void take(const std::vector<TrianglePair>& block) override {
    for (const TrianglePair& pair : block) pairs_.push_back(std::minmax(pair.a, pair.b));
  }
  Pairs pairs_;
};

// A surface in noisy motion with random clusters and random classes. The cull is exact whatever these are.
struct Scene {
  std::mt19937 random;
  std::vector<Vec3> start, end;
  TriangleMesh mesh;
  AtomicClusters clusters;
  ClusterHierarchy hierarchy;
  std::vector<Orientation> class_of;  // [triangles]

  Scene(const test::Shape& shape, unsigned seed, int cluster_count)
      : random(seed),
        start(shape.positions),
        end(shape.positions),
        mesh(shape.mesh()),
        clusters(make_atomic_clusters(mesh, random_bones(cluster_count))),
        hierarchy(mesh, start, clusters),
        class_of(mesh.triangle_count()) {
    for (Vec3& p : end)
      for (int i = 0; i < 3; ++i) p[i] += 0.4 * (static_cast<double>(random() % 2001) / 1000 - 1);
  }

  std::vector<BoneId> random_bones(int count) {
    std::vector<BoneId> bone_of(mesh.triangle_count());
    for (BoneId& bone : bone_of) bone = BoneId{static_cast<int>(random() % static_cast<unsigned>(count))};
    return bone_of;
  }
  std::vector<std::int32_t> random_labels(unsigned count) {
    std::vector<std::int32_t> labels(clusters.clusters.size());
    for (std::int32_t& label : labels) label = static_cast<std::int32_t>(random() % count);
    return labels;
  }
  // Draws classes at random, `uncertain` and `negative` in 100 triangles.
  void set_classes(unsigned uncertain, unsigned negative) {
    for (std::size_t c = 0; c < hierarchy.groups().size(); ++c) {
      const std::span<Orientation> classes = hierarchy.classes(c);
      for (std::size_t member = 0; member < classes.size(); ++member) {
        const unsigned roll = random() % 100;
        classes[member] = roll < uncertain              ? Orientation::uncertain
                          : roll < uncertain + negative ? Orientation::negative
                                                        : Orientation::positive;
        class_of[+hierarchy.groups()[c][member]] = classes[member];
      }
    }
  }
  Kdop16 bound(TriangleId triangle) const {
    const Motion motion(start, end);
    const Triangle& c = mesh.corners(triangle);
    return united(united(kdop_of(motion[c[0]]), kdop_of(motion[c[1]])), kdop_of(motion[c[2]]));
  }
  Pairs by_hand(std::span<const std::int32_t> labels) const {
    Pairs pairs;
    const auto count = static_cast<std::int32_t>(mesh.triangle_count());
    std::vector<Kdop16> bounds;
    for (std::int32_t i = 0; i < count; ++i) bounds.push_back(bound(TriangleId{i}));
    const auto label = [&](std::size_t triangle) {
      return labels[static_cast<std::size_t>(clusters.of_triangle[triangle])];
    };
    for (std::size_t i = 0; i < bounds.size(); ++i)
      for (std::size_t j = i + 1; j < bounds.size(); ++j) {
        if (!overlap(bounds[i], bounds[j])) continue;
        const bool same_sign = class_of[i] == class_of[j] && class_of[i] != Orientation::uncertain;
        if (same_sign && label(i) == label(j)) continue;
        pairs.emplace_back(TriangleId{static_cast<std::int32_t>(i)},
                           TriangleId{static_cast<std::int32_t>(j)});
      }
    return pairs;
  }
};

TEST(ClusterHierarchy, GroupsAreTheClusters) {
  const Scene scene(test::torus(), 1, 5);
  ASSERT_EQ(scene.hierarchy.groups().size(), scene.clusters.clusters.size());
  for (std::size_t c = 0; c < scene.clusters.clusters.size(); ++c) {
    std::vector<TriangleId> group = scene.hierarchy.groups()[c];
    std::sort(group.begin(), group.end());
    EXPECT_EQ(group, scene.clusters.clusters[c].triangles);
  }
}

TEST(ClusterHierarchy, ShowsTheClassAndTheLabelOfEveryTriangle) {
  Scene scene(test::torus(), 2, 5);
  scene.set_classes(30, 20);
  const std::vector<std::int32_t> merged = scene.random_labels(3);
  const Observer observers[] = {
      Observer::point({Vec3(1, 2, 3), Vec3(4, 5, 6)}),
      Observer::segment({Vec3::Zero(), Vec3::Ones()}, {Vec3::Ones(), Vec3::Zero()})};
  const RadialView view = scene.hierarchy.view(merged, observers);
  ASSERT_EQ(view.observers.size(), 2u);
  EXPECT_EQ(view.observers[0].cluster, 0);
  EXPECT_EQ(view.observers[0].tail.end, Vec3(4, 5, 6));
  EXPECT_EQ(view.observers[1].cluster, 1);
  EXPECT_EQ(view.observers[1].tail.end, Vec3(0, 0, 0));
  ASSERT_EQ(view.cluster.size(), scene.mesh.triangle_count());
  for (std::size_t t = 0; t < view.cluster.size(); ++t) {
    EXPECT_EQ(view.cluster[t], merged[static_cast<std::size_t>(scene.clusters.of_triangle[t])]);
    EXPECT_EQ(view.positive[t], scene.class_of[t] == Orientation::positive);
  }
}

TEST(ClusterHierarchy, CullsExactlyTheSameSignPairsOfOneLabelAndNoOther) {
  const test::Shape shapes[] = {
      test::icosphere(2), test::torus(),
      test::together(test::icosphere(1), test::moved(test::octahedron(), {0.5, 0.5, 0}))};
  for (const test::Shape& shape : shapes)
    for (unsigned seed = 0; seed < 8; ++seed) {
      Scene scene(shape, seed, seed < 2 ? 1 : static_cast<int>(2 * seed));
      scene.hierarchy.refit(Motion(scene.start, scene.end));
      for (const auto& [uncertain, negative] : {std::pair{10u, 5u}, {60u, 20u}, {0u, 0u}, {1u, 98u}}) {
        scene.set_classes(uncertain, negative);
        const RadialCounts counts = scene.hierarchy.finish_classes();
        EXPECT_EQ(counts.positive, static_cast<std::size_t>(std::count(
                                       scene.class_of.begin(), scene.class_of.end(), Orientation::positive)));
        EXPECT_EQ(counts.positive + counts.negative + counts.uncertain, scene.mesh.triangle_count());
        for (const unsigned labels : {1u, 3u, 100u}) {
          const std::vector<std::int32_t> merged = scene.random_labels(labels);
          Collector sink;
          const CullCounts done = scene.hierarchy.cull(merged, sink);
          EXPECT_EQ(sink.sorted(), scene.by_hand(merged)) << "seed " << seed << ", labels " << labels;
          EXPECT_GE(*done.bvot, sink.sorted().size());
        }
      }
    }
}

// Rule one-field. A pair of triangles may be dropped if one field certifies both. It may not be dropped
// because each triangle is positive for a field of its own. Mutation: cluster_pair compares signs whatever
// the labels.
TEST(ClusterHierarchy, RuleOneFieldSignsTowardsDifferentObserversDropNothing) {
  Scene scene(test::icosphere(2), 3, 6);
  scene.hierarchy.refit(Motion(scene.start, scene.end));
  scene.set_classes(0, 0);
  scene.hierarchy.finish_classes();

  const std::size_t count = scene.clusters.clusters.size();
  std::vector<std::int32_t> apart(count);
  for (std::size_t c = 0; c < count; ++c) apart[c] = static_cast<std::int32_t>(c);
  std::vector<std::int32_t> two_merged = apart;
  two_merged[1] = apart[0];

  Collector each_its_own, with_one_merger;
  scene.hierarchy.cull(apart, each_its_own);
  scene.hierarchy.cull(two_merged, with_one_merger);
  const Pairs all = each_its_own.sorted(), fewer = with_one_merger.sorted();
  const auto cluster = [&](TriangleId t) { return scene.clusters.of_triangle[+t]; };
  std::size_t between_the_two = 0;
  Pairs expected;
  for (const auto& [a, b] : all) {
    EXPECT_NE(cluster(a), cluster(b)) << "all are positive, so nothing inside a cluster is left";
    if (std::max(cluster(a), cluster(b)) == 1)
      ++between_the_two;
    else
      expected.emplace_back(a, b);
  }
  EXPECT_GT(between_the_two, 0u);
  EXPECT_EQ(fewer, expected) << "nothing but the pairs between clusters 0 and 1 may go";
}

// Rule fresh-detector. Mutation: refit or finish_classes is left out for the second interval.
TEST(ClusterHierarchy, RuleFreshDetectorAnIntervalLeavesNothingBehind) {
  Scene used(test::icosphere(2), 4, 4), fresh(test::icosphere(2), 4, 4);
  const std::vector<std::int32_t> labels(used.clusters.clusters.size(), 0);
  Collector before;
  std::vector<Vec3> elsewhere = used.end;
  for (Vec3& p : elsewhere) p = 3 * p + Vec3(1, 2, 3);
  used.hierarchy.refit(Motion(used.end, elsewhere));
  for (std::size_t c = 0; c < used.hierarchy.groups().size(); ++c)
    std::fill(used.hierarchy.classes(c).begin(), used.hierarchy.classes(c).end(), Orientation::uncertain);
  used.hierarchy.finish_classes();
  used.hierarchy.cull(labels, before);

  Collector a, b;
  std::uint64_t tests[2];
  int which = 0;
  for (const auto& [scene, sink] : {std::pair{&used, &a}, {&fresh, &b}}) {
    scene->set_classes(20, 20);  // both draw the same classes
    scene->hierarchy.refit(Motion(scene->start, scene->end));
    scene->hierarchy.finish_classes();
    tests[which++] = scene->hierarchy.cull(labels, *sink).bvot.value();
  }
  EXPECT_EQ(a.sorted(), b.sorted());
  EXPECT_EQ(tests[0], tests[1]);
}

}  // namespace
}  // namespace cscd::radial
