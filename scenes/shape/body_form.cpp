#include "scenes/shape/body_form.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "scenes/shape/key_curve.h"

namespace cscd::scenes {
namespace {

constexpr int kTable = 512;  // cells of the table of sections

// base^exponent for an even exponent. The results of std::pow differ between libraries, and frames must not.
double even_power(double base, int exponent) {
  double result = 1;
  for (int i = 0; i < exponent; i += 2) result *= base * base;
  return result;
}

}  // namespace

BodyForm::BodyForm(const Spec& spec, const std::string& who) : spec_(spec) {
  const Parameters::Table& rows = spec.sections;
  bool usable = rows.size() >= 2;
  for (std::size_t i = 0; i < rows.size(); ++i)
    usable = usable && rows[i][1] > 0 && rows[i][2] > 0 && (i == 0 || rows[i][0] > rows[i - 1][0]);
  if (!usable)
    throw InputError(who +
                     ": the body needs at least two sections, in order along its axis, of positive size");
  for (const int power : {spec.section_power, spec.end_power})
    if (power < 2 || power > 64 || power % 2 != 0)
      throw InputError(who + ": the body's powers must be even, from 2 to 64");

  const KeyCurve curve(rows, who);
  low_ = rows.front()[0];
  high_ = rows.back()[0];
  Section largest{0, 0, 0, 0};
  for (int i = 0; i <= kTable; ++i) {
    const double along = low_ + (high_ - low_) * i / kTable;
    table_.push_back({curve.at(along, 1), curve.at(along, 2), curve.at(along, 3), curve.at(along, 4)});
    largest.half_u = std::max(largest.half_u, table_.back().half_u);
    largest.half_v = std::max(largest.half_v, table_.back().half_v);
  }
  const double middle = (low_ + high_) / 2;
  const Section section = at(middle);
  const int u = spec.axis == 0 ? 1 : 0, v = spec.axis == 2 ? 1 : 2;
  centre_[spec.axis] = middle;
  centre_[u] = section.shift_u;
  centre_[v] = section.shift_v;
  extent_[spec.axis] = (high_ - low_) / 2;
  extent_[u] = largest.half_u;
  extent_[v] = largest.half_v;
}

BodyForm::Section BodyForm::at(double along) const {
  const double place = std::clamp((along - low_) / (high_ - low_), 0.0, 1.0) * kTable;
  const int cell = std::min(static_cast<int>(place), kTable - 1);
  const double t = place - cell;
  const Section &a = table_[static_cast<std::size_t>(cell)], &b = table_[static_cast<std::size_t>(cell) + 1];
  return {a.half_u + t * (b.half_u - a.half_u), a.half_v + t * (b.half_v - a.half_v),
          a.shift_u + t * (b.shift_u - a.shift_u), a.shift_v + t * (b.shift_v - a.shift_v)};
}

bool BodyForm::inside(const Vec3& point) const {
  const int u = spec_.axis == 0 ? 1 : 0, v = spec_.axis == 2 ? 1 : 2;
  const double along = point[spec_.axis];
  const double end = (2 * along - low_ - high_) / (high_ - low_);
  if (end < -1 || end > 1) return false;
  const Section section = at(along);
  return even_power((point[u] - section.shift_u) / section.half_u, spec_.section_power) +
             even_power((point[v] - section.shift_v) / section.half_v, spec_.section_power) +
             even_power(end, spec_.end_power) <
         1;
}

Vec3 BodyForm::projected(const Vec3& point) const {
  const Vec3 ray = point - centre_;
  const auto within = [&](double t) { return inside(centre_ + t * ray); };
  double near = 1, far = 1;
  if (within(1))
    for (int i = 0; i < 200 && within(far); ++i) near = far, far *= 1.1;
  else
    for (int i = 0; i < 200 && !within(near); ++i) far = near, near /= 1.1;
  for (int i = 0; i < 24; ++i) {
    const double t = (near + far) / 2;
    (within(t) ? near : far) = t;
  }
  return centre_ + near * ray;
}

Vec3 BodyForm::towards(const Vec3& direction) const {
  return centre_ + direction.cwiseProduct(extent_);
}

}  // namespace cscd::scenes
