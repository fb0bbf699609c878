#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/compare/side.h"
#include "bench/records/shortfall.h"
#include "bench/statistics/statistics.h"

// What this project took, commit by commit: one small JSON file a commit and kind of machine, which is never
// rewritten.
namespace cscd::bench {

// Entries of version 1 do not say what their rows lacked (HistoryPoint::lacking).
inline constexpr std::string_view kHistorySchema = "cscd.history/2", kFirstHistorySchema = "cscd.history/1";

// Asks git for the date of a commit in the repository that holds the folder, which need not exist yet.
// Returns it in UTC, such as 2026-11-25T12:00:00+00:00. Throws InputError for what is no name of a commit,
// and for a commit that the repository does not have.
std::string committed_date(const std::filesystem::path& folder, const std::string& commit);

// Seconds from the beginning of 1970 (UTC) to a commit's date in an entry, which may name another time zone.
// Throws InputError for any other text, and for a day or an hour that does not exist.
std::int64_t commit_second(const std::string& committed);

// Summarises the records of one commit: digests, counters, medians with intervals, what the rows lacked, and
// the environment. `committed` is the commit's date. Throws InputError for records of no commit, and where
// the verification failed.
nlohmann::ordered_json history_entry(const Side& side, const std::string& committed);

// Where an entry belongs: FOLDER/MACHINE/DATE-COMMIT.json.
std::filesystem::path history_file(const std::filesystem::path& folder, const nlohmann::ordered_json& entry);

// A stage of courses beside those of a query: how many times faster a row answers a query than the row that
// it is held against, in one run. Machines that differ in speed can be compared by it.
inline constexpr std::string_view kSpeedupStage = "speedup";

// What one stage of a row took at one commit, or how much faster than another row it was.
struct HistoryPoint {
  std::string commit, committed, machine;
  Estimate value;                    // milliseconds, or times
  std::string answers;               // what the digests of all intervals come to
  nlohmann::ordered_json counted;    // the counted intervals
  nlohmann::ordered_json counters;   // sums over these, by name
  std::optional<Shortfall> lacking;  // nothing where the entry does not say what the row lacked
};
// What stands behind a time wherever it is printed: kShortfallMark where the row did not answer all that a
// complete row answers, "?" where that is not known, else nothing.
std::string mark_of(const HistoryPoint& point);

// One stage of one row of one scene, in order of the commits. All its points measured the same: frames,
// elementary test and timed intervals. Times are those of one machine and of the same rows in turns, which
// share the caches. Speedups are those of all machines.
struct Course {
  std::string machine, scene, row, stage;  // `machine` is empty for a speedup
  std::string over;                        // the row that a speedup is held against; empty for times
  nlohmann::ordered_json measured;         // digest, elementary, timed_intervals, and of times the rows
  std::vector<HistoryPoint> points;
  std::vector<ChangePoint> changes;
};

// Which courses are wanted; an empty name stands for all.
struct CourseChoice {
  std::string machine, scene, row, stage;
};

// Reads every entry below a folder. Throws InputError, naming the file, for one that is not of the schema and
// for a second one of the same commit and machine, and for a folder without entries.
std::vector<Course> read_courses(const std::filesystem::path& folder, const CourseChoice& choice);

nlohmann::ordered_json courses_json(const std::vector<Course>& courses);
// The same of speedups in a screen: for each row over how many scenes and commits, how many times faster it
// was and is, and at which commits that or a counter changed. Courses of a single commit are left out.
std::string speedups_text(const std::vector<Course>& courses);
// For a terminal. A course of a single commit shows no change, so it is left out and counted in the last
// line, unless `with_single_commits` asks for it.
std::string courses_text(const std::vector<Course>& courses, bool every_point, bool with_single_commits);

}  // namespace cscd::bench
