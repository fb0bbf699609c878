#include "bench/strategies/catalogue.h"

#include <array>

#include "baselines/cgal_boxes/cgal_boxes.h"
#include "baselines/embree/embree.h"
#include "baselines/fcl/fcl.h"
#include "baselines/mcd/mcd.h"
#include "baselines/plain.h"
#include "baselines/rvbc.h"
#include "baselines/selfccd.h"
#include "bench/strategies/unknown_name.h"
#include "core/drvbc/drvbc.h"
#include "core/fast/drvbc_fast.h"
#include "core/radial/setup.h"
#include "core/session/near_strategy.h"

namespace cscd::bench {
namespace {

constexpr std::string_view kAblation = "ablation";

using Make = Prepared (*)(const StrategyInput&);

// Rows of the ablation that promise what the published methods, or the engine, promise.
constexpr Strategy of_published(std::string_view name, std::string_view source, Make make) {
  return {name, source,   Guarantee::first_contact, Needs::closed_mesh_with_bones, StrategyKind::published,
          make, kAblation};
}
constexpr Strategy of_engine(std::string_view name, std::string_view source, Make make) {
  return {name, source,   Guarantee::first_contact, Needs::closed_mesh, StrategyKind::adaptive,
          make, kAblation};
}

// A row names what it says of its strategy; what it leaves out has the default of core/detect/strategy.h.
constexpr std::array kStrategies = {
    Strategy{
        .name = "base",
        .source = "16-DOP hierarchy (Klosowski et al. 1998)",
        .guarantee = Guarantee::complete,
        .needs = Needs::any_mesh,
        .kind = StrategyKind::published,
        .make = make_base,
        .sees_start = true,
        .knows_distance = true,
    },
    Strategy{
        .name = "brute",
        .source = "all pairs of triangles",
        .guarantee = Guarantee::complete,
        .needs = Needs::any_mesh,
        .kind = StrategyKind::published,
        .make = make_brute,
        .group = "oracle",
        .sees_start = true,
        .knows_distance = true,
    },
    Strategy{
        .name = "aabb",
        .source = "AABB hierarchy (van den Bergen 1999)",
        .guarantee = Guarantee::complete,
        .needs = Needs::any_mesh,
        .kind = StrategyKind::published,
        .make = make_aabb,
        .sees_start = true,
        .knows_distance = true,
    },
    Strategy{
        .name = "mcd",
        .source = "continuous normal cones and contour tests (Tang et al. 2009)",
        .guarantee = Guarantee::complete,
        .needs = Needs::any_mesh,
        .kind = StrategyKind::published,
        .make = make_mcd,
    },
    Strategy{
        .name = "selfccd",
        .source = "representative triangles and orphan sets (Curtis et al. 2008, Tang et al. 2009)",
        .guarantee = Guarantee::complete,
        .needs = Needs::any_mesh,
        .kind = StrategyKind::published,
        .make = make_selfccd,
    },
#ifdef CSCD_BASELINES_EMBREE
    Strategy{
        .name = "embree",
        .source = kEmbreeTitle,
        .guarantee = Guarantee::complete,
        .needs = Needs::any_mesh,
        .kind = StrategyKind::package,
        .make = make_embree,
    },
#endif
#ifdef CSCD_BASELINES_CGAL_BOXES
    Strategy{
        .name = "cgal_boxes",
        .source = "CGAL, box_self_intersection_d",
        .guarantee = Guarantee::complete,
        .needs = Needs::any_mesh,
        .kind = StrategyKind::package,
        .make = make_cgal_boxes,
    },
#endif
    Strategy{
        .name = "rvbc",
        .source = "radial view based culling (Wong et al. 2013)",
        .guarantee = Guarantee::first_contact,
        .needs = Needs::closed_mesh_with_bones,
        .kind = StrategyKind::published,
        .make = [](const StrategyInput& setup) { return make_rvbc(setup); },
        .knows_distance = true,
    },
    Strategy{
        .name = "drvbc",
        .source = "dynamic radial view based culling (Wong et al. 2014)",
        .guarantee = Guarantee::first_contact,
        .needs = Needs::closed_mesh_with_bones,
        .kind = StrategyKind::published,
        .make = [](const StrategyInput& setup) { return make_drvbc(setup); },
        .knows_distance = true,
    },
    kDrvbcFast,
    kDrvbcFastComplete,
    Strategy{
        .name = "drvbc_fast_all",
        .source = "drvbc_fast_complete from starts that are known to be embedded",
        .guarantee = Guarantee::all_from_embedded,
        .needs = Needs::closed_mesh,
        .kind = StrategyKind::adaptive,
        .make =
            [](const StrategyInput& setup) {
              return make_drvbc_fast(setup,
                                     {.name = "drvbc_fast_all", .complete = true, .starts_embedded = true});
            },
        .knows_distance = true,
    },
    kDrvbcFastNear,
#ifdef CSCD_BASELINES_FCL
    Strategy{
        .name = "fcl",
        .source = "FCL 0.7, continuous traversal of a model with itself (Pan et al. 2012)",
        .guarantee = Guarantee::heuristic,
        .needs = Needs::any_mesh,
        .kind = StrategyKind::package,
        .make = make_fcl,
        .group = "checker",
        .own_test = true,
    },
#endif
    // One thing at a time left out, or added.
    of_published("rvbc_relative", "rvbc with relative boxes",
                 [](const StrategyInput& setup) {
                   return make_rvbc(setup, {.name = "rvbc_relative", .relative_boxes = true});
                 }),
    of_published("drvbc_unrefined", "drvbc without refinement of its atomic clusters",
                 [](const StrategyInput& setup) {
                   return make_drvbc(setup, {.bones = {.refinement = false}, .name = "drvbc_unrefined"});
                 }),
    of_published("drvbc_bones", "drvbc with one atomic cluster for each bone",
                 [](const StrategyInput& setup) {
                   return make_drvbc(setup, {.division = radial::Division::none, .name = "drvbc_bones"});
                 }),
    of_published("drvbc_pieces", "drvbc with one atomic cluster for each connected piece of a bone's surface",
                 [](const StrategyInput& setup) {
                   return make_drvbc(setup, {.division = radial::Division::pieces, .name = "drvbc_pieces"});
                 }),
    of_published(
        "drvbc_unmerged", "drvbc without mega clusters",
        [](const StrategyInput& setup) { return make_drvbc(setup, {.gamma = 0, .name = "drvbc_unmerged"}); }),
    of_published("drvbc_unrelative", "drvbc without relative boxes",
                 [](const StrategyInput& setup) {
                   return make_drvbc(setup, {.relative_boxes = false, .name = "drvbc_unrelative"});
                 }),
    of_published("drvbc_uncached", "drvbc without its cache of triangles that were not positive",
                 [](const StrategyInput& setup) {
                   return make_drvbc(setup, {.name = "drvbc_uncached", .cache = false});
                 }),
    of_engine("drvbc_fast_one_cover", "drvbc_fast with the first of its covers alone",
              [](const StrategyInput& setup) {
                return make_drvbc_fast(setup, {.name = "drvbc_fast_one_cover", .covers = 1});
              }),
    of_engine("drvbc_fast_two_covers", "drvbc_fast with at most two covers",
              [](const StrategyInput& setup) {
                return make_drvbc_fast(setup, {.name = "drvbc_fast_two_covers", .covers = 2});
              }),
    of_engine("drvbc_fast_swept_bounds", "drvbc_fast with bounds of whole paths",
              [](const StrategyInput& setup) {
                return make_drvbc_fast(setup, {.name = "drvbc_fast_swept_bounds", .time_linear = false});
              }),
    of_engine("drvbc_fast_no_stars", "drvbc_fast without one-rings of vertices",
              [](const StrategyInput& setup) {
                return make_drvbc_fast(setup, {.name = "drvbc_fast_no_stars", .one_rings = false});
              }),
    of_engine("drvbc_fast_no_planes", "drvbc_fast without planes of triangles",
              [](const StrategyInput& setup) {
                return make_drvbc_fast(setup, {.name = "drvbc_fast_no_planes", .planes = false});
              }),
    of_engine("drvbc_fast_whole_steps", "drvbc_fast without parts of long steps",
              [](const StrategyInput& setup) {
                return make_drvbc_fast(
                    setup, {.name = "drvbc_fast_whole_steps", .long_descent = DrvbcFastOptions::kNever});
              }),
    Strategy{
        .name = "drvbc_fast_fixed_covers",
        .source = "drvbc_fast with covers that stay as preparation cut them",
        .guarantee = Guarantee::first_contact,
        .needs = Needs::closed_mesh,
        .kind = StrategyKind::fixed,
        .make =
            [](const StrategyInput& setup) {
              return make_drvbc_fast(setup, {.name = "drvbc_fast_fixed_covers", .follows = false});
            },
        .group = kAblation,
    },
    Strategy{
        .name = "drvbc_fast_fixed_covers_complete",
        .source = "drvbc_fast_complete with covers that stay as preparation cut them",
        .guarantee = Guarantee::complete,
        .needs = Needs::any_mesh,
        .kind = StrategyKind::fixed,
        .make =
            [](const StrategyInput& setup) {
              return make_drvbc_fast(
                  setup, {.name = "drvbc_fast_fixed_covers_complete", .follows = false, .complete = true});
            },
        .group = kAblation,
        .sees_start = true,
        .drops_by_signs = true,
    },
    Strategy{
        .name = "drvbc_fast_bones",
        .source = "drvbc_fast, all covers of bones without a trial",
        .guarantee = Guarantee::first_contact,
        .needs = Needs::closed_mesh_with_bones,
        .kind = StrategyKind::adaptive,
        .make =
            [](const StrategyInput& setup) {
              radial::require_radial_setup(setup, "drvbc_fast_bones");
              return make_drvbc_fast(
                  setup, {.name = "drvbc_fast_bones", .clusters = DrvbcFastOptions::Clusters::of_bones});
            },
        .group = kAblation,
    },
    of_engine("drvbc_fast_no_bones", "drvbc_fast, all covers of the surface without a trial",
              [](const StrategyInput& setup) {
                return make_drvbc_fast(setup, {.name = "drvbc_fast_no_bones",
                                               .clusters = DrvbcFastOptions::Clusters::of_surface});
              }),
    Strategy{
        .name = "drvbc_one_vertex",
        .source = "drvbc with the paper's test of one vertex for segments",
        .guarantee = Guarantee::heuristic,
        .needs = Needs::closed_mesh_with_bones,
        .kind = StrategyKind::published,
        .make =
            [](const StrategyInput& setup) {
              return make_drvbc(
                  setup, {.name = "drvbc_one_vertex", .segment_test = radial::SegmentTest::first_corner});
            },
        .group = kAblation,
    },
};

}  // namespace

std::span<const Strategy> strategies() {
  return kStrategies;
}

const Strategy& strategy_named(std::string_view name) {
  for (const Strategy& strategy : kStrategies)
    if (strategy.name == name) return strategy;
  refuse_unknown("strategy", name, kStrategies);
}

std::vector<const Strategy*> strategies_called(std::string_view name_or_group) {
  std::vector<const Strategy*> group = strategies_in(name_or_group);
  if (group.empty()) group.push_back(&strategy_named(name_or_group));
  return group;
}

std::vector<const Strategy*> strategies_in(std::string_view group) {
  std::vector<const Strategy*> rows;
  for (const Strategy& strategy : kStrategies)
    if (strategy.group == group) rows.push_back(&strategy);
  return rows;
}

const Strategy& complete_reference() {
  return strategy_named("base");
}

const Strategy& all_pairs() {
  return strategy_named("brute");
}

const Strategy& complete_fallback() {
  return strategy_named(kDrvbcFastComplete.name);
}

}  // namespace cscd::bench
