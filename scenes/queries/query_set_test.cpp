// Compares the referee and `filtered_exact` with the open query set and its published truths (see the
// README of that folder). The set is found through CSCD_QUERIES, or as shared/queries in the current folder
// or one above. Without the set the test is skipped.
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iostream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "core/elementary/certified/filtered_exact.h"
#include "core/elementary/exact/exact.h"
#include "scenes/queries/query_file.h"

namespace cscd {
namespace {

std::optional<std::filesystem::path> find_query_set() {
  if (const char* chosen = std::getenv("CSCD_QUERIES")) return chosen;
  for (std::filesystem::path at = std::filesystem::current_path();; at = at.parent_path()) {
    if (std::filesystem::exists(at / "shared/queries/index.csv")) return at / "shared/queries";
    if (at == at.parent_path()) return std::nullopt;
  }
}

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, separator);) cells.push_back(cell);
  return cells;
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

// filtered_exact must give the referee's verdict and the same double as its time.
template <class Query>
void expect_filtered_exact_agrees(const Query& query, Answer (&test)(const Query&),
                                  const std::optional<exact::TimeEnclosure>& referee, Tally& tally) {
  const Answer answer = test(query);
  ++tally.stages[static_cast<std::size_t>(filtered_exact_stage(query))];
  EXPECT_EQ(answer.verdict, referee ? Verdict::contact : Verdict::apart);
  if (referee) {
    EXPECT_EQ(answer.time, referee->lo);
  }
}

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
              << tally.stages[3] << " by the referee\n";
}

}  // namespace
}  // namespace cscd
