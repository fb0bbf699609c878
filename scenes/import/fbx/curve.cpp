#include "scenes/import/fbx/curve.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/base/error.h"

namespace cscd::scenes::fbx {
namespace {

// Bits of KeyAttrFlags.
constexpr std::int64_t kConstant = 0x2, kCubic = 0x8;
constexpr std::int64_t kConstantNext = 0x100;  // with kConstant: the next key's value holds
constexpr std::int64_t kAuto = 0x100, kTcb = 0x200, kUser = 0x400;
constexpr std::int64_t kClamp = 0x1000, kTimeIndependent = 0x2000, kClampProgressive = 0x4000;
constexpr std::int64_t kWeightedRight = 0x1000000, kWeightedNextLeft = 0x2000000;

constexpr double kThird = 1.0 / 3;
// Weights are written in ten-thousandths.
constexpr double kWeightUnit = 1e-4;
// A weighted segment becomes this many cubics over equal shares of its parameter. The cubics differ from
// the segment by the fourth power of a share.
constexpr int kPieces = 48;

// Clamped keys are flat where a neighbour's value differs by at most this.
constexpr double kFlatStep = 1e-4;
// A stored number counts as a computed slope if it differs by at most this share of the slope.
constexpr double kStoredSlope = 1e-3;

// The attributes that KeyAttrFlags and KeyAttrDataFloat give for a key and for the way to the next key.
struct Attributes {
  std::int64_t flags = 0;
  double data[2] = {0, 0};   // slope after the key and before the next; of TCB keys tension and continuity
  float packed_weights = 0;  // two weights in one; of TCB keys the bias
};

// A key with everything that the segments on both sides of it depend on.
struct RawKey {
  std::int64_t ticks = 0;
  double value = 0;
  Attributes attributes;
  double arriving = 0, leaving = 0;                           // slopes a second
  double weight_before_next = kThird, weight_after = kThird;  // shares of the way to the next key
  double seconds = 0;
  bool is(std::int64_t bit) const { return (attributes.flags & bit) != 0; }
};

// Converts a number of KeyAttrDataFloat to a float. Text files of version 7200 and later write the bits of
// these floats as integers, because some of them are packed integers. An integer below 2^23 would be the
// bits of a float next to zero, so it is taken for a number that was written by hand.
float float_of(const WrittenNumber& n, bool packed) {
  constexpr std::int64_t kSmallestNormal = 1 << 23;
  if (n.is_integer && (packed || std::abs(n.real) >= kSmallestNormal))
    return std::bit_cast<float>(static_cast<std::uint32_t>(n.integer));
  return static_cast<float>(n.real);
}

class CurveReader {
 public:
  CurveReader(const Object& curve, double ticks_per_second, std::size_t most)
      : element_(*curve.element),
        ticks_per_second_(ticks_per_second),
        most_(most),
        where_("animation curve " + std::to_string(curve.id)) {}

  ReadCurve read() {
    ReadCurve result;
    std::vector<RawKey> keys = read_keys(result.dropped);
    find_slopes(keys);
    result.curve.keys = join(keys);
    if (keys.empty()) return result;
    Extrapolation& beyond = result.curve.beyond;
    beyond.first = keys.front().seconds;
    beyond.last = keys.back().seconds;
    beyond.tick = 1 / ticks_per_second_;
    read_end("Pre-Extrapolation", beyond.before, beyond.repeats_before, result.unknown_ends);
    read_end("Post-Extrapolation", beyond.after, beyond.repeats_after, result.unknown_ends);
    return result;
  }

 private:
  std::vector<RawKey> read_keys(std::size_t& dropped) const {
    const Element *times = element_.child("KeyTime"), *values = element_.child("KeyValueFloat");
    if (times == nullptr || values == nullptr) return {};
    const std::vector<std::int64_t> ticks = integers(*times, most_, where_);
    const std::vector<double> numbers = reals(*values, most_, where_);
    if (ticks.size() != numbers.size())
      throw InputError(where_ + ": has " + std::to_string(ticks.size()) + " times and " +
                       std::to_string(numbers.size()) + " values; export it again");
    const std::vector<Attributes> attributes = read_attributes(ticks.size());
    std::vector<RawKey> keys;
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      if (!std::isfinite(numbers[i])) refuse_number(i, "value");
      if (!keys.empty() && ticks[i] <= keys.back().ticks) {
        if (ticks[i] < keys.back().ticks || numbers[i] != keys.back().value) refuse_time(i);
        ++dropped;
        continue;
      }
      RawKey& key = keys.emplace_back();
      key.ticks = ticks[i];
      key.seconds = static_cast<double>(ticks[i]) / ticks_per_second_;
      key.value = numbers[i];
      key.attributes = attributes[i];
    }
    return keys;
  }

  [[noreturn]] void refuse_time(std::size_t key) const {
    throw InputError(
        where_ + ": key " + std::to_string(key) +
        " (counted from 0) is not later than the key before, and has another value; sort the keys, "
        "and export it again");
  }

  [[noreturn]] void refuse_number(std::size_t key, const char* what) const {
    throw InputError(where_ + ": the " + what + " of key " + std::to_string(key) +
                     " (counted from 0) is not a number; repair the curve and export it again");
  }

  // Reads the attributes of all keys. Runs of keys share their attributes. Keys without attributes are
  // joined by straight lines.
  std::vector<Attributes> read_attributes(std::size_t keys) const {
    std::vector<Attributes> attributes(keys);
    const Element *flags = element_.child("KeyAttrFlags"), *data = element_.child("KeyAttrDataFloat"),
                  *runs = element_.child("KeyAttrRefCount");
    if (flags == nullptr || runs == nullptr) return attributes;
    const std::vector<std::int64_t> flag = integers(*flags, most_, where_),
                                    run = integers(*runs, most_, where_);
    std::vector<WrittenNumber> datum;
    if (data != nullptr) datum = written_numbers(*data, 4 * most_, where_);
    bool fits = flag.size() == run.size() && (data == nullptr || datum.size() == 4 * run.size());
    std::size_t key = 0;
    for (std::size_t r = 0; fits && r < run.size(); ++r) {
      fits = run[r] >= 0 && static_cast<std::uint64_t>(run[r]) <= keys - key;
      for (std::int64_t i = 0; fits && i < run[r]; ++i, ++key) {
        attributes[key].flags = flag[r];
        if (data == nullptr) continue;
        for (std::size_t k = 0; k < 2; ++k)
          attributes[key].data[k] = static_cast<double>(float_of(datum[4 * r + k], false));
        attributes[key].packed_weights = float_of(datum[4 * r + 2], (flag[r] & kTcb) == 0);
        const bool numbers = std::isfinite(attributes[key].data[0]) &&
                             std::isfinite(attributes[key].data[1]) &&
                             ((flag[r] & kTcb) == 0 || std::isfinite(attributes[key].packed_weights));
        if ((flag[r] & kCubic) != 0 && !numbers) refuse_number(key, "tangent");
      }
    }
    if (!fits || key != keys)
      throw InputError(where_ + ": its attributes do not fit its " + std::to_string(keys) +
                       " keys; export it again");
    return attributes;
  }

  static void find_slopes(std::vector<RawKey>& keys) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      RawKey& key = keys[i];
      if (!key.is(kCubic) || key.is(kTcb)) continue;
      key.leaving = key.attributes.data[0];
      if (i + 1 < keys.size()) keys[i + 1].arriving = key.attributes.data[1];
      const auto packed = std::bit_cast<std::uint32_t>(key.attributes.packed_weights);
      if (key.is(kWeightedRight)) key.weight_after = kWeightUnit * (packed & 0xffff);
      if (key.is(kWeightedNextLeft)) key.weight_before_next = kWeightUnit * (packed >> 16);
    }
    for (std::size_t i = 0; i < keys.size(); ++i) {
      RawKey& key = keys[i];
      if (!key.is(kCubic)) continue;
      if (key.is(kTcb)) {
        turn_by_tcb(keys, i);
      } else if (key.is(kAuto) && !key.is(kUser)) {
        // An automatic key stores a bias towards a neighbour in the place of its slopes.
        key.leaving = automatic_slope(keys, i, key.leaving);
        key.arriving = automatic_slope(keys, i, -key.arriving);
      }
    }
  }

  static double rise(const RawKey& a, const RawKey& b) {
    return (b.value - a.value) / (b.seconds - a.seconds);
  }

  // Sets the slopes of a TCB key from its tension, continuity and bias (Kochanek and Bartels, SIGGRAPH 1984).
  static void turn_by_tcb(std::vector<RawKey>& keys, std::size_t i) {
    RawKey& key = keys[i];
    const double tension = key.attributes.data[0], continuity = key.attributes.data[1],
                 bias = static_cast<double>(key.attributes.packed_weights);
    const bool first = i == 0, last = i + 1 == keys.size();
    const double before = first ? 0 : rise(keys[i - 1], key), after = last ? 0 : rise(key, keys[i + 1]);
    const double share = (first || last ? 1 : 0.5) * (1 - tension);
    key.arriving = share * ((1 + bias) * (1 - continuity) * before + (1 - bias) * (1 + continuity) * after);
    key.leaving = share * ((1 + bias) * (1 + continuity) * before + (1 - bias) * (1 - continuity) * after);
  }

  // Computes the slope of an automatic key from its neighbours, in the way that the authors of ufbx found
  // the FBX SDK to use. The bias is in per cent; a positive bias pulls towards the next key.
  static double automatic_slope(const std::vector<RawKey>& keys, std::size_t i, double bias) {
    const RawKey& key = keys[i];
    if (keys.size() == 1) return 0;
    const bool first = i == 0, last = i + 1 == keys.size();
    const double left = first ? 0 : std::abs(key.value - keys[i - 1].value),
                 right = last ? 0 : std::abs(keys[i + 1].value - key.value);
    if (key.is(kClamp) && (first ? right : last ? left : std::min(left, right)) <= kFlatStep) return 0;
    // A bias above 500 also adds to the slope.
    const double above = std::max(0.0, std::abs(bias) / 100 - 5), extra = 40 * above * above;
    const bool biased = !key.is(kTimeIndependent);
    if (first || last) {
      if (key.is(kClampProgressive)) return 0;
      const double slope = first ? rise(key, keys[i + 1]) : rise(keys[i - 1], key);
      return biased ? slope + std::copysign(extra, bias) : slope;
    }
    const RawKey &previous = keys[i - 1], &next = keys[i + 1];
    const double before = rise(previous, key), after = rise(key, next);
    double slope = rise(previous, next);
    if (biased) {
      const double share = (key.seconds - previous.seconds) / (next.seconds - previous.seconds);
      slope = 0.5 * slope + 0.5 * ((1 - share) * before + share * after);
      // If the number in the place of the bias equals the slope itself, the file means that slope.
      if (std::abs(std::abs(bias) - std::abs(slope)) > kStoredSlope * std::abs(slope)) {
        const double strength = std::abs(bias) / 100, target = bias > 0 ? after : before;
        const double way = std::abs(target - slope) > 1e-5 ? target - slope : bias;
        slope = (1 - strength) * slope + strength * target + std::copysign(extra, way);
      }
    }
    if (key.is(kClampProgressive)) {
      // Limit the slope so that the ends of the tangents stay within the neighbours' values.
      const double sign = slope >= 0 ? 1 : -1;
      const double most_left = std::max(0.0, sign * before / previous.weight_before_next),
                   most_right = std::max(0.0, sign * after / key.weight_after);
      slope = sign * std::min({sign * slope, most_left, most_right});
    }
    return slope;
  }

  // Converts the file's keys to those of a Curve.
  std::vector<Key<double>> join(const std::vector<RawKey>& raw) const {
    std::vector<Key<double>> curve;
    for (std::size_t i = 0; i < raw.size(); ++i) {
      const RawKey& key = raw[i];
      const bool steps_here = i > 0 && raw[i - 1].is(kConstant);
      // The SDK counts time in whole ticks. Placing a step half a tick early makes it act at its own key,
      // however the time of a frame was rounded.
      const double time =
          steps_here ? (static_cast<double>(key.ticks) - 0.5) / ticks_per_second_ : key.seconds;
      curve.push_back({time, key.value, Between::line, key.arriving, key.leaving});
      if (i + 1 == raw.size()) break;
      if (key.is(kConstant)) {
        curve.back().next = Between::constant;
        if (key.is(kConstantNext))
          curve.push_back({std::max((static_cast<double>(key.ticks) + 0.5) / ticks_per_second_,
                                    std::nextafter(time, std::numeric_limits<double>::infinity())),
                           raw[i + 1].value, Between::constant, 0, 0});
      } else if (key.is(kCubic)) {
        curve.back().next = Between::cubic;
        const bool weighted = key.weight_after != kThird || key.weight_before_next != kThird;
        if (weighted) add_weighted(key, raw[i + 1], curve);
      }
    }
    // Times that are very long leave no room for half a tick.
    const auto out_of_order = [](const Key<double>& a, const Key<double>& b) { return !(a.time < b.time); };
    if (std::adjacent_find(curve.begin(), curve.end(), out_of_order) != curve.end())
      throw InputError(where_ + ": its keys are too close together; resample it");
    return curve;
  }

  // Adds the keys of a weighted segment. The segment is a Bezier curve in the plane of time and value, and
  // becomes cubics over its parts.
  void add_weighted(const RawKey& a, const RawKey& b, std::vector<Key<double>>& curve) const {
    const double length = b.seconds - a.seconds, w = a.weight_after, v = a.weight_before_next;
    if (!(w >= 0 && w <= 1 && v >= 0 && v <= 1))
      throw InputError(where_ + ": a tangent's weight is not between 0 and 1; resample the animation");
    const auto bezier = [](const double(&p)[4], double s) {
      const double r = 1 - s;
      return r * r * r * p[0] + 3 * r * r * s * p[1] + 3 * r * s * s * p[2] + s * s * s * p[3];
    };
    const auto slope = [](const double(&p)[4], double s) {
      const double r = 1 - s;
      return 3 * (r * r * (p[1] - p[0]) + 2 * r * s * (p[2] - p[1]) + s * s * (p[3] - p[2]));
    };
    const double x[4] = {0, w * length, (1 - v) * length, length};
    const double y[4] = {a.value, a.value + a.leaving * w * length, b.value - b.arriving * v * length,
                         b.value};
    // A key whose weight is zero leaves towards the end of the next key's tangent.
    curve.back().leaving = w > 0 ? a.leaving : slope(y, 1e-6) / slope(x, 1e-6);
    for (int i = 1; i < kPieces; ++i) {
      const double s = static_cast<double>(i) / kPieces, rise = slope(y, s) / slope(x, s);
      if (!std::isfinite(rise) || !(a.seconds + bezier(x, s) > curve.back().time)) continue;
      curve.push_back({a.seconds + bezier(x, s), bezier(y, s), Between::cubic, rise, rise});
    }
    if (!(curve.back().time < b.seconds)) curve.pop_back();
  }

  // Reads how the curve goes on at one of its ends. Text files write the letter of the kind as a word, binary
  // files as a number. A negative number of repetitions stands for no limit.
  void read_end(std::string_view name, Beyond& kind, double& repeats, bool& unknown) const {
    const Element* end = element_.child(name);
    const Element* type = end == nullptr ? nullptr : end->child("Type");
    if (type == nullptr || type->values.empty()) return;
    const std::string_view word = type->text(0);
    const std::int64_t letter =
        type->values[0].kind == Value::Kind::text ? (word.empty() ? 0 : word[0]) : type->integer(0);
    switch (letter) {
      case 'C':
        return;
      case 'K':
        kind = Beyond::straight;
        return;
      case 'R':
        kind = Beyond::repeat;
        break;
      case 'A':
        kind = Beyond::rise;
        break;
      case 'M':
        kind = Beyond::mirror;
        break;
      default:
        unknown = true;
        return;
    }
    const Element* count = end->child("Repetition");
    const std::int64_t most = count == nullptr ? -1 : count->integer(0, -1);
    if (most >= 0) repeats = static_cast<double>(most);
  }

  const Element& element_;
  double ticks_per_second_;
  std::size_t most_;
  std::string where_;
};

}  // namespace

ReadCurve read_curve(const Object& curve, double ticks_per_second, std::size_t most) {
  return CurveReader(curve, ticks_per_second, most).read();
}

Curve scaled(Curve curve, double factor, double offset) {
  for (Key<double>& key : curve.keys) {
    key.value = factor * key.value + offset;
    key.arriving *= factor;
    key.leaving *= factor;
  }
  return curve;
}

bool is_level(const Curve& curve) {
  const std::vector<Key<double>>& keys = curve.keys;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i].value != keys.front().value) return false;
    if (keys[i].next != Between::cubic || i + 1 == keys.size()) continue;
    if (keys[i].leaving != 0 || keys[i + 1].arriving != 0) return false;
  }
  return true;
}

}  // namespace cscd::scenes::fbx
