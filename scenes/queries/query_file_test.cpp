#include "scenes/queries/query_file.h"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gmpxx.h>
#include <gtest/gtest.h>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/split.h"
#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"
#include "core/elementary/certified/filtered_exact.h"
#include "core/elementary/exact/exact.h"

namespace cscd {

namespace {

// A file that exists as long as this object.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& text) { test::write(path(), text); }
  std::filesystem::path path() const { return folder_ / "queries.csv"; }

 private:
  test::Folder folder_;
};

std::string repeated(const std::string& row, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += row + "\n";
  return text;
}

std::string error_of(const std::string& text) {
  const ScratchFile file(text);
  const std::string what = test::refusal([&] { read_queries(file.path()); });
  EXPECT_NE(what.find(file.path().filename().string()), std::string::npos) << text.substr(0, 200);
  return what;
}

void expect_error(const std::string& text, const std::string& place, const std::string& reason) {
  const std::string what = error_of(text);
  EXPECT_NE(what.find(place), std::string::npos) << what;
  EXPECT_NE(what.find(reason), std::string::npos) << what;
  EXPECT_NE(what.find("; "), std::string::npos) << "says how to mend it: " << what;
}

TEST(QueryFile, ReadsPointsInOrder) {
  std::string text;
  for (int row = 0; row < 16; ++row)
    text +=
        std::to_string(row) + ",1,-3,4," + std::to_string(10 * row) + ",8," + (row < 8 ? "1" : "0") + "\r\n";
  text.resize(text.size() - 2);  // the last line may lack its end
  const ScratchFile file(text);
  const std::vector<Query> queries = read_queries(file.path());
  ASSERT_EQ(queries.size(), 2u);
  EXPECT_EQ(queries[0].truth, true);
  EXPECT_EQ(queries[1].truth, false);
  for (std::size_t q = 0; q < 2; ++q)
    for (std::size_t i = 0; i < 4; ++i) {
      const double row = static_cast<double>(8 * q + i);
      EXPECT_EQ(queries[q].points[i].start, Vec3(row, -0.75, 1.25 * row));
      EXPECT_EQ(queries[q].points[i].end, Vec3(row + 4, -0.75, 1.25 * (row + 4)));
    }
  const MovingVertexFace vf = as_vertex_face(queries[0]);
  EXPECT_EQ(vf.vertex.start.x(), 0);
  EXPECT_EQ(vf.corner[2].end.x(), 7);
  const MovingEdgeEdge ee = as_edge_edge(queries[0]);
  EXPECT_EQ(ee.first[1].start.x(), 1);
  EXPECT_EQ(ee.second[0].end.x(), 6);
}

TEST(QueryFile, TruthIsOptional) {
  const ScratchFile file(repeated("1,2,3,4,5,8", 8));
  const std::vector<Query> queries = read_queries(file.path());
  ASSERT_EQ(queries.size(), 1u);
  EXPECT_FALSE(queries[0].truth);
}

TEST(QueryFile, KeepsEveryDoubleExactly) {
  const std::string least = "1," + mpz_class(mpz_class(1) << 1074).get_str();
  const std::string largest = mpz_class(((mpz_class(1) << 53) - 1) << 971).get_str() + ",1";
  // The numerator and the denominator share a large factor that is not a power of two.
  const std::string unreduced =
      mpz_class(-3 * (mpz_class(7) << 2000)).get_str() + "," + mpz_class(mpz_class(7) << 2001).get_str();
  const ScratchFile file(repeated(least + "," + largest + "," + unreduced, 8));
  const Vec3 p = read_queries(file.path()).at(0).points[3].end;
  EXPECT_EQ(p, Vec3(0x1p-1074, 0x1.fffffffffffffp+1023, -1.5));
}

TEST(QueryFile, NamesWhatIsWrongAndWhere) {
  const std::string good = "1,2,3,4,5,8,1";
  const auto second_row = [&](const std::string& row) {
    return good + "\n" + row + "\n" + repeated(good, 6);
  };
  expect_error(second_row("1,2,3,4,5"), "line 2", "5 columns");
  expect_error(second_row("1,2,3,4,5,8,1,1"), "line 2", "8 columns");
  expect_error(second_row("1,2,3,4,5,8"), "line 2", "6 columns");
  expect_error(second_row("1,2,x,4,5,8,1"), "line 2", "'x' is not an integer");
  expect_error(second_row("1,2,0.5,4,5,8,1"), "line 2", "'0.5' is not an integer");
  expect_error(second_row("1,2,,4,5,8,1"), "line 2", "'' is not an integer");
  expect_error(second_row("1,2,3 3,4,5,8,1"), "line 2", "'3 3' is not an integer");
  expect_error(second_row("1,2,-,4,5,8,1"), "line 2", "'-' is not an integer");
  expect_error(second_row("1,2,-inf,4,5,8,1"), "line 2", "not finite");
  expect_error(second_row("1,2,NaN,1,5,8,1"), "line 2", "not finite");
  expect_error(second_row("1,2,3,0,5,8,1"), "line 2", "denominator");
  expect_error(second_row("1,3,3,4,5,8,1"), "line 2", "not exactly a double");
  expect_error(second_row("9007199254740993,1,3,4,5,8,1"), "line 2", "not exactly a double");
  expect_error(second_row("1," + mpz_class(mpz_class(1) << 1075).get_str() + ",3,4,5,8,1"), "line 2",
               "not exactly a double");
  expect_error(second_row(mpz_class(mpz_class(1) << 1024).get_str() + ",1,3,4,5,8,1"), "line 2",
               "largest double");
  expect_error(second_row("1,2,3,4,5,8,2"), "line 2", "neither 0 nor 1");
  expect_error(second_row("1,2,3,4,5,8,0"), "line 2", "truth differs");
  expect_error(second_row("\n" + good), "line 2", "empty");
  expect_error(repeated(good, 7), "line 7", "7 rows");
  expect_error(repeated(good, 9), "line 9", "9 rows");
  expect_error("", ".csv", "no rows");
  expect_error("\n\n", ".csv", "no rows");
}

TEST(QueryFile, RefusesWhatIsNoFile) {
  EXPECT_THROW(read_queries(std::filesystem::temp_directory_path()), InputError);
  EXPECT_THROW(read_queries(std::filesystem::temp_directory_path() / "cscd-no-such-file.csv"), InputError);
}

TEST(QueryFile, SurvivesDamage) {
  // Any damaged file is either read or refused with an InputError.
  constexpr unsigned seed = 3;
  std::mt19937_64 random(seed);
  const std::string alphabet = "0123456789,-\n\r .eNax\t\"" + std::string(1, '\0') + "\xff";
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::string text = repeated("12,8,-3,4,5,16,1", 8);
    for (int edits = 1 + i % 3; edits > 0; --edits)
      text[random() % text.size()] = alphabet[random() % alphabet.size()];
    if (i % 5 == 0) text.resize(random() % text.size());
    const ScratchFile file(text);
    try {
      EXPECT_EQ(read_queries(file.path()).size(), 1u);
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 100) << "seed " << seed;
}

TEST(QueryFile, WhatIsWrittenIsReadBackBitForBit) {
  std::mt19937_64 random(3);
  const double values[] = {0, -1, 0.1, 1e-300, -0x1p-1074, 1e150, 0x1.fffffffffffffp1023, 1.0 / 3};
  std::vector<Query> queries(20);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    queries[i].truth = i % 3 == 0;
    for (MovingPoint& p : queries[i].points)
      for (Vec3* x : {&p.start, &p.end})
        for (int axis = 0; axis < 3; ++axis) (*x)[axis] = values[random() % std::size(values)];
  }
  const ScratchFile file(query_text(queries));
  const std::vector<Query> read = read_queries(file.path());
  ASSERT_EQ(read.size(), queries.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].truth, queries[i].truth);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(read[i].points[k].start, queries[i].points[k].start);
      EXPECT_EQ(read[i].points[k].end, queries[i].points[k].end);
    }
  }
}

std::optional<std::filesystem::path> find_query_set() {
  if (const char* chosen = std::getenv("CSCD_QUERIES")) return chosen;
  for (std::filesystem::path at = std::filesystem::current_path();; at = at.parent_path()) {
    if (std::filesystem::exists(at / "shared/queries/index.csv")) return at / "shared/queries";
    if (at == at.parent_path()) return std::nullopt;
  }
}

// One line of index.csv.
struct Entry {
  std::string file, group, kind;
  std::size_t row;
  bool collides;
};

std::vector<Entry> read_index(const std::filesystem::path& set) {
  std::ifstream stream(set / "index.csv");
  std::vector<Entry> entries;
  std::string line;
  std::getline(stream, line);  // the names of the columns
  while (std::getline(stream, line)) {
    const std::vector<std::string> cells = split(line, ',');
    entries.push_back({cells.at(0), cells.at(2), cells.at(3), std::stoul(cells.at(1)), cells.at(6) == "1"});
  }
  return entries;
}

// Reads lines "row hit t_lo t_hi d_lo d_hi flags". Returns the published bounds d_lo <= t* <= d_hi by row.
std::map<std::size_t, exact::TimeEnclosure> read_times(const std::filesystem::path& set, std::string file) {
  file.resize(file.size() - std::string(".csv").size());
  for (std::size_t slash; (slash = file.find('/')) != std::string::npos;) file.replace(slash, 1, "__");
  std::ifstream stream(set / "toi" / (file + ".toi"));
  std::map<std::size_t, exact::TimeEnclosure> times;
  for (std::string line; std::getline(stream, line);) {
    const std::vector<std::string> words = split(line, ' ');
    if (words.at(1) == "1")
      times[std::stoul(words.at(0))] = {std::strtod(words.at(4).c_str(), nullptr),
                                        std::strtod(words.at(5).c_str(), nullptr)};
  }
  return times;
}

struct Tally {
  int queries = 0, contacts = 0, wrong = 0, wrong_time = 0, same_time = 0;
  std::array<int, 4> stages{};  // queries that ended in each stage of filtered_exact
};

// filtered_exact must give the oracle's verdict and the same double as its time.
template <class Query>
void expect_filtered_exact_agrees(const Query& query, Answer (&test)(const Query&),
                                  const std::optional<exact::TimeEnclosure>& oracle, Tally& tally) {
  const Answer answer = test(query);
  ++tally.stages[static_cast<std::size_t>(filtered_exact_stage(query))];
  EXPECT_EQ(answer.verdict, oracle ? Verdict::contact : Verdict::apart);
  if (oracle) {
    EXPECT_EQ(answer.time, oracle->lo);
  }
}

// Compares the oracle and `filtered_exact` with the open query set and its published truths (see the
// README of that folder). The set is found through CSCD_QUERIES, or as shared/queries in the current folder
// or one above. Without the set the test is skipped.
TEST(QuerySet, EveryPublishedTruthIsMet) {
  const auto set = find_query_set();
  if (!set) GTEST_SKIP() << "no query set: set CSCD_QUERIES to its folder";
  std::map<std::string, std::vector<Query>> queries;
  std::map<std::string, std::map<std::size_t, exact::TimeEnclosure>> times;
  std::map<std::string, Tally> tallies;
  for (const Entry& entry : read_index(*set)) {
    if (!queries.contains(entry.file)) {
      queries[entry.file] = read_queries(*set / entry.file);
      times[entry.file] = read_times(*set, entry.file);
    }
    const Query& query = queries[entry.file].at(entry.row);
    SCOPED_TRACE(entry.file + ", query " + std::to_string(entry.row));
    const auto answer = entry.kind == "vf" ? exact::first_contact(as_vertex_face(query))
                                           : exact::first_contact(as_edge_edge(query));
    Tally& tally = tallies[entry.group + " " + entry.kind];
    ++tally.queries;
    tally.contacts += entry.collides;
    if (entry.kind == "vf")
      expect_filtered_exact_agrees(as_vertex_face(query), filtered_exact_vertex_face, answer, tally);
    else
      expect_filtered_exact_agrees(as_edge_edge(query), filtered_exact_edge_edge, answer, tally);
    if (query.truth) {
      EXPECT_EQ(*query.truth, entry.collides) << "the set contradicts itself";
    }
    EXPECT_EQ(answer.has_value(), entry.collides);
    tally.wrong += answer.has_value() != entry.collides;
    if (!answer || !entry.collides) continue;
    EXPECT_LE(answer->hi - answer->lo, 0x1p-50);
    ASSERT_TRUE(times[entry.file].contains(entry.row));
    const exact::TimeEnclosure expected = times[entry.file][entry.row];
    const bool overlap = answer->lo <= expected.hi && expected.lo <= answer->hi;
    EXPECT_TRUE(overlap) << answer->lo << " .. " << answer->hi << ", published " << expected.lo << " .. "
                         << expected.hi;
    tally.wrong_time += !overlap;
    tally.same_time += answer->lo == expected.lo && answer->hi == expected.hi;
  }
  EXPECT_FALSE(tallies.empty());
  for (const auto& [name, tally] : tallies)
    std::cout << name << ": " << tally.queries << " queries, " << tally.contacts << " contacts, "
              << tally.wrong << " wrong answers, " << tally.wrong_time << " wrong times, " << tally.same_time
              << " times with the published bounds exactly; filtered_exact decided " << tally.stages[0]
              << " by filters, " << tally.stages[1] << " in doubles, " << tally.stages[2] << " in integers, "
              << tally.stages[3] << " by the oracle\n";
}

}  // namespace

}  // namespace cscd
