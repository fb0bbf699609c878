#include <gtest/gtest.h>

#include "core/base/test_refusal.h"
#include "library/test_steps.h"

// Vertices of no face collide with faces as points do. Random steps have some, too (test_steps.h).
namespace cscd {
namespace {

using namespace test;

const FaceRows kFace{{0, 1, 2}};
// A point above the face, which flies through it.
const Rows kAbove{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}};
const Rows kBelow{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}};

// Mutation: only what pairs of faces carry is tested.
TEST(LooseVertices, TouchFacesInEveryAnswer) {
  SelfCollision body(kFace, kAbove);
  EXPECT_FALSE(body.is_free(kAbove, kBelow));
  EXPECT_TRUE(body.is_free(kAbove, kAbove));
  for (const SelfCollision::Answer& answer :
       {body.first_contact(kAbove, kBelow), body.all_contacts(kAbove, kBelow)}) {
    ASSERT_EQ(answer.contacts.size(), 1u);
    EXPECT_FALSE(answer.intersects_at_start());
    const SelfCollision::Contact& contact = answer.contacts[0];
    EXPECT_FALSE(contact.edges);
    EXPECT_EQ(contact.vertices, (std::array<int, 4>{3, 0, 1, 2}));
    EXPECT_EQ(contact.face, 0);
    EXPECT_NEAR(contact.time, 0.5, 1e-15);
    EXPECT_NEAR(contact.normal.z(), 1, 1e-12);
  }
  EXPECT_NEAR(body.largest_step(kAbove, kBelow, 1), 0.5, 1e-12);
  EXPECT_TRUE(body.is_free(kBelow, kBelow)) << "what one step found says nothing wrong of the next";
}

TEST(LooseVertices, AreCandidatesAndHaveBounds) {
  SelfCollision body(kFace, kAbove);
  EXPECT_EQ(body.candidates(kAbove, kBelow, 0).vertex_face, (std::vector<std::array<int, 2>>{{3, 0}}));
  EXPECT_TRUE(body.candidates(kAbove, kAbove, 0.9).vertex_face.empty());
  EXPECT_EQ(body.candidates(kAbove, kAbove, 1).vertex_face.size(), 1u);
  for (const double bound : body.vertex_bounds(kAbove, 10)) {
    EXPECT_GT(bound, 0.49);
    EXPECT_LT(bound, 0.51);
  }
}

TEST(LooseVertices, KeepTheirThicknessAndTheirExclusions) {
  SelfCollision::Options thick;
  thick.thickness = 0.5, thick.vertex_thickness = {0, 0, 0, 0.25};
  SelfCollision body(kFace, kAbove, thick);
  EXPECT_NEAR(body.first_contact(kAbove, kBelow).time().value_or(2), 0.125, 1e-15);
  EXPECT_TRUE(body.is_free(kAbove, kAbove));

  SelfCollision::Options pairs;  // the face's pairs with other faces say nothing of a point
  pairs.exclude.face_pairs = {{0, 0}};
  EXPECT_FALSE(SelfCollision(kFace, kAbove, pairs).is_free(kAbove, kBelow));
  SelfCollision::Options rigid;
  rigid.exclude.rigid = {true, true, true, true};
  EXPECT_TRUE(SelfCollision(kFace, kAbove, rigid).is_free(kAbove, kBelow));
}

// A point of the mesh meets an obstacle's face, and an obstacle's point meets the mesh, however far the
// obstacle's faces are.
TEST(LooseVertices, OfAnObstacleMeetTheMeshAlone) {
  const Rows far{{90, 0, 0}, {94, 0, 0}, {90, 4, 0}, {1, 1, 2}};
  SelfCollision::Options options;
  options.obstacles.emplace_back(kFace, far);
  const Rows own = kAbove.topRows(3);
  Rows up = own;
  up.col(2).setConstant(3);
  SelfCollision body(kFace, own, options);
  EXPECT_TRUE(body.is_free(own, own));
  EXPECT_FALSE(body.is_free(own, up));
  EXPECT_NEAR(body.first_contact(own, up).time().value_or(2), 2.0 / 3, 1e-15);
  EXPECT_EQ(body.all_contacts(own, up).contacts[0].vertices, (std::array<int, 4>{6, 0, 1, 2}));
  EXPECT_EQ(body.candidates(own, up, 0).vertex_face, (std::vector<std::array<int, 2>>{{6, 0}}));

  SelfCollision::Options wall;
  wall.obstacles.emplace_back(kFace, Rows(own + Rows::Constant(3, 3, 0.5)));
  Rows through = kAbove;
  through.row(3) << 1, 1, 0.25;
  EXPECT_FALSE(SelfCollision(kFace, kAbove, wall).is_free(kAbove, through));
}

TEST(LooseVertices, AreRefusedOnOtherPathsThanLines) {
  SelfCollision body(kFace, kAbove);
  const SelfCollision::Paths paths{[](double) { return std::vector<double>(12, 0.0); },
                                   [](double, double) { return std::vector<double>(1, 0.0); }};
  const std::string said = refusal<std::invalid_argument>([&] { body.true_motion(paths, 0, 1); });
  EXPECT_NE(said.find("1 vertex is of no face, the first of them 3"), std::string::npos) << said;
}

}  // namespace
}  // namespace cscd
