#include "scenes/shape/key_curve.h"

#include <cmath>

#include "core/base/error.h"

namespace cscd::scenes {

KeyCurve::KeyCurve(Parameters::Table keys, const std::string& who) : keys_(std::move(keys)) {
  if (keys_.empty()) throw InputError(who + ": has no keys; give at least one");
  for (std::size_t i = 1; i < keys_.size(); ++i)
    if (!(keys_[i][0] > keys_[i - 1][0])) throw InputError(who + ": the frames of its keys must increase");
}

KeyCurve KeyCurve::periodic(const Parameters::Table& keys, double period, const std::string& who) {
  KeyCurve curve(keys, who);
  const std::size_t count = keys.size();
  if (!(keys.back()[0] - keys.front()[0] < period))
    throw InputError(who + ": its keys must lie within less than the period");
  // Add the neighbouring keys of the periods before and after. They give the slopes at both ends.
  const auto moved = [&](std::size_t key, double periods) {
    std::vector<double> row = keys[key];
    row[0] += periods * period;
    return row;
  };
  curve.keys_.insert(curve.keys_.begin(), moved(count - 1, -1));
  curve.keys_.push_back(moved(0, 1));
  curve.keys_.push_back(count > 1 ? moved(1, 1) : moved(0, 2));
  curve.origin_ = keys.front()[0];
  curve.period_ = period;
  return curve;
}

double KeyCurve::at(double frame, std::size_t column) const {
  if (period_ > 0) frame -= period_ * std::floor((frame - origin_) / period_);
  if (frame <= first_frame()) return keys_.front()[column];
  if (frame >= last_frame()) return keys_.back()[column];
  std::size_t next = 1;
  while (keys_[next][0] < frame) ++next;
  const double from = keys_[next - 1][column], to = keys_[next][column];
  const double span = keys_[next][0] - keys_[next - 1][0];
  const double t = (frame - keys_[next - 1][0]) / span, u = 1 - t;
  const double a = slope(next - 1, column) * span, b = slope(next, column) * span;
  return u * u * (1 + 2 * t) * from + t * u * u * a + t * t * (1 + 2 * u) * to - t * t * u * b;
}

double KeyCurve::slope(std::size_t key, std::size_t column) const {
  if (key == 0 || key + 1 == keys_.size()) return 0;
  const double before_span = keys_[key][0] - keys_[key - 1][0],
               after_span = keys_[key + 1][0] - keys_[key][0];
  const double before = (keys_[key][column] - keys_[key - 1][column]) / before_span;
  const double after = (keys_[key + 1][column] - keys_[key][column]) / after_span;
  if (before * after <= 0) return 0;
  const double share = (before_span + 2 * after_span) / (3 * (before_span + after_span));
  return before * after / (share * after + (1 - share) * before);
}

}  // namespace cscd::scenes
