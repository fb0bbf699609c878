#include <gtest/gtest.h>
#include <map>
#include <set>
#include <sstream>

#include "core/elementary/catalogue.h"
#include "core/elementary/exact/brute_referee.h"
#include "core/elementary/exact/closeness.h"
#include "core/geometry/nearest_points.h"
#include "scenes/hard/family.h"

namespace cscd::scenes::hard {
namespace {

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

TEST(CloseCases, ASecondRefereeAgreesOnTheLattice) {
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
