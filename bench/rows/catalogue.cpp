#include "bench/rows/catalogue.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <string>

#include "baselines/aabb.h"
#include "baselines/base.h"
#include "baselines/brute.h"
#include "baselines/cgal_boxes/cgal_boxes.h"
#include "baselines/embree/embree.h"
#include "baselines/fcl/fcl.h"
#include "baselines/fcl/fcl_elementary.h"
#include "baselines/mcd/mcd.h"
#include "baselines/rvbc.h"
#include "baselines/selfccd.h"
#include "core/base/closest_name.h"
#include "core/base/error.h"
#include "core/base/joined.h"
#include "core/drvbc/drvbc.h"
#include "core/elementary/catalogue.h"
#include "core/fast/drvbc_fast.h"

namespace cscd::bench {
namespace {

constexpr std::string_view kAblation = "ablation";

constexpr Needs kAnySurface = {}, kClosedMesh = {.closed_mesh = true},
                kBones = {.bones = true, .closed_mesh = true};

// These return a row with one member changed, so that no row has to spell out the members before that one.
constexpr Strategy with_role(Strategy row, Role role) {
  row.role = role;
  return row;
}
constexpr Strategy seeing_start(Strategy row) {
  row.sees_start = true;
  return row;
}
constexpr Strategy by_signs(Strategy row) {
  row.looks_by_signs = true;
  return row;
}
constexpr Strategy following(Strategy row) {
  row.follows = true;
  return row;
}
// The paper's method, or what the paper compares it with: it can be made in the pipeline `published`.
constexpr Strategy of_paper(Strategy row) {
  row.published = true;
  return row;
}
// The library allocates memory as it pleases. A build without any library has no such row.
[[maybe_unused]] constexpr Strategy in_library(Strategy row) {
  row.settles = false;
  return row;
}

// Members that a row leaves out have the defaults of strategy.h.
constexpr std::array kStrategies = {
    of_paper(seeing_start(with_role(
        {"base", "16-DOP hierarchy (Klosowski et al. 1998)", Guarantee::complete, kAnySurface, make_base},
        Role::reference))),
    of_paper(seeing_start(
        with_role({"brute", "all pairs of triangles", Guarantee::complete, kAnySurface, make_brute, "oracle"},
                  Role::oracle))),
    of_paper(seeing_start(
        {"aabb", "AABB hierarchy (van den Bergen 1999)", Guarantee::complete, kAnySurface, make_aabb})),
    of_paper({"mcd", "continuous normal cones and contour tests (Tang et al. 2009)", Guarantee::complete,
              kAnySurface, make_mcd}),
    of_paper({"selfccd", "representative triangles and orphan sets (Curtis et al. 2008, Tang et al. 2009)",
              Guarantee::complete, kAnySurface, make_selfccd}),
#ifdef CSCD_BASELINES_EMBREE
    in_library({"embree", kEmbreeTitle, Guarantee::complete, kAnySurface, make_embree}),
#endif
#ifdef CSCD_BASELINES_CGAL_BOXES
    in_library(
        {"cgal_boxes", "CGAL, box_self_intersection_d", Guarantee::complete, kAnySurface, make_cgal_boxes}),
#endif
    of_paper({"rvbc", "radial view based culling (Wong et al. 2013)", Guarantee::first_contact, kBones,
              [](const Setup& setup) { return make_rvbc(setup); }}),
    of_paper({"drvbc", "dynamic radial view based culling (Wong et al. 2014)", Guarantee::first_contact,
              kBones, [](const Setup& setup) { return make_drvbc(setup); }}),
    following({"drvbc_fast", "radial view based culling with overlapping covers", Guarantee::first_contact,
             kClosedMesh, [](const Setup& setup) { return make_drvbc_fast(setup); }}),
    following(by_signs(seeing_start(with_role({"drvbc_fast_complete", "drvbc_fast with a contour test of capped clusters",
                            Guarantee::complete, kAnySurface,
                            [](const Setup& setup) {
                              return make_drvbc_fast(setup,
                                                     {.name = "drvbc_fast_complete", .complete = true});
                            }},
                           Role::stand_in)))),
    following({"drvbc_fast_all", "drvbc_fast_complete from starts that are known to be embedded",
               Guarantee::all_from_embedded, kClosedMesh,
               [](const Setup& setup) {
                 return make_drvbc_fast(
                     setup, {.name = "drvbc_fast_all", .complete = true, .starts_embedded = true});
               }}),
#ifdef CSCD_BASELINES_FCL
    in_library({"fcl", "FCL 0.7, continuous traversal of a model with itself (Pan et al. 2012)",
                Guarantee::heuristic, kAnySurface, make_fcl, "checker", true}),
#endif
    // One thing at a time left out, or added.
    of_paper({"rvbc_relative", "rvbc with relative boxes", Guarantee::first_contact, kBones,
              [](const Setup& setup) {
                return make_rvbc(setup, {.name = "rvbc_relative", .relative_boxes = true});
              },
              kAblation}),
    of_paper({"drvbc_unrefined", "drvbc without refinement of its atomic clusters", Guarantee::first_contact,
              kBones,
              [](const Setup& setup) {
                return make_drvbc(setup, {.bones = {.refinement = false}, .name = "drvbc_unrefined"});
              },
              kAblation}),
    of_paper({"drvbc_bones", "drvbc with one atomic cluster for each bone", Guarantee::first_contact, kBones,
              [](const Setup& setup) {
                return make_drvbc(setup, {.division = radial::Division::none, .name = "drvbc_bones"});
              },
              kAblation}),
    of_paper({"drvbc_pieces", "drvbc with one atomic cluster for each connected piece of a bone's surface",
              Guarantee::first_contact, kBones,
              [](const Setup& setup) {
                return make_drvbc(setup, {.division = radial::Division::pieces, .name = "drvbc_pieces"});
              },
              kAblation}),
    of_paper({"drvbc_unmerged", "drvbc without mega clusters", Guarantee::first_contact, kBones,
              [](const Setup& setup) { return make_drvbc(setup, {.gamma = 0, .name = "drvbc_unmerged"}); },
              kAblation}),
    of_paper({"drvbc_unrelative", "drvbc without relative boxes", Guarantee::first_contact, kBones,
              [](const Setup& setup) {
                return make_drvbc(setup, {.relative_boxes = false, .name = "drvbc_unrelative"});
              },
              kAblation}),
    of_paper(
        {"drvbc_uncached", "drvbc without its cache of triangles that were not positive",
         Guarantee::first_contact, kBones,
         [](const Setup& setup) { return make_drvbc(setup, {.name = "drvbc_uncached", .cache = false}); },
         kAblation}),
    following({"drvbc_fast_one_cover", "drvbc_fast with the first of its covers alone",
             Guarantee::first_contact, kClosedMesh,
             [](const Setup& setup) {
               return make_drvbc_fast(setup, {.name = "drvbc_fast_one_cover", .covers = 1});
             },
             kAblation}),
    following({"drvbc_fast_two_covers", "drvbc_fast with at most two covers", Guarantee::first_contact,
             kClosedMesh,
             [](const Setup& setup) {
               return make_drvbc_fast(setup, {.name = "drvbc_fast_two_covers", .covers = 2});
             },
             kAblation}),
    following({"drvbc_fast_swept_bounds", "drvbc_fast with bounds of whole paths", Guarantee::first_contact,
             kClosedMesh,
             [](const Setup& setup) {
               return make_drvbc_fast(setup, {.name = "drvbc_fast_swept_bounds", .time_linear = false});
             },
             kAblation}),
    following({"drvbc_fast_no_stars", "drvbc_fast without stars of vertices", Guarantee::first_contact,
             kClosedMesh,
             [](const Setup& setup) {
               return make_drvbc_fast(setup, {.name = "drvbc_fast_no_stars", .stars = false});
             },
             kAblation}),
    following({"drvbc_fast_no_planes", "drvbc_fast without planes of triangles", Guarantee::first_contact,
             kClosedMesh,
             [](const Setup& setup) {
               return make_drvbc_fast(setup, {.name = "drvbc_fast_no_planes", .planes = false});
             },
             kAblation}),
    following({"drvbc_fast_whole_steps", "drvbc_fast without parts of long steps", Guarantee::first_contact,
             kClosedMesh,
             [](const Setup& setup) {
               return make_drvbc_fast(setup, {.name = "drvbc_fast_whole_steps", .long_descent = DrvbcFastOptions::kNever});
             },
             kAblation}),
    Strategy{"drvbc_fast_fixed_covers", "drvbc_fast with covers that stay as preparation cut them",
             Guarantee::first_contact, kClosedMesh,
             [](const Setup& setup) {
               return make_drvbc_fast(setup, {.name = "drvbc_fast_fixed_covers", .follows = false});
             },
             kAblation},
    by_signs(seeing_start({"drvbc_fast_fixed_covers_complete",
                  "drvbc_fast_complete with covers that stay as preparation cut them", Guarantee::complete,
                  kAnySurface,
                  [](const Setup& setup) {
                    return make_drvbc_fast(setup, {.name = "drvbc_fast_fixed_covers_complete",
                                                   .follows = false,
                                                   .complete = true});
                  },
                  kAblation})),
    following({"drvbc_fast_bones", "drvbc_fast, all covers of bones without a trial", Guarantee::first_contact,
             kClosedMesh,
             [](const Setup& setup) {
               return make_drvbc_fast(
                   setup, {.name = "drvbc_fast_bones", .clusters = DrvbcFastOptions::Clusters::of_bones});
             },
             kAblation}),
    following({"drvbc_fast_no_bones", "drvbc_fast, all covers of the surface without a trial",
             Guarantee::first_contact, kClosedMesh,
             [](const Setup& setup) {
               return make_drvbc_fast(setup, {.name = "drvbc_fast_no_bones",
                                              .clusters = DrvbcFastOptions::Clusters::of_surface});
             },
             kAblation}),
    of_paper({"drvbc_one_vertex", "drvbc with the paper's test of one vertex for segments",
              Guarantee::heuristic, kBones,
              [](const Setup& setup) {
                return make_drvbc(
                    setup, {.name = "drvbc_one_vertex", .segment_test = radial::SegmentTest::first_corner});
              },
              kAblation}),
};

const Strategy& playing(Role role) {
  return *std::find_if(kStrategies.begin(), kStrategies.end(),
                       [&](const Strategy& s) { return s.role == role; });
}

template <class Rows>
[[noreturn]] void refuse(const char* what, std::string_view name, const Rows& rows) {
  std::vector<std::string_view> names;
  for (const auto& row : rows) names.push_back(row.name);
  throw InputError(std::string(what) + " '" + std::string(name) + "' is not known" +
                   did_you_mean(name.substr(0, name.find('@')), names) + "; choose one of " + joined(names));
}

// Reads the parameters from NAME@TOLERANCE[:STEPS].
TestParameters parsed_parameters(std::string_view name, TestParameters parameters) {
  const auto fail = [&](const std::string& what) {
    throw InputError("elementary test '" + std::string(name) + "': " + what);
  };
  const std::string_view text = name.substr(name.find('@') + 1), tolerance = text.substr(0, text.find(':'));
  if (parameters.tolerance < 0) fail("takes no tolerance; leave out what begins with @");
  const auto read = [](std::string_view digits, auto& value) {
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc() && end == digits.data() + digits.size();
  };
  if (!read(tolerance, parameters.tolerance) || !(parameters.tolerance >= 0 && parameters.tolerance < 1))
    fail("the tolerance is not a number from 0 to less than 1; write it as in @1e-6");
  if (tolerance.size() == text.size()) return parameters;
  if (parameters.steps < 0) fail("takes no number of steps; leave out what begins with :");
  if (!read(text.substr(tolerance.size() + 1), parameters.steps) || parameters.steps < 1)
    fail("the number of steps is not a whole number from 1; write it as in @1e-6:1000");
  return parameters;
}

}  // namespace

std::span<const Strategy> strategies() {
  return kStrategies;
}

const Strategy& strategy_named(std::string_view name) {
  for (const Strategy& strategy : kStrategies)
    if (strategy.name == name) return strategy;
  refuse("strategy", name, kStrategies);
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

std::span<const ElementaryTest> all_elementary_tests() {
  static const std::vector<ElementaryTest> rows = [] {
    const auto own = elementary_tests();
    std::vector<ElementaryTest> all(own.begin(), own.end());
#ifdef CSCD_BASELINES_FCL
    all.push_back(fcl_elementary_test());
#endif
    return all;
  }();
  return rows;
}

const ElementaryTest& elementary_test_named(std::string_view name) {
  static std::map<std::string, ElementaryTest, std::less<>> chosen;
  if (const auto before = chosen.find(name); before != chosen.end()) return before->second;
  const std::string_view row_name = name.substr(0, name.find('@'));
  for (const ElementaryTest& row : all_elementary_tests()) {
    if (row.name != row_name) continue;
    if (row_name == name) return row;
    ElementaryTest with = row;
    with.parameters = parsed_parameters(name, row.parameters);
    const auto place = chosen.emplace(std::string(name), with).first;
    place->second.name = place->first;
    return place->second;
  }
  refuse("elementary test", name, all_elementary_tests());
}

std::vector<const ElementaryTest*> elementary_tests_named(std::string_view names) {
  std::vector<const ElementaryTest*> rows;
  for (;;) {
    const std::size_t comma = names.find(',');
    const std::string_view name = names.substr(0, comma);
    if (name == "all")
      for (const ElementaryTest& row : all_elementary_tests()) rows.push_back(&row);
    else
      rows.push_back(&elementary_test_named(name));
    if (comma == std::string_view::npos) return rows;
    names.remove_prefix(comma + 1);
  }
}

const Strategy& complete_reference() {
  return playing(Role::reference);
}

const Strategy& all_pairs() {
  return playing(Role::oracle);
}

const Strategy& complete_stand_in() {
  return playing(Role::stand_in);
}

}  // namespace cscd::bench
