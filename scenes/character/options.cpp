#include "scenes/character/options.h"

#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "core/base/number_text.h"

namespace cscd::scenes {
namespace {

template <class Number>
Number number(const std::string& option, const std::string& digits) {
  Number value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size())
    throw InputError(option + " " + digits + ": is not a number it can use; give another");
  return value;
}

void check(const ImportOptions& options) {
  if (options.fps && !(*options.fps > 0 && *options.fps <= 10'000))
    throw InputError("--fps " + exact_text(*options.fps) + ": give a number above 0 and up to 10000");
  if (options.weld && !(*options.weld >= 0 && *options.weld <= 0.01))
    throw InputError("--weld " + exact_text(*options.weld) + ": give a share of the diagonal from 0 to 0.01");
}

}  // namespace

std::vector<std::string> to_arguments(const ImportOptions& options) {
  std::vector<std::string> words{"--component", options.component};
  const auto add = [&](const std::string& name, const std::string& value) {
    words.push_back(name);
    words.push_back(value);
  };
  if (options.fps) add("--fps", exact_text(*options.fps));
  if (!options.clip.empty()) add("--clip", options.clip);
  if (options.clip_number) add("--clip-number", std::to_string(*options.clip_number));
  if (options.fill_holes) add("--fill-holes", std::to_string(*options.fill_holes));
  if (options.weld) add("--weld", exact_text(*options.weld));
  if (options.from_bind_pose) words.push_back("--from-bind-pose");
  if (options.flip_inward) words.push_back("--flip-inward");
  if (options.survey) words.push_back("--survey");
  if (options.one_pose) words.push_back("--one-pose");
  if (!options.motion.empty()) add("--motion", options.motion);
  return words;
}

ImportOptions parse_arguments(std::span<const std::string> arguments) {
  ImportOptions options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& name = arguments[i];
    const auto value = [&]() -> const std::string& {
      if (++i >= arguments.size()) throw InputError(name + ": needs a value");
      return arguments[i];
    };
    if (name == "--fps") {
      options.fps = number<double>(name, value());
    } else if (name == "--component") {
      options.component = value();
    } else if (name == "--clip") {
      options.clip = value();
    } else if (name == "--clip-number") {
      options.clip_number = number<std::size_t>(name, value());
    } else if (name == "--fill-holes") {
      options.fill_holes = number<std::size_t>(name, value());
    } else if (name == "--weld") {
      options.weld = number<double>(name, value());
    } else if (name == "--from-bind-pose") {
      options.from_bind_pose = true;
    } else if (name == "--flip-inward") {
      options.flip_inward = true;
    } else if (name == "--survey") {
      options.survey = true;
    } else if (name == "--one-pose") {
      options.one_pose = true;
    } else if (name == "--motion") {
      options.motion = value();
    } else {
      throw InputError("option " + name + " is not known");
    }
  }
  check(options);
  return options;
}

}  // namespace cscd::scenes
