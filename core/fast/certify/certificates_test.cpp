#include "core/fast/certify/certificates.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

#include "core/detect/test_feature_pairs.h"
#include "core/fast/certify/test_certificates.h"

namespace cscd::fast {

namespace {

using radial::Orientation;

template <class Visit>
void for_each_pair_of_lanes(const CertifiedBody& scene, const Visit& visit) {
  const std::vector<Patch>& patches = scene.tree.patches;
  for (std::size_t p = 0; p < patches.size(); ++p)
    for (std::size_t q = 0; q < patches.size(); ++q)
      for (std::size_t i = 0; patches[p].lanes >> i != 0; ++i) {
        const Mask16 needed = scene.certificates.shared(p, q).needed(i);
        for (std::size_t j = 0; patches[q].lanes >> j != 0; ++j)
          visit(scene.tree.triangles[p][i], scene.tree.triangles[q][j], (needed >> j & 1) != 0);
      }
}

// Both drop the same pairs, in all nodes.
void expect_same(const CertifiedBody& scene, const Certificates& found, const Certificates& expected) {
  for (std::size_t p = 0; p < scene.tree.patches.size(); ++p)
    for (std::size_t q = 0; q < scene.tree.patches.size(); ++q) {
      const Certificates::Shared one = found.shared(p, q), other = expected.shared(p, q);
      ASSERT_TRUE(one.p == other.p && one.q == other.q) << p << " and " << q;
    }
  for (std::size_t a = 0; a < scene.tree.nodes.size(); ++a)
    for (std::size_t b = a; b < scene.tree.nodes.size(); ++b)
      ASSERT_EQ(found.skip(a, b), expected.skip(a, b)) << a << " and " << b;
}

struct Case {
  bool inside_out;
  CertifiedBody::Bones bones;
};
constexpr Case kCases[] = {{false, CertifiedBody::Bones::chain},
                           {true, CertifiedBody::Bones::chain},
                           {false, CertifiedBody::Bones::sixths},
                           {true, CertifiedBody::Bones::sixths}};

// Mutations: certify_by_rings takes the certificate from the triangle that is not positive instead of from
// all round it; needed() compares signs of different clusters, or drops pairs whose triangles are certified
// by different covers; certify_by_rings ignores neighbours when it certifies negatives.
TEST(Certificates, APairIsDroppedOnlyByOneField) {
  for (const auto& [inside_out, bones] : kCases)
    for (int seed = 1; seed <= 2; ++seed) {
      const CertifiedBody scene(0.04 * seed, 3, seed, inside_out, bones);
      EXPECT_EQ(scene.covers[2].observers.empty(), bones == CertifiedBody::Bones::chain);
      std::size_t dropped = 0, needed_though_each_is_certified = 0, certain = 0;
      for_each_pair_of_lanes(scene, [&](TriangleId t, TriangleId u, bool needed) {
        certain += scene.one_field(t, u);
        if (!needed) {
          ++dropped;
          EXPECT_TRUE(scene.one_field(t, u)) << +t << " and " << +u << ", seed " << seed;
          return;
        }
        const auto by_some = [&](TriangleId triangle) {
          for (std::size_t c = 0; c < kCovers; ++c)
            if (scene.certain(c, triangle) != Orientation::uncertain) return true;
          return false;
        };
        needed_though_each_is_certified += by_some(t) && by_some(u);
      });
      EXPECT_GT(needed_though_each_is_certified, 1000u) << "else mixing covers would change nothing";
      EXPECT_GT(dropped, certain * 9 / 10) << "float bounds cost little";
      EXPECT_LT(certain, scene.mesh.triangle_count() * scene.mesh.triangle_count() / 2);
    }
}

// Rule one-field. A feature pair is dropped if all triangle pairs that carry it are dropped. Mutations: the
// second cover also certifies triangles by themselves, as positive or as negative.
TEST(Certificates, RuleOneFieldAFeaturePairIsDroppedOnlyByOneFieldAllRoundIt) {
  for (const auto& [inside_out, bones] : kCases) {
    const CertifiedBody scene(0.08, 3, 2, inside_out, bones);
    const TriangleMesh& mesh = scene.mesh;
    std::vector<std::vector<bool>> needed(mesh.triangle_count(), std::vector<bool>(mesh.triangle_count()));
    for_each_pair_of_lanes(scene, [&](TriangleId t, TriangleId u, bool is) { needed[+t][+u] = is; });
    std::size_t dropped = 0;
    const auto look = [&](std::span<const TriangleId> at, std::span<const TriangleId> also_at) {
      for (const TriangleId t : at)
        for (const TriangleId u : also_at)
          if (needed[+t][+u]) return;
      ++dropped;
      EXPECT_TRUE(scene.one_field(at, also_at)) << +at[0] << " and " << +also_at[0];
    };
    for (const FeaturePair& pair : test::all_feature_pairs(mesh)) {
      const TriangleId face[] = {TriangleId{pair.b}};
      if (pair.kind == FeaturePair::Kind::vertex_face)
        look(mesh.triangles_at(VertexId{pair.a}), face);
      else
        look(mesh.triangles_at(EdgeId{pair.a}), mesh.triangles_at(EdgeId{pair.b}));
    }
    EXPECT_GT(dropped, 100'000u);
  }
}

// Mutation: label_nodes takes the left child's label.
TEST(Certificates, ANodeIsSkippedOnlyWhereAllPairsBelowAre) {
  const CertifiedBody scene(0.04, 3, 1);
  std::vector<std::vector<std::size_t>> below(scene.tree.nodes.size());
  for (std::size_t n = below.size(); n-- > 0;) {
    const PatchTree::Node& node = scene.tree.nodes[n];
    if (node.is_leaf()) {
      below[n] = {node.patch()};
      continue;
    }
    below[n] = below[node.left()];
    const std::vector<std::size_t>& right = below[node.right()];
    below[n].insert(below[n].end(), right.begin(), right.end());
  }
  std::size_t skipped_inner = 0;
  for (std::size_t a = 0; a < below.size(); ++a)
    for (std::size_t b = a; b < below.size(); ++b) {
      if (!scene.certificates.skip(a, b)) continue;
      skipped_inner += below[a].size() > 1;
      for (const std::size_t p : below[a])
        for (const std::size_t q : below[b])
          for (std::size_t i = 0; scene.tree.patches[p].lanes >> i != 0; ++i)
            ASSERT_EQ(scene.certificates.shared(p, q).needed(i), 0) << "nodes " << a << " and " << b;
    }
  EXPECT_GT(skipped_inner, 10u);
}

// Mutations: certificates of covers that are no longer used stay; orientation_passes counts all covers.
TEST(Certificates, CoversThatAreNotUsedDropNothing) {
  CertifiedBody scene(0.04, 3, 1, false, CertifiedBody::Bones::sixths);
  const std::size_t passes = scene.certificates.orientation_passes();
  EXPECT_EQ(
      scene.certificates.counts().clusters,
      scene.covers[0].observers.size() + scene.covers[1].observers.size() + scene.covers[2].observers.size());
  scene.certificates.use_covers(1);
  EXPECT_EQ(scene.certificates.orientation_passes(), scene.tree.patches.size());
  EXPECT_GT(passes, scene.tree.patches.size() * 3 / 2);
  EXPECT_EQ(scene.certificates.counts().clusters, scene.covers[0].observers.size());
  scene.certify();
  std::size_t dropped = 0;
  for_each_pair_of_lanes(scene, [&](TriangleId t, TriangleId u, bool needed) {
    dropped += !needed;
    EXPECT_TRUE(needed || scene.cluster(0, +t) == scene.cluster(0, +u)) << +t << " and " << +u;
  });
  EXPECT_GT(dropped, 10'000u);
}

// The triangles of each cover that are certainly positive and clear, as the contour tests of its clusters say
// if they are asked directly: [covers][patches].
std::vector<std::vector<Mask16>> clear_triangles(const CertifiedBody& scene) {
  std::vector<std::vector<Mask16>> clear;
  for (std::size_t c = 0; c < scene.covers.size(); ++c) {
    const Cover& cover = scene.covers[c];
    std::vector<Viewpoint> from;
    for (const FollowingPoint& observer : cover.observers)
      from.push_back(placed(observer, scene.local.records()));
    CappedClusters capped(scene.mesh, scene.shape.positions, cover, c);
    capped.start(scene.local, from);
    std::vector<Mask16>& of_patch = clear.emplace_back(scene.tree.patches.size());
    const auto for_each = [&](const auto& take) {
      for (std::size_t p = 0; p < of_patch.size(); ++p) {
        const Patch& patch = scene.tree.patches[p];
        if (patch.cluster[c] == kNone) continue;
        const auto cluster = static_cast<std::size_t>(patch.cluster[c]);
        const Signs signs =
            orientation(load(scene.local.records(), patch.vertex), patch, from[cluster], scene.local.error());
        take(p, patch, cluster, static_cast<Mask16>(patch.lanes & signs.positive));
      }
    };
    for_each(
        [&](std::size_t, const Patch& patch, std::size_t, Mask16 positive) { capped.take(patch, positive); });
    while (capped.choose_other_rays())
      for_each([&](std::size_t, const Patch& patch, std::size_t cluster, Mask16 positive) {
        if (capped.has_other_ray(cluster)) capped.count(patch, positive);
      });
    for_each([&](std::size_t p, const Patch& patch, std::size_t, Mask16 positive) {
      of_patch[p] = capped.clear(patch, positive);
    });
  }
  return clear;
}

// With capped clusters a pair of triangles of one cluster is dropped exactly if one of the two is clear.
// Mutations: patches that the ray of one cover may cross are not counted; a patch counts as clear in all
// covers if it is in one; clear triangles of the second patch are entered elsewhere.
TEST(Certificates, CapsDropAPairOfAClusterWhereOneTriangleIsClear) {
  for (const auto& [bend, bones] :
       {std::pair(0.5, CertifiedBody::Bones::chain), {3.0, CertifiedBody::Bones::sixths}}) {
    CertifiedBody scene(0.02, bend, 1, false, bones);
    Certificates certificates = scene.with_caps();
    classify_all(certificates, scene.tree, scene.local);
    const std::vector<std::vector<Mask16>> clear = clear_triangles(scene);
    std::size_t dropped_by_one_cover = 0, wrong = 0;
    for (std::size_t p = 0; p < scene.tree.patches.size(); ++p)
      for (std::size_t q = 0; q < scene.tree.patches.size(); ++q) {
        const Patch &first = scene.tree.patches[p], &second = scene.tree.patches[q];
        const Certificates::Shared shared = certificates.shared(p, q);
        for_each_lane(first.lanes, [&](std::size_t lane) {
          unsigned needed = second.lanes;
          std::size_t covers = 0;
          for (std::size_t c = 0; c < kCovers; ++c)
            if (first.cluster[c] == second.cluster[c] && first.cluster[c] != kNone) {
              const unsigned dropped = (clear[c][p] >> lane & 1) != 0 ? second.lanes : clear[c][q];
              covers += dropped != 0;
              needed &= ~dropped;
            }
          wrong += shared.needed(lane) != needed;
          dropped_by_one_cover += covers == 1;
        });
      }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(dropped_by_one_cover, 1000u);
  }
}

// A picture shows what the certificates say: signs of the first cover, clusters of all covers, patches, and
// observers where they stand in the scene.
TEST(Certificates, AreShownAsTheyAre) {
  CertifiedBody scene(0.04, 3, 1, false, CertifiedBody::Bones::sixths);
  for (const std::size_t covers : {kCovers, std::size_t{1}}) {
    scene.certificates.use_covers(covers);
    scene.certify();
    const RadialView view = scene.certificates.view();
    ASSERT_EQ(view.further_covers.size(), covers - 1);
    for (std::size_t t = 0; t < scene.mesh.triangle_count(); ++t) {
      EXPECT_EQ(view.positive[t], scene.own[t][0] == Orientation::positive);
      EXPECT_EQ(view.cluster[t], scene.cluster(0, t));
      for (std::size_t c = 1; c < covers; ++c)
        EXPECT_EQ(view.further_covers[c - 1].cluster[t], scene.cluster(c, t));
      const auto members = scene.tree.triangles_of(static_cast<std::size_t>(view.patch[t]));
      EXPECT_NE(std::ranges::find(members, TriangleId{static_cast<std::int32_t>(t)}), members.end());
    }
    for (std::size_t c = 0; c < covers; ++c) {
      const auto& shown = c == 0 ? view.observers : view.further_covers[c - 1].observers;
      ASSERT_EQ(shown.size(), scene.covers[c].observers.size());
      for (std::size_t i = 0; i < shown.size(); ++i) {
        EXPECT_EQ(shown[i].cluster, static_cast<std::int32_t>(i));
        EXPECT_LT((shown[i].head.start - scene.covers[c].observers[i].at(scene.start)).norm(), 1e-3);
        EXPECT_LT((shown[i].tail.end - scene.covers[c].observers[i].at(scene.end)).norm(), 1e-3);
      }
    }
  }
}

// A sphere is one cluster, all of it positive. Half of its patches then become a cluster of their own, seen
// from the same place. Mutation: relabel() leaves patches as they were, with a label that names the old
// cluster.
TEST(Certificates, LabelsNameTheClusterThatAPatchHasNow) {
  const test::Shape sphere = test::icosphere(3);
  const TriangleMesh mesh = sphere.mesh();
  CutSurface cut = cut_surface(mesh, sphere.positions, std::vector<std::int32_t>(mesh.triangle_count(), 0));
  Certificates certificates(mesh, cut.tree, cut.covers);
  LocalPositions local(sphere.positions);
  local.update(Motion(sphere.positions, sphere.positions));
  const auto certify = [&] { classify_all(certificates, cut.tree, local); };
  const std::size_t first = static_cast<std::size_t>(cut.tree.leaf.front()),
                    last = static_cast<std::size_t>(cut.tree.leaf.back());
  certify();
  ASSERT_TRUE(certificates.skip(first, last));
  const std::size_t half = cut.tree.patches.size() / 2;
  cut.covers[0].observers.push_back(cut.covers[0].observers[0]);
  for (std::size_t p = half; p < cut.tree.patches.size(); ++p) cut.tree.patches[p].cluster[0] = 1;
  certificates.resize_first_cover();
  certificates.relabel(half, cut.tree.patches.size());
  certify();
  EXPECT_FALSE(certificates.skip(first, last));
  EXPECT_TRUE(certificates.skip(last, last));
}

TEST(Certificates, NothingIsCertifiedWhereTheMotionLeavesTheRange) {
  CertifiedBody scene(0.01, 1, 1);
  for (Vec3& p : scene.start) p *= 1e10;  // changes no sign, but leaves the range
  for (Vec3& p : scene.end) p *= 1e10;
  scene.local.update(scene.motion());
  ASSERT_FALSE(scene.local.known());
  scene.certify();
  for_each_pair_of_lanes(scene, [](TriangleId, TriangleId, bool needed) { EXPECT_TRUE(needed); });
}

// Takes intervals one after the other with certificates that have seen all intervals before, and with fresh
// certificates for each interval. Both must give the same results.
class FreshBesideUsed {
 public:
  explicit FreshBesideUsed(CertifiedBody& scene) : scene_(scene) {}

  // `mirrored`, [patches], marks patches that are seen from the other side.
  void take(const Motion& motion, const std::vector<bool>& mirrored, std::size_t covers) {
    scene_.local.update(motion);
    classify(scene_.certificates, mirrored);
    Certificates fresh(scene_.mesh, scene_.tree, scene_.covers);
    fresh.use_covers(covers);
    classify(fresh, mirrored);
    ASSERT_NO_FATAL_FAILURE(expect_same(scene_, scene_.certificates, fresh));
    const RadialCounts &found = scene_.certificates.counts(), &expected = fresh.counts();
    ASSERT_EQ(found.positive, expected.positive);
    ASSERT_EQ(found.negative, expected.negative);
    ASSERT_EQ(found.uncertain, expected.uncertain);
    positive.push_back(found.positive);
  }
  std::vector<std::uint64_t> positive;

 private:
  void classify(Certificates& certificates, const std::vector<bool>& mirrored) {
    const std::span<const LocalPositions::Record> records = scene_.local.records();
    float sum = 0;
    for (const LocalPositions::Record& r : records) sum += r.at[1];
    const float twice_middle = 2 * sum / static_cast<float>(records.size());
    certificates.start(scene_.local);
    for (std::size_t p = 0; p < scene_.tree.patches.size(); ++p) {
      PatchLanes lanes = load(records, scene_.tree.patches[p].vertex);
      if (!mirrored.empty() && mirrored[p])
        for (Float16(&end)[3] : lanes.at) end[1] = twice_middle - end[1];
      certificates.classify(p, lanes);
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
  const auto classify = [&](Certificates& certificates, bool all) {
    certificates.use_contour_test(all);
    classify_all(certificates, scene.tree, scene.local);
  };
  Certificates used = scene.with_caps();
  std::size_t different = 0;
  for (const bool all : {true, false, false, true, false}) {
    classify(used, all);
    Certificates fresh = scene.with_caps(), other = scene.with_caps();
    classify(fresh, all), classify(other, !all);
    ASSERT_NO_FATAL_FAILURE(expect_same(scene, used, fresh));
    for (std::size_t p = 0; p < scene.tree.patches.size(); ++p)
      for (std::size_t q = 0; q < scene.tree.patches.size(); ++q)
        different += used.shared(p, q).p != other.shared(p, q).p;
  }
  EXPECT_GT(different, 100u);
}

}  // namespace

}  // namespace cscd::fast
