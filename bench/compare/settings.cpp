#include "bench/compare/settings.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <string_view>

#include "core/base/number_text.h"

namespace cscd::bench {
namespace {

// Options of `cscd run` that choose an input, rows, intervals, repetitions, threads or a place for the
// result. None of them changes an answer or a counter of an interval that both records have. --clip and
// --frames choose frames, and the digest of the frames says whether these are the same. Limits on time and
// memory change no answer either.
constexpr std::string_view kNoSettings[] = {
    "--scene",      "--input",         "--strategy",      "--frames", "--repetitions",     "--count-every",
    "--time-every", "--time-contacts", "--verify-every",  "--seed",   "--smoke",           "--threads",
    "--json",       "--force",         "--counts",        "--shards", "--shard-intervals", "--worker",
    "--clip",       "--clip-number",   "--import-memory", "--memory", "--import-seconds"};

constexpr std::string_view kThickName = ", thickness ";  // between the name of a scene and the thickness
// Members of a record say these better than its command line, which older records do not spell out.
constexpr std::string_view kElementary = "--elementary", kPipeline = "--pipeline", kThickness = "--thickness";

bool is_option(const std::string& word) {
  return word.size() > 2 && word.starts_with("--");
}

// A value in one way of writing it: numbers, those of edges included, in as few digits as tell them apart,
// and two names with a colon between them in order.
std::string plainly(const std::string& value) {
  double number = 0;
  const char* const end = value.data() + value.size();
  const auto [rest, error] = std::from_chars(value.data(), end, number);
  if (error == std::errc{} && (rest == end || std::string_view(rest, end) == "e"))
    return exact_text(number) + std::string(rest, end);
  const std::size_t colon = value.find(':');
  if (colon == std::string::npos || value.find(':', colon + 1) != std::string::npos) return value;
  const std::string first = value.substr(0, colon), second = value.substr(colon + 1);
  return std::min(first, second) + ":" + std::max(first, second);
}

// The options of a command line that are settings. An option that is given several times, as --ignore, has
// all its values in order, so that the order in which they were given makes no difference.
Settings from_command(const std::vector<std::string>& words) {
  std::map<std::string, std::set<std::string>> given;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (!is_option(words[i])) continue;
    const std::size_t equals = words[i].find('=');
    const std::string option = words[i].substr(0, equals);
    if (std::ranges::find(kNoSettings, option) != std::end(kNoSettings)) continue;
    const bool has_value = equals != std::string::npos || (i + 1 < words.size() && !is_option(words[i + 1]));
    given[option].insert(
        !has_value ? "given"
                   : plainly(equals != std::string::npos ? words[i].substr(equals + 1) : words[i + 1]));
  }
  Settings out;
  for (const auto& [option, values] : given)
    for (const std::string& value : values) out[option] += (out[option].empty() ? "" : " ") + value;
  return out;
}

// A setting of a record as it is shown: the thickness as it was written, with its length where that is
// another number.
std::string shown(const Record& record, const std::string& name) {
  const Settings settings = settings_of(record);
  const auto found = settings.find(name);
  if (found == settings.end()) return "left out";
  if (name != kThickness) return found->second;
  const std::string& scene = record.scene.name;
  const std::size_t at = scene.rfind(kThickName);
  const std::string written = at == std::string::npos ? found->second : scene.substr(at + kThickName.size());
  return plainly(written) == found->second ? found->second
                                           : written + " (" + short_text(record.thickness) + ")";
}

}  // namespace

Settings settings_of(const Record& record) {
  Settings out = from_command(record.command);
  out[std::string(kElementary)] = record.elementary;
  out[std::string(kPipeline)] = to_string(record.pipeline);
  out["the surface"] = std::to_string(record.scene.vertices) + " vertices, " +
                       std::to_string(record.scene.triangles) + " triangles, " +
                       std::to_string(record.scene.bones) + " bones";
  out.erase(std::string(kThickness));
  if (record.thickness > 0) out[std::string(kThickness)] = exact_text(record.thickness);
  return out;
}

std::string other_settings(const Record& one, const Record& other) {
  const Settings first = settings_of(one), second = settings_of(other);
  std::set<std::string> names;
  for (const Settings* side : {&first, &second})
    for (const auto& [name, value] : *side) names.insert(name);
  const auto value_in = [](const Settings& settings, const std::string& name) {
    const auto found = settings.find(name);
    return found == settings.end() ? std::nullopt : std::optional(found->second);
  };
  std::string out;
  for (const std::string& name : names)
    if (value_in(first, name) != value_in(second, name))
      out += (out.empty() ? "" : "; ") + name + " is " + shown(one, name) + " and " + shown(other, name);
  return out;
}

std::string bare_name(const Record& record) {
  const std::string& name = record.scene.name;
  return record.thickness > 0 ? name.substr(0, name.rfind(kThickName)) : name;
}

bool asks_the_same(const Record& one, const Record& other) {
  return bare_name(one) == bare_name(other) && one.thickness == other.thickness &&
         one.pipeline == other.pipeline;
}

std::string other_row_settings(const StrategyRecord& one, const StrategyRecord& other) {
  if (one.lead == other.lead) return "";
  return one.name + " was led up to each interval by " + std::to_string(one.lead) + " and " +
         std::to_string(other.lead) + " intervals";
}

}  // namespace cscd::bench
