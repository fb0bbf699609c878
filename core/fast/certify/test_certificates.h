#pragma once

// For tests only: one interval of a body, and its certificates.

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/fast/certify/certificates.h"
#include "core/fast/prepare/cut_surface.h"
#include "core/fast/prepare/test_body.h"
#include "core/radial/orientation.h"

namespace cscd::fast {

// Lets the certificates classify all patches of one interval.
inline void classify_all(Certificates& certificates, const PatchTree& tree, const LocalPositions& local) {
  certificates.start(local);
  for (std::size_t p = 0; p < tree.patches.size(); ++p)
    certificates.classify(p, load(local.records(), tree.patches[p].vertex));
  certificates.finish();
}

// One interval of a body, and its certificates computed straight from their definition, in double precision
// and triangle by triangle. These are the twins of the certificates that Certificates computes from patches.
struct CertifiedBody : test::Body {
  Covers covers;
  PatchTree tree;
  LocalPositions local;
  Certificates certificates;
  // [triangles][covers]. `own` is the sign of the triangle towards the observer of its cluster. `all_round`
  // is the sign that all triangles that share a vertex with it have towards that observer; uncertain if these
  // do not all belong to one cluster or do not all have one sign.
  std::vector<std::array<radial::Orientation, kCovers>> own, all_round;

  enum class Bones { chain, sixths };  // sixths: seams of the first two covers meet

  explicit CertifiedBody(double noise, double bend, int seed, bool inside_out = false,
                         Bones bones = Bones::chain)
      : test::Body(noise, bend, {3, -2, 1}, 1, seed),
        local(start),
        certificates(prepared(inside_out, bones)) {
    local.update(motion());
    certify();
    find_all_round();
  }
  void certify() { classify_all(certificates, tree, local); }
  // Returns certificates for the same covers that use capped clusters.
  Certificates with_caps() const {
    std::vector<CappedClusters> capped;
    for (std::size_t c = 0; c < covers.size(); ++c) capped.emplace_back(mesh, shape.positions, covers[c], c);
    return Certificates(mesh, tree, covers, std::move(capped));
  }
  std::int32_t cluster(std::size_t c, std::size_t triangle) const { return covers[c].cluster_of[triangle]; }
  // Returns the certificate that is expected: in the first cover from the triangle alone, in the others from
  // all triangles round it.
  radial::Orientation certain(std::size_t c, TriangleId t) const { return (c == 0 ? own : all_round)[+t][c]; }
  // Returns whether one cover certifies both triangles with one sign, in one cluster.
  bool one_field(TriangleId t, TriangleId u) const {
    for (std::size_t c = 0; c < kCovers; ++c)
      if (cluster(c, +t) == cluster(c, +u) && certain(c, t) != radial::Orientation::uncertain &&
          certain(c, t) == certain(c, u))
        return true;
    return false;
  }
  // Returns whether all these triangles have one sign towards one observer of one cover. The theorem asks
  // that of the triangles at a feature pair that is dropped.
  bool one_field(std::span<const TriangleId> at, std::span<const TriangleId> also_at) const {
    for (std::size_t c = 0; c < kCovers; ++c) {
      const auto as_first = [&](TriangleId t) {
        return cluster(c, +t) == cluster(c, +at[0]) && own[+t][c] == own[+at[0]][c];
      };
      if (own[+at[0]][c] != radial::Orientation::uncertain && std::all_of(at.begin(), at.end(), as_first) &&
          std::all_of(also_at.begin(), also_at.end(), as_first))
        return true;
    }
    return false;
  }

 private:
  Certificates prepared(bool inside_out, Bones bones) {
    if (bones == Bones::sixths) {
      std::vector<BoneId> bone_of;
      for (const Triangle& t : mesh.triangles()) {
        const Vec3& p = shape.positions[+t[0]];
        bone_of.push_back(BoneId{2 * (p.x() < 5 ? 0 : p.x() < 10 ? 1 : 2) + (p.y() < 0 ? 0 : 1)});
      }
      atomic = radial::make_atomic_clusters(mesh, bone_of);
    }
    CutSurface cut = cut_surface(mesh, shape.positions, atomic.of_triangle);
    covers = std::move(cut.covers);
    tree = std::move(cut.tree);
    // A mirrored surface is inside out: what an observer saw from behind, it sees from in front.
    if (inside_out)
      for (std::vector<Vec3>* positions : {&start, &end})
        for (Vec3& p : *positions) p.x() = -p.x();
    return Certificates(mesh, tree, covers);
  }
  // Returns a vertex in local coordinates, but in double precision.
  MovingPoint at(VertexId v) const {
    const double unit = scale();
    return {(start[+v] - start[0]) * unit, (end[+v] - start[0]) * unit};
  }
  double scale() const {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : start) box.extend(p);
    return std::ldexp(1.0, -std::ilogb(box.sizes().maxCoeff()));
  }
  radial::Observer observer(const FollowingPoint& from) const {
    float sum[8] = {};
    for (std::size_t i = 0; i < from.vertices().size(); ++i)
      for (std::size_t k = 0; k < 8; ++k)
        sum[k] += from.weights()[i] * local.records()[+from.vertices()[i]].at[k];
    return radial::Observer::point({Vec3(sum[0], sum[1], sum[2]), Vec3(sum[4], sum[5], sum[6])});
  }
  void find_all_round() {
    own.resize(mesh.triangle_count());
    for (std::size_t t = 0; t < own.size(); ++t)
      for (std::size_t c = 0; c < kCovers; ++c) {
        own[t][c] = radial::Orientation::uncertain;
        if (cluster(c, t) == kNone) continue;
        const Triangle& corner = mesh.triangles()[t];
        own[t][c] =
            radial::orientation({at(corner[0]), at(corner[1]), at(corner[2])},
                                observer(covers[c].observers[static_cast<std::size_t>(cluster(c, t))]));
      }
    all_round = own;
    for (std::size_t t = 0; t < own.size(); ++t)
      for (std::size_t c = 0; c < kCovers; ++c)
        for (const VertexId v : mesh.triangles()[t])
          for (const TriangleId near : mesh.triangles_at(v))
            if (own[+near][c] != own[t][c] || cluster(c, +near) != cluster(c, t))
              all_round[t][c] = radial::Orientation::uncertain;
  }
};

}  // namespace cscd::fast
