#include "core/session/known_starts.h"

#include <gtest/gtest.h>
#include <limits>

#include "core/detect/compose.h"
#include "core/detect/plain_culler.h"
#include "core/elementary/catalogue.h"
#include "core/mesh/test_shapes.h"

namespace cscd {
namespace {

constexpr Certainty kNothing{}, kWhether{.whether = true}, kAll{.all = true, .whether = true};

// Reports what it is told to report, and remembers what it was asked.
struct Scripted : Detector {
  ContactSet contacts;
  Crossings start;
  int asked = 0;
  bool told_embedded = false, had_bones = false, asked_for_any = false;

  Report detect(const Step& step, ContactSet& out) override {
    ++asked;
    told_embedded = step.starts_embedded;
    had_bones = step.bones != nullptr;
    asked_for_any = step.any_contact;
    out = contacts;
    if (step.crossings) *step.crossings = start;
    return {};
  }
};

// One octahedron rests, and another lies along the x axis where a test puts it.
class KnownStartsTest : public testing::Test {
 protected:
  std::vector<Vec3> pose(double x) const {
    std::vector<Vec3> out = shape_.positions;
    for (std::size_t v = 6; v < out.size(); ++v) out[v] += Vec3(x, 0.1, 0.2);
    return out;
  }
  ContactSet contacts_of(const Motion& motion) {
    const StrategyInput setup{mesh_, shape_.positions, nullptr, *find_elementary_test("filtered_exact")};
    ContactSet out;
    compose(std::make_unique<PlainCuller<Kdop16>>(setup), setup)->detect({motion}, out);
    return out;
  }
  // Begins a step, whose end is finite.
  bool begin(const Motion& motion) {
    bool finite = false;
    const bool known = starts_.begin(motion, finite);
    EXPECT_TRUE(finite || !known);
    return known;
  }
  // What crosses in a pose, searched from nothing.
  std::vector<CrossingPair> truth(std::span<const Vec3> pose) {
    return EmbeddingTest(mesh_, shape_.positions)
        .find_all(pose, std::numeric_limits<std::size_t>::max())
        .pairs;
  }

  test::Shape shape_ = test::together(test::octahedron(), test::octahedron(0.8));
  TriangleMesh mesh_ = shape_.mesh();
  const std::vector<Vec3> far_ = pose(5), near_ = pose(3), inside_ = pose(1);
  KnownStarts starts_{mesh_, shape_.positions, false};
};

TEST_F(KnownStartsTest, TheEndOfAStepInWhichNothingTouchesIsKnown) {
  starts_.search(far_, nullptr, nullptr);
  EXPECT_TRUE(starts_.embedded());
  EXPECT_FALSE(starts_.knows(near_));
  const Motion motion(far_, near_);
  EXPECT_TRUE(begin(motion));
  EXPECT_TRUE(starts_.knows(far_)) << "the start of the step that has begun";
  starts_.learn_end(motion, nullptr, kWhether, {});
  EXPECT_TRUE(begin(Motion(near_, inside_)));
  EXPECT_TRUE(starts_.embedded());
  EXPECT_EQ(starts_.searches(), 1u);
}

// Mutations: the end is taken for the known pose at once; its crossings are not followed; an end is followed
// from another pose than the start of its step.
TEST_F(KnownStartsTest, BothEndsOfAStepWithContactsAreKnownWhereTheyAreAll) {
  starts_.search(near_, nullptr, nullptr);
  const Motion motion(near_, inside_);
  const ContactSet found = contacts_of(motion);
  ASSERT_FALSE(found.contacts.empty());
  ASSERT_TRUE(begin(motion));
  starts_.learn_end(motion, nullptr, kAll, found);
  EXPECT_TRUE(starts_.embedded());
  ASSERT_TRUE(begin(Motion(near_, far_))) << "a shorter step from the same start";
  starts_.abandon(Motion(near_, far_));
  ASSERT_FALSE(truth(inside_).empty());
  ASSERT_TRUE(begin(Motion(inside_, near_)));
  EXPECT_EQ(starts_.crossings().pairs, truth(inside_));
  EXPECT_EQ(starts_.searches(), 1u);
}

TEST_F(KnownStartsTest, AnEndIsFollowedFromTheStartOfItsStepAlone) {
  starts_.search(near_, nullptr, nullptr);
  const Motion motion(near_, inside_);
  ASSERT_TRUE(begin(motion));
  starts_.learn_end(motion, nullptr, kAll, contacts_of(motion));
  starts_.search(far_, nullptr, nullptr);
  EXPECT_FALSE(begin(Motion(inside_, near_)));
}

TEST_F(KnownStartsTest, TheEndAfterContactsIsNotKnownWhereSomeMayBeMissing) {
  starts_.search(near_, nullptr, nullptr);
  const Motion motion(near_, inside_);
  ContactSet found = contacts_of(motion);
  found.contacts.resize(1);
  ASSERT_TRUE(begin(motion));
  starts_.learn_end(motion, nullptr, kWhether, found);
  EXPECT_FALSE(starts_.knows(inside_));
  EXPECT_TRUE(starts_.knows(near_)) << "the start is the known pose again";
  EXPECT_TRUE(starts_.embedded());

  Scripted detector;
  EXPECT_FALSE(starts_.follow_to(inside_, nullptr, detector, kWhether));
  EXPECT_EQ(detector.asked, 0) << "the way there has just been asked about";
  EXPECT_TRUE(starts_.follow_to(far_, nullptr, detector, kWhether));
  EXPECT_TRUE(detector.told_embedded);
  EXPECT_TRUE(starts_.knows(far_));
}

// Who divides a step asks about several ends from one start. Mutations: the start is forgotten; it is still
// taken for known after a step in which something touched.
TEST_F(KnownStartsTest, TheStartOfAStepInWhichNothingTouchesStaysKnown) {
  starts_.search(far_, nullptr, nullptr);
  Scripted detector;
  EXPECT_TRUE(starts_.follow_to(far_, nullptr, detector, kWhether));  // so that starts are kept
  for (const std::vector<Vec3>& end : {near_, pose(4), near_}) {
    const Motion motion(far_, end);
    ASSERT_TRUE(begin(motion));
    starts_.learn_end(motion, nullptr, kWhether, {});
    EXPECT_TRUE(starts_.knows(end));
  }
  ASSERT_TRUE(begin(Motion(far_, inside_)));
  starts_.learn_end(Motion(far_, inside_), nullptr, kWhether, contacts_of(Motion(far_, inside_)));
  EXPECT_TRUE(starts_.knows(far_));
  EXPECT_FALSE(begin(Motion(near_, far_))) << "it is no more the pose before";
  EXPECT_FALSE(begin(Motion(inside_, far_))) << "what crosses there is not known";
  EXPECT_EQ(starts_.searches(), 1u);
}

TEST_F(KnownStartsTest, AnUncertainStepTeachesNothing) {
  starts_.search(far_, nullptr, nullptr);
  const Motion motion(far_, near_);
  ASSERT_TRUE(begin(motion));
  starts_.learn_end(motion, nullptr, kNothing, {});
  EXPECT_FALSE(starts_.knows(near_));
  Scripted detector;
  EXPECT_FALSE(starts_.follow_to(inside_, nullptr, detector, kNothing));
  EXPECT_EQ(detector.asked, 0);
}

TEST_F(KnownStartsTest, AnAbandonedStepTeachesNothing) {
  starts_.search(far_, nullptr, nullptr);
  const Motion motion(far_, near_);
  ASSERT_TRUE(begin(motion));
  starts_.abandon(motion);
  EXPECT_TRUE(starts_.knows(far_));
  EXPECT_FALSE(starts_.knows(near_));
  EXPECT_FALSE(begin(Motion(near_, far_))) << "it starts elsewhere";
}

// A way may be long, and its contacts are as many as one likes: no more is asked than whether there are any.
// Mutations: the way is asked about all contacts; a way on which something touches is followed.
TEST_F(KnownStartsTest, AWayOnWhichSomethingTouchesIsNotFollowed) {
  for (const Certainty& certainty : {kAll, kWhether}) {
    starts_.search(near_, nullptr, nullptr);
    Scripted detector;
    detector.contacts = contacts_of(Motion(near_, inside_));
    EXPECT_FALSE(starts_.follow_to(inside_, nullptr, detector, certainty));
    EXPECT_TRUE(detector.asked_for_any);
    EXPECT_FALSE(starts_.knows(inside_));
    EXPECT_TRUE(starts_.knows(near_));
    EXPECT_EQ(starts_.crossings().pairs, truth(near_));
  }
}

TEST_F(KnownStartsTest, ADetectorThatSeesStartsSearchesThem) {
  Scripted detector;
  detector.start = {truth(inside_), truth(inside_).size()};
  starts_.search(inside_, nullptr, &detector);
  EXPECT_EQ(starts_.crossings().pairs, truth(inside_));
  EXPECT_TRUE(starts_.knows(inside_));
  ContactSet found;
  detector.start = {};
  starts_.see(detector, {Motion(far_, near_)}, found);
  EXPECT_TRUE(starts_.knows(far_));
  EXPECT_TRUE(starts_.embedded());
  EXPECT_EQ(starts_.searches(), 1u) << "a start that is seen with an answer is no search";
}

// The way to a pose needs the skeleton at its beginning.
TEST_F(KnownStartsTest, AWayNeedsTheBonesOfTheKnownPose) {
  KnownStarts starts(mesh_, shape_.positions, true);
  const std::vector<Bone> skeleton(2);
  const Rig::Interval bones{skeleton, skeleton};
  starts.search(far_, nullptr, nullptr);
  Scripted detector;
  EXPECT_FALSE(starts.follow_to(near_, &bones, detector, kAll));
  EXPECT_EQ(detector.asked, 0);
  const Motion motion(far_, near_);
  bool finite = false;
  ASSERT_TRUE(starts.begin(motion, finite));
  starts.learn_end(motion, &bones, kAll, {});
  EXPECT_TRUE(starts.follow_to(far_, &bones, detector, kAll));
  EXPECT_TRUE(detector.had_bones);
}

}  // namespace
}  // namespace cscd
