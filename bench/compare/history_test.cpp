#include "bench/compare/history.h"

#include <fstream>
#include <gtest/gtest.h>

#include "bench/compare/test_records.h"
#include "bench/output/json_text.h"
#include "bench/output/schema.h"
#include "core/base/error.h"
#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"

namespace cscd::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

ordered_json entry_of(const std::string& commit, const std::string& committed, double factor,
                      const std::vector<std::size_t>& timed_intervals = {0, 2}) {
  std::vector<Record> records;
  for (int i = 0; i < 3; ++i) {
    records.push_back(test::small_record(commit, i));
    records.back().timed_intervals = timed_intervals;
    for (StrategyRecord& row : records.back().strategies)
      for (auto& [stage, repetitions] : row.ms)
        for (auto& repetition : repetitions)
          for (double& ms : repetition) ms *= factor;
  }
  return history_entry(side_of(std::move(records), "a test"), committed);
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(History, KeepsWhatACommitTook) {
  const ordered_json entry = entry_of("aaaaaaaaaaaaaaaa", "2026-11-25T10:00:00+00:00", 1);
  EXPECT_EQ(schema_violation(entry, "history.schema.json"), "");
  EXPECT_EQ(history_file("h", entry), fs::path("h/a-machine-2core/2026-11-25-aaaaaaaaaa.json"));
  const ordered_json& row = entry["scenes"][0]["rows"][0];
  EXPECT_EQ(row["counters"]["bvot"], 1000);
  EXPECT_DOUBLE_EQ(row["ms"]["total"]["median"].get<double>(),
                   (7.1 + 12.1) / 2);  // lowest deciles of two intervals
  EXPECT_EQ(entry["scenes"][0]["processes"], 3);
}

TEST(History, RefusesRecordsOfNoCommit) {
  Record dirty = test::small_record();
  dirty.environment["dirty"] = true;
  EXPECT_THROW(history_entry(side_of({dirty}, "a test"), "2026-11-25T10:00:00+00:00"), InputError);
  Record failed = test::small_record();
  failed.verification.strategies[0].failures = {"missing contact"};
  EXPECT_THROW(history_entry(side_of({failed}, "a test"), "2026-11-25T10:00:00+00:00"), InputError);
}

// Both become parts of a file's name, and an entry that cannot be read would stand in the way of all others.
TEST(History, TakesNoCommitThatGitDoesNotName) {
  const cscd::test::Folder scratch;  // in no repository
  for (const char* commit : {"unknown", "../../../x", "HEAD", "aaaaaa", "AAAAAAAAAA", "$(touch x)"})
    EXPECT_TRUE(says(cscd::test::refusal([&] { committed_date(scratch.path, commit); }),
                     "which is no name that git gives"))
        << commit;
  EXPECT_TRUE(
      says(cscd::test::refusal([&] { committed_date(scratch.path / "it's" / "none", "aaaaaaaaaaaaaaaa"); }),
           "git knows no commit aaaaaaaaaaaaaaaa there"));
  Record record = test::small_record();
  record.environment["cores"] = "../../2";
  const ordered_json entry = history_entry(side_of({record}, "a test"), "2026-11-25T10:00:00+00:00");
  EXPECT_EQ(history_file("h", entry).parent_path(), fs::path("h/a-machine-2core"));
}

TEST(History, CountsFromTheZoneThatADateNames) {
  for (const char* date :
       {"", "yesterday", "../../x", "2026-11-25", "2026-11-25T10:00:00Z", "2026-11-25T10:00:00",
        "2026-11-31T10:00:00+00:00", "2026-13-01T10:00:00+00:00", "2026-11-25T24:00:00+00:00",
        "2026-11-25T10:60:00+00:00", "2026-11-25 10:00:00 +0000", "2026-11-25T10:00:00+24:00",
        "2026-11-25T10:00:00+00:00/../../../x", "../../../../T10:00:00+00:00"})
    EXPECT_THROW(commit_second(date), InputError) << date;
  EXPECT_EQ(commit_second("1970-01-02T00:00:00+00:00"), 24 * 3600);
  EXPECT_EQ(commit_second("2024-02-29T12:00:00+02:30"), commit_second("2024-02-29T09:30:00+00:00"));
  EXPECT_EQ(commit_second("2026-11-24T23:30:00-01:00"), commit_second("2026-11-25T00:30:00+00:00"));
}

// The entry of a program that took any text for a date.
TEST(History, NamesTheEntryWhoseDateIsNone) {
  const cscd::test::Folder scratch;
  ordered_json entry = entry_of("aaaaaaaaaaaaaaaa", "2026-11-25T10:00:00+00:00", 1);
  for (const char* date : {"yesterday", "2026-11-31T10:00:00+00:00"}) {
    entry["committed"] = date;
    std::ofstream(scratch.path / "bad.json") << json_text(entry);
    try {
      read_courses(scratch.path, {});
      ADD_FAILURE() << date;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("bad.json"), std::string::npos) << error.what();
    }
  }
}

// One commit that is kept twice, under two dates, counts once.
TEST(History, RefusesASecondEntryOfACommit) {
  const cscd::test::Folder scratch;
  for (const char* day : {"2026-11-24", "2026-11-25"})
    std::ofstream(scratch.path / (std::string(day) + ".json"))
        << json_text(entry_of("aaaaaaaaaaaaaaaa", std::string(day) + "T10:00:00+00:00", 1));
  const std::string why = cscd::test::refusal([&] { read_courses(scratch.path, {}); });
  EXPECT_TRUE(says(why, "2026-11-25.json: is of the commit and the machine of ")) << why;
  EXPECT_TRUE(says(why, "2026-11-24.json, and a commit counts once; remove one of the two")) << why;
}

// Mutation: a row that the entry says nothing of counts as one that kept all contacts.
TEST(History, MarksTimesOfRowsThatDidNotAnswerEverything) {
  const cscd::test::Folder scratch;
  ordered_json entry = entry_of("aaaaaaaaaaaaaaaa", "2026-11-25T10:00:00+00:00", 1);
  EXPECT_EQ(schema_violation(entry, "history.schema.json"), "");
  const auto shown = [&] {
    std::ofstream(scratch.path / "a.json") << json_text(entry);
    return read_courses(scratch.path, {"", "", "", "traversal"});
  };
  const auto mark = [](const std::vector<Course>& courses, const std::string& row) {
    for (const Course& course : courses)
      if (course.row == row) return mark_of(course.points.at(0));
    return std::string("no such row");
  };
  std::vector<Course> courses = shown();
  EXPECT_EQ(mark(courses, "slow"), "");
  EXPECT_EQ(mark(courses, "swift"), "*") << "it kept 2 of 3 contacts";
  std::string text = courses_text(courses, true, true);
  EXPECT_TRUE(says(text, " ms* [")) << text;
  EXPECT_TRUE(says(text, std::string("\n") + kShortfallMeaning)) << text;
  EXPECT_FALSE(says(text, "?")) << text;
  EXPECT_EQ(courses_json(courses)["courses"][0]["points"][0]["mark"], "");
  EXPECT_TRUE(says(courses_json(courses)["note"], kShortfallMeaning));

  entry["schema"] = kFirstHistorySchema;
  for (ordered_json& row : entry["scenes"][0]["rows"]) row.erase("lacking");
  EXPECT_EQ(schema_violation(entry, "history.schema.json"), "");
  courses = shown();
  for (const char* row : {"slow", "swift"}) EXPECT_EQ(mark(courses, row), "?") << row;
  text = courses_text(courses, true, true);
  EXPECT_TRUE(says(text, " ms? [")) << text;
  EXPECT_TRUE(says(text, "\n? The entry does not say whether the row answered everything.\n")) << text;
  EXPECT_FALSE(says(text, "*")) << text;
}

TEST(History, FindsTheCommitThatChangedARow) {
  const cscd::test::Folder scratch;
  const fs::path& folder = scratch.path;
  fs::create_directories(folder / "m");
  EXPECT_THROW(read_courses(folder, {}), InputError);
  for (int i = 0; i < 8; ++i) {
    const std::string commit = std::string(16, static_cast<char>('1' + i)),
                      day = "2026-11-1" + std::to_string(i);
    // Written in another order than committed, as later measurements of earlier commits are.
    std::ofstream(folder / "m" / (std::to_string(9 - i) + ".json"))
        << json_text(entry_of(commit, day + "T10:00:00+00:00", i < 5 ? 1 : 0.7));
  }
  const std::vector<Course> courses = read_courses(folder, {"", "hand", "slow", "traversal"});
  ASSERT_EQ(courses.size(), 1u);
  ASSERT_EQ(courses[0].changes.size(), 1u);
  EXPECT_EQ(courses[0].points[courses[0].changes[0].first].commit, "6666666666666666");
  EXPECT_NEAR(courses[0].changes[0].ratio, 0.7, 1e-6);
  EXPECT_NE(courses_text(courses, true, false).find("<- 1.43 times faster"), std::string::npos)
      << courses_text(courses, true, false);
  EXPECT_EQ(courses_json(courses)["courses"][0]["changes"][0]["commit"], "6666666666666666");
  // Times of other intervals, as a full record has, are no point of this course.
  std::ofstream(folder / "m" / "full.json")
      << json_text(entry_of("9999999999999999", "2026-11-18T10:00:00+00:00", 3, {1, 3}));
  const std::vector<Course> both = read_courses(folder, {"", "hand", "slow", "traversal"});
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].points.size(), 8u);
  EXPECT_EQ(both[0].changes.size(), 1u);
  EXPECT_EQ(both[1].points.size(), 1u);
  const std::string some = courses_text(both, false, false);
  EXPECT_EQ(some.find(": 1 commit,"), std::string::npos) << some;
  EXPECT_NE(some.find("left out: 1 course of a single commit; --all shows them"), std::string::npos) << some;
  EXPECT_NE(courses_text(both, false, true).find(": 1 commit, 0 changes"), std::string::npos);
  std::ofstream(folder / "m" / "other.json") << "{}";
  EXPECT_THROW(read_courses(folder, {}), InputError);
}

// A speedup is a ratio within one run: machines that differ by a factor of two do not hide a loss of 3 %.
TEST(History, FindsALossOfSpeedupOverMachines) {
  const cscd::test::Folder scratch;
  for (int i = 0; i < 8; ++i) {
    ordered_json entry = entry_of(std::string(16, static_cast<char>('1' + i)),
                                  "2026-11-1" + std::to_string(i) + "T10:00:00+00:00", i % 2 == 0 ? 1 : 2);
    entry["environment"]["cpu"] = i % 2 == 0 ? "a machine" : "another machine";
    ordered_json& rows = entry["scenes"][0]["rows"];
    rows[0]["name"] = "base";
    const double factor = (i >= 5 ? 1.03 : 1) * (1 + 0.002 * (i % 3));  // and what repetitions differ by
    for (auto& [what, ms] : rows[1]["ms"]["total"].items()) ms = 0.1 * factor * ms.get<double>();
    if (i >= 6) rows[1]["counters"]["bvot"] = 1001;
    std::ofstream(scratch.path / (std::to_string(i) + ".json")) << json_text(entry);
  }
  const CourseChoice choice{"", "hand", "swift", std::string(kSpeedupStage)};
  const std::vector<Course> courses = read_courses(scratch.path, choice);
  ASSERT_EQ(courses.size(), 1u);
  EXPECT_EQ(courses[0].over, "base");
  EXPECT_EQ(courses[0].machine, "");
  ASSERT_EQ(courses[0].points.size(), 8u);
  EXPECT_NEAR(courses[0].points[0].value.value, 10, 1e-9);
  ASSERT_EQ(courses[0].changes.size(), 1u);
  EXPECT_EQ(courses[0].points[courses[0].changes[0].first].commit, "6666666666666666");
  const std::string text = speedups_text(courses);
  EXPECT_TRUE(says(text, "8 commits on 2 kinds of machine\n")) << text;
  EXPECT_TRUE(says(text, "swift over base: hand 10* to 9.")) << text;
  EXPECT_TRUE(says(text, "\n  from 6666666666 on: hand 1.03 times less\n")) << text;
  EXPECT_TRUE(says(text, "\n  from 7777777777 on: hand 1 counter\n")) << text;
  EXPECT_TRUE(says(courses_text(courses, true, false), "  <- bvot +0.1 %"));
  EXPECT_TRUE(says(courses_text(courses, true, false), " times* [")) << courses_text(courses, true, false);
  // Times are those of one machine.
  EXPECT_EQ(read_courses(scratch.path, {"", "hand", "swift", "total"}).size(), 2u);
}

}  // namespace
}  // namespace cscd::bench
