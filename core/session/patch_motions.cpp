#include "core/session/patch_motions.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cscd {
namespace {

using fast::Patch;
using fast::PatchLanes;

// Loaded lanes hold the pose that is looked at first, and the anchor second.
constexpr std::size_t kPose = 0, kAnchor = 1;

// What roundings add to a deviation, in errors of a coordinate. Let u = 2^-24, S the largest local coordinate
// and E >= u S the error of one. The components of x - from are off by 3.1 E. Those of the turning are off by
// 8 u, which with three components of up to 2.1 S makes 50 E; three products and two sums, of up to 3.6 S,
// make 18 E, and the first error through the turning 6 E. Adding `to` less the pose makes 9 E. Three
// components of less than 84 E are less than 146 E long, and the length of up to 10 S rounds by 40 E.
constexpr float kRoundings = 256;
// Pays for a few roundings of lengths.
constexpr float kAbove = 1 + 0x1p-20F, kBelow = 1 - 0x1p-20F;
// A length in local units, rounded down: LocalPositions::in_local() rounds up by less than half of this.
constexpr float kRoundedDown = 1 - 0x1p-18F;
// A distance that is known up to a smaller share is not measured.
constexpr double kWorthMeasuring = 0.125;
// Steps towards the best turning. Each squares the error of the last one, and few turn far at a time.
constexpr int kTurnSteps = 3;

float largest(const Float16& v) {
  return folded(v, [](auto a, auto b) { return larger(a, b); });
}

using Matrix16 = Float16[3][3];

// The rotation of a quaternion, which need not have unit length; or those of sixteen.
template <class Number>
void rotation(const Number (&q)[4], Number (&out)[3][3]) {
  const Number &w = q[0], &x = q[1], &y = q[2], &z = q[3], one = Number{} + 1.0F;
  const Number s = (one + one) / (w * w + x * x + y * y + z * z);
  out[0][0] = one - s * (y * y + z * z), out[0][1] = s * (x * y - w * z), out[0][2] = s * (x * z + w * y);
  out[1][0] = s * (x * y + w * z), out[1][1] = one - s * (x * x + z * z), out[1][2] = s * (y * z - w * x);
  out[2][0] = s * (x * z - w * y), out[2][1] = s * (y * z + w * x), out[2][2] = one - s * (x * x + y * y);
}

// Turns quaternions towards the rotations R for which the sum of y . R x is largest, where h holds the sum of
// y x^T: one step of Newton's method. Where points lie on a line, or a turn is lost, the result may be any.
void turn_towards(const Matrix16& h, Float16 (&q)[4]) {
  Matrix16 r, g;
  rotation(q, r);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      g[i][j] = product_plus(h[i][2], r[j][2], product_plus(h[i][1], r[j][1], h[i][0] * r[j][0]));
  // The gradient, and the matrix of second derivatives with its sign changed.
  const Float16 t[3] = {g[2][1] - g[1][2], g[0][2] - g[2][0], g[1][0] - g[0][1]};
  const Float16 half = all_lanes(0.5F), trace = g[0][0] + g[1][1] + g[2][2];
  const Float16 a = trace - g[0][0], b = trace - g[1][1], c = trace - g[2][2];
  const Float16 d = -half * (g[0][1] + g[1][0]), e = -half * (g[0][2] + g[2][0]),
                f = -half * (g[1][2] + g[2][1]);
  const Float16 bc = b * c - f * f, ac = a * c - e * e, ab = a * b - d * d;
  const Float16 de = e * f - d * c, df = d * f - b * e, ef = d * e - a * f;
  const Float16 determinant = a * bc + d * de + e * df, zero = {};
  // Half of the turn.
  const Float16 share = select(determinant > 1e-6F * trace * trace * trace, half / determinant, zero);
  const Float16 x = share * (bc * t[0] + de * t[1] + df * t[2]);
  const Float16 y = share * (de * t[0] + ac * t[1] + ef * t[2]);
  const Float16 z = share * (df * t[0] + ef * t[1] + ab * t[2]);
  const Float16 turned[4] = {q[0] - (x * q[1] + y * q[2] + z * q[3]), q[1] + (x * q[0] + y * q[3] - z * q[2]),
                             q[2] + (y * q[0] + z * q[1] - x * q[3]),
                             q[3] + (z * q[0] + x * q[2] - y * q[1])};
  Float16 length = {};
  for (const Float16& number : turned) length += number * number;
  const Float16 scale = all_lanes(1) / square_root(length), one = all_lanes(1);
  for (int i = 0; i < 4; ++i)
    q[i] = select((length > 1e-3F) & (length < 1e3F), turned[i] * scale, i == 0 ? one : zero);
}

using Vectors16 = Float16[3];

Float16 squared_length(const Vectors16& v) {
  return product_plus(v[2], v[2], product_plus(v[1], v[1], v[0] * v[0]));
}

// Where a motion takes vertices from the anchor, as seen from where they are in the pose.
void deviations(const PatchLanes& lanes, const float (&turn)[3][3], const float (&from)[3],
                const float (&to)[3], Vectors16& out) {
  Vectors16 seen;
  for (int i = 0; i < 3; ++i) seen[i] = lanes.at[kAnchor][i] - from[i];
  for (int i = 0; i < 3; ++i) {
    const Float16 turned = product_plus(all_lanes(turn[i][2]), seen[2],
                                        product_plus(all_lanes(turn[i][1]), seen[1], turn[i][0] * seen[0]));
    out[i] = turned + (to[i] - lanes.at[kPose][i]);
  }
}

// What vertices have, at a corner of each triangle.
void at_corner(const Vectors16& of_vertices, const Patch& patch, std::size_t corner, Vectors16& out) {
  for (int i = 0; i < 3; ++i) out[i] = permuted(of_vertices[i], patch.corner[corner]);
}

}  // namespace

PatchMotions::PatchMotions(std::span<const Vec3> reference, const fast::PatchTree& patches)
    : positions_(reference) {
  tree_.nodes = patches.nodes, tree_.leaf = patches.leaf;
  tree_.patches = patches.patches, tree_.triangles = patches.triangles;
  const std::size_t count = tree_.patches.size();
  vertex_.resize((count + kGroup - 1) / kGroup);
  for (std::size_t p = 0; p < vertex_.size() * kGroup; ++p)
    for (std::size_t k = 0; k < kLanes16; ++k)
      vertex_[p / kGroup][k][p % kGroup] = tree_.patches[std::min(p, count - 1)].vertex[k];
  std::size_t triangles = 0;
  for (const Patch& patch : tree_.patches) triangles += static_cast<std::size_t>(std::popcount(patch.lanes));
  place_.resize(triangles);
  for (std::size_t p = 0; p < count; ++p)
    for_each_lane(tree_.patches[p].lanes, [&](std::size_t lane) {
      place_[+tree_.triangles[p][lane]] = static_cast<std::int32_t>(p * kLanes16 + lane);
    });
  turn_.resize(vertex_.size());
  motion_.resize(vertex_.size() * kGroup);
  lanes_.resize(count);
  box_.resize(tree_.nodes.size());
}

void PatchMotions::set_anchor(std::span<const Vec3> pose, double reach, std::span<const NearPair> near) {
  reach_ = 0;  // until all is there
  anchor_.assign(pose.begin(), pose.end());
  listed_.clear();
  for (const auto& [low, pair] : near) {
    const auto [a, b] = std::minmax(place_[+pair.a], place_[+pair.b]);
    listed_.push_back({low, a, b});
  }
  std::ranges::sort(listed_, {}, &Listed::patches);
  for (Turn& turn : turn_)
    for (int i = 0; i < 4; ++i) turn.at[i] = all_lanes(i == 0 ? 1 : 0);
  reach_ = reach;
}

std::optional<std::size_t> PatchMotions::pass_on(std::span<const Vec3> pose, double reach, std::size_t most,
                                                 std::vector<NearPair>& known, TrianglePairSink& sink) {
  if (!(reach_ > reach)) return std::nullopt;
  positions_.update(Motion(pose, anchor_));
  if (!positions_.known()) return std::nullopt;
  off_ = kRoundings * positions_.error();
  local_reach_ = positions_.in_local(reach);
  budget_ = kBelow * (kRoundedDown * positions_.in_local(reach_) - local_reach_);
  if (!(budget_ > 0)) return std::nullopt;
  margin_ = kAbove * (local_reach_ / 2 + 4 * positions_.error());
  passed_ = 0, most_ = most;
  for (std::size_t group = 0; group < vertex_.size(); ++group) find_motions(group);
  for (std::size_t p = 0; p < lanes_.size(); ++p)
    lanes_[p] = fast::load(positions_.records(), tree_.patches[p].vertex);
  find_boxes();
  look_below(0, sink);
  if (passed_ > most_) return std::nullopt;
  look_at_listed(reach, known, sink);
  sink.flush();
  return passed_;
}

// Sixteen patches side by side: finds the motion of each, how far its vertices deviate from it, and its box.
void PatchMotions::find_motions(std::size_t group) {
  PatchLanes at[kLanes16];
  for (std::size_t k = 0; k < kLanes16; ++k) at[k] = fast::load(positions_.records(), vertex_[group][k]);
  PatchLanes sum = {};
  for (std::size_t end = 0; end < 2; ++end)
    for (int i = 0; i < 3; ++i) {
      for (const PatchLanes& lanes : at) sum.at[end][i] += lanes.at[end][i] - at[0].at[end][i];
      sum.at[end][i] = at[0].at[end][i] + sum.at[end][i] * (1.0F / kLanes16);
    }
  const auto &from = sum.at[kAnchor], &to = sum.at[kPose];
  Matrix16 h = {};
  for (const PatchLanes& lanes : at)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        h[i][j] = product_plus(lanes.at[kPose][i] - to[i], lanes.at[kAnchor][j] - from[j], h[i][j]);
  Turn& turn = turn_[group];
  for (int step = 0; step < kTurnSteps; ++step) turn_towards(h, turn.at);
  Matrix16 r;
  rotation(turn.at, r);

  Float16 farthest = {}, low[3], high[3];
  for (int i = 0; i < 3; ++i) low[i] = high[i] = at[0].at[kPose][i];
  for (const PatchLanes& lanes : at) {
    Float16 squares = {}, seen[3];
    for (int i = 0; i < 3; ++i) {
      low[i] = smaller(low[i], lanes.at[kPose][i]);
      high[i] = larger(high[i], lanes.at[kPose][i]);
      seen[i] = lanes.at[kAnchor][i] - from[i];
    }
    for (int i = 0; i < 3; ++i) {
      const Float16 turned =
          product_plus(r[i][2], seen[2], product_plus(r[i][1], seen[1], r[i][0] * seen[0]));
      const Float16 gap = turned + (to[i] - lanes.at[kPose][i]);
      squares = product_plus(gap, gap, squares);
    }
    farthest = larger(farthest, squares);
  }
  for (std::size_t l = 0; l < kGroup; ++l) {
    const std::size_t patch = group * kGroup + l;
    Rigid& motion = motion_[patch];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) motion.turn[i][j] = r[i][j][l];
      motion.from[i] = from[i][l];
      motion.to[i] = to[i][l];
    }
    for (int i = 0; i < 4; ++i) motion.quaternion[i] = turn.at[i][l];
    motion.deviation = kAbove * std::sqrt(farthest[l]) + off_;
    if (patch >= tree_.patches.size()) continue;
    Box& box = box_[static_cast<std::size_t>(tree_.leaf[patch])];
    for (std::size_t i = 0; i < 3; ++i) {
      box.least[i] = low[i][l] - margin_;
      box.least[4 + i] = -(high[i][l] + margin_);
    }
    box.set_against();
  }
}

void PatchMotions::find_boxes() {
  for (std::size_t n = tree_.nodes.size(); n-- > 0;) {
    const fast::PatchTree::Node& node = tree_.nodes[n];
    if (node.is_leaf()) continue;
    const Box &p = box_[node.left()], &q = box_[node.right()];
    for (std::size_t i = 0; i < 8; ++i) box_[n].least[i] = std::min(p.least[i], q.least[i]);
    box_[n].set_against();
  }
}

void PatchMotions::look_below(std::size_t n, TrianglePairSink& sink) {
  const fast::PatchTree::Node& node = tree_.nodes[n];
  if (node.is_leaf()) return look_at(node.patch(), node.patch(), sink);
  look_below(node.left(), sink);
  look_below(node.right(), sink);
  if ((overlapping(node.left(), node.left()) & 2) != 0) look_between(node.left(), node.right(), sink);
}

// Which of two nodes that stand side by side have boxes that overlap the one of another node.
unsigned PatchMotions::overlapping(std::size_t node, std::size_t first) const {
  const auto against = loaded<Float8>(box_[node].against);
  const Float16 both =
      joined<Float16>(loaded<Float8>(box_[first].least), loaded<Float8>(box_[first + 1].least));
  const unsigned apart = above(both, joined<Float16>(against, against));
  return unsigned{(apart & 0xff) == 0} | unsigned{(apart & 0xff00) == 0} << 1;
}

// Looks at the patches below two nodes that overlap.
void PatchMotions::look_between(std::size_t a, std::size_t b, TrianglePairSink& sink) {
  if (passed_ > most_) return;
  const fast::PatchTree::Node &m = tree_.nodes[a], &n = tree_.nodes[b];
  if (m.is_leaf() && n.is_leaf()) return look_at(m.patch(), n.patch(), sink);
  const auto take = [&](std::size_t node, const fast::PatchTree::Node& other) {
    for_each_lane(overlapping(node, other.left()),
                  [&](std::size_t i) { look_between(node, other.left() + i, sink); });
  };
  if (m.is_leaf()) return take(a, n);
  if (n.is_leaf()) return take(b, m);
  take(m.left(), n), take(m.right(), n);
}

// By how much any triangle of one patch may have come nearer to any of another, or of the same.
float PatchMotions::nearer(std::size_t a, std::size_t b) const {
  const Rigid& motion = motion_[a];
  if (a == b) return kAbove * 2 * motion.deviation;
  Vectors16 deviation;
  deviations(lanes_[b], motion.turn, motion.from, motion.to, deviation);
  return kAbove * (motion.deviation + kAbove * std::sqrt(largest(squared_length(deviation))) + off_);
}

void PatchMotions::look_at(std::size_t a, std::size_t b, TrianglePairSink& sink) {
  if (!(nearer(a, b) < budget_)) look_closely(a, b, sink);
}

// Two patches, whose triangles have deviated from one rigid motion. Its rotation is the mean of both
// patches', because near the seam between two patches that bend, either goes half as far astray.
struct PatchMotions::Common {
  Vectors16 middle;    // of the deviations of each triangle of the first patch at its corners
  Float16 radius;      // how far these are from their middle
  Vectors16 other[3];  // deviations of the triangles of the second patch at their corners
  float off;

  Common(const PatchMotions& all, std::size_t a, std::size_t b) : off(2 * all.off_) {
    const Rigid &p = all.motion_[a], &q = all.motion_[b];
    float same = 0, mean[4], turn[3][3];
    for (int i = 0; i < 4; ++i) same += p.quaternion[i] * q.quaternion[i];
    for (int i = 0; i < 4; ++i) mean[i] = p.quaternion[i] + (same < 0 ? -q.quaternion[i] : q.quaternion[i]);
    rotation(mean, turn);
    Vectors16 first, second, corner[3];
    deviations(all.lanes_[a], turn, p.from, p.to, first);
    deviations(all.lanes_[b], turn, p.from, p.to, second);
    for (std::size_t k = 0; k < 3; ++k) {
      at_corner(first, all.tree_.patches[a], k, corner[k]);
      at_corner(second, all.tree_.patches[b], k, other[k]);
    }
    for (int i = 0; i < 3; ++i) middle[i] = (corner[0][i] + corner[1][i] + corner[2][i]) * (1.0F / 3);
    Float16 squares = {};
    for (Vectors16& at : corner) {
      for (int i = 0; i < 3; ++i) at[i] = at[i] - middle[i];
      squares = larger(squares, squared_length(at));
    }
    radius = kAbove * square_root(squares) + off;
  }
  // By how much each triangle of the second patch may have come nearer to one of the first.
  Float16 from(std::size_t lane) const {
    Float16 squares = {};
    for (const Vectors16& at : other) {
      Vectors16 seen;
      for (int i = 0; i < 3; ++i) seen[i] = at[i] - middle[i][lane];
      squares = larger(squares, squared_length(seen));
    }
    return kAbove * (kAbove * square_root(squares) + radius[lane]);
  }
};

void PatchMotions::look_closely(std::size_t a, std::size_t b, TrianglePairSink& sink) {
  const Patch &p = tree_.patches[a], &q = tree_.patches[b];
  const Common common(*this, a, b);
  Vectors16 low[2], high[2];  // the boxes of triangles in the pose
  for (std::size_t side = 0; side < 2; ++side) {
    const PatchLanes& lanes = lanes_[side == 0 ? a : b];
    for (std::size_t k = 0; k < 3; ++k) {
      Vectors16 at;
      at_corner(lanes.at[kPose], side == 0 ? p : q, k, at);
      for (int i = 0; i < 3; ++i) {
        low[side][i] = k == 0 ? at[i] : smaller(low[side][i], at[i]);
        high[side][i] = k == 0 ? at[i] : larger(high[side][i], at[i]);
      }
    }
  }
  const Float16 budget = all_lanes(budget_);
  for_each_lane(p.lanes, [&](std::size_t lane) {
    unsigned left = q.lanes;
    if (a == b) left &= ~0U << (lane + 1);
    for (int i = 0; i < 3 && left != 0; ++i)
      left &= ~static_cast<unsigned>(above(all_lanes(low[0][i][lane] - 2 * margin_), high[1][i]) |
                                     above(low[1][i], all_lanes(high[0][i][lane] + 2 * margin_)));
    if (left != 0) left &= ~static_cast<unsigned>(above(budget, common.from(lane)));
    for_each_lane(left, [&](std::size_t other) {
      sink.add(tree_.triangles[a][lane], tree_.triangles[b][other]);
      ++passed_;
    });
  });
}

void PatchMotions::look_at_listed(double reach, std::vector<NearPair>& known, TrianglePairSink& sink) const {
  // How long a local unit is at most, with room for the roundings of two products and a sum.
  const double unit = double{kAbove} * reach / (double{kRoundedDown} * double{local_reach_});
  for (std::size_t first = 0, last = 0; first < listed_.size(); first = last) {
    const std::pair patches = listed_[first].patches();
    const auto a = static_cast<std::size_t>(patches.first), b = static_cast<std::size_t>(patches.second);
    const double any = unit * double{nearer(a, b)};
    std::optional<Common> common;
    for (; last < listed_.size() && listed_[last].patches() == patches; ++last) {
      const Listed& listed = listed_[last];
      if (listed.low - any > reach) continue;
      const std::size_t lane = static_cast<std::size_t>(listed.a) % kLanes16,
                        other = static_cast<std::size_t>(listed.b) % kLanes16;
      const TrianglePair pair{tree_.triangles[a][lane], tree_.triangles[b][other]};
      double low = listed.low - any;
      if (any > kWorthMeasuring * listed.low) {
        if (!common) common.emplace(*this, a, b);
        const double alone = unit * double{common->from(lane)[other]};
        low = listed.low - alone;
        if (low > reach) continue;
        if (alone > kWorthMeasuring * listed.low) {
          sink.add(pair.a, pair.b);
          continue;
        }
      }
      known.push_back({low, pair});
    }
  }
}

}  // namespace cscd
