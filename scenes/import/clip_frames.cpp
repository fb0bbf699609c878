#include "scenes/import/clip_frames.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/number_text.h"
#include "core/base/sort_unique.h"

namespace cscd::scenes {
namespace {

// A clip ends with a whole frame if its length differs from a whole number of frames by less than this.
// Times in files are single precision, so their lengths are seldom exact.
constexpr double kNearFrame = 1e-3;
// How far rounding to single precision moves a time, as a share of it, where a few of them are added.
constexpr double kSingle = 0x1p-21;
// At most this many frames of a clip, and spans between its keys, are looked at to see whether the clip moves
// the surface.
constexpr std::size_t kMostLooks = 4096;
// So many times between two frames, and between two keys, a clip is looked at, too, at the fractional parts
// of multiples of this share of the span. A motion that comes back to one pose in every frame, as a wheel of
// one turn a frame does, comes back at none of them, because no small multiple of it is whole:
// (3 - sqrt(5)) / 2.
constexpr std::size_t kLooksBetween = 8, kLooksBetweenKeys = 4;
constexpr double kShareBetween = 0.381966011250105;
// Movement below this share of the diagonal counts as rounding.
constexpr double kMoves = 1e-9;

Moment moment_at(const Character& character, const Animation& animation, double seconds) {
  const double time = animation.start + seconds;
  return {pose_at(character, animation, time), weights_at(character, animation, time)};
}

double share_between(std::size_t k) {
  const double share = static_cast<double>(k) * kShareBetween;
  return share - std::floor(share);
}

template <class Value>
bool same(const Value& a, const Value& b) {
  return a == b;
}
bool same(const Quaternion& a, const Quaternion& b) {
  return a.w == b.w && a.x == b.x && a.y == b.y && a.z == b.z;
}

// A span of the file's time line in which some value may change.
using KeySpan = std::pair<double, double>;

template <class Value>
void add_changes(const std::vector<Key<Value>>& keys, std::vector<KeySpan>& out) {
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const Key<Value>&a = keys[i - 1], &b = keys[i];
    const bool bends =
        a.next == Between::cubic && !(same(a.leaving, kFlat<Value>) && same(b.arriving, kFlat<Value>));
    if (bends || !same(a.value, b.value)) out.emplace_back(a.time, b.time);
  }
}

// A curve that repeats its keys changes in each of its repetitions that the clip shows, of which
// no more are taken than are looked at.
void add_changes(const Curve& curve, const KeySpan& clip, std::vector<KeySpan>& out) {
  std::vector<KeySpan> once;
  add_changes(curve.keys, once);
  const auto repeats = [](Beyond kind) { return kind != Beyond::hold && kind != Beyond::straight; };
  const Extrapolation& beyond = curve.beyond;
  const double length = beyond.last - beyond.first;
  double first = 0, last = 0;
  if (length > 0 && repeats(beyond.before)) first = std::floor((clip.first - beyond.first) / length);
  if (length > 0 && repeats(beyond.after)) last = std::ceil((clip.second - beyond.last) / length);
  const double most = std::ceil(static_cast<double>(kMostLooks) / static_cast<double>(once.size() + 1));
  first = std::clamp(first, -most, 0.0);
  last = std::clamp(last, 0.0, most);
  for (double k = first; k <= last; ++k) {
    const bool backwards = std::fmod(k, 2) != 0 && (k < 0 ? beyond.before : beyond.after) == Beyond::mirror;
    for (const auto& [from, to] : once)
      if (backwards)
        out.emplace_back(beyond.first + beyond.last - to + k * length,
                         beyond.first + beyond.last - from + k * length);
      else
        out.emplace_back(from + k * length, to + k * length);
  }
}

// The seconds after a clip's start at which a motion shows that its keys make, however short it is: those of
// keys beside which a value changes, and some between them. Sorted. Of very many spans between keys, some
// are taken.
std::vector<double> seconds_of_changes(const Animation& animation) {
  const KeySpan clip{animation.start, animation.start + animation.seconds};
  std::vector<KeySpan> spans;
  const auto add = [&](const Curve& curve) { add_changes(curve, clip, spans); };
  for (const Channel& channel : animation.channels) {
    add_changes(channel.moves, spans);
    add_changes(channel.rotations, spans);
    add_changes(channel.scales, spans);
    for (const Layered<3>* numbers :
         {&channel.move_components, &channel.scale_components, &channel.angles.degrees})
      for_each_curve(*numbers, add);
  }
  for (const MorphChannel& morph : animation.morphs)
    for (const Layered<1>& weight : morph.weights) for_each_curve(weight, add);
  for (const Curve& weight : animation.layer_weights) add(weight);
  sort_unique(spans);
  std::vector<double> seconds;
  const std::size_t taken = std::min(spans.size(), kMostLooks);
  for (std::size_t i = 0; i < taken; ++i) {
    const auto& [first, last] = spans[i * spans.size() / taken];
    const double from = std::max(first, clip.first), to = std::min(last, clip.second);
    if (!(from < to)) continue;
    seconds.push_back(from - clip.first);
    seconds.push_back(to - clip.first);
    for (std::size_t k = 1; k <= kLooksBetweenKeys; ++k)
      seconds.push_back(from - clip.first + share_between(k) * (to - from));
  }
  sort_unique(seconds);
  return seconds;
}

std::string listed_clips(const Character& character) {
  std::string known;
  for (std::size_t i = 0; i < character.animations.size(); ++i)
    known += (i ? ", " : "") + std::to_string(i) + " '" + character.animations[i].name + "'";
  return known;
}

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// What a clip does to the vertices in use.
enum class Movement { none, between_frames, at_frames };

// Looks at the frames of a clip, and where these show one pose, at its keys and between frames.
Movement movement_of(const Character& character, const Animation& animation, const std::vector<bool>& used,
                     double diagonal, double fps) {
  if (animation.channels.empty() && animation.morphs.empty()) return Movement::none;
  const std::size_t frames = std::min(frames_of(animation.seconds, fps), kMostLooks);
  std::vector<Vec3> first, now;
  const auto skin_at = [&](double seconds, std::vector<Vec3>& out) {
    const Moment moment = moment_at(character, animation, seconds);
    skin(character, moment.pose, moment.weights, out);
  };
  const auto moves_at = [&](double seconds) {
    skin_at(seconds, now);
    for (std::size_t v = 0; v < first.size(); ++v)
      if (used[v] && (now[v] - first[v]).cwiseAbs().maxCoeff() > kMoves * diagonal) return true;
    return false;
  };
  // Of a clip of very many frames, some are looked at.
  const std::size_t all = frames_of(animation.seconds, fps);
  const auto second_of = [&](std::size_t frame) {
    return second_of_frame(frame * (all - 1) / std::max<std::size_t>(1, frames - 1), animation.seconds, fps);
  };
  skin_at(0, first);
  for (std::size_t i = 1; i < frames; ++i)
    if (moves_at(second_of(i))) return Movement::at_frames;
  if (frames < 2) return Movement::none;
  if (std::ranges::any_of(seconds_of_changes(animation), moves_at)) return Movement::between_frames;
  for (std::size_t k = 1, looks = 0; k <= kLooksBetween; ++k)
    for (std::size_t i = 0; i + 1 < frames && looks < kMostLooks; ++i, ++looks)
      if (moves_at(std::lerp(second_of(i), second_of(i + 1), share_between(k))))
        return Movement::between_frames;
  return Movement::none;
}

std::size_t clip_named(const Character& character, const std::string& wanted) {
  const auto& all = character.animations;
  const auto one_of = [&](const auto& same) -> std::optional<std::size_t> {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (same(all[i].name)) found.push_back(i);
    if (found.size() > 1)
      throw InputError("--clip " + wanted + ": " + std::to_string(found.size()) +
                       " clips have this name; choose by number: " + listed_clips(character));
    return found.empty() ? std::nullopt : std::optional(found.front());
  };
  if (const auto exact = one_of([&](const std::string& name) { return name == wanted; })) return *exact;
  std::size_t number = 0;
  const char* end = wanted.data() + wanted.size();
  const auto [stop, error] = std::from_chars(wanted.data(), end, number);
  if (error == std::errc{} && stop == end && number < all.size()) return number;
  if (const auto alike = one_of([&](const std::string& name) { return lower(name) == lower(wanted); }))
    return *alike;
  throw InputError("--clip " + wanted + ": there is no such clip; choose one of " + listed_clips(character));
}

std::size_t choose_clip(const Character& character, const std::vector<bool>& used, double diagonal,
                        double fps, const ImportOptions& options) {
  const auto& all = character.animations;
  if (all.empty())
    throw InputError(
        "has a bind pose but no clip, so nothing moves (" + std::to_string(character.nodes.size()) +
        " nodes, " + std::to_string(moving_nodes(character).size()) +
        " bones); export it with an animation, or pass --from-bind-pose to move to the pose at rest");
  if (options.clip_number) {
    if (*options.clip_number < all.size()) return *options.clip_number;
    throw InputError("has no clip " + std::to_string(*options.clip_number) + "; choose one of " +
                     listed_clips(character));
  }
  if (!options.clip.empty()) return clip_named(character, options.clip);
  std::optional<std::size_t> between;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Movement movement = movement_of(character, all[i], used, diagonal, fps);
    if (movement == Movement::at_frames) return i;
    if (movement == Movement::between_frames && !between) between = i;
  }
  if (between) return *between;
  // A file is one pose where its clips move nothing of it. Where they move other parts than the chosen one,
  // it is none, and the user should know that the choice is at fault.
  const std::vector<bool> whole(used.size(), true);
  const bool are_poses = std::ranges::all_of(all, [&](const Animation& animation) {
    return movement_of(character, animation, whole, diagonal, fps) == Movement::none;
  });
  if (options.from_bind_pose || (options.one_pose && are_poses)) return 0;
  throw InputError(
      "none of its clips moves the surface: " + listed_clips(character) + ", at " + exact_text(fps) +
      " a second; give more frames with --fps, pass --from-bind-pose to move from the bind pose to "
      "one of them, or name one with --clip");
}

Frames survey(const Character& character, const Pose& bound) {
  const auto start_of_clip = [&character, &bound](std::size_t frame) -> Moment {
    if (frame == 0 || frame > character.animations.size()) return {bound, rest_weights(character)};
    return moment_at(character, character.animations[frame - 1], 0);
  };
  return {std::max<std::size_t>(2, character.animations.size() + 1), start_of_clip};  // a cache has two
}

}  // namespace

std::size_t frames_of(double seconds, double fps) {
  constexpr double kMost = 1e15;  // which is refused, whatever the memory
  const double frames = std::min(seconds * fps, kMost);
  const double whole = std::round(frames);
  return static_cast<std::size_t>(std::abs(frames - whole) <= kNearFrame ? whole : std::ceil(frames)) + 1;
}

double second_of_frame(std::size_t frame, double seconds, double fps) {
  return frame + 1 >= frames_of(seconds, fps) ? seconds : static_cast<double>(frame) / fps;
}

double frame_number(double seconds, double fps) {
  const double number = seconds * fps, whole = std::round(number);
  return std::abs(number - whole) <= kNearFrame ? whole : number;
}

void put_keys_on_frames(Character& character, double fps) {
  for (Animation& clip : character.animations) {
    // The frame's time where a key is meant for a frame, or else its own.
    const auto meant = [&](double time) {
      const double frame = std::round((time - clip.start) * fps);
      if (!(frame >= 0) || !(frame <= clip.seconds * fps + 1)) return time;
      const double there = clip.start + second_of_frame(static_cast<std::size_t>(frame), clip.seconds, fps);
      const double rounding = std::min(kSingle * std::abs(time), 0.25 / fps);
      return std::abs(there - time) <= std::max(kNearFrame / fps, rounding) ? there : time;
    };
    // Of neighbours that are meant for one frame, none is moved: they are a jump between two frames.
    const auto put = [&](auto& keys) {
      std::vector<double> times(keys.size());
      for (std::size_t i = 0; i < keys.size(); ++i) times[i] = meant(keys[i].time);
      for (std::size_t i = 0; i < keys.size(); ++i)
        if ((i == 0 || times[i - 1] < times[i]) && (i + 1 == keys.size() || times[i] < times[i + 1]))
          keys[i].time = times[i];
    };
    const auto put_all = [&](auto& layered) {
      for (Curve& curve : layered.base.axis) put(curve.keys);
      for (auto& layer : layered.above)
        for (Curve& curve : layer.values.axis) put(curve.keys);
    };
    for (Channel& channel : clip.channels) {
      put(channel.moves), put(channel.rotations), put(channel.scales);
      put_all(channel.move_components), put_all(channel.scale_components), put_all(channel.angles.degrees);
    }
    for (MorphChannel& morph : clip.morphs)
      for (Layered<1>& weight : morph.weights) put_all(weight);
    for (Curve& weight : clip.layer_weights) put(weight.keys);
  }
}

Frames plan_frames(const Character& character, const Pose& bound, const std::vector<bool>& used,
                   double diagonal, const ImportOptions& options, ImportReport& report) {
  if (options.survey) return survey(character, bound);
  const bool to_rest = character.animations.empty() && (options.from_bind_pose || options.one_pose);
  if (to_rest && options.from_bind_pose)
    report.notes.push_back("has no clip; moves from the bind pose to the pose at rest");
  const long chosen =
      to_rest ? -1 : static_cast<long>(choose_clip(character, used, diagonal, report.fps, options));
  const Animation animation = to_rest ? Animation{} : character.animations[static_cast<std::size_t>(chosen)];
  const std::size_t frames = frames_of(animation.seconds, report.fps);
  const std::size_t lead_in =
      options.from_bind_pose
          ? std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kLeadInSeconds * report.fps)))
          : 0;
  report.chosen_clip = chosen;
  report.lead_in = lead_in;
  const bool is_one_pose = frames + lead_in < 2;
  if (is_one_pose && !options.one_pose)
    throw InputError("--clip " + options.clip + ": is one pose; pass --from-bind-pose to move to it");
  if (is_one_pose && !options.motion.empty())
    throw InputError("--true-motion: is one pose, and nothing moves; leave it out");
  if (!is_one_pose && lead_in == 0 &&
      movement_of(character, animation, used, diagonal, report.fps) == Movement::between_frames)
    report.notes.push_back(
        "clip '" + animation.name + "' moves between its frames alone: at " + exact_text(report.fps) +
        " a second, all frames show one pose; give more with --fps, or ask for --true-motion");
  const auto moment = [&character, &bound, animation, fps = report.fps, lead_in](std::size_t frame) {
    if (frame >= lead_in)
      return moment_at(character, animation, second_of_frame(frame - lead_in, animation.seconds, fps));
    const Moment start = moment_at(character, animation, 0);
    const double share = static_cast<double>(frame) / static_cast<double>(lead_in);
    return Moment{blend(character, bound, start.pose, share),
                  blend(rest_weights(character), start.weights, share)};
  };
  return {is_one_pose ? 2 : frames + lead_in, moment};  // a cache has two
}

}  // namespace cscd::scenes
