#include "core/fast/trial.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include "core/base/random.h"
#include "core/base/thread_pool.h"
#include "core/fast/clusters/surface_clusters.h"
#include "core/fast/joints_of_parts.h"
#include "core/fast/prepare/coarse_surface.h"
#include "core/fast/prepare/outward_mesh.h"
#include "core/geometry/simd_floats.h"
#include "core/radial/atomic_clusters.h"
#include "core/radial/bone_clusters.h"

namespace cscd::fast {

namespace {

constexpr double kTurned = std::numbers::pi / 9, kFurther = std::numbers::pi / 36;
constexpr int kSmoothed = 8;  // the number of times that turns are smoothed over the seams

using Transforms = std::vector<Eigen::Isometry3d>;

// The turn of every bone, its parent's turns included.
Transforms turned(const Rig& rig, std::span<const Vec3> axes, double angle) {
  const std::size_t count = rig.parent.size();
  Transforms transforms(count);
  std::vector<bool> known(count, false);
  const std::function<const Eigen::Isometry3d&(std::size_t)> of =
      [&](std::size_t bone) -> const Eigen::Isometry3d& {
    if (known[bone]) return transforms[bone];
    const Vec3& joint = rig.reference[bone].head;
    const Eigen::Isometry3d own =
        Eigen::Translation3d(joint) * Eigen::AngleAxisd(angle, axes[bone]) * Eigen::Translation3d(-joint);
    const BoneId parent = rig.parent[bone];
    transforms[bone] = +parent < rig.parent.size() ? of(+parent) * own : own;
    known[bone] = true;
    return transforms[bone];
  };
  for (std::size_t bone = 0; bone < count; ++bone) of(bone);
  return transforms;
}

// How far a vertex is moved at both ends of a trial: x, y, z and an unused number each.
using Shift = Float8;

// Moves each vertex by the mean of what the bones of the triangles at the vertex would move it by.
std::vector<Shift> turned_shifts(const TriangleMesh& mesh, std::span<const Vec3> reference,
                                 std::span<const BoneId> bone_of, const std::array<Transforms, 2>& turns) {
  std::vector<Shift> shifts(reference.size());
  for (std::size_t v = 0; v < shifts.size(); ++v) {
    const auto around = mesh.triangles_at(VertexId{static_cast<std::int32_t>(v)});
    for (std::size_t end = 0; end < 2; ++end) {
      Vec3 sum = Vec3::Zero(), one = Vec3::Zero();
      BoneId last{-1};
      for (const TriangleId t : around) {
        if (bone_of[+t] != last) one = turns[end][+bone_of[+t]] * reference[v] - reference[v];
        last = bone_of[+t];
        sum += one / static_cast<double>(around.size());
      }
      for (std::size_t i = 0; i < 3; ++i)
        shifts[v][4 * end + i] = static_cast<float>(sum[static_cast<int>(i)]);
    }
  }
  return shifts;
}

// The neighbours of each vertex, in compressed rows. On a closed and oriented surface each neighbour is a
// corner of two of the triangles at the vertex, and comes behind the vertex in one of them.
struct Neighbours {
  std::vector<std::int32_t> of;
  std::vector<std::size_t> first{0};

  explicit Neighbours(const TriangleMesh& mesh) {
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      const VertexId vertex{static_cast<std::int32_t>(v)};
      for (const TriangleId t : mesh.triangles_at(vertex)) {
        const Triangle& c = mesh.corners(t);
        of.push_back(+c[c[0] == vertex ? 1 : c[1] == vertex ? 2 : 0]);
      }
      first.push_back(of.size());
    }
  }
};

// Replaces every shift by the mean over the corners of the triangles at the vertex, again and again.
void smooth(const Neighbours& neighbours, std::vector<Shift>& shifts) {
  const auto& [of, first] = neighbours;
  std::vector<Shift> before(shifts.size());
  for (int i = 0; i < kSmoothed; ++i) {
    before.swap(shifts);
    for (std::size_t v = 0; v < shifts.size(); ++v) {
      Shift sum{};
      for (std::size_t k = first[v]; k < first[v + 1]; ++k) sum += before[static_cast<std::size_t>(of[k])];
      const std::size_t count = first[v + 1] - first[v];
      shifts[v] = count == 0 ? before[v] : (before[v] + sum * (2 / static_cast<float>(count))) / 3.0F;
    }
  }
}

bool has_bones(const StrategyInput& setup) {
  return setup.rig != nullptr && !setup.rig->parent.empty();
}

// Labels that are all alike say nothing.
bool has_labels(const StrategyInput& setup) {
  return !has_bones(setup) &&
         std::ranges::adjacent_find(setup.labels, std::not_equal_to{}) != setup.labels.end();
}

class CountingSink : public TrianglePairSink {
  void take(const std::vector<TrianglePair>&) override {}
};

// Work is counted in overlap tests of bounding volumes. These constants say how many overlap tests cost about
// as much as one patch in an interval, one look, and one observer that is placed.
constexpr std::uint64_t kTestsOfPatch = 9, kTestsOfPass = 3, kTestsOfObserver = 10;
// The number of trial poses, and the number on a surface of many triangles, where each pose costs more.
constexpr std::size_t kTrials = 6, kFewTrials = 2;
// Candidates that look with caps take fewer overlap tests if their clusters are found on a coarser surface of
// more triangles than kManyTriangles. These candidates are cut from the surface itself, so the finer clusters
// add little to the time of preparation.
constexpr std::size_t kManyTrianglesForCaps = 64000;

// The trial poses turn the joints of the bones, at which the clusters of bones have their seams. The motion
// to come bends the surface elsewhere too, so the clusters of bones are taken only if they make less work
// than those of the surface by more than one part in kFlattered.
constexpr std::uint64_t kFlattered = 20;

// Returns the largest number of triangles that the surface may have on which clusters are found. A surface of
// more than kManyTriangles triangles is always made coarser by one level at least.
std::size_t most_triangles_for_clusters(std::size_t triangles, bool with_caps) {
  if (!with_caps || triangles <= kManyTriangles) return kManyTriangles;
  return std::min(kManyTrianglesForCaps, triangles - 1);
}

// Returns the work of all trials, for a complete culler by signs or by caps. Stops early, and returns a sum
// above `most`, once the work is more than `most`.
std::uint64_t work(FastCuller& culler, std::span<const PosePair> trials, bool by_signs, std::uint64_t most) {
  std::uint64_t tests = 0;
  for (const PosePair& trial : trials) {
    if (tests > most) break;
    CountingSink sink;
    const Step step{.motion = Motion(trial[0], trial[1]), .starts_embedded = by_signs};
    culler.refit(step);
    culler.classify(step);
    const CullCounts counts = culler.cull(sink);
    tests += kTestsOfPatch * culler.patch_count() + kTestsOfPass * culler.orientation_passes() +
             kTestsOfObserver * counts.radial->clusters + *counts.bvot + kTestsOfPair * sink.count();
  }
  return tests;
}

TrialCuller made(const StrategyInput& setup, std::vector<std::int32_t> cluster_of,
                 const DrvbcFastOptions& options) {
  const ThreadPool pool(setup.threads);
  auto culler = std::make_unique<FastCuller>(
      setup, cut_surface(setup.mesh, setup.reference, cluster_of, kLeastCell, pool), options);
  return {std::move(cluster_of), std::move(culler)};
}

// Takes over what an earlier preparation of the surface has decided.
TrialCuller restored(const StrategyInput& setup, const DrvbcFastOptions& options) {
  RestoredCut restored = restored_cut(setup.mesh, setup.reference, setup.preparation);
  TrialCuller candidate{restored.cut.covers[0].cluster_of, nullptr, restored.new_triangles};
  candidate.culler = std::make_unique<FastCuller>(setup, std::move(restored.cut), options);
  candidate.culler->use_covers(std::min(restored.covers, options.covers));
  return candidate;
}

// The least work that a candidate makes, and the number of covers with which it makes it.
struct TrialResult {
  std::uint64_t work = std::numeric_limits<std::uint64_t>::max();
  std::size_t covers = kCovers;
};

// Tries a candidate with three covers, two and one. A trial stops early once it has made more work than
// `most()`, so a result above most() may be less than the candidate's work.
template <class Most>
TrialResult tried_with(FastCuller& culler, std::span<const PosePair> trials, bool by_signs,
                       const Most& most) {
  TrialResult least;
  for (std::size_t count = kCovers; count > 0; --count) {
    culler.use_covers(count);
    const std::uint64_t needed = work(culler, trials, by_signs, std::min(least.work, most()));
    if (needed < least.work) least = {needed, count};
  }
  return least;
}

// The surfaces that preparation works on. Clusters are always found on the coarse surface. Candidates are cut
// and tried either on the coarse surface too, or on the surface itself: candidates that look with caps come
// out in another order on a fine surface than on a coarse one.
struct Surfaces {
  const StrategyInput& setup;
  const CoarseSurface& coarse;
  bool tried_on_coarse;

  StrategyInput coarse_setup() const {
    StrategyInput coarser{coarse.mesh(), coarse.positions(), setup.rig, setup.elementary};
    coarser.threads = setup.threads;
    return coarser;
  }
  StrategyInput trial_setup() const { return tried_on_coarse ? coarse_setup() : setup; }
  std::size_t trials() const { return tried_on_coarse || !coarse.is_coarser() ? kTrials : kFewTrials; }
  // Takes labels of the coarse surface's triangles to the surface that candidates are tried on.
  std::vector<std::int32_t> on_trial_surface(std::vector<std::int32_t> label_of) const {
    return tried_on_coarse ? label_of : coarse.carried(std::move(label_of));
  }
};

std::vector<std::int32_t> clusters_of_surface(const Surfaces& surfaces) {
  const TriangleMesh& coarse = surfaces.coarse.mesh();
  const double fineness = static_cast<double>(surfaces.setup.mesh.triangle_count()) /
                          static_cast<double>(coarse.triangle_count());
  return surfaces.on_trial_surface(surface_clusters(coarse, surfaces.coarse.positions(), fineness));
}

// Returns the bone of each triangle of the trial surface. Edges of a coarse surface are long, so a cell of
// the distance field spans fewer of them, and as many passes of smoothing would leave little of thin limbs.
std::vector<BoneId> bones_of_triangles(const Surfaces& surfaces, StageClock& clock) {
  const radial::BoneClusterOptions fine, coarse{.coarsening = 2, .smoothing_passes = 1};
  std::vector<std::int32_t> numbers;
  for (const BoneId bone : radial::bones_of_triangles(surfaces.coarse_setup(),
                                                      surfaces.coarse.is_coarser() ? coarse : fine, clock))
    numbers.push_back(static_cast<std::int32_t>(bone));
  std::vector<BoneId> bone_of;
  for (const std::int32_t number : surfaces.on_trial_surface(std::move(numbers)))
    bone_of.push_back(BoneId{number});
  return bone_of;
}

// Returns the part of each triangle of the trial surface, numbered from 0 without gaps: the label of its
// first corner, or of the second where the second and the third agree.
std::vector<std::int32_t> labelled_parts(const Surfaces& surfaces) {
  const std::vector<std::int32_t> label_of = surfaces.coarse.coarse_labels(surfaces.setup.labels);
  std::vector<std::int32_t> part_of;
  std::map<std::int32_t, std::int32_t> part_of_label;
  for (const Triangle& c : surfaces.coarse.mesh().triangles()) {
    const std::int32_t label = label_of[+c[label_of[+c[1]] == label_of[+c[2]] ? 1 : 0]];
    const auto next = static_cast<std::int32_t>(part_of_label.size());
    part_of.push_back(part_of_label.try_emplace(label, next).first->second);
  }
  return surfaces.on_trial_surface(std::move(part_of));
}

// The parts of a surface that turn against each other: bones, or what the labels of vertices tell apart.
struct Parts {
  Rig rig;
  std::vector<BoneId> bone_of;  // [triangles of the trial surface]
};
Parts parts_of(const Surfaces& surfaces, StageClock& clock) {
  const StrategyInput tried = surfaces.trial_setup();
  if (has_bones(tried)) return {*tried.rig, bones_of_triangles(surfaces, clock)};
  const std::vector<std::int32_t> part_of = labelled_parts(surfaces);
  Parts parts{joints_of_parts(tried.mesh, tried.reference, part_of), {}};
  for (const std::int32_t part : part_of) parts.bone_of.push_back(BoneId{part});
  return parts;
}

// Calls work(0) and work(1), side by side if there are two threads or more. Throws what one of the two calls
// has thrown.
template <class Work>
void for_both(int threads, const Work& work) {
  std::array<std::exception_ptr, 2> thrown;
  ThreadPool(threads).parallel_for(thrown.size(), [&](std::size_t i, std::size_t) {
    try {
      work(i);
    } catch (...) {
      thrown[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& exception : thrown)
    if (exception) std::rethrow_exception(exception);
}

// The clusters along which the trial surface is cut, and the number of covers to look from. If there was a
// trial, the winner comes with the culler that was tried; otherwise there is no culler.
struct Decision {
  TrialCuller taken;
  std::size_t covers = kCovers;
};
Decision decided(const Surfaces& surfaces, const DrvbcFastOptions& options, StageClock& clock) {
  using Clusters = DrvbcFastOptions::Clusters;
  const StrategyInput tried = surfaces.trial_setup();
  const bool has_parts = has_bones(tried) || has_labels(surfaces.setup);
  if (!has_parts || options.clusters == Clusters::of_surface || !tried.mesh.closed_and_oriented())
    return {{clusters_of_surface(surfaces), nullptr}};
  const auto of_bones = [&](std::span<const BoneId> bone_of) {
    return radial::make_atomic_clusters(tried.mesh, bone_of).of_triangle;
  };
  if (options.clusters == Clusters::of_bones) return {{of_bones(parts_of(surfaces, clock).bone_of), nullptr}};

  std::vector<PosePair> trials;
  std::array<TrialCuller, 2> candidates;
  for_both(tried.threads, [&](std::size_t i) {
    if (i == 0) {
      const Parts parts = parts_of(surfaces, clock);
      trials = trial_poses(tried.mesh, tried.reference, parts.rig, parts.bone_of, surfaces.trials());
      candidates[i] = made(tried, of_bones(parts.bone_of), options);
    } else {
      candidates[i] = made(tried, clusters_of_surface(surfaces), options);
    }
  });
  // The trial of the clusters of bones may stop once they make more work than those of the surface, because
  // they are then not taken.
  std::array<TrialResult, 2> results;
  std::atomic<std::uint64_t> of_surface = results[1].work;
  for_both(tried.threads, [&](std::size_t i) {
    const auto most = [&] { return i == 1 ? std::numeric_limits<std::uint64_t>::max() : of_surface.load(); };
    results[i] = tried_with(*candidates[i].culler, trials, options.starts_embedded, most);
    if (i == 1) of_surface = results[1].work;
  });
  const std::size_t taken = results[0].work < results[1].work - results[1].work / kFlattered ? 0 : 1;
  return {std::move(candidates[taken]), results[taken].covers};
}

// Does what best_trial_culler() does, for a surface of which no component faces inward.
TrialCuller best_of_outward(const StrategyInput& setup, const DrvbcFastOptions& options, StageClock& clock) {
  if (!setup.preparation.empty()) return restored(setup, options);
  // A row of the ablation takes the candidate that `drvbc_fast` with all its ideas would take, so that the
  // rows differ in nothing but the idea that is left out.
  const DrvbcFastOptions whole{.name = options.name,
                               .clusters = options.clusters,
                               .complete = options.complete,
                               .starts_embedded = options.starts_embedded};
  const bool with_caps = options.complete && !options.starts_embedded;
  const CoarseSurface coarse(setup.mesh, setup.reference,
                             most_triangles_for_clusters(setup.mesh.triangle_count(), with_caps));
  const bool tried_on_coarse = coarse.is_coarser() && !with_caps;
  Decision decision = decided({setup, coarse, tried_on_coarse}, whole, clock);
  TrialCuller best = std::move(decision.taken);
  if (tried_on_coarse) best.cluster_of = coarse.carried(std::move(best.cluster_of));
  renumber(best.cluster_of);
  if (!best.culler || tried_on_coarse || options != whole)
    best = made(setup, std::move(best.cluster_of), options);
  best.culler->use_covers(std::min(decision.covers, options.covers));
  return best;
}

}  // namespace

std::vector<PosePair> trial_poses(const TriangleMesh& mesh, std::span<const Vec3> reference, const Rig& rig,
                                  std::span<const BoneId> bone_of, std::size_t count) {
  std::mt19937 random(kPreparationSeed);
  const auto dice = [&] { return static_cast<double>(random() >> 8) * 0x1p-23 - 1; };
  const Neighbours neighbours(mesh);
  std::vector<PosePair> trials;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<Vec3> axes;
    for (std::size_t b = 0; b < rig.parent.size(); ++b) {
      Vec3 axis;
      for (int k = 0; k < 3; ++k) axis[k] = dice();
      axes.push_back(axis.squaredNorm() > 0 ? axis.normalized() : Vec3(Vec3::UnitX()));
    }
    std::vector<Shift> shifts = turned_shifts(
        mesh, reference, bone_of, {turned(rig, axes, kTurned), turned(rig, axes, kTurned + kFurther)});
    smooth(neighbours, shifts);
    PosePair& trial = trials.emplace_back();
    for (std::size_t end = 0; end < 2; ++end)
      for (std::size_t v = 0; v < shifts.size(); ++v)
        trial[end].push_back(reference[v] +
                             Vec3(shifts[v][4 * end], shifts[v][4 * end + 1], shifts[v][4 * end + 2]));
  }
  return trials;
}

TrialCuller best_trial_culler(const StrategyInput& setup, const DrvbcFastOptions& options,
                              StageClock& clock) {
  std::unique_ptr<const TriangleMesh> outward = turned_outward(setup.mesh, setup.reference);
  if (!outward) return best_of_outward(setup, options, clock);
  StrategyInput turned{*outward, setup.reference, setup.rig, setup.elementary};
  turned.threads = setup.threads;
  turned.preparation = setup.preparation;
  turned.labels = setup.labels;
  TrialCuller best = best_of_outward(turned, options, clock);
  best.culler->keep(std::move(outward));
  return best;
}

}  // namespace cscd::fast
