#include "core/radial/bone_observer.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

#include "core/mesh/test_shapes.h"

namespace cscd::radial {
namespace {

constexpr double kTheta = 10 * std::numbers::pi / 180;

struct Body {
  test::Shape shape;
  TriangleMesh mesh;
  Rig rig;
  AtomicClusters clusters;

  Body(test::Shape shape_in, const Bone& bone)
      : shape(std::move(shape_in)),
        mesh(shape.mesh()),
        rig{{BoneId{-1}}, {bone}},
        clusters(make_atomic_clusters(mesh, std::vector<BoneId>(mesh.triangle_count(), BoneId{0}))) {}

  std::size_t positive(ObserverKind kind) const {
    std::size_t count = 0;
    for (const Triangle& t : mesh.triangles()) {
      const auto still = [&](VertexId v) { return MovingPoint{shape.positions[+v], shape.positions[+v]}; };
      count += orientation({still(t[0]), still(t[1]), still(t[2])},
                           observer(kind, rig.reference[0], rig.reference[0])) == Orientation::positive;
    }
    return count;
  }
  ObserverKind in_reference_pose() const {
    return choose_in_reference_pose(mesh, shape.positions, rig, clusters).at(0);
  }
  ObserverKind by_rotation(double theta = kTheta) const {
    return choose_by_rotation_trial(mesh, shape.positions, rig, clusters, theta).at(0);
  }
};

TEST(Observer, IsTheMiddleOfTheBoneOrTheBone) {
  const Bone start{{0, 0, 0}, {2, 4, 6}}, end{{10, 0, 0}, {12, 2, 0}};
  const Observer centre = observer(ObserverKind::bone_centre, start, end);
  EXPECT_FALSE(centre.is_segment);
  EXPECT_EQ(centre.head.start, Vec3(1, 2, 3));
  EXPECT_EQ(centre.head.end, Vec3(11, 1, 0));
  const Observer segment = observer(ObserverKind::bone_segment, start, end);
  EXPECT_TRUE(segment.is_segment);
  EXPECT_EQ(segment.head.start, start.head);
  EXPECT_EQ(segment.head.end, end.head);
  EXPECT_EQ(segment.tail.start, start.tail);
  EXPECT_EQ(segment.tail.end, end.tail);
}

TEST(Observer, MiddleOfHugeBonesIsFinite) {
  const double huge = std::numeric_limits<double>::max();
  const Bone bone{{huge, 0, 0}, {huge, 0, 0}};
  EXPECT_EQ(observer(ObserverKind::bone_centre, bone, bone).head.start.x(), huge);
}

TEST(ChoiceInReferencePose, ASlimTubeIsSeenFromItsBone) {
  const Body tube(test::uneven_tube(8, 12, 12, [](double x) { return 0.5 + 0.4 * std::sin(2 * x); }),
                  {{0.5, 0, 0}, {11.5, 0, 0}});
  EXPECT_GT(tube.positive(ObserverKind::bone_segment), tube.positive(ObserverKind::bone_centre));
  EXPECT_EQ(tube.in_reference_pose(), ObserverKind::bone_segment);
}

TEST(ChoiceInReferencePose, ABallIsSeenFromTheCentreWhichCostsLess) {
  const Body ball(test::icosphere(2), {{-0.1, 0, 0}, {0.1, 0, 0}});
  ASSERT_EQ(ball.positive(ObserverKind::bone_segment), ball.positive(ObserverKind::bone_centre));
  EXPECT_EQ(ball.in_reference_pose(), ObserverKind::bone_centre);
}

TEST(ChoiceInReferencePose, TheCentreWinsWhereTheBoneSticksOut) {
  const Body ball(test::icosphere(2), {{-3, 0, 0}, {3, 0, 0}});
  ASSERT_LT(ball.positive(ObserverKind::bone_segment), ball.positive(ObserverKind::bone_centre));
  EXPECT_EQ(ball.in_reference_pose(), ObserverKind::bone_centre);
}

TEST(RotationTrial, TheSegmentWinsOnATie) {
  const Body ball(test::icosphere(2), {{-0.1, 0, 0}, {0.1, 0, 0}});
  EXPECT_EQ(ball.by_rotation(), ObserverKind::bone_segment);
}

TEST(RotationTrial, TheCentreWinsWhereTheBoneSticksOut) {
  const Body ball(test::icosphere(2), {{-3, 0, 0}, {3, 0, 0}});
  EXPECT_EQ(ball.by_rotation(), ObserverKind::bone_centre);
}

TEST(RotationTrial, WithoutRotationItIsTheReferencePoseButForTies) {
  const test::Shape tube = test::uneven_tube(8, 12, 12, [](double x) { return 0.5 + 0.4 * std::sin(2 * x); });
  for (const double reach : {0.2, 1.0, 3.0, 5.5, 9.0, 14.0}) {
    const Body body(tube, {{6 - reach, 0, 0}, {6 + reach, 0, 0}});
    const bool tie = body.positive(ObserverKind::bone_segment) == body.positive(ObserverKind::bone_centre);
    if (!tie) {
      EXPECT_EQ(body.by_rotation(0), body.in_reference_pose()) << reach;
    }
  }
}

// A wide turn about the head carries the far end of the cluster away from the bone, which moves without
// turning. The centre of the bone moves with the cluster. So the trial can choose another kind than the
// reference pose.
TEST(RotationTrial, ItCanDecideAgainstTheReferencePose) {
  const test::Shape tube = test::uneven_tube(8, 10, 10, [](double) { return 0.6; });
  const Body body(tube, {{0.5, 0, 0}, {9.5, 0, 0}});
  ASSERT_GT(body.positive(ObserverKind::bone_segment), 0u);
  const auto choice = [&](double degrees) { return body.by_rotation(degrees * std::numbers::pi / 180); };
  EXPECT_EQ(choice(1), ObserverKind::bone_segment);
  EXPECT_EQ(choice(80), ObserverKind::bone_centre);
}

}  // namespace
}  // namespace cscd::radial
