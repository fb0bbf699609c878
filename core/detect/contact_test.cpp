#include "core/detect/contact.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>
#include <set>

namespace cscd {
namespace {

Contact contact(FeaturePair::Kind kind, std::int32_t a, std::int32_t b, double time,
                Verdict verdict = Verdict::contact) {
  return {{kind, a, b}, verdict, time};
}
constexpr auto kVf = FeaturePair::Kind::vertex_face, kEe = FeaturePair::Kind::edge_edge;

ContactSet some_contacts() {
  ContactSet set;
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i)  // pairs are different, times are not
    set.contacts.push_back(contact(i % 2 ? kVf : kEe, i, static_cast<int>(random() % 50) + 200,
                                   static_cast<double>(random() % 8) / 8));
  return set;
}

TEST(ContactSet, SortsByTimeThenPair) {
  ContactSet set{{contact(kEe, 1, 2, 0.5), contact(kVf, 9, 9, 0.5), contact(kVf, 9, 3, 0.5),
                  contact(kVf, 2, 7, 0.5), contact(kEe, 4, 5, 0.25)}};
  set.sort();
  const std::vector<FeaturePair> expected = {{kEe, 4, 5}, {kVf, 2, 7}, {kVf, 9, 3}, {kVf, 9, 9}, {kEe, 1, 2}};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(set.contacts[i].pair, expected[i]);
  set.clear();
  EXPECT_TRUE(set.contacts.empty());
}

TEST(Digest, DoesNotDependOnTheOrderOfDetection) {
  ContactSet set = some_contacts();
  set.sort();
  const std::string expected = digest(set);
  EXPECT_EQ(expected.size(), 16u);
  std::mt19937 random(2);
  for (int i = 0; i < 20; ++i) {
    std::shuffle(set.contacts.begin(), set.contacts.end(), random);
    set.sort();
    EXPECT_EQ(digest(set), expected);
  }
}

// The FNV-1a hash of no bytes, and that of forty zero bytes, computed from the definition.
TEST(Digest, IsFnv1a) {
  EXPECT_EQ(digest({}), "cbf29ce484222325");
  std::uint64_t hash = 0xcbf29ce484222325;
  for (int i = 0; i < 40; ++i) hash *= 0x100000001b3;
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  EXPECT_EQ(digest({{contact(kVf, 0, 0, 0.0, Verdict::apart)}}), text);
}

TEST(Digest, SeesEveryField) {
  const auto one = [](Contact c) { return digest({{contact(kVf, 1, 1, 0.125), c}}); };
  std::set<std::string> digests = {
      one(contact(kVf, 3, 5, 0.5)),
      one(contact(kEe, 3, 5, 0.5)),
      one(contact(kVf, 4, 5, 0.5)),
      one(contact(kVf, 3, 6, 0.5)),
      one(contact(kVf, 5, 3, 0.5)),
      one(contact(kVf, 3, 5, 0.5, Verdict::undecided)),
      one(contact(kVf, 3, 5, std::nextafter(0.5, 1))),
      one(contact(kVf, 3, 5, std::nextafter(0.5, 0))),
      digest({{contact(kVf, 1, 1, 0.125)}}),
      digest({}),
  };
  EXPECT_EQ(digests.size(), 10u);
}

TEST(Ask, FindsTheFeaturesOfThePair) {
  // Two triangles without a common vertex. No two vertices have the same position.
  const TriangleMesh mesh({{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{3}, VertexId{4}, VertexId{5}}},
                          6);
  std::vector<Vec3> start, end;
  for (int i = 0; i < 6; ++i) start.emplace_back(i, 10 + i, 20 + i), end.emplace_back(i, 30 + i, 40 + i);
  static MovingVertexFace asked_vf;
  static MovingEdgeEdge asked_ee;
  const ElementaryTest recorder{"recorder",
                                "",
                                false,
                                false,
                                one_by_one<[](const MovingVertexFace& q) {
                                  asked_vf = q;
                                  return Answer{Verdict::contact, 0.25};
                                }>,
                                one_by_one<[](const MovingEdgeEdge& q) {
                                  asked_ee = q;
                                  return Answer{Verdict::undecided, 0.5};
                                }>};
  const Motion motion(start, end);
  const Answer vf = ask(recorder, mesh, motion, FeaturePair::of(VertexId{4}, TriangleId{0}));
  EXPECT_EQ(vf.time, 0.25);
  EXPECT_EQ(asked_vf.vertex.start, start[4]);
  EXPECT_EQ(asked_vf.vertex.end, end[4]);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(asked_vf.corner[k].start, start[k]);
    EXPECT_EQ(asked_vf.corner[k].end, end[k]);
  }
  const EdgeId e = mesh.edges_of(TriangleId{1})[0], f = mesh.edges_of(TriangleId{0})[1];
  const Answer ee = ask(recorder, mesh, motion, FeaturePair::of(e, f));
  EXPECT_EQ(ee.verdict, Verdict::undecided);
  const FeaturePair pair = FeaturePair::of(e, f);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(asked_ee.first[k].end, end[+mesh.ends(EdgeId{pair.a})[k]]);
    EXPECT_EQ(asked_ee.second[k].start, start[+mesh.ends(EdgeId{pair.b})[k]]);
  }
}

}  // namespace
}  // namespace cscd
