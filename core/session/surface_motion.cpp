#include "core/session/surface_motion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/rounding.h"
#include "core/geometry/simd_doubles.h"

namespace cscd {
namespace {

using Mat3 = Eigen::Matrix3d;

constexpr std::size_t kSampled = 64;
// Squares of lengths below this underflow.
constexpr double kTiny = 0x1p-480;

// The least and the largest of `to` - turn `from` over all vertices, along each axis.
struct Displacements {
  Vec3 low, high;
  double largest;  // coordinate of `from`, and number in low and high

  Displacements(std::span<const Vec3> from, std::span<const Vec3> to, const Mat3& turn);
  Vec3 middle() const { return low / 2 + high / 2; }
  // Let u be the unit roundoff and L the largest number. Differences are off by u L. Where there is a turn,
  // products and sums are off by less than 9 u L more, and the length of all three by 21 u L.
  double error() const { return 64 * kUnitRoundoff * largest; }
  double bound() const { return rounded_up((high / 2 - low / 2).norm() + error()); }
};

// A number of a turned vertex is a sum of that vertex's three numbers, which are at most two places away in
// memory. For each of these places, what it is multiplied with: eight vertices are three times eight numbers.
struct TurnLanes {
  static constexpr std::size_t kAway = 2;
  Lane8 of[2 * kAway + 1][3];

  explicit TurnLanes(const Mat3& turn) {
    for (std::size_t place = 0; place <= 2 * kAway; ++place)
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t l = 0; l < kLanes; ++l) {
          const std::size_t row = (kLanes * r + l) % 3, column = row + place;
          const bool is_own = column >= kAway && column < kAway + 3;
          of[place][r][l] =
              is_own ? turn(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column - kAway)) : 0;
        }
  }
  Lane8 turned(const double* at, std::size_t r) const {
    Lane8 sum = of[0][r] * loaded<Lane8>(at - kAway);
    for (std::size_t place = 1; place <= 2 * kAway; ++place)
      sum = sum + of[place][r] * loaded<Lane8>(at - kAway + place);
    return sum;
  }
};

Displacements::Displacements(std::span<const Vec3> from, std::span<const Vec3> to, const Mat3& turn) {
  const auto displacement = [&](std::size_t v) -> Vec3 { return to[v] - turn * from[v]; };
  low = high = displacement(0);
  Vec3 outermost = from[0].cwiseAbs();
  const auto take = [&](const Vec3& d) { low = low.cwiseMin(d), high = high.cwiseMax(d); };
  // The first and the last vertex are left out of the lanes, because turning reads two numbers on either
  // side.
  const std::size_t whole = from.size() > 2 ? (from.size() - 2) / kLanes : 0;
  if (whole > 0) {
    const double *const before = from[1].data(), *const after = to[1].data();
    Lane8 least[3], most[3], outer[3];
    const auto look = [&](const auto& turned) {
      for (std::size_t i = 0; i < whole; ++i)
        for (std::size_t r = 0; r < 3; ++r) {
          const std::size_t at = 3 * kLanes * i + kLanes * r;
          const Lane8 d = loaded<Lane8>(after + at) - turned(before + at, r);
          const Lane8 far = absolute(loaded<Lane8>(before + at));
          least[r] = i == 0 ? d : smaller(least[r], d), most[r] = i == 0 ? d : larger(most[r], d);
          outer[r] = i == 0 ? far : larger(outer[r], far);
        }
    };
    if (turn != Mat3::Identity())
      look([lanes = TurnLanes(turn)](const double* at, std::size_t r) { return lanes.turned(at, r); });
    else
      look([](const double* at, std::size_t /*r*/) { return loaded<Lane8>(at); });
    double lowest[3 * kLanes], highest[3 * kLanes], farthest[3 * kLanes];
    for (std::size_t r = 0; r < 3; ++r) {
      store(least[r], lowest + kLanes * r);
      store(most[r], highest + kLanes * r);
      store(outer[r], farthest + kLanes * r);
    }
    for (std::size_t i = 0; i < 3 * kLanes; ++i) {
      const auto k = static_cast<Eigen::Index>(i % 3);
      low[k] = std::min(low[k], lowest[i]), high[k] = std::max(high[k], highest[i]);
      outermost[k] = std::max(outermost[k], farthest[i]);
    }
  }
  for (std::size_t v = 1 + kLanes * whole; v < from.size(); ++v) {
    take(displacement(v));
    outermost = outermost.cwiseMax(from[v].cwiseAbs());
  }
  largest = outermost.cwiseMax(low.cwiseAbs()).cwiseMax(high.cwiseAbs()).maxCoeff();
}

// The largest displacement of some vertices, or of all where none are named, less a shift.
double longest(std::span<const Vec3> from, std::span<const Vec3> to, const Mat3& turn, const Vec3& shift,
               std::span<const std::size_t> some = {}) {
  double squared = 0;
  for (std::size_t i = 0; i < (some.empty() ? from.size() : some.size()); ++i) {
    const std::size_t v = some.empty() ? i : some[i];
    squared = std::max(squared, (to[v] - turn * from[v] - shift).squaredNorm());
  }
  return std::sqrt(squared);
}

Vec3 mean_of(std::span<const Vec3> points, std::span<const std::size_t> sample) {
  Vec3 sum = Vec3::Zero();
  for (const std::size_t v : sample) sum += points[v];
  return sum / static_cast<double>(sample.size());
}

// The rotation that brings the sample of `from` closest to that of `to`: the quaternion of the largest
// eigenvalue of a symmetric matrix (Horn, 1987). Squaring the matrix again and again leaves nothing but that
// eigenvector, with less code than a decomposition.
Mat3 best_turn(std::span<const Vec3> from, std::span<const Vec3> to, std::span<const std::size_t> sample) {
  constexpr int kSquarings = 30;
  const Vec3 before = mean_of(from, sample), after = mean_of(to, sample);
  Mat3 s = Mat3::Zero();
  for (const std::size_t v : sample) s += (from[v] - before) * (to[v] - after).transpose();
  const Vec3 twist(s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0));
  double n[4][4] = {{s.trace(), twist.x(), twist.y(), twist.z()}};
  double largest = std::abs(s.trace());
  for (int i = 0; i < 3; ++i)
    for (int j = -1; j < 3; ++j) {
      n[1 + i][1 + j] = j < 0 ? twist[i] : s(i, j) + s(j, i) - (i == j ? s.trace() : 0);
      largest = std::max(largest, std::abs(n[1 + i][1 + j]));
    }
  if (!(largest > 0 && largest < std::numeric_limits<double>::max())) return Mat3::Identity();
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) n[i][j] = n[i][j] / largest / 4 + (i == j ? 1 : 0);  // no eigenvalue below 0
  for (int k = 0; k < kSquarings; ++k) {
    double squared[4][4] = {}, trace = 0;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        for (int l = 0; l < 4; ++l) squared[i][j] += n[i][l] * n[l][j];
    for (int i = 0; i < 4; ++i) trace += squared[i][i];
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) n[i][j] = squared[i][j] / trace;
  }
  const auto& q = *std::ranges::max_element(n, {}, [&](const auto& row) { return row[&row - n]; });
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

// How far the sample is from where a turn takes it, less one shift.
double sampled_length(std::span<const Vec3> from, std::span<const Vec3> to, const Mat3& turn,
                      std::span<const std::size_t> sample) {
  const auto displacement = [&](std::size_t v) -> Vec3 { return to[v] - turn * from[v]; };
  Vec3 low = displacement(sample[0]), high = low;
  for (const std::size_t v : sample)
    low = low.cwiseMin(displacement(v)), high = high.cwiseMax(displacement(v));
  return longest(from, to, turn, low / 2 + high / 2, sample);
}

}  // namespace

double rounded_up(double length) {
  return std::max(length, kTiny) * (1 + 16 * kUnitRoundoff);
}

double SurfaceMotion::reach(double distance) const {
  return kept > 0 ? rounded_up((2 * most + distance) / kept) : std::numeric_limits<double>::infinity();
}

std::vector<std::size_t> sampled_vertices(std::size_t vertex_count) {
  const std::size_t count = std::min(kSampled, vertex_count);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(i * vertex_count / count);
  return out;
}

SurfaceMotion surface_motion(const Motion& motion, std::span<const Vec3> from,
                             std::span<const std::size_t> sample, double enough) {
  const std::span<const Vec3> ends[2]{motion.start(), motion.end()};
  Mat3 turns[2]{Mat3::Identity(), Mat3::Identity()};
  double most = 0;
  for (std::size_t e = 0; e < 2; ++e) {
    const auto bound = [&](const Mat3& turn) {
      if (!(sampled_length(from, ends[e], turn, sample) <= enough)) return SurfaceMotion{}.most;
      const Displacements all(from, ends[e], turn);
      const double of_box = all.bound();
      return of_box <= enough ? of_box : rounded_up(longest(from, ends[e], turn, all.middle()) + all.error());
    };
    double least = bound(turns[e]);
    if (!(least <= enough)) {
      turns[e] = best_turn(from, ends[e], sample);
      least = bound(turns[e]);
    }
    if (!(least <= enough)) return {};
    most = std::max(most, least);
  }
  // What the matrices lack of being rotations, and how far they differ, in Frobenius norms, which are not
  // less than spectral norms.
  double lacks = 0;
  for (const Mat3& turn : turns) lacks = std::max(lacks, (turn.transpose() * turn - Mat3::Identity()).norm());
  const double squared = 1 - lacks - (turns[1] - turns[0]).squaredNorm() / 4;
  const double roundings = lacks > 0 || squared < 1 ? 64 * kUnitRoundoff : 0;
  return {most, squared > roundings ? std::sqrt(squared - roundings) : 0};
}

double sampled_length(const Motion& motion, std::span<const std::size_t> sample, double enough) {
  const double shifted = sampled_length(motion.start(), motion.end(), Mat3::Identity(), sample);
  if (shifted <= enough) return shifted;
  return sampled_length(motion.start(), motion.end(), best_turn(motion.start(), motion.end(), sample),
                        sample);
}

}  // namespace cscd
