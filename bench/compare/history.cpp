#include "bench/compare/history.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <span>
#include <string_view>

#include "bench/compare/times.h"
#include "bench/output/data.h"
#include "bench/output/schema.h"
#include "bench/statistics/statistics.h"
#include "core/base/digest.h"
#include "core/base/error.h"
#include "core/base/number_text.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr const char* kEnvironment[] = {"cpu",    "cores", "instruction_set", "compiler", "build_type",
                                        "kernel", "flags"};

// What all digests of a row come to: FNV-1a over their texts.
std::string answers_of(const StrategyRecord& row) {
  std::uint64_t hash = kDigestOfNothing;
  for (const std::string& digest : row.digests) hash = digest_of(std::as_bytes(std::span(digest)), hash);
  return hex_text(hash);
}

ordered_json estimate_json(const Estimate& estimate) {
  return {{"median", estimate.value}, {"low", estimate.low}, {"high", estimate.high}};
}

// The median over the processes (process_time); of one process, over its repetitions.
Estimate stage_estimate(const std::vector<Record>& records, const std::string& row,
                        const std::string& stage) {
  std::vector<double> processes, repetitions;
  for (const Record& record : records)
    if (const StrategyRecord* strategy = record.strategy(row)) {
      const ProcessTimes times = stage_times(record, *strategy, stage, record.timed_intervals);
      if (times.empty()) continue;
      processes.push_back(process_time(times));
      repetitions = stage_samples(record, *strategy, stage);
    }
  return bootstrap_median(processes.size() > 1 ? processes : repetitions);
}

ordered_json row_json(const std::vector<Record>& records, const StrategyRecord& row) {
  ordered_json counters = ordered_json::object(), ms = ordered_json::object();
  for (const auto& [counter, column] : row.counts) {
    std::uint64_t sum = 0;
    for (const std::uint64_t value : column) sum += value;
    counters[counter] = sum;
  }
  for (const std::string& stage : stages_of(row))
    ms[stage] = estimate_json(stage_estimate(records, row.name, stage));
  return {{"name", row.name},
          {"guarantee", row.guarantee},
          {"answers", answers_of(row)},
          {"counters", std::move(counters)},
          {"ms", std::move(ms)}};
}

// Lower-case letters and digits of a text, with one dash between words.
std::string slug(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)))
      out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!out.empty() && out.back() != '-')
      out += '-';
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out;
}

std::string machine_of(const ordered_json& entry) {
  const ordered_json& environment = entry.at("environment");
  return slug(environment_text(environment, "cpu") + "-" + environment_text(environment, "cores")) + "core";
}

bool is_commit(const std::string& text) {
  return text.size() >= 7 && text.size() <= 64 &&
         text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

ordered_json read_entry(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const ordered_json entry = ordered_json::parse(file, nullptr, false);
  if (entry.is_discarded() || !entry.is_object() || entry.value("schema", "") != kHistorySchema)
    throw InputError("history " + path.string() + ": is no entry of schema " + std::string(kHistorySchema) +
                     "; remove it, or write it anew with `cscd history --keep`");
  if (const std::string violation = schema_violation(entry, "history.schema.json"); !violation.empty())
    throw InputError("history " + path.string() + ": does not follow its schema at " + violation);
  try {
    commit_second(entry.at("committed"));
  } catch (const InputError& error) {
    throw InputError("history " + path.string() + ": " + error.what());
  }
  return entry;
}

// What was measured of a scene. Times of two entries form one course only where this is the same.
ordered_json measured_of(const ordered_json& scene) {
  ordered_json rows = ordered_json::array();
  for (const ordered_json& row : scene.at("rows")) rows.push_back(row.at("name"));
  return {{"digest", scene.at("digest")},
          {"elementary", scene.at("elementary")},
          {"timed_intervals", scene.at("timed_intervals")},
          {"rows", std::move(rows)}};
}

void add_entry(const ordered_json& entry, const CourseChoice& choice, std::vector<Course>& courses) {
  const auto wanted = [](const std::string& one, const std::string& name) {
    return one.empty() || one == name;
  };
  const std::string machine = machine_of(entry);
  if (!wanted(choice.machine, machine)) return;
  for (const ordered_json& scene : entry.at("scenes")) {
    const ordered_json measured = measured_of(scene);
    for (const ordered_json& row : scene.at("rows"))
      for (const auto& [stage, ms] : row.at("ms").items()) {
        const std::string scene_name = scene.at("name"), row_name = row.at("name");
        if (!wanted(choice.scene, scene_name) || !wanted(choice.row, row_name) ||
            !wanted(choice.stage, stage))
          continue;
        auto course = std::ranges::find_if(courses, [&, &stage = stage](const Course& c) {
          return c.machine == machine && c.scene == scene_name && c.row == row_name && c.stage == stage &&
                 c.measured == measured;
        });
        if (course == courses.end()) {
          courses.push_back({machine, scene_name, row_name, stage, measured, {}, {}, {}, {}, {}});
          course = courses.end() - 1;
        }
        course->commits.push_back(entry.at("commit"));
        course->dates.push_back(entry.at("committed"));
        course->ms.push_back({ms.at("median"), ms.at("low"), ms.at("high")});
        course->answers.push_back(row.at("answers"));
      }
  }
}

std::vector<ChangePoint> changes_of(const Course& course) {
  constexpr double kHalfWidth = 1.96;
  std::vector<CoursePoint> points;
  for (const Estimate& ms : course.ms) {
    if (ms.low <= 0) return {};
    points.push_back({ms.value, std::log(ms.high / ms.low) / (2 * kHalfWidth)});
  }
  return change_points(points, data_json("comparison.json").at("history").at("least_noise"));
}

std::string step_text(double ratio) {
  char text[64];
  if (ratio < 1)
    std::snprintf(text, sizeof text, "%.3g times faster", 1 / ratio);
  else
    std::snprintf(text, sizeof text, "%.3g times slower", ratio);
  return text;
}

std::string point_text(const Course& course, std::size_t i) {
  char text[128];
  std::snprintf(text, sizeof text, "  %s  %.10s  %10.4g ms [%.4g, %.4g]",
                course.dates[i].substr(0, 16).c_str(), course.commits[i].c_str(), course.ms[i].value,
                course.ms[i].low, course.ms[i].high);
  std::string out = text;
  for (const ChangePoint& change : course.changes)
    if (change.first == i) out += "  <- " + step_text(change.ratio);
  return out + "\n";
}

}  // namespace

std::int64_t commit_second(const std::string& committed) {
  constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:ddsdd:dd";  // d is a digit, s a sign
  const auto fits = [&](std::size_t i) {
    const char c = committed[i];
    if (kForm[i] == 'd') return c >= '0' && c <= '9';
    return kForm[i] == 's' ? c == '+' || c == '-' : c == kForm[i];
  };
  bool has_form = committed.size() == kForm.size();
  for (std::size_t i = 0; has_form && i < kForm.size(); ++i) has_form = fits(i);
  if (has_form) {
    const auto number = [&](std::size_t at, std::size_t digits) {
      return std::stoi(committed.substr(at, digits));
    };
    const std::chrono::year_month_day day{std::chrono::year(number(0, 4)),
                                          std::chrono::month(static_cast<unsigned>(number(5, 2))),
                                          std::chrono::day(static_cast<unsigned>(number(8, 2)))};
    const int hour = number(11, 2), minute = number(14, 2), second = number(17, 2);
    const int zone = 60 * number(20, 2) + number(23, 2);  // minutes ahead of UTC, without its sign
    if (day.ok() && hour < 24 && minute < 60 && second <= 60 && number(23, 2) < 60 && zone < 24 * 60) {
      const std::int64_t days = std::chrono::sys_days(day).time_since_epoch().count();
      const std::int64_t local = ((days * 24 + hour) * 60 + minute) * 60 + second;
      return local - (committed[19] == '-' ? -60 : 60) * zone;
    }
  }
  throw InputError("the commit's date " + committed +
                   " is not what git prints; take \"$(git show -s --format=%cI COMMIT)\"");
}

ordered_json history_entry(const Side& side, const std::string& committed) {
  commit_second(committed);
  if (side.dirty || side.commit == "unknown")
    throw InputError(
        "history: the records are of no commit, as the sources differed from it; commit them and "
        "measure again");
  if (!is_commit(side.commit))
    throw InputError("history: the records name the commit " + side.commit +
                     ", which is no name that git gives; measure again with a program that cscd built");
  ordered_json scenes = ordered_json::array(), environment = ordered_json::object();
  for (const char* key : kEnvironment)
    if (const ordered_json& all = side.scenes.begin()->second.front().environment; all.contains(key))
      environment[key] = all[key];
  for (const auto& [name, records] : side.scenes) {
    const Record& first = records.front();
    if (!first.verification.ok())
      throw InputError("history: the verification of " + name +
                       " failed, so it holds no times; mend it first");
    ordered_json rows = ordered_json::array();
    for (const StrategyRecord& row : first.strategies) rows.push_back(row_json(records, row));
    scenes.push_back({{"name", name},
                      {"digest", first.scene.digest},
                      {"elementary", first.elementary},
                      {"processes", records.size()},
                      {"counted_intervals", first.counted_intervals},
                      {"timed_intervals", first.timed_intervals},
                      {"rows", std::move(rows)}});
  }
  return {{"schema", kHistorySchema},  {"commit", side.commit},      {"committed", committed},
          {"measured", side.measured}, {"environment", environment}, {"scenes", std::move(scenes)}};
}

fs::path history_file(const fs::path& folder, const ordered_json& entry) {
  const std::string commit = entry.at("commit"), date = entry.at("committed");
  return folder / machine_of(entry) / (date.substr(0, 10) + "-" + commit.substr(0, 10) + ".json");
}

std::vector<Course> read_courses(const fs::path& folder, const CourseChoice& choice) {
  std::vector<ordered_json> entries;
  std::error_code error;
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(folder, error))
    if (file.is_regular_file() && file.path().extension() == ".json")
      entries.push_back(read_entry(file.path()));
  if (entries.empty())
    throw InputError("history " + folder.string() +
                     ": holds no entry; add one with scripts/compare-commits --keep or cscd history --keep");
  std::ranges::stable_sort(entries, {}, [](const ordered_json& entry) {
    return commit_second(entry.at("committed"));  // texts of two time zones do not sort as their dates do
  });
  std::vector<Course> courses;
  for (const ordered_json& entry : entries) add_entry(entry, choice, courses);
  for (Course& course : courses) course.changes = changes_of(course);
  return courses;
}

ordered_json courses_json(const std::vector<Course>& courses) {
  ordered_json out = ordered_json::array();
  for (const Course& course : courses) {
    ordered_json points = ordered_json::array(), changes = ordered_json::array();
    for (std::size_t i = 0; i < course.ms.size(); ++i) {
      points.push_back({{"commit", course.commits[i]}, {"committed", course.dates[i]}});
      points.back().update(estimate_json(course.ms[i]));
      points.back()["answers"] = course.answers[i];
    }
    for (const ChangePoint& change : course.changes)
      changes.push_back(
          {{"first", change.first}, {"commit", course.commits[change.first]}, {"ratio", change.ratio}});
    out.push_back({{"machine", course.machine},
                   {"scene", course.scene},
                   {"row", course.row},
                   {"stage", course.stage},
                   {"measured", course.measured},
                   {"points", std::move(points)},
                   {"changes", std::move(changes)}});
  }
  return {{"schema", "cscd.courses/1"}, {"courses", std::move(out)}};
}

std::string courses_text(const std::vector<Course>& courses, bool every_point, bool with_single_commits) {
  std::string out;
  std::size_t single = 0;
  for (const Course& course : courses) {
    if (course.ms.size() < 2 && !with_single_commits) {
      ++single;
      continue;
    }
    out += course.scene + ", " + course.row + ", " + course.stage + " on " + course.machine + ", " +
           std::to_string(course.measured.at("timed_intervals").size()) + " intervals, " +
           std::to_string(course.measured.at("rows").size()) +
           " rows in turns: " + many(course.ms.size(), "commit") + ", " +
           many(course.changes.size(), "change") + "\n";
    for (std::size_t i = 0; i < course.ms.size(); ++i) {
      const bool is_change =
          std::ranges::any_of(course.changes, [&](const ChangePoint& change) { return change.first == i; });
      if (every_point || is_change) out += point_text(course, i);
    }
  }
  if (single > 0) out += "left out: " + many(single, "course") + " of a single commit; --all shows them\n";
  return out;
}

}  // namespace cscd::bench
