#include "baselines/embree/embree.h"

#include <atomic>
#include <chrono>
#include <thread>

#include "baselines/test_packages.h"
#include "core/base/thread_pool.h"
#include "core/elementary/catalogue.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

TEST(Embree, PassesOnTheSamePairsAsTheHierarchyOfBoxes) {
  test::expect_the_pairs_of_boxes(make_embree);
}

TEST(Embree, LosesNothingBeyondTheFloats) {
  test::expect_pairs_beyond_floats(make_embree);
}

// Two parts wait for each other. If Embree limited oneTBB to one thread, one of them would wait in vain.
TEST(Embree, LeavesOtherThreadsAlone) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one core";
  const test::Shape shape = test::box();
  const TriangleMesh mesh = shape.mesh();
  const Prepared embree = make_embree({mesh, shape.positions, nullptr, *find_elementary_test("newton")});
  std::atomic<int> started = 0, met = 0;
  ThreadPool(2).parallel_for(2, [&](std::size_t, std::size_t) {
    ++started;
    const auto begin = std::chrono::steady_clock::now();
    while (started < 2 && std::chrono::steady_clock::now() - begin < std::chrono::seconds(20))
      std::this_thread::yield();
    met += started == 2;
  });
  EXPECT_EQ(met, 2);
}

TEST(Embree, TestsSubnormalTrianglesAsTheyAre) {
  test::expect_pairs_of_subnormal_triangles(make_embree);
}

}  // namespace
}  // namespace cscd
