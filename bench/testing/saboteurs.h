#pragma once

// For tests only: strategies made of the house's own parts in which one thing at a time is broken.
// `Flaw::none` is the sound twin.

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <random>

#include "baselines/mcd/contour.h"
#include "baselines/mcd/discs.h"
#include "baselines/mcd/normal_cones.h"
#include "baselines/rvbc_culler.h"
#include "core/detect/compose.h"
#include "core/hierarchy/overlap_descent.h"
#include "core/radial/nearest_point.h"
#include "core/radial/segmentation.h"
#include "core/radial/setup.h"

namespace cscd::test {

enum class Flaw {
  none,
  one_triangle_pair_in_10000_lost,
  one_feature_pair_in_10000_lost,
  bounds_one_ulp_too_tight,
  last_leaf_skipped,
  representative_triangles,
  uncertain_called_positive,
  segment_by_one_vertex,
  clusters_span_components,
  observers_mixed,
  contours_not_tested,
  covers_mixed,
  certified_by_triangle,
};

// A descent over the swept bounds of all triangles.
class DescentCuller : public Culler {
 public:
  explicit DescentCuller(const StrategyInput& setup)
      : mesh_(setup.mesh), tree_(build_tree(mesh_, setup.reference)), bounds_(mesh_, tree_) {}

  void refit(const Step& step) override { bounds_.refit(step.motion); }

 protected:
  template <class Skip, class Emit>
  CullCounts descend(const Skip& skip, const Emit& emit) {
    const auto is_leaf = [&](NodeIndex node) { return tree_.is_leaf(node); };
    CullCounts counts;
    counts.bvot = self_descent(tree_, bounds_, 0, is_leaf, skip, emit);
    return counts;
  }

  const TriangleMesh& mesh_;
  Tree tree_;
  SweptBounds bounds_;
};

// All pairs of triangles whose swept bounds overlap.
template <Flaw flaw>
class PlainCuller : public DescentCuller {
 public:
  using DescentCuller::DescentCuller;

  void refit(const Step& step) override {
    DescentCuller::refit(step);
    leaf_.clear();
    for (NodeIndex n = 0; n < static_cast<NodeIndex>(tree_.node_count()); ++n) {
      if (!tree_.is_leaf(n)) continue;
      last_ = n;
      leaf_.push_back({tree_.triangle(n), bounds_[n]});
      if (flaw == Flaw::bounds_one_ulp_too_tight)
        for (float& bound : leaf_.back().bound.at_least)
          bound = std::nextafter(bound, std::numeric_limits<float>::infinity());
    }
  }
  CullCounts cull(TrianglePairSink& sink) override {
    if (flaw == Flaw::bounds_one_ulp_too_tight) {
      for (std::size_t i = 0; i < leaf_.size(); ++i)
        for (std::size_t j = i + 1; j < leaf_.size(); ++j)
          if (overlap(leaf_[i].bound, leaf_[j].bound)) sink.add(leaf_[i].triangle, leaf_[j].triangle);
      return {};
    }
    const auto skip = [&](NodeIndex a, NodeIndex b) {
      return flaw == Flaw::last_leaf_skipped && (a == last_ || b == last_);
    };
    const auto emit = [&](NodeIndex a, NodeIndex b) {
      if (flaw == Flaw::one_triangle_pair_in_10000_lost && ++emitted_ % 10000 == 0) return;
      sink.add(tree_.triangle(a), tree_.triangle(b));
    };
    return descend(skip, emit);
  }

 private:
  struct Leaf {
    TriangleId triangle;
    Kdop16 bound;
  };
  std::vector<Leaf> leaf_;
  NodeIndex last_ = 0;
  static inline std::uint64_t emitted_ = 0;
};

// Drops the pairs inside every patch whose normals lie in a half space and whose contour, seen from there, is
// simple.
template <Flaw flaw>
class ConeCuller : public DescentCuller {
 public:
  explicit ConeCuller(const StrategyInput& setup)
      : DescentCuller(setup), discs_(mesh_, tree_), cones_(mesh_, tree_) {}

  void refit(const Step& step) override {
    DescentCuller::refit(step);
    cones_.update(tree_, step.motion);
    motion_ = step.motion;
  }
  CullCounts cull(TrianglePairSink& sink) override {
    const auto skip = [&](NodeIndex a, NodeIndex b) {
      return a == b && !discs_.contour(a).empty() && cones_[a].in_half_space() &&
             (flaw == Flaw::contours_not_tested ||
              contour_.simple(discs_.contour(a), cones_[a].axis, *motion_));
    };
    const auto emit = [&](NodeIndex a, NodeIndex b) { sink.add(tree_.triangle(a), tree_.triangle(b)); };
    return descend(skip, emit);
  }

 private:
  mcd::Discs discs_;
  mcd::NormalCones cones_;
  mcd::ContourTest contour_;
  std::optional<Motion> motion_;
};

// The culler of rvbc with spoilt classes, or with clusters that all act as one (sound only as long as they
// share one observer: Flaw::observers_mixed).
template <Flaw flaw>
class RadialCuller : public RvbcCuller {
 public:
  RadialCuller(const StrategyInput& setup, radial::AtomicClusters clusters,
               std::vector<radial::ObserverKind> kinds)
      : RvbcCuller(setup, std::move(clusters), std::move(kinds)), mesh_(setup.mesh) {
    if (flaw == Flaw::observers_mixed) std::ranges::fill(unmerged_, 0);
  }
  bool classify(const Step& step) override {
    RvbcCuller::classify(step);
    for (std::size_t c = 0; c < kinds_.size(); ++c) {
      const std::span<radial::Orientation> classes = hierarchy_.classes(c);
      for (std::size_t member = 0; member < classes.size(); ++member)
        spoil(classes[member], step.motion, hierarchy_.groups()[c][member], observers_[c]);
    }
    radial_ = hierarchy_.finish_classes();
    return true;
  }

 private:
  void spoil(radial::Orientation& found, const Motion& motion, TriangleId triangle,
             const radial::Observer& observer) const {
    if (flaw == Flaw::uncertain_called_positive && found == radial::Orientation::uncertain)
      found = radial::Orientation::positive;
    if (flaw != Flaw::segment_by_one_vertex || !observer.is_segment) return;
    const Triangle& c = mesh_.corners(triangle);
    const MovingPoint corner[3] = {motion[c[0]], motion[c[1]], motion[c[2]]};
    const auto seen_from = [&](const Vec3& p, const Vec3& head, const Vec3& tail) {
      return radial::nearest_on_segment(p, head, tail);
    };
    found = orientation(
        corner, radial::Observer::point({seen_from(corner[0].start, observer.head.start, observer.tail.start),
                                         seen_from(corner[0].end, observer.head.end, observer.tail.end)}));
  }

  const TriangleMesh& mesh_;
};

// Many covers, each of one cluster a component that is seen from a vertex or a point between two; a pair is
// dropped where one of them certifies all triangles round both.
template <Flaw flaw>
class ManyCoversCuller : public DescentCuller {
 public:
  using DescentCuller::DescentCuller;

  bool classify(const Step& step) override {
    const Motion& motion = step.motion;
    by_.assign(mesh_.triangle_count(), {});
    std::mt19937 random(14);
    for (int cover = 0; cover < kManyCovers; ++cover) {
      const auto vertex = [&] {
        return motion[VertexId{static_cast<std::int32_t>(random() % mesh_.vertex_count())}];
      };
      const MovingPoint a = vertex(), b = vertex();
      const auto q = radial::Observer::point({(a.start + b.start) / 2, (a.end + b.end) / 2});
      std::vector<radial::Orientation> found;
      for (const Triangle& c : mesh_.triangles()) {
        const MovingPoint corner[3] = {motion[c[0]], motion[c[1]], motion[c[2]]};
        found.push_back(orientation(corner, q));
      }
      for (const radial::Orientation sign : {radial::Orientation::positive, radial::Orientation::negative})
        for (std::size_t t = 0; t < found.size(); ++t) {
          bool all = found[t] == sign;
          if (flaw != Flaw::certified_by_triangle)
            for (const VertexId v : mesh_.triangles()[t])
              for (const TriangleId other : mesh_.triangles_at(v)) all = all && found[+other] == sign;
          by_[t].push_back(all);
        }
    }
    return true;
  }
  CullCounts cull(TrianglePairSink& sink) override {
    const auto emit = [&](NodeIndex a, NodeIndex b) {
      if (!dropped(tree_.triangle(a), tree_.triangle(b))) sink.add(tree_.triangle(a), tree_.triangle(b));
    };
    return descend([](NodeIndex, NodeIndex) { return false; }, emit);
  }

 private:
  static constexpr int kManyCovers = 40;

  bool dropped(TriangleId a, TriangleId b) const {
    if (mesh_.component(a) != mesh_.component(b)) return false;
    const std::vector<bool>&one = by_[+a], &other = by_[+b];
    if (flaw == Flaw::covers_mixed)  // one sign, but each for a field of its own
      for (std::size_t sign = 0; sign < 2; ++sign) {
        bool any[2] = {};
        for (std::size_t i = sign; i < one.size(); i += 2) any[0] |= one[i], any[1] |= other[i];
        if (any[0] && any[1]) return true;
      }
    for (std::size_t i = 0; i < one.size(); ++i)
      if (one[i] && other[i]) return true;
    return false;
  }

  std::vector<std::vector<bool>> by_;  // of each triangle: positive and negative for each cover
};

template <Flaw flaw>
Prepared make_many_covers(const StrategyInput& setup) {
  radial::require_radial_setup(setup, "a saboteur");
  return {compose(std::make_unique<ManyCoversCuller<flaw>>(setup), setup), {}};
}

// Every vertex and edge belongs to the first triangle at it, and is tested with that triangle alone.
class RepresentativeDetector : public Detector {
 public:
  RepresentativeDetector(std::unique_ptr<Culler> culler, const StrategyInput& setup)
      : culler_(std::move(culler)), mesh_(setup.mesh), test_(setup.elementary) {}

  Report detect(const Step& step, ContactSet& out) override {
    out.clear();
    Sink sink(*this, step.motion, out);
    culler_->refit(step);
    culler_->classify(step);
    Report report;
    report.cull = culler_->cull(sink);
    sink.flush();
    report.cull.pctp = sink.count();
    return report;
  }

 private:
  struct Sink : TrianglePairSink {
    RepresentativeDetector& detector;
    const Motion& motion;
    ContactSet& out;
    Sink(RepresentativeDetector& d, const Motion& m, ContactSet& o) : detector(d), motion(m), out(o) {}
    void take(const std::vector<TrianglePair>& block) override {
      for (const TrianglePair& pair : block) detector.test(pair, motion, out);
    }
  };
  void test(const TrianglePair& pair, const Motion& motion, ContactSet& out) const {
    const auto owns = [&](TriangleId triangle, auto feature) {
      return mesh_.triangles_at(feature).front() == triangle;
    };
    const auto has = [](const auto& items, VertexId v) {
      return std::find(items.begin(), items.end(), v) != items.end();
    };
    const auto answer = [&](const FeaturePair& features) {
      const Answer a = ask(test_, mesh_, motion, features);
      if (a.verdict != Verdict::apart) out.contacts.push_back({features, a.verdict, a.time});
    };
    for (const auto& [one, other] : {std::pair{pair.a, pair.b}, std::pair{pair.b, pair.a}})
      for (const VertexId v : mesh_.corners(one))
        if (owns(one, v) && !has(mesh_.corners(other), v)) answer(FeaturePair::of(v, other));
    for (const EdgeId e : mesh_.edges_of(pair.a))
      for (const EdgeId f : mesh_.edges_of(pair.b)) {
        const Edge &ends = mesh_.ends(e), &others = mesh_.ends(f);
        if (owns(pair.a, e) && owns(pair.b, f) && !has(others, ends[0]) && !has(others, ends[1]))
          answer(FeaturePair::of(e, f));
      }
  }

  std::unique_ptr<Culler> culler_;
  const TriangleMesh& mesh_;
  const ElementaryTest& test_;
};

// Forgets the contacts of one feature pair in 10,000, by a hash of the pair and its number in the stream.
class ForgetfulDetector : public Detector {
 public:
  explicit ForgetfulDetector(std::unique_ptr<Detector> inner) : inner_(std::move(inner)) {}
  Report detect(const Step& step, ContactSet& out) override {
    const Report report = inner_->detect(step, out);
    const std::uint64_t salt = std::bit_cast<std::uint64_t>(step.motion.start()[0].x());
    std::erase_if(out.contacts, [&](const Contact& contact) {
      std::uint64_t hash = salt;
      for (const std::int32_t id : {contact.pair.a, contact.pair.b})
        hash = (hash ^ static_cast<std::uint64_t>(id)) * 0x9e3779b97f4a7c15u;
      return (hash >> 20) % 10000 == 0;
    });
    return report;
  }

 private:
  std::unique_ptr<Detector> inner_;
};

template <Flaw flaw>
Prepared make_plain(const StrategyInput& setup) {
  auto detector = compose(std::make_unique<PlainCuller<flaw>>(setup), setup);
  if (flaw == Flaw::one_feature_pair_in_10000_lost)
    return {std::make_unique<ForgetfulDetector>(std::move(detector)), {}};
  return {std::move(detector), {}};
}

template <Flaw flaw>
Prepared make_cones(const StrategyInput& setup) {
  return {compose(std::make_unique<ConeCuller<flaw>>(setup), setup), {}};
}

// One cluster a bone, whatever the components of the mesh.
inline radial::AtomicClusters clusters_across_components(const TriangleMesh& mesh,
                                                         std::span<const BoneId> bone_of_triangle) {
  radial::AtomicClusters clusters;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto known = std::find_if(clusters.clusters.begin(), clusters.clusters.end(),
                                    [&](const auto& c) { return c.bone == bone_of_triangle[t]; });
    clusters.of_triangle.push_back(static_cast<std::int32_t>(known - clusters.clusters.begin()));
    if (known == clusters.clusters.end()) clusters.clusters.push_back({bone_of_triangle[t], {}});
    clusters.clusters[static_cast<std::size_t>(clusters.of_triangle.back())].triangles.push_back(
        TriangleId{static_cast<std::int32_t>(t)});
  }
  clusters.neighbours.resize(clusters.clusters.size());
  return clusters;
}

// From clusters and observers that are given.
template <Flaw flaw>
std::unique_ptr<Detector> make_radial(const StrategyInput& setup, radial::AtomicClusters clusters,
                                      std::vector<radial::ObserverKind> kinds) {
  auto culler = std::make_unique<RadialCuller<flaw>>(setup, std::move(clusters), std::move(kinds));
  if (flaw == Flaw::representative_triangles)
    return std::make_unique<RepresentativeDetector>(std::move(culler), setup);
  return compose(std::move(culler), setup);
}

// Clusters in the way of rvbc, all of them viewed from their bones as segments or from the bones' centres.
template <Flaw flaw, radial::ObserverKind kind>
Prepared make_radial(const StrategyInput& setup) {
  radial::require_radial_setup(setup, "a saboteur");
  const std::vector<BoneId> bone_of =
      radial::nearest_bone_by_heat(setup.mesh, setup.reference, *setup.rig, {8, 0});
  radial::AtomicClusters clusters = flaw == Flaw::clusters_span_components
                                        ? clusters_across_components(setup.mesh, bone_of)
                                        : radial::make_atomic_clusters(setup.mesh, bone_of);
  std::vector<radial::ObserverKind> kinds(clusters.clusters.size(), kind);
  return {make_radial<flaw>(setup, std::move(clusters), std::move(kinds)), {}};
}

}  // namespace cscd::test
