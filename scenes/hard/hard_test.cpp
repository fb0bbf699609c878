#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/digest.h"
#include "core/elementary/catalogue.h"
#include "core/elementary/exact/closeness.h"
#include "core/elementary/exact/exact.h"
#include "core/elementary/exact/test_brute_oracle.h"
#include "core/geometry/nearest_points.h"
#include "scenes/hard/disturbance.h"
#include "scenes/hard/family.h"

namespace cscd::scenes::hard {

namespace {

constexpr std::uint64_t kSeed = 5;
constexpr Kind kKinds[] = {Kind::vertex_face, Kind::edge_edge};

std::string text(const Query& query) {
  std::ostringstream out;
  out << std::hexfloat;
  for (const MovingPoint& p : query.points) out << p.start.transpose() << " -> " << p.end.transpose() << "\n";
  return out.str();
}
Answer ask(const ElementaryTest& row, const Query& query, Kind kind) {
  return kind == Kind::vertex_face ? row.vertex_face(as_vertex_face(query))
                                   : row.edge_edge(as_edge_edge(query));
}
std::optional<exact::TimeEnclosure> truth_of(const Query& query, Kind kind) {
  return kind == Kind::vertex_face ? exact::first_contact(as_vertex_face(query))
                                   : exact::first_contact(as_edge_edge(query));
}

// Calls check(family, kind, number) for every family, every kind, and numbers below `count`.
template <class Check>
void for_each_case(std::size_t count, const Check& check) {
  for (const Family& family : families())
    for (const Kind kind : kKinds)
      for (std::size_t i = 0; i < count; ++i) {
        SCOPED_TRACE(std::string(family.name) + (kind == Kind::vertex_face ? " vf " : " ee ") +
                     std::to_string(i));
        check(family, kind, i);
        if (testing::Test::HasFailure()) return;
      }
}

TEST(HardCases, EveryFamilyHasContactsAndNone) {
  for (const Family& family : families()) {
    EXPECT_FALSE(family.story.empty());
    for (const Kind kind : kKinds) {
      int contacts = 0, off_lattice = 0;
      constexpr int count = 400;
      for (std::size_t i = 0; i < count; ++i) {
        const Query query = suite_query(family, kind, i, kSeed);
        for (const MovingPoint& p : query.points) {
          ASSERT_TRUE(p.start.allFinite()) << family.name;
          ASSERT_TRUE(p.end.allFinite()) << family.name;
        }
        contacts += in_contact(query, kind);
        off_lattice += in_contact(random_query(family, kind, 1e-9, i, kSeed), kind);
      }
      EXPECT_GT(contacts, count / 50) << family.name << static_cast<int>(kind);
      EXPECT_LT(contacts, count * 49 / 50) << family.name << static_cast<int>(kind);
      EXPECT_GT(off_lattice, 0) << family.name << static_cast<int>(kind);
      EXPECT_LT(off_lattice, count) << family.name << static_cast<int>(kind);
    }
  }
}

TEST(HardCases, DependOnTheSeedAlone) {
  for_each_case(3, [](const Family& family, Kind kind, std::size_t i) {
    EXPECT_EQ(text(suite_query(family, kind, i, kSeed)), text(suite_query(family, kind, i, kSeed)));
    EXPECT_EQ(text(random_query(family, kind, 1e-3, i, kSeed)),
              text(random_query(family, kind, 1e-3, i, kSeed)));
  });
}

// The brute-force oracle gives the truth a second time and shares no algorithm with the oracle.
TEST(HardCases, ASecondOracleAgreesOnTheLattice) {
  for_each_case(6, [](const Family& family, Kind kind, std::size_t i) {
    Random random(kSeed + i);
    const Query query = family.make(kind, random);
    const brute::Four points{brute::moving(query.points[0]), brute::moving(query.points[1]),
                             brute::moving(query.points[2]), brute::moving(query.points[3])};
    const auto brute =
        brute::first_contact(points, kind == Kind::vertex_face ? brute::kVertexTriangle : brute::kEdgeEdge);
    EXPECT_EQ(brute.has_value(), in_contact(query, kind)) << text(query);
  });
}

TEST(HardCases, ProofsHoldOnTheSuite) {
  for_each_case(240, [](const Family& family, Kind kind, std::size_t i) {
    const Query query = suite_query(family, kind, i, kSeed);
    const auto truth = truth_of(query, kind);
    for (const ElementaryTest& row : elementary_tests()) {
      if (!row.apart_is_proof && !row.contact_is_proof) continue;
      const Answer answer = ask(row, query, kind);
      if (row.apart_is_proof && truth) {
        EXPECT_NE(answer.verdict, Verdict::apart) << row.name << "\n" << text(query);
        EXPECT_LE(answer.time, truth->hi) << row.name << "\n" << text(query);
      }
      if (row.contact_is_proof && !truth) {
        EXPECT_NE(answer.verdict, Verdict::contact) << row.name << "\n" << text(query);
      }
      // A test that is exact both ways gives the oracle's bits as the time. So its time is the same with
      // every compiler and instruction set.
      if (row.apart_is_proof && row.contact_is_proof && truth) {
        EXPECT_EQ(answer.time, truth->lo) << row.name << "\n" << text(query);
      }
    }
  });
}

TEST(HardCases, ProofsHoldAtEveryHardness) {
  for (double hardness = 0.1; hardness > 1e-17; hardness /= 100)
    for_each_case(24, [&](const Family& family, Kind kind, std::size_t i) {
      const Query query = random_query(family, kind, hardness, i, kSeed);
      const bool contact = in_contact(query, kind);
      for (const ElementaryTest& row : elementary_tests()) {
        if (row.apart_is_proof && contact) {
          EXPECT_NE(ask(row, query, kind).verdict, Verdict::apart) << row.name << "\n" << text(query);
        }
        if (row.contact_is_proof && !contact) {
          EXPECT_NE(ask(row, query, kind).verdict, Verdict::contact) << row.name << "\n" << text(query);
        }
      }
    });
}

template <class Map>
Query mapped(Query query, const Map& map) {
  for (MovingPoint& p : query.points) p = {map(p.start), map(p.end)};
  return query;
}
Query swapped(Query query, std::size_t a, std::size_t b) {
  std::swap(query.points[a], query.points[b]);
  return query;
}

// The query times 2^exponent, or nullopt if a coordinate would lose digits or overflow.
std::optional<Query> scaled_exactly(const Query& query, int exponent) {
  bool exact = true;
  const Query there = mapped(query, [&](const Vec3& p) {
    Vec3 q;
    for (int axis = 0; axis < 3; ++axis) {
      q[axis] = std::ldexp(p[axis], exponent);
      exact = exact && std::ldexp(q[axis], -exponent) == p[axis];
    }
    return q;
  });
  return exact ? std::optional(there) : std::nullopt;
}

// Tests that are exact both ways must keep their answers under symmetries that keep the truth.
TEST(HardCases, ExactAnswersKeepUnderSymmetries) {
  for_each_case(48, [](const Family& family, Kind kind, std::size_t i) {
    const Query query = suite_query(family, kind, i, kSeed);
    std::vector<Query> same = {mapped(query, [](const Vec3& p) { return Vec3(-p); }),
                               mapped(query, [](const Vec3& p) { return Vec3(p.z(), p.x(), p.y()); })};
    if (kind == Kind::vertex_face) {
      same.push_back(swapped(query, 1, 2));
      same.push_back(swapped(query, 2, 3));
    } else {
      same.push_back(swapped(query, 0, 1));
      same.push_back(swapped(query, 2, 3));
      same.push_back(swapped(swapped(query, 0, 2), 1, 3));
    }
    for (const int exponent : {-200, 150})
      if (const auto there = scaled_exactly(query, exponent)) same.push_back(*there);
    Query reversed = query;
    for (MovingPoint& p : reversed.points) std::swap(p.start, p.end);
    for (const ElementaryTest& row : elementary_tests()) {
      if (!row.apart_is_proof || !row.contact_is_proof) continue;
      const Answer answer = ask(row, query, kind);
      for (std::size_t k = 0; k < same.size(); ++k) {
        const Answer again = ask(row, same[k], kind);
        EXPECT_EQ(again.verdict, answer.verdict) << row.name << ", symmetry " << k << "\n" << text(query);
        if (answer.verdict == Verdict::contact) {
          EXPECT_EQ(again.time, answer.time) << row.name << ", symmetry " << k << "\n" << text(query);
        }
      }
      EXPECT_EQ(ask(row, reversed, kind).verdict, answer.verdict) << row.name << "\n" << text(query);
    }
  });
}

// The translation moves every coordinate without rounding.
TEST(HardCases, ExactAnswersKeepUnderExactTranslation) {
  for (const Family& family : families()) {
    if (family.name == "extreme_scale" || family.name == "grazing") continue;  // would round
    for (const Kind kind : kKinds)
      for (int i = 0; i < 24; ++i) {
        Random random(kSeed + static_cast<std::uint64_t>(i));
        const Query query = family.make(kind, random);
        const Vec3 by(1 << 20, -12345, 1 << 18);
        const Query there = mapped(query, [&](const Vec3& p) { return Vec3(p + by); });
        for (const ElementaryTest& row : elementary_tests()) {
          if (!row.apart_is_proof || !row.contact_is_proof) continue;
          const Answer a = ask(row, query, kind), b = ask(row, there, kind);
          EXPECT_EQ(a.verdict, b.verdict) << row.name << " " << family.name << "\n" << text(query);
          if (a.verdict == Verdict::contact) {
            EXPECT_EQ(a.time, b.time) << row.name << " " << family.name;
          }
        }
      }
  }
}

constexpr std::uint64_t kCloseSeed = 58;

std::string text(const CloseQuery& q) {
  std::ostringstream out;
  out << std::hexfloat << "r = " << q.r << "\n";
  for (const MovingPoint& p : q.query.points)
    out << p.start.transpose() << " -> " << p.end.transpose() << "\n";
  return out.str();
}

template <class Check>
void for_each_close_case(std::size_t count, const Check& check) {
  for (const CloseFamily& family : close_families())
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge})
      for (std::size_t i = 0; i < count; ++i) {
        SCOPED_TRACE(std::string(family.name) + (kind == Kind::vertex_face ? " vf " : " ee ") +
                     std::to_string(i));
        check(family, kind, i);
        if (testing::Test::HasFailure()) return;
      }
}

TEST(CloseCases, EveryFamilyHasCloseQueriesAndOthers) {
  for (const CloseFamily& family : close_families())
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      int close = 0, lattice = 0;
      constexpr int count = 300;
      for (std::size_t i = 0; i < count; ++i) {
        close += is_close(close_suite_query(family, kind, i, kCloseSeed), kind);
        Random random(i);
        lattice += is_close(family.make(kind, random), kind);
      }
      for (const int number : {close, lattice}) {
        EXPECT_GT(number, count / 20) << family.name << static_cast<int>(kind);
        EXPECT_LT(number, count * 19 / 20) << family.name << static_cast<int>(kind);
      }
    }
}

// Mutation: two numbers are drawn as arguments of one call, in an order that each compiler chooses for
// itself.
TEST(CloseCases, AreTheSameWithEveryCompiler) {
  std::uint64_t digest = kDigestOfNothing;
  const auto add = [&](double value) { digest = digest_step(digest, std::bit_cast<std::uint64_t>(value)); };
  for (const CloseFamily& family : close_families())
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge})
      for (std::uint64_t seed = 0; seed < 50; ++seed) {
        Random random(seed);
        const CloseQuery made = family.make(kind, random);
        add(made.r);
        for (const MovingPoint& point : made.query.points)
          for (int axis = 0; axis < 3; ++axis) add(point.start[axis]), add(point.end[axis]);
      }
  EXPECT_EQ(hex_text(digest), "e849714b8a86e6b6");
}

// All seven cases of a vertex and a face and all nine of two edges come up where features become close.
TEST(CloseCases, EveryCaseOfNearestFeaturesComesUp) {
  std::set<int> vertex_face, edges;
  for (std::size_t i = 0; i < 600; ++i) {
    const CloseFamily& family = close_families()[0];
    const CloseQuery vf = close_suite_query(family, Kind::vertex_face, i, kCloseSeed),
                     ee = close_suite_query(family, Kind::edge_edge, i, kCloseSeed);
    const auto pose = [](const Query& q, double t) {
      return std::array{q.points[0].at(t), q.points[1].at(t), q.points[2].at(t), q.points[3].at(t)};
    };
    if (const auto t = exact::first_closeness(as_vertex_face(vf.query), vf.r))
      vertex_face.insert(nearest_of_vertex_face(pose(vf.query, t->lo)).number);
    if (const auto t = exact::first_closeness(as_edge_edge(ee.query), ee.r))
      edges.insert(nearest_of_edges(pose(ee.query, t->lo)).number);
  }
  EXPECT_EQ(vertex_face.size(), 7);
  EXPECT_EQ(edges.size(), 9);
}

TEST(CloseCases, ASecondOracleAgreesOnTheLattice) {
  for_each_close_case(4, [](const CloseFamily& family, Kind kind, std::size_t i) {
    Random random(kCloseSeed + i);
    const CloseQuery made = family.make(kind, random);
    const auto& p = made.query.points;
    const brute::Four points{brute::moving(p[0]), brute::moving(p[1]), brute::moving(p[2]),
                             brute::moving(p[3])};
    const auto brute = brute::first_closeness(points, kind == Kind::vertex_face, mpq_class(made.r));
    EXPECT_EQ(brute.has_value(), is_close(made, kind)) << text(made);
  });
}

TEST(CloseCases, ProofsHoldOnTheSuite) {
  for_each_close_case(120, [](const CloseFamily& family, Kind kind, std::size_t i) {
    const CloseQuery asked = close_suite_query(family, kind, i, kCloseSeed);
    const auto check = [&](const auto& query) {
      const auto truth = exact::first_closeness(query, asked.r);
      for (const ElementaryTest& row : elementary_tests()) {
        if (!row.knows_distance()) continue;
        const Answer answer = row.answer_close(query, asked.r);
        if (row.apart_is_proof && truth) {
          EXPECT_NE(answer.verdict, Verdict::apart) << row.name << "\n" << text(asked);
          EXPECT_LE(answer.time, truth->hi) << row.name << "\n" << text(asked);
        }
        if (row.contact_is_proof && !truth) {
          EXPECT_NE(answer.verdict, Verdict::contact) << row.name << "\n" << text(asked);
        }
        if (row.apart_is_proof && row.contact_is_proof && truth) {
          EXPECT_EQ(answer.time, truth->lo) << row.name << "\n" << text(asked);
        }
      }
    };
    if (kind == Kind::vertex_face)
      check(as_vertex_face(asked.query));
    else
      check(as_edge_edge(asked.query));
  });
}

}  // namespace

}  // namespace cscd::scenes::hard
