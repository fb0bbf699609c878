#include "bench/inputs/thickness.h"

#include <cmath>
#include <memory>
#include <vector>

#include "bench/inputs/input.h"
#include "bench/strategies/catalogue.h"
#include "core/base/error.h"
#include "core/base/number_text.h"
#include "core/mesh/mean_edge.h"
#include "scenes/base/joined.h"

namespace cscd::bench {
namespace {

double length_in(const Input& input, const WrittenLength& written, const char* option) {
  require_unit(input, written, option);
  const double length = written.length(length_scale(input));
  if (!std::isfinite(length))
    throw InputError(std::string(option) + " " + written.text +
                     ": is more than a number holds in the units of " + input.name + "; give less");
  return length;
}

// The diagonal of the box that holds a pose.
double diagonal(std::span<const Vec3> pose) {
  Vec3 low = pose.front(), high = low;
  for (const Vec3& x : pose) low = low.cwiseMin(x), high = high.cwiseMax(x);
  return (high - low).norm();
}

template <class Rows, class Has>
std::string names_of_rows(const Rows& rows, const Has& has) {
  std::vector<std::string_view> names;
  for (const auto& row : rows)
    if (has(row)) names.push_back(row.name);
  return joined(names);
}

}  // namespace

void set_thickness(Input& input, const ThicknessRequest& request, bool with_ignored) {
  InputThickness& out = input.thickness;
  out.asked = request;
  out.edge = mean_edge(input.mesh, input.rest());
  out.length = length_in(input, request.thickness, "--thickness");
  // Far above the size of the surface, squares overflow, and every answer is known.
  if (out.length > diagonal(input.rest()))
    throw InputError("--thickness " + request.thickness.text + ": is more than all of " + input.name +
                     " at rest, so that every pair of features is close; give less than " +
                     std::to_string(diagonal(input.rest())));
  if (!request.leaves_out()) return;
  Exclusions left_out;
  if (with_ignored && input.ignored) left_out = input.ignored->triangles;
  left_out.exclude_rings(input.mesh, request.rings.value_or(0));
  left_out.exclude_near(input.rest(), length_in(input, request.near_rest, "--exclude-near-rest"));
  out.left_out = std::make_shared<const Exclusions>(std::move(left_out));
}

LengthScale length_scale(const Input& input) {
  return {input.thickness.edge, input.import ? input.import->centimetres_per_unit : 0};
}

void require_unit(const Input& input, const WrittenLength& written, const char* option) {
  if (!(written.centimetres > 0) || length_scale(input).centimetres_per_unit > 0) return;
  throw InputError(std::string(option) + " " + written.text + ": " + input.name +
                   " does not tell how long its unit is; write 0.01 for a length in that unit, or 0.2e for "
                   "mean edges of its pose at rest");
}

std::string distance_text(const Input& input, double length) {
  const double centimetres = length_scale(input).centimetres_per_unit * length;
  if (!(length_scale(input).centimetres_per_unit > 0)) return short_text(length);
  if (centimetres >= 100) return figure_text(centimetres / 100) + " m";
  return centimetres >= 1 ? figure_text(centimetres) + " cm" : figure_text(10 * centimetres) + " mm";
}

std::string why_not_within(const ThicknessRequest& request, const Strategy& strategy) {
  if (request.thickness.number > 0 && !strategy.knows_distance) return "it has no proof for distances";
  const bool can_leave_out = !strategy.own_test && (strategy.guarantee == Guarantee::complete ||
                                                    strategy.guarantee == Guarantee::all_from_embedded);
  return request.leaves_out() && !can_leave_out ? "it cannot leave pairs out" : "";
}

void require_fit(const ThicknessRequest& request, const Strategy& strategy) {
  const std::string why = why_not_within(request, strategy);
  if (why.empty()) return;
  const bool by_distance = request.thickness.number > 0 && !strategy.knows_distance;
  throw InputError(
      (by_distance ? "--thickness " + request.thickness.text
                   : std::string(request.rings.value_or(0) > 0 ? "--exclude-rings" : "--exclude-near-rest")) +
      ": strategy " + std::string(strategy.name) + " cannot answer that, as " + why + "; choose one of " +
      names_of_rows(strategies(), [&](const Strategy& row) { return why_not_within(request, row).empty(); }));
}

void require_fit(const ThicknessRequest& request, const ElementaryTest& elementary) {
  if (!(request.thickness.number > 0) || elementary.knows_distance()) return;
  throw InputError(
      "--thickness " + request.thickness.text + ": elementary test '" + std::string(elementary.name) +
      "' knows no distances; choose one with --elementary: " +
      names_of_rows(all_elementary_tests(), [](const auto& row) { return row.knows_distance(); }));
}

ContactSet close_at_rest(const Input& input, const Exclusions* left_out) {
  StrategyInput setup = input.setup(elementary_test_named("filtered_exact"));
  setup.exclusions = left_out;
  setup.rig = nullptr;
  const Prepared reference = complete_reference().make(setup);
  ContactSet found;
  reference.detector->detect(
      {.motion = Motion(input.rest(), input.rest()), .thickness = input.thickness.thickness()}, found);
  found.sort();
  return found;
}

}  // namespace cscd::bench
