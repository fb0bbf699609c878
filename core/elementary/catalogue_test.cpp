// Compares the promises of all rows of the catalogue with the oracle. A new row is tested without a change
// here.
#include "core/elementary/catalogue.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <utility>
#include <vector>

#include "core/elementary/exact/closeness.h"
#include "core/elementary/exact/exact.h"
#include "core/elementary/question/query_scale.h"
#include "core/elementary/question/test_queries.h"

namespace cscd {
namespace {

using test::FourMovingPoints;
using test::query_of;
using test::QueryMaker;

struct Family {
  const char* name;
  int count;
  std::function<FourMovingPoints(QueryMaker&, bool vertex_face)> make;
};

FourMovingPoints crossing(QueryMaker& make, bool vertex_face, double hair) {
  const double t = make.uniform(0.05, 0.95), along = make.uniform(0.1, 0.9);
  return vertex_face ? test::vertex_meets_face(make, t, hair, along * (1 - hair))
                     : test::edge_meets_edge(make, t, hair, along);
}

const std::vector<Family> kFamilies = {
    {"any", 1500, [](QueryMaker& make, bool) { return make.any(); }},
    {"crossing", 500, [](QueryMaker& make, bool vf) { return crossing(make, vf, 0.3); }},
    {"grazing", 500,
     [](QueryMaker& make, bool vf) { return crossing(make, vf, make.below(2) ? 1e-7 : -1e-7); }},
    {"lattice", 1500, [](QueryMaker& make, bool) { return make.lattice(1 + make.below(3)); }},
    {"far from the origin", 500,
     [](QueryMaker& make, bool vf) {
       const Vec3 far = 1e3 * make.vector();
       return test::moved(crossing(make, vf, make.uniform(0, 0.5)), far, far);
     }},
    {"fast common motion", 500,
     [](QueryMaker& make, bool vf) {
       return test::moved(crossing(make, vf, make.uniform(0, 0.5)), Vec3::Zero(), 1e6 * make.vector());
     }},
    {"tiny", 300,
     [](QueryMaker& make, bool vf) {
       return test::scaled(crossing(make, vf, make.uniform(-0.1, 0.5)), 1e-300);
     }},
    {"huge", 300,
     [](QueryMaker& make, bool vf) {
       return test::scaled(crossing(make, vf, make.uniform(-0.1, 0.5)), 1e150);
     }},
    {"subnormal", 300, [](QueryMaker& make, bool) { return test::scaled(make.lattice(2), 0x1p-1070); }},
};

// What each row promises of its answers. All families take part.
TEST(Catalogue, ProofsHold) {
  int contacts = 0;
  for (const Family& family : kFamilies) {
    QueryMaker make{17};
    for (int i = 0; i < family.count; ++i) {
      const FourMovingPoints vf = family.make(make, true), ee = family.make(make, false);
      const auto ask_all = [&](const FourMovingPoints& points, const auto& query) {
        const auto truth = exact::first_contact(query);
        for (const ElementaryTest& row : elementary_tests()) {
          SCOPED_TRACE(std::string(row.name) + ", " + family.name + "\n" + test::text(points));
          const Answer answer = row.answer(query);
          contacts += truth.has_value();
          if (row.apart_is_proof && truth) {
            EXPECT_NE(answer.verdict, Verdict::apart);
            EXPECT_LE(answer.time, truth->hi);
            if (answer.verdict == Verdict::contact && row.contact_is_proof) {
              EXPECT_NEAR(answer.time, truth->lo, 1e-12);
            }
          }
          if (row.contact_is_proof && !truth) {
            EXPECT_NE(answer.verdict, Verdict::contact);
          }
          if (answer.verdict != Verdict::apart) {
            EXPECT_GE(answer.time, 0);
            EXPECT_LE(answer.time, 1);
          }
        }
      };
      ask_all(vf, query_of<MovingVertexFace>(vf));
      ask_all(ee, query_of<MovingEdgeEdge>(ee));
      if (testing::Test::HasFailure()) return;  // one failure is enough to read
    }
  }
  EXPECT_GT(contacts, 1000);
}

// The same at random distances.
TEST(Catalogue, ProofsHoldAtADistance) {
  int close = 0, apart = 0;
  for (const Family& family : kFamilies) {
    QueryMaker make{58};
    for (int i = 0; i < family.count / 3; ++i) {
      const FourMovingPoints vf = family.make(make, true), ee = family.make(make, false);
      const auto ask_all = [&](const FourMovingPoints& points, const auto& query) {
        const double r = extent(query) * std::exp(make.uniform(-8, 0));
        const auto truth = exact::first_closeness(query, r);
        ++(truth ? close : apart);
        for (const ElementaryTest& row : elementary_tests()) {
          if (!row.knows_distance() || r == 0) continue;
          SCOPED_TRACE(std::string(row.name) + ", " + family.name + ", r = " + std::to_string(r) + "\n" +
                       test::text(points));
          const Answer answer = row.answer_close(query, r);
          if (row.apart_is_proof && truth) {
            EXPECT_NE(answer.verdict, Verdict::apart);
            EXPECT_LE(answer.time, truth->hi);
            if (answer.verdict == Verdict::contact && row.contact_is_proof) {
              EXPECT_EQ(answer.time, truth->lo);
            }
          }
          if (row.contact_is_proof && !truth) {
            EXPECT_EQ(answer.verdict, Verdict::apart);
          }
          if (answer.verdict != Verdict::apart) {
            EXPECT_GE(answer.time, 0);
            EXPECT_LE(answer.time, 1);
          }
        }
      };
      ask_all(vf, query_of<MovingVertexFace>(vf));
      ask_all(ee, query_of<MovingEdgeEdge>(ee));
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(close, 1000);
  EXPECT_GT(apart, 300);
}

TEST(Catalogue, AtDistanceZeroAnswersAreThoseOfTouching) {
  QueryMaker make{58};
  for (int i = 0; i < 2000; ++i) {
    const auto query = query_of<MovingEdgeEdge>(make.lattice(2));
    for (const ElementaryTest& row : elementary_tests()) {
      const Answer touching = row.answer(query), close = row.answer_close(query, 0);
      EXPECT_EQ(close.verdict, touching.verdict) << row.name;
      EXPECT_EQ(close.time, touching.time) << row.name;
    }
  }
}

TEST(Catalogue, DistancesThatAreNoneAreRefused) {
  const auto query = test::against_triangle({1, 1, 1}, {1, 1, -1});
  for (const ElementaryTest& row : elementary_tests()) {
    for (const double r : {-1.0, -1e-300, std::nan(""), HUGE_VAL}) {
      EXPECT_THROW(row.answer_close(query, r), InputError) << row.name << " at " << r;
    }
    if (!row.knows_distance()) {
      EXPECT_THROW(row.answer_close(query, 0.1), InputError) << row.name;
    }
  }
}

TEST(Catalogue, NamesAreUnique) {
  for (const ElementaryTest& row : elementary_tests()) EXPECT_EQ(find_elementary_test(row.name), &row);
  EXPECT_EQ(find_elementary_test("none such"), nullptr);
}

}  // namespace
}  // namespace cscd
