#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

#include "core/base/number_text.h"
#include "core/base/test_refusal.h"

#include "cscd/cscd.h"

// Holds every entry of the library to the shapes, types and values that it takes: what is right in any layout
// is answered alike, what is wrong is refused with one line, and the object stays usable. Under
// AddressSanitizer this also shows that nothing is read before it is checked.
namespace cscd {
namespace {

using Eigen::Dynamic;
using Eigen::MatrixXd;
using Eigen::MatrixXi;
using Rows = Eigen::Matrix<double, Dynamic, 3, Eigen::RowMajor>;
using Wide = Eigen::Matrix<double, Dynamic, Dynamic, Eigen::RowMajor>;
using Options = SelfCollision::Options;

// A triangle that falls through another in the middle of the step.
const MatrixXi kFaces{{0, 1, 2}, {3, 4, 5}};
const MatrixXd kStart{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 1}, {2, 1, 1}, {1, 2, 1}};
const MatrixXd kEnd{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {2, 1, -1}, {1, 2, -1}};

void expect_refused(const std::string& part, const std::function<void()>& call) {
  const std::string text = test::refusal<std::invalid_argument>(call);
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

void expect_time(SelfCollision body, const SelfCollision::Positions& start,
                 const SelfCollision::Positions& end) {
  EXPECT_EQ(body.first_contact(start, end).time(), 0.5);
}

// Mutation: a matrix is read where it is although its rows have gaps between them.
TEST(Input, EveryLayoutIsReadAlike) {
  const Rows start = kStart, end = kEnd;
  Wide wide_start = Wide::Constant(6, 5, 7), wide_end = wide_start;
  wide_start.middleCols(1, 3) = kStart, wide_end.middleCols(1, 3) = kEnd;
  const MatrixXd across = kStart.transpose();
  const Wide across_end = kEnd.transpose();
  const std::vector<double> flat_start(start.data(), start.data() + 18),
      flat_end(end.data(), end.data() + 18);
  const std::vector<float> float_start(flat_start.begin(), flat_start.end()),
      float_end(flat_end.begin(), flat_end.end());
  const Eigen::Matrix<double, 6, 3> fixed = kStart;

  const auto body = [&] { return SelfCollision(kFaces, kStart); };
  expect_time(body(), start, end);
  expect_time(body(), kStart, kEnd);
  expect_time(body(), fixed, kStart + 1.0 * (kEnd - kStart));
  expect_time(body(), wide_start.middleCols(1, 3), wide_end.middleCols(1, 3));
  expect_time(body(), wide_start.middleCols<3>(1), wide_end.middleCols<3>(1));
  expect_time(body(), across.transpose(), across_end.transpose());
  expect_time(body(), start.cast<float>(), end.array().cast<float>());
  expect_time(body(), flat_start, flat_end);
  expect_time(body(), std::span(float_start), std::span(float_end));
  expect_time(body(), std::span(start.data(), 18), std::span<const double>(end.data(), 18));
  expect_time(body(), start.colwise().reverse().colwise().reverse(), Eigen::Ref<const MatrixXd>(kEnd));
  const Wide twice = kStart.replicate(1, 2).reshaped<Eigen::RowMajor>(12, 3);
  expect_time(body(), Eigen::Map<const Rows, 0, Eigen::OuterStride<>>(twice.data(), 6, 3, {6}), kEnd);

  std::vector<Eigen::Vector3d> list;
  for (const auto& row : kStart.rowwise()) list.push_back(row.transpose());
  expect_time(body(), std::span(list.data()->data(), 3 * list.size()), end);

  const std::vector<std::uint32_t> flat_faces{0, 1, 2, 3, 4, 5};
  const Eigen::Matrix<long, Dynamic, Dynamic> long_faces = kFaces.cast<long>();
  const Eigen::Matrix<std::uint8_t, 2, 3> small_faces = kFaces.cast<std::uint8_t>();
  expect_time(SelfCollision(flat_faces, flat_start), start, end);
  expect_time(SelfCollision(long_faces, float_start), start, end);
  expect_time(SelfCollision(small_faces, kStart), start, end);
}

// Doubles that stand row by row are no copy.
TEST(Input, WhatStandsRowByRowIsReadWhereItIs) {
  const Rows rows = kStart;
  const MatrixXd across = kStart.transpose();
  const SelfCollision::Positions whole = rows, some = rows.topRows(4), turned = across.transpose();
  EXPECT_EQ(whole.data(), rows.data());
  EXPECT_EQ(some.data(), rows.data());
  EXPECT_EQ(turned.data(), across.data());
  const SelfCollision::Positions copy = SelfCollision::Positions(kStart);  // outlives what it is made from
  EXPECT_EQ(copy.data()[3], 4);
}

template <class Parameter, class... Given>
constexpr bool kTakesNone = !(std::is_convertible_v<Given, Parameter> || ...);
static_assert(
    kTakesNone<SelfCollision::Faces, Eigen::MatrixX4i, Eigen::MatrixX2i, Eigen::VectorXi, MatrixXd,
               std::vector<double>, std::vector<bool>, Eigen::Array<bool, Dynamic, 3>, const char*>);
static_assert(kTakesNone<SelfCollision::Positions, Eigen::MatrixX2d, Eigen::MatrixX4f, Eigen::VectorXd,
                         Eigen::MatrixX3i, Eigen::MatrixX3cd, std::vector<int>, const double*>);

// Mutation: the library does not ask for three columns.
TEST(Input, WrongShapesAreRefusedWhereverTheyAreGiven) {
  const MatrixXi quads{{0, 1, 2, 3}};
  const MatrixXd square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  expect_refused("faces: 1 rows of 4 columns; give one row of three for each triangle: split quads",
                 [&] { SelfCollision(quads, square); });
  expect_refused("faces: 3 rows of 20 columns; give one row of three for each triangle: transpose",
                 [&] { SelfCollision(MatrixXi(kFaces.replicate(10, 1).transpose()), kStart); });
  expect_refused("faces: 3 rows of 2 columns", [&] { SelfCollision(MatrixXi(kFaces.transpose()), kStart); });
  expect_refused("faces: 2 rows of 0 columns", [&] { SelfCollision(MatrixXi(2, 0), kStart); });
  expect_refused("has no triangles", [&] { SelfCollision(MatrixXi(0, 3), kStart); });
  expect_refused("has no triangles", [&] { SelfCollision(std::vector<int>(), kStart); });
  expect_refused("faces: 0 rows of 0 columns", [&] { SelfCollision(MatrixXi(), kStart); });
  expect_refused("faces: 5 numbers are no", [&] { SelfCollision(std::vector<int>(5), kStart); });
  expect_refused("reference positions: 5 numbers are no",
                 [&] { SelfCollision(kFaces, std::vector<double>(5)); });
  expect_refused("faces: triangle 1 names vertex 8589934592", [&] {
    SelfCollision(std::vector<long long>{0, 1, 2, 3, 4, 1LL << 33}, kStart);
  });
  expect_refused("faces: triangle 0 names vertex 4294967295", [&] {
    SelfCollision(std::vector<unsigned>{0, 1, ~0U, 3, 4, 5}, kStart);
  });
  expect_refused("names vertex -1", [&] { SelfCollision(std::vector<long>{0, 1, -1}, kStart); });

  // Positions of a wrong shape, in every place that takes positions.
  Options options;
  options.obstacles.emplace_back(kFaces, kStart.array() + 50);
  SelfCollision body(kFaces, kStart, options);
  SelfCollision::Answer answer;
  using Call = std::function<void(const MatrixXd&)>;
  const std::pair<const char*, Call> calls[] = {
      {"reference positions", [&](const MatrixXd& x) { SelfCollision(kFaces, x); }},
      {"start positions", [&](const MatrixXd& x) { body.is_free(x, kEnd); }},
      {"end positions", [&](const MatrixXd& x) { body.is_free(kStart, x); }},
      {"start positions", [&](const MatrixXd& x) { body.first_contact(x, kEnd); }},
      {"end positions", [&](const MatrixXd& x) { body.first_contact(kStart, x, answer); }},
      {"start positions", [&](const MatrixXd& x) { body.all_contacts(x, kEnd, answer); }},
      {"end positions", [&](const MatrixXd& x) { body.all_contacts(kStart, x); }},
      {"start positions", [&](const MatrixXd& x) { body.largest_step(x, kEnd); }},
      {"end positions", [&](const MatrixXd& x) { body.largest_step(kStart, x); }},
      {"start positions", [&](const MatrixXd& x) { body.candidates(x, kEnd, 1); }},
      {"end positions", [&](const MatrixXd& x) { body.candidates(kStart, x, 1); }},
      {"obstacle 0, start positions", [&](const MatrixXd& x) { body.place_obstacle(0, x); }},
      {"obstacle 0, start positions", [&](const MatrixXd& x) { body.move_obstacle(0, x, kEnd); }},
      {"obstacle 0, end positions", [&](const MatrixXd& x) { body.move_obstacle(0, kStart, x); }}};
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (const std::pair<const char*, Call>& entry : calls) {
    const std::string name = entry.first;
    const Call& call = entry.second;
    SCOPED_TRACE(name);
    for (const Eigen::Index columns : {0, 1, 2, 4, 6, 17})
      expect_refused(name + ": 6 rows of " + std::to_string(columns) + " columns",
                     [&] { call(MatrixXd::Zero(6, columns)); });
    expect_refused(name + ": 3 rows of 6 columns; give one row of three for each vertex: transpose",
                   [&] { call(kStart.transpose()); });
    expect_refused(name, [&] { call(MatrixXd()); });
    for (const Eigen::Index count : {0, 1, 3, 5, 7, 600}) {
      if (name != "reference positions")
        expect_refused(name, [&] { call(MatrixXd::Zero(count, 3)); });
      else if (count < 6)
        expect_refused("outside [0, ", [&] { call(MatrixXd::Zero(count, 3)); });
    }
    for (const double wrong : {nan, inf, -inf}) {
      MatrixXd x = kStart;
      x(4, 2) = wrong;
      expect_refused(name + ": vertex 4", [&] { call(x); });
    }
  }
  expect_refused("obstacle, positions: 3 rows of 6 columns",
                 [&] { SelfCollision::Obstacle(kFaces, kStart.transpose()); });
  expect_refused("obstacle, faces: 1 rows of 4 columns", [&] { SelfCollision::Obstacle(quads, square); });
  expect_refused("obstacle, faces: triangle 0 names vertex 8589934592", [&] {
    SelfCollision::Obstacle(std::vector<long long>{0, 1, 1LL << 33}, square);
  });
  expect_refused("end positions: 19 numbers are no", [&] { body.is_free(kStart, std::vector<double>(19)); });
  EXPECT_EQ(body.first_contact(kStart, kEnd).time(), 0.5) << "the object outlives wrong calls";
}

TEST(Input, WrongNumbersAreRefused) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  constexpr int kLeast = std::numeric_limits<int>::min(), kMost = std::numeric_limits<int>::max();
  SelfCollision body(kFaces, kStart);
  for (const double safety : {nan, inf, -inf, -1.0, 0.0, 1.001, 1e300})
    expect_refused("safety", [&] { body.largest_step(kStart, kEnd, safety); });
  for (const double radius : {nan, inf, -inf, -1.0, -1e-300})
    expect_refused("radius", [&] { body.candidates(kStart, kEnd, radius); });
  for (const int obstacle : {0, 1, -1})
    expect_refused("obstacle " + std::to_string(obstacle) + ": there are 0",
                   [&] { body.place_obstacle(static_cast<std::size_t>(obstacle), kStart); });

  using Change = std::function<void(Options&)>;
  const auto refused = [](const std::string& part, const Change& change) {
    Options options;
    change(options);
    expect_refused(part, [&] { SelfCollision(kFaces, kStart, options); });
  };
  for (const int threads : {kLeast, -1, 0, 1025, kMost})
    refused("threads is " + std::to_string(threads), [&](Options& o) { o.threads = threads; });
  for (const double distance : {nan, inf, -inf, -1.0})
    refused("exclude, rest_distance: " + exact_text(distance),
            [&](Options& o) { o.exclude.rest_distance = distance; });
  for (const int rings : {kLeast, -1})
    refused("exclude, rings: " + std::to_string(rings), [&](Options& o) { o.exclude.rings = rings; });
  for (const int wrong : {kLeast, -1, 6, kMost}) {
    refused("exclude, vertex_pairs: entry 1 names vertex " + std::to_string(wrong), [&](Options& o) {
      o.exclude.vertex_pairs = {{1, 0}, {wrong, 0}};
    });
    if (wrong < 0)
      refused("exclude, group: vertex 5 has group " + std::to_string(wrong),
              [&](Options& o) { o.exclude.group = {0, 0, 0, 0, 0, wrong}; });
    refused("exclude, groups_that_ignore_each_other: entry 0 names group " + std::to_string(wrong),
            [&](Options& o) {
              o.exclude.group = {0, 0, 0, 1, 1, 1};
              o.exclude.groups_that_ignore_each_other = {{0, wrong}};
            });
  }
  refused("exclude, groups_that_ignore_each_other: 5000 different groups; give at most 4096", [](Options& o) {
    o.exclude.group.assign(6, 4999);
    for (int g = 0; g < 5000; ++g) o.exclude.groups_that_ignore_each_other.emplace_back(g, 0);
  });
  for (const int wrong : {kLeast, -1, 2, kMost})
    refused("exclude, face_pairs: entry 0 names face " + std::to_string(wrong), [&](Options& o) {
      o.exclude.face_pairs = {{1, wrong}};
    });
  refused("exclude, rigid: 5 entries for 6 vertices", [](Options& o) { o.exclude.rigid.resize(5); });
  refused("exclude, group: 7 entries for 6 vertices", [](Options& o) { o.exclude.group.resize(7); });
  refused("exclude, groups_that_ignore_each_other: no vertex has a group", [](Options& o) {
    o.exclude.groups_that_ignore_each_other = {{0, 0}};
  });
  for (const std::size_t size : {1u, 7u, 64u, 4096u})
    refused("preparation", [&](Options& o) { o.preparation.assign(size, std::byte{1}); });
  for (const int wrong : {kLeast, -1, 6, kMost})
    refused("obstacle 0, faces", [&](Options& o) {
      o.obstacles.emplace_back(kFaces, kStart);
      o.obstacles[0].faces[1][2] = wrong;
    });
  refused("obstacle 0, positions: vertex 2", [&](Options& o) {
    o.obstacles.emplace_back(kFaces, kStart);
    o.obstacles[0].positions[2][1] = inf;
  });
}

TEST(Input, MessagesNameNumbersAsTheyAre) {
  SelfCollision body(kFaces, kStart);
  expect_refused("safety 1.000000001", [&] { body.largest_step(kStart, kEnd, 1 + 1e-9); });
  expect_refused("radius -1e-300", [&] { body.candidates(kStart, kEnd, -1e-300); });
  expect_refused("cap 1e+308", [&] { body.vertex_bounds(kStart, 1e308); });
}

TEST(Input, PositionsThatWereNeverFilledInAreRefused) {
  expect_refused("all vertices are in one place",
                 [] { SelfCollision(kFaces, MatrixXd::Constant(6, 3, 0.5)); });
}

// From where a step ended that is known to be free, positions are checked in another way.
TEST(Input, WrongEndsOfStepsFromAFreeStartAreRefused) {
  SelfCollision body(kFaces, kStart);
  EXPECT_TRUE(body.is_free(kStart, kStart));
  MatrixXd broken = kStart;
  broken(1, 1) = std::nan("");
  expect_refused("end positions: vertex 1", [&] { body.is_free(kStart, broken); });
  EXPECT_TRUE(body.is_free(kStart, kStart)) << "an object outlives wrong calls";
  expect_refused("7 rows for 6 vertices", [&] { body.is_free(kStart, MatrixXd::Zero(7, 3)); });
}

TEST(Input, ASecondObstacleIsNamedByItsNumber) {
  Options options;
  for (int i = 0; i < 2; ++i) options.obstacles.emplace_back(kFaces, kStart.array() + 50);
  options.obstacles[1].faces[1][2] = 6;
  expect_refused("obstacle 1, faces", [&] { SelfCollision(kFaces, kStart, options); });
}

TEST(Input, AnObjectThatHasBeenMovedFromSaysSo) {
  SelfCollision body(kFaces, kStart);
  const SelfCollision other = std::move(body);
  expect_refused("moved from", [&] { body.is_free(kStart, kEnd); });
  expect_refused("moved from", [&] { body.vertex_count(); });
  EXPECT_EQ(other.vertex_count(), 6u);
}

// Two threads ask one object: every call is answered right, or refused.
// Mutation: calls are not held apart.
TEST(Input, ASecondThreadIsTurnedAway) {
  SelfCollision body(kFaces, kStart);
  const auto expected = body.first_contact(kStart, kEnd).time();
  std::atomic<int> refused = 0, wrong = 0;
  const auto ask_often = [&] {
    for (int i = 0; i < 20000 && refused < 100; ++i) try {
        wrong += body.first_contact(kStart, kEnd).time() != expected;
      } catch (const std::logic_error& error) {
        wrong += std::string(error.what()).find("another thread") == std::string::npos;
        ++refused;
      }
  };
  std::thread other(ask_often);
  ask_often();
  other.join();
  EXPECT_EQ(wrong, 0);
}

// Mutation: a call of the thread that is being answered is taken for that of another thread.
TEST(Input, AFunctionThatAsksTheObjectWhichCallsItIsNamed) {
  SelfCollision body(kFaces, kStart);
  const std::vector<double> still(kStart.size(), 0);
  const SelfCollision::Paths paths{[&](double) {
                                     body.is_free(kStart, kEnd);
                                     return still;
                                   },
                                   [](double, double) { return std::vector<double>{0}; }};
  const std::string text = test::refusal<std::logic_error>([&] { body.true_motion(paths, 0, 1); });
  EXPECT_NE(text.find("a function given to that asks the same object"), std::string::npos) << text;
  EXPECT_TRUE(body.first_contact(kStart, kEnd).time());  // the object is as it was
}

// Mutations: the square of a distance overflows, or vanishes.
TEST(Input, ExtremeNumbersAreAnswered) {
  constexpr double kSmallest = std::numeric_limits<double>::denorm_min(),
                   kLargest = std::numeric_limits<double>::max();
  SelfCollision body(kFaces, kStart);
  EXPECT_EQ(body.candidates(kStart, kEnd, kLargest).vertex_face.size(), 6u);
  EXPECT_EQ(body.candidates(kStart, kEnd, kSmallest).vertex_face.size(), 3u);
  EXPECT_EQ(body.largest_step(kStart, kEnd, kSmallest), 0);
  EXPECT_GT(body.largest_step(kStart, kEnd, 1e-200), 0);

  // The second triangle lies in the first one's place, or as far from it as numbers reach.
  MatrixXd same = kStart;
  same.bottomRows(3) = kStart.topRows(3);
  const auto contacts = [](const MatrixXd& reference, const SelfCollision::Exclusions& exclude) {
    Options options;
    options.exclude = exclude;
    return SelfCollision(kFaces, reference, options).all_contacts(kStart, kEnd).contacts.size();
  };
  const std::size_t all = contacts(kStart, {});
  EXPECT_GT(all, 0u);
  SelfCollision::Exclusions exclude;
  exclude.rest_distance = kSmallest;
  EXPECT_EQ(contacts(kStart, exclude), all);
  EXPECT_EQ(contacts(same, exclude), all) << "a contact has vertices that are not in one place";
  exclude.rest_distance = 6;
  EXPECT_EQ(contacts(same, exclude), 0u);
  for (const double scale : {1e-200, 1e-160, 1e160, 1e200}) {
    exclude.rest_distance = 6 * scale;
    EXPECT_EQ(contacts(scale * same, exclude), 0u) << scale;
    exclude.rest_distance = 0.5 * scale;
    EXPECT_EQ(contacts(scale * kStart, exclude), all) << scale;
  }
  exclude = {};
  exclude.rings = std::numeric_limits<int>::max();
  EXPECT_EQ(contacts(kStart, exclude), all) << "the triangles are two pieces";
}

}  // namespace
}  // namespace cscd
