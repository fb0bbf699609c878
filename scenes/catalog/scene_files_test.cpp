// Checks every scene file: its counts, its frames, and the properties that make it a workload. The first test
// generates a scene anew. The others, each of which is a process of its own under ctest, read its cache.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>
#include <queue>

#include "core/detect/compose.h"
#include "core/detect/plain_culler.h"
#include "core/detect/start/embedding.h"
#include "core/drvbc/drvbc.h"
#include "core/elementary/catalogue.h"
#include "core/mesh/mean_edge.h"
#include "scenes/catalog/scene_cache.h"
#include "scenes/catalog/shapes.h"
#include "scenes/catalog/test_scenes.h"

namespace cscd::scenes {
namespace {

enum class Surface { sphere, disc, sphere_and_ring };  // the third is a body that wears a skirt

// The counts that a scene was ordered with. The expected counts in its file only say what its author thought.
struct Asked {
  const char* name;
  std::size_t triangles, vertices;
  Surface surface = Surface::sphere;
};
// The one that takes longest to make comes first, so that it is there when the next test asks for it.
constexpr Asked kScenes[] = {
    {"bag_contact", 50000, 25002},
    {"skirt_contact", 50015, 25227, Surface::sphere_and_ring},
    {"box", 25088, 12546},
    {"octopus", 47976, 23990},
    {"hand", 11208, 5606},
    {"man", 20000, 10002},
    {"rope", 48440, 24222},
    {"rope_contact", 48440, 24222},
    {"urchin", 2840, 1422},
    {"box_contact", 25088, 12546},
    {"octopus_contact", 47976, 23990},
    {"hand_contact", 11208, 5606},
    {"man_contact", 20000, 10002},
    {"urchin_contact", 2840, 1422},
    // Beyond the paper: cloth.
    {"sheet", 50150, 25393, Surface::disc},
    {"sheet_contact", 50150, 25393, Surface::disc},
    {"fold", 50150, 25393, Surface::disc},
    {"fold_contact", 50150, 25393, Surface::disc},
    {"bag", 50000, 25002},
    {"skirt", 50015, 25227, Surface::sphere_and_ring},
};
void PrintTo(const Asked& asked, std::ostream* out) {
  *out << asked.name;
}

// Tells whether the surface is kept off itself. Such a scene has contacts on purpose.
bool responds(const Asked& asked) {
  return std::string_view(asked.name).ends_with("_contact");
}

std::vector<Asked> scenes_that(bool respond) {
  std::vector<Asked> out;
  std::ranges::copy_if(kScenes, std::back_inserter(out),
                       [respond](const Asked& asked) { return responds(asked) == respond; });
  return out;
}

// Every how many frames the tests check one. The exact test takes 0.04 s a frame in Release and ten times
// that with sanitizers, whose builds have the assertions of libstdc++. CSCD_FULL=1 checks every frame.
std::size_t stride() {
  if (std::getenv("CSCD_FULL")) return 1;
#ifndef _GLIBCXX_ASSERTIONS
  return 4;
#else
  return 16;
#endif
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns for each vertex those that a path along edges of a pose, no longer than `reach`, leads to, sorted.
std::vector<std::vector<std::size_t>> within_reach(const TriangleMesh& mesh, std::span<const Vec3> pose,
                                                   double reach) {
  std::vector<std::vector<std::size_t>> joined(pose.size()), found(pose.size());
  for (const Edge& ends : mesh.edges()) {
    joined[+ends[0]].push_back(+ends[1]);
    joined[+ends[1]].push_back(+ends[0]);
  }
  using Path = std::pair<double, std::size_t>;
  std::vector<double> length(pose.size(), kInfinity);
  for (std::size_t from = 0; from < pose.size(); ++from) {
    std::priority_queue<Path, std::vector<Path>, std::greater<>> next;
    length[from] = 0;
    next.emplace(0, from);
    while (!next.empty()) {
      const auto [so_far, v] = next.top();
      next.pop();
      if (so_far > length[v]) continue;
      found[from].push_back(v);
      for (const std::size_t w : joined[v]) {
        const double longer = so_far + (pose[v] - pose[w]).norm();
        if (longer > reach || longer >= length[w]) continue;
        length[w] = longer;
        next.emplace(longer, w);
      }
    }
    for (const std::size_t v : found[from]) length[v] = kInfinity;
    std::ranges::sort(found[from]);
  }
  return found;
}

// Whether two vertices lie closer than `distance` and are out of each other's reach.
bool has_near_contact(std::span<const Vec3> x, const std::vector<std::vector<std::size_t>>& within_reach,
                      double distance) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t v) { return x[v].x(); });
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size() && x[order[j]].x() - x[order[i]].x() < distance; ++j)
      if ((x[order[i]] - x[order[j]]).squaredNorm() < distance * distance &&
          !std::ranges::binary_search(within_reach[order[i]], order[j]))
        return true;
  return false;
}

class SceneFiles : public testing::TestWithParam<Asked> {
 protected:
  static bool responds() { return cscd::scenes::responds(GetParam()); }
  void SetUp() override {
    // What takes longest to make and is made by the same code as hand_contact, urchin_contact and
    // bag_contact.
    constexpr std::string_view kForFull[] = {
        "rope_contact", "octopus_contact", "man_contact",   "box_contact",  "sheet",        "fold",
        "bag",          "skirt",           "sheet_contact", "fold_contact", "skirt_contact"};
    if (!std::getenv("CSCD_FULL") && std::ranges::find(kForFull, GetParam().name) != std::end(kForFull))
      GTEST_SKIP() << "takes up to a minute to make; CSCD_FULL=1 asks for it";
    if (stride() > 4 && responds() && GetParam().triangles > 12'000)
      GTEST_SKIP() << "detecting contacts takes minutes with sanitizers";
    if (stride() > 4 && GetParam().triangles >= 50'000)
      GTEST_SKIP() << "simulating cloth takes minutes with sanitizers";
  }
  static Clip frames() {
    const std::unique_ptr<ClipSource> source = open_scene(load_scene(GetParam().name));
    Clip clip(source->header());
    copy_frames(*source, clip);
    return clip;
  }
  static TriangleMesh mesh(const Clip& clip) {
    return {clip.header().triangles, clip.header().vertex_count, GetParam().name};
  }
};

TEST_P(SceneFiles, IsGeneratedBitForBitAsPromised) {
  // The scene file's digest stands for every compiler and build type. A contact scene is what the engine's
  // contacts made of it, so this test fails where the engine finds other contacts than when the digest was
  // accepted. Where there is no cache yet, opening the scene generates it, and writes the cache for the other
  // tests.
  const Scene scene = load_scene(GetParam().name);
  if (std::filesystem::exists(cache_file(scene)))
    EXPECT_NO_THROW(generate(scene));
  else
    EXPECT_NO_THROW(open_scene(scene));
}

TEST_P(SceneFiles, HasTheCountsAskedForAndFrameZeroAtRest) {
  const Clip clip = frames();
  EXPECT_EQ(clip.header().vertex_count, GetParam().vertices);
  EXPECT_EQ(clip.header().triangles.size(), GetParam().triangles);
  const std::size_t edges = mesh(clip).edge_count();
  EXPECT_EQ(GetParam().vertices + GetParam().triangles,
            edges + (GetParam().surface == Surface::disc ? 1 : 2));
  // Cloth that responds to contacts is shown for half as long, because it takes a minute to make.
  EXPECT_GE(clip.interval_count(), responds() && GetParam().triangles >= 50'000 ? 120u : 200u);
  const Scene scene = load_scene(GetParam().name);
  const Shape shape = make_shape(scene.shape, scene.shape_parameters);
  EXPECT_TRUE(std::ranges::equal(clip.frame(0).positions, shape.positions));
}

TEST_P(SceneFiles, IsEmbeddedInItsFrames) {
  const Clip clip = frames();
  const TriangleMesh mesh = this->mesh(clip);
  for (const TriangleMesh::DefectReport& defect : mesh.defects())
    ASSERT_EQ(defect.kind, Defect::boundary_edge) << defect.first;
  ASSERT_EQ(mesh.closed_and_oriented(), GetParam().surface == Surface::sphere);
  ASSERT_EQ(mesh.component_count(), GetParam().surface == Surface::sphere_and_ring ? 2 : 1);
  EmbeddingTest test(mesh, clip.frame(0).positions);
  for (std::size_t frame = 0; frame < clip.frame_count(); frame += stride())
    ASSERT_TRUE(test.embedded(clip.frame(frame).positions)) << "frame " << frame;
}

// A near contact: parts of the surface closer than two edges, with eight edges or more between them along the
// surface at rest. There only a fold sharper than about 29 degrees brings such parts that close.
TEST_P(SceneFiles, HasNearContactsInHalfOfItsIntervals) {
  const Clip clip = frames();
  const TriangleMesh mesh = this->mesh(clip);
  const double edge = mean_edge(mesh, clip.frame(0).positions);
  const auto reached = within_reach(mesh, clip.frame(0).positions, 8 * edge);
  std::size_t near = 0, looked_at = 0;
  // A share of fewer samples would mean little.
  for (std::size_t i = 0; i < clip.interval_count(); i += std::min<std::size_t>(stride(), 4), ++looked_at)
    near += has_near_contact(clip.frame(i).positions, reached, 2 * edge);
  const double share = static_cast<double>(near) / static_cast<double>(looked_at);
  RecordProperty("near_contact_share", std::to_string(share));
  EXPECT_GE(share, 0.5);
}

TEST_P(SceneFiles, MovesAllTheTimeAndNotTooFast) {
  // Speeds are in mean edge lengths an interval.
  const Clip clip = frames();
  const double edge = mean_edge(mesh(clip), clip.frame(0).positions);
  double sum = 0, fastest = 0;
  std::size_t moving = 0;
  for (std::size_t i = 0; i < clip.interval_count(); ++i) {
    const Motion motion = clip.interval(i).motion;
    double mean = 0;
    for (std::size_t v = 0; v < motion.vertex_count(); ++v) {
      const double moved = (motion.end()[v] - motion.start()[v]).norm() / edge;
      mean += moved / static_cast<double>(motion.vertex_count());
      fastest = std::max(fastest, moved);
    }
    sum += mean;
    moving += mean > 0.25;
  }
  EXPECT_GT(sum / static_cast<double>(clip.interval_count()), 0.5);
  EXPECT_LT(fastest, 40);
  EXPECT_GT(moving, clip.interval_count() * 3 / 4);
}

// Scenes that move freely, and scenes whose surface is kept off itself.
class FreeSceneFiles : public SceneFiles {};
class ContactSceneFiles : public SceneFiles {};

TEST_P(FreeSceneFiles, TouchThemselvesNowhere) {
  const Clip clip = frames();
  ASSERT_FALSE(clip.header().predicted);
  const TriangleMesh mesh = this->mesh(clip);
  const std::vector<Vec3> reference(clip.frame(0).positions.begin(), clip.frame(0).positions.end());
  const StrategyInput setup{mesh, reference, nullptr, *find_elementary_test("filtered_exact")};
  const std::unique_ptr<Detector> detector =
      compose(std::make_unique<PlainCuller<Kdop16>>(setup), setup, {.relative_boxes = true});
  ContactSet found;
  for (std::size_t i = 0; i < clip.interval_count(); i += stride()) {
    detector->detect({clip.interval(i).motion}, found);
    EXPECT_TRUE(found.contacts.empty()) << "interval " << i;
  }
}

TEST_P(ContactSceneFiles, MeetThemselvesInATenthOfTheirIntervals) {
  const Clip clip = frames();
  ASSERT_TRUE(clip.header().predicted);
  const TriangleMesh mesh = this->mesh(clip);
  const Scene scene = load_scene(GetParam().name);
  const Shape shape = make_shape(scene.shape, scene.shape_parameters);
  const bool boned = !shape.rig.parent.empty() && mesh.closed_and_oriented();
  const StrategyInput setup{mesh, shape.positions, boned ? &shape.rig : nullptr,
                            *find_elementary_test("exact")};
  const std::unique_ptr<Detector> detector =
      boned ? make_drvbc(setup).detector
            : compose(std::make_unique<PlainCuller<Kdop16>>(setup), setup, {.relative_boxes = true});
  ContactSet found;
  std::size_t corrected = 0;
  for (std::size_t i = 0; i < clip.interval_count(); ++i) {
    const ClipInterval interval = clip.interval(i);
    const bool differs = !std::ranges::equal(interval.motion.end(), clip.frame(i + 1).positions);
    corrected += differs;
    if (i % 8 != 0) continue;
    const Rig::Interval* bones = boned ? &*interval.bones : nullptr;
    detector->detect({interval.motion, bones}, found);
    EXPECT_EQ(differs, !found.contacts.empty())
        << "interval " << i << ": corrected where it collides, nowhere else";
    const Motion taken(interval.motion.start(), clip.frame(i + 1).positions);
    detector->detect({taken, bones}, found);
    EXPECT_TRUE(found.contacts.empty()) << "interval " << i << ": the way to the next start is free";
  }
  RecordProperty("contact_share", std::to_string(corrected) + " of " + std::to_string(clip.interval_count()));
  EXPECT_GE(10 * corrected, clip.interval_count());
}

const auto kName = [](const auto& asked) { return std::string(asked.param.name); };
INSTANTIATE_TEST_SUITE_P(All, SceneFiles, testing::ValuesIn(kScenes), kName);
INSTANTIATE_TEST_SUITE_P(Without, FreeSceneFiles, testing::ValuesIn(scenes_that(false)), kName);
INSTANTIATE_TEST_SUITE_P(With, ContactSceneFiles, testing::ValuesIn(scenes_that(true)), kName);

TEST(SceneFolder, IsAllTested) {
  for (const std::string& name : tracked_scenes())
    EXPECT_TRUE(std::ranges::any_of(kScenes, [&](const Asked& asked) { return asked.name == name; }))
        << name << ": add it here";
}

}  // namespace
}  // namespace cscd::scenes
