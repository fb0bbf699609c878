#include "bench/records/shortfall.h"

#include <gtest/gtest.h>

namespace cscd::bench {
namespace {

// Three verified intervals, one of which does not start embedded, and two contacts.
Record record_of(const VerifiedStrategy& row) {
  Record record;
  record.scene.name = "rope";
  record.verification.intervals = {0, 1, 2};
  record.verification.unembedded = {1};
  record.verification.strategies = {row};
  record.strategies.emplace_back().name = row.name;
  return record;
}

TEST(Shortfall, IsOfRowsThatLoseContactsOrPromiseNothing) {
  const auto text = [](const VerifiedStrategy& row) {
    const auto lacking = shortfall(record_of(row), row.name);
    return lacking ? shortfall_text(*lacking) : "";
  };
  EXPECT_EQ(text({"a", "complete", 2, 2, 1, {}}), "");
  EXPECT_EQ(text({"a", "heuristic", 2, 2, 0, {}}), "");
  EXPECT_EQ(text({"a", "heuristic", 2, 1, 0, {}}), "kept 1 of 2 contacts");
  EXPECT_EQ(text({"a", "all_from_embedded", 2, 2, 1, {}}), "promise void on 1 of 3 intervals");
  EXPECT_EQ(text({"a", "first_contact", 2, 1, 1, {}}),
            "kept 1 of 2 contacts; promise void on 1 of 3 intervals");
}

TEST(Shortfall, SaysNothingOfRowsThatWereNotVerified) {
  EXPECT_FALSE(shortfall(record_of({"a", "first_contact", 2, 1, 1, {}}), "b"));
}

TEST(Shortfall, HasANoteForAllRecordsTogether) {
  const Record whole = record_of({"a", "complete", 2, 2, 1, {}}),
               less = record_of({"b", "first_contact", 2, 2, 1, {}});
  EXPECT_EQ(shortfall_note({&whole, 1}), "");
  const std::vector<Record> both = {whole, less};
  const std::string note = shortfall_note(both);
  EXPECT_EQ(note.find(kShortfallMark), 0u);
  EXPECT_NE(note.find("crosses itself"), std::string::npos) << note;
  EXPECT_NE(note.find("- rope, pipeline today: b (promise void on 1 of 3 intervals)\n"), std::string::npos)
      << note;
  EXPECT_EQ(note.find("a ("), std::string::npos) << note;
}

}  // namespace
}  // namespace cscd::bench
