#include "bench/compare/history.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <set>
#include <span>
#include <string_view>

#include "bench/compare/times.h"
#include "bench/output/data.h"
#include "bench/output/schema.h"
#include "bench/statistics/statistics.h"
#include "core/base/digest.h"
#include "core/base/error.h"
#include "core/base/number_text.h"
#include "scenes/base/joined.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr std::string_view kUnknownMark = "?";
// What speedups are held against: the first of these rows that took turns with the others.
constexpr std::string_view kOver[] = {"base", "drvbc"};

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

// What a row lacks; null for nothing.
ordered_json lacking_json(const Record& record, const std::string& row) {
  const std::optional<Shortfall> lacking = shortfall(record, row);
  if (!lacking) return nullptr;
  return {{"contacts_expected", lacking->contacts_expected},
          {"contacts_found", lacking->contacts_found},
          {"intervals", lacking->intervals},
          {"void_intervals", lacking->void_intervals}};
}

// The same, read back; nothing where the entry does not say it.
std::optional<Shortfall> lacking_of(const ordered_json& row) {
  const auto lacking = row.find("lacking");
  if (lacking == row.end()) return std::nullopt;
  if (lacking->is_null()) return Shortfall{};
  return Shortfall{lacking->at("contacts_expected"), lacking->at("contacts_found"), lacking->at("intervals"),
                   lacking->at("void_intervals")};
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
  ordered_json out = {{"name", row.name},
                      {"guarantee", row.guarantee},
                      {"answers", answers_of(row)},
                      {"counters", std::move(counters)},
                      {"ms", std::move(ms)}};
  if (records.front().verification.strategy(row.name) != nullptr)
    out["lacking"] = lacking_json(records.front(), row.name);
  return out;
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

bool is_entry(const ordered_json& document) {
  const std::string schema = document.value("schema", "");
  return schema == kHistorySchema || schema == kFirstHistorySchema;
}

ordered_json read_entry(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const ordered_json entry = ordered_json::parse(file, nullptr, false);
  if (entry.is_discarded() || !entry.is_object() || !is_entry(entry))
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

// All entries below a folder, in the order of their names.
std::vector<fs::path> entries_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(folder, error))
    if (file.is_regular_file() && file.path().extension() == ".json") files.push_back(file.path());
  std::ranges::sort(files);
  return files;
}

// What was measured of a scene. Speedups of two entries form one course only where this is the same, and
// times where their rows are the same, too.
ordered_json measured_of(const ordered_json& scene) {
  return {{"digest", scene.at("digest")},
          {"elementary", scene.at("elementary")},
          {"timed_intervals", scene.at("timed_intervals")}};
}

Estimate estimate_of(const ordered_json& ms) {
  return {ms.at("median"), ms.at("low"), ms.at("high")};
}

// The ratio of two medians that were taken in turns, so that each errs by itself.
Estimate ratio_of(const Estimate& over, const Estimate& under) {
  const double value = over.value / under.value;
  const double wide = std::hypot(std::log(over.high / over.low), std::log(under.high / under.low)) / 2;
  return {value, value * std::exp(-wide), value * std::exp(wide)};
}

// The row that others are held against; null where there is none with whole queries.
const ordered_json* row_over(const ordered_json& scene) {
  for (const std::string_view name : kOver)
    for (const ordered_json& row : scene.at("rows"))
      if (row.at("name") == name && row.at("ms").contains("total") && row["ms"]["total"].at("low") > 0)
        return &row;
  return nullptr;
}

// Sorts what entries hold into courses. Entries come in the order of their commits.
class CourseMaker {
 public:
  explicit CourseMaker(const CourseChoice& choice) : choice_(choice) {}
  void add(const ordered_json& entry) {
    const std::string machine = machine_of(entry);
    if (!is_wanted(choice_.machine, machine)) return;
    for (const ordered_json& scene : entry.at("scenes")) {
      const ordered_json measured = measured_of(scene);
      ordered_json timed = measured;  // times depend on the rows that shared the caches
      for (const ordered_json& row : scene.at("rows")) timed["rows"].push_back(row.at("name"));
      const ordered_json* const over = row_over(scene);
      for (const ordered_json& row : scene.at("rows")) {
        const Course course{{}, scene.at("name"), row.at("name"), {}, {}, measured, {}, {}};
        for (const auto& [stage, ms] : row.at("ms").items()) {
          Course times = course;
          times.machine = machine, times.stage = stage, times.measured = timed;
          add(entry, scene, row, std::move(times), estimate_of(ms));
        }
        if (over == nullptr || over == &row || !row["ms"].contains("total") ||
            !(row["ms"]["total"].at("low") > 0))
          continue;
        Course speedup = course;
        speedup.stage = kSpeedupStage, speedup.over = over->at("name");
        add(entry, scene, row, std::move(speedup),
            ratio_of(estimate_of((*over)["ms"]["total"]), estimate_of(row["ms"]["total"])));
      }
    }
  }
  std::vector<Course> take() { return std::move(courses_); }

 private:
  static bool is_wanted(const std::string& one, const std::string& name) {
    return one.empty() || one == name;
  }
  // Adds a point to the course that is like this one, or makes it the first of a new course.
  void add(const ordered_json& entry, const ordered_json& scene, const ordered_json& row, Course like,
           const Estimate& value) {
    if (!is_wanted(choice_.scene, like.scene) || !is_wanted(choice_.row, like.row) ||
        !is_wanted(choice_.stage, like.stage))
      return;
    auto course = std::ranges::find_if(courses_, [&](const Course& c) {
      return c.machine == like.machine && c.scene == like.scene && c.row == like.row &&
             c.stage == like.stage && c.over == like.over && c.measured == like.measured;
    });
    if (course == courses_.end()) course = courses_.insert(courses_.end(), std::move(like));
    course->points.push_back({entry.at("commit"), entry.at("committed"), machine_of(entry), value,
                              row.at("answers"), scene.at("counted_intervals"), row.at("counters"),
                              lacking_of(row)});
  }

  CourseChoice choice_;
  std::vector<Course> courses_;
};

bool is_speedup(const Course& course) {
  return course.stage == kSpeedupStage;
}

std::vector<ChangePoint> changes_of(const Course& course) {
  constexpr double kHalfWidth = 1.96;
  std::vector<CoursePoint> points;
  for (const HistoryPoint& point : course.points) {
    const Estimate& value = point.value;
    if (value.low <= 0) return {};
    points.push_back({value.value, std::log(value.high / value.low) / (2 * kHalfWidth)});
  }
  const ordered_json noise = data_json("comparison.json").at("history");
  return change_points(points, noise.at(is_speedup(course) ? "least_noise_of_speedups" : "least_noise"));
}

// `ratio` is that of times.
std::string step_text(double ratio) {
  return ratio < 1 ? figure_text(1 / ratio) + " times faster" : figure_text(ratio) + " times slower";
}

// A speedup changes where either of its rows does.
std::string step_text(const Course& course, const ChangePoint& change) {
  if (!is_speedup(course)) return step_text(change.ratio);
  return change.ratio < 1 ? figure_text(1 / change.ratio) + " times less"
                          : figure_text(change.ratio) + " times more";
}

// How counters differ from those of the commit before, where both counted the same intervals: "bvot +1.2 %".
std::vector<std::string> counter_changes(const Course& course, std::size_t i) {
  std::vector<std::string> out;
  if (!is_speedup(course) || i == 0 || course.points[i - 1].counted != course.points[i].counted) return out;
  const ordered_json &before = course.points[i - 1].counters, &after = course.points[i].counters;
  for (const auto& [name, value] : after.items()) {
    if (!before.contains(name) || before[name] == value) continue;
    const double from = before[name], to = value;
    char text[96];
    if (from > 0)
      std::snprintf(text, sizeof text, "%s %+.3g %%", name.c_str(), 100 * (to / from - 1));
    else
      std::snprintf(text, sizeof text, "%s 0 to %.0f", name.c_str(), to);
    out.emplace_back(text);
  }
  return out;
}

std::string point_text(const Course& course, std::size_t i) {
  const HistoryPoint& point = course.points[i];
  char text[128];
  std::snprintf(text, sizeof text, "  %s  %.10s  %10s %s%-1s [%s, %s]", point.committed.substr(0, 16).c_str(),
                point.commit.c_str(), short_text(point.value.value).c_str(),
                is_speedup(course) ? "times" : "ms", mark_of(point).c_str(),
                short_text(point.value.low).c_str(), short_text(point.value.high).c_str());
  std::string out = text;
  if (is_speedup(course)) out += "  " + point.machine;
  for (const ChangePoint& change : course.changes)
    if (change.first == i) out += "  <- " + step_text(course, change);
  for (const std::string& change : counter_changes(course, i)) out += "  <- " + change;
  return out + "\n";
}

// A word of the shell.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

// What the marks of these points stand for; empty where there is none.
std::string note_on_marks(std::span<const HistoryPoint* const> points) {
  const auto has = [&](const std::string& mark) {
    return std::ranges::any_of(points, [&](const HistoryPoint* point) { return mark_of(*point) == mark; });
  };
  std::string out;
  if (has(std::string(kShortfallMark))) out += std::string(kShortfallMeaning) + ".\n";
  if (has(std::string(kUnknownMark)))
    out += std::string(kUnknownMark) + " The entry does not say whether the row answered everything.\n";
  return out;
}

}  // namespace

std::string mark_of(const HistoryPoint& point) {
  if (!point.lacking) return std::string(kUnknownMark);
  return is_short(*point.lacking) ? std::string(kShortfallMark) : "";
}

std::string committed_date(const fs::path& folder, const std::string& commit) {
  if (!is_commit(commit))
    throw InputError("history: the records name the commit " + commit +
                     ", which is no name that git gives; measure again with a program that cscd built");
  std::error_code error;
  fs::path place = fs::absolute(folder, error);
  while (place.has_relative_path() && !fs::is_directory(place, error)) place = place.parent_path();
  const std::string command = "git -C " + quoted(place.string()) + " show --no-patch --format=%ct " +
                              quoted(commit + "^{commit}") + " 2>/dev/null";
  std::string said;
  if (FILE* const git = popen(command.c_str(), "r")) {
    char piece[64];
    while (std::fgets(piece, sizeof piece, git) != nullptr) said += piece;
    pclose(git);
  }
  std::int64_t second = 0;
  if (const auto [end, fault] = std::from_chars(said.data(), said.data() + said.size(), second);
      fault != std::errc{})
    throw InputError(
        "history " + folder.string() + ": git knows no commit " + commit +
        " there, or is not installed; name a folder in the repository of the program that measured");
  char text[64];
  const std::time_t time = second;
  std::tm parts{};
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S+00:00", gmtime_r(&time, &parts));
  return text;
}

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
  throw InputError("the commit's date " + committed + " is none that git knows; write the entry anew");
}

ordered_json history_entry(const Side& side, const std::string& committed) {
  if (side.dirty || side.commit == "unknown")
    throw InputError(
        "history: the records are of no commit, as the sources differed from it; commit them and "
        "measure again");
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
  std::map<std::pair<std::string, std::string>, fs::path> seen;  // by machine and commit
  for (const fs::path& file : entries_in(folder)) {
    const ordered_json& entry = entries.emplace_back(read_entry(file));
    const auto [same, is_new] = seen.try_emplace({machine_of(entry), entry.at("commit")}, file);
    if (!is_new)
      throw InputError("history " + file.string() + ": is of the commit and the machine of " +
                       same->second.string() + ", and a commit counts once; remove one of the two");
  }
  if (entries.empty())
    throw InputError("history " + folder.string() +
                     ": holds no entry; add one with scripts/compare-commits --keep or cscd history --keep");
  std::ranges::stable_sort(entries, {}, [](const ordered_json& entry) {
    return commit_second(entry.at("committed"));  // texts of two time zones do not sort as their dates do
  });
  CourseMaker maker(choice);
  for (const ordered_json& entry : entries) maker.add(entry);
  std::vector<Course> courses = maker.take();
  for (Course& course : courses) course.changes = changes_of(course);
  return courses;
}

ordered_json courses_json(const std::vector<Course>& courses) {
  ordered_json out = ordered_json::array();
  std::vector<const HistoryPoint*> all;
  for (const Course& course : courses) {
    ordered_json points = ordered_json::array(), changes = ordered_json::array();
    for (const HistoryPoint& point : course.points) {
      points.push_back({{"commit", point.commit}, {"committed", point.committed}});
      points.back()["machine"] = point.machine;
      points.back().update(estimate_json(point.value));
      points.back()["mark"] = mark_of(point);
      points.back()["answers"] = point.answers;
      all.push_back(&point);
    }
    for (const ChangePoint& change : course.changes)
      changes.push_back(
          {{"first", change.first}, {"commit", course.points[change.first].commit}, {"ratio", change.ratio}});
    out.push_back({{"machine", course.machine},
                   {"scene", course.scene},
                   {"row", course.row},
                   {"stage", course.stage},
                   {"over", course.over},
                   {"measured", course.measured},
                   {"points", std::move(points)},
                   {"changes", std::move(changes)}});
  }
  return {{"schema", "cscd.courses/3"}, {"note", note_on_marks(all)}, {"courses", std::move(out)}};
}

std::string speedups_text(const std::vector<Course>& courses) {
  std::map<std::pair<std::string, std::string>, std::vector<const Course*>> rows;
  std::set<std::string> commits, machines;
  std::vector<const HistoryPoint*> shown;
  std::size_t single = 0;
  for (const Course& course : courses) {
    if (course.points.size() < 2) {
      ++single;
      continue;
    }
    rows[{course.row, course.over}].push_back(&course);
    for (const HistoryPoint& point : course.points)
      commits.insert(point.commit), machines.insert(point.machine), shown.push_back(&point);
  }
  std::string out =
      "Times faster in one run, at the first commit and at the last: " + many(commits.size(), "commit") +
      " on " + many(machines.size(), "kind") + " of machine\n";
  for (const auto& [row, scenes] : rows) {
    std::vector<std::string> figures;
    std::map<std::string, std::vector<std::string>> changes;  // by commit
    for (const Course* course : scenes) {
      const HistoryPoint &first = course->points.front(), &last = course->points.back();
      figures.push_back(course->scene + " " + figure_text(first.value.value) + mark_of(first) + " to " +
                        figure_text(last.value.value) + mark_of(last));
      for (std::size_t i = 0; i < course->points.size(); ++i) {
        std::vector<std::string>& at = changes[course->points[i].commit.substr(0, 10)];
        for (const ChangePoint& change : course->changes)
          if (change.first == i) at.push_back(course->scene + " " + step_text(*course, change));
        if (const std::size_t count = counter_changes(*course, i).size(); count > 0)
          at.push_back(course->scene + " " + many(count, "counter"));
      }
    }
    out += row.first + " over " + row.second + ": " + joined(figures) + "\n";
    for (const auto& [commit, what] : changes)
      if (!what.empty()) out += "  from " + commit + " on: " + joined(what) + "\n";
  }
  out += note_on_marks(shown);
  if (single > 0) out += "left out: " + many(single, "course") + " of a single commit; --all shows them\n";
  return out;
}

std::string courses_text(const std::vector<Course>& courses, bool every_point, bool with_single_commits) {
  std::string out;
  std::size_t single = 0;
  std::vector<const HistoryPoint*> shown;
  for (const Course& course : courses) {
    if (course.points.size() < 2 && !with_single_commits) {
      ++single;
      continue;
    }
    out += course.scene + ", " + course.row +
           (is_speedup(course) ? ", times faster than " + course.over
                               : ", " + course.stage + " on " + course.machine + ", " +
                                     std::to_string(course.measured.at("rows").size()) + " rows in turns") +
           ", " + std::to_string(course.measured.at("timed_intervals").size()) +
           " intervals: " + many(course.points.size(), "commit") + ", " +
           many(course.changes.size(), "change") + "\n";
    for (std::size_t i = 0; i < course.points.size(); ++i) {
      const bool is_change =
          std::ranges::any_of(course.changes, [&](const ChangePoint& change) { return change.first == i; });
      if (!every_point && !is_change) continue;
      out += point_text(course, i);
      shown.push_back(&course.points[i]);
    }
  }
  out += note_on_marks(shown);
  if (single > 0) out += "left out: " + many(single, "course") + " of a single commit; --all shows them\n";
  return out;
}

}  // namespace cscd::bench
