#include "bench/tables/shaped_table.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <span>
#include <string>
#include <vector>

#include "bench/tables/test_tables.h"

namespace cscd::bench {
namespace {

// The paper's Table 2 begins: rope, 0.07, 0.16, 0.03, 0.22, 28.4, 18.9x, 6.0x. Mutation: another order of
// columns.
TEST(ShapedTables, HaveThePapersRowsColumnsAndOrder) {
  const std::vector<ShapedTable> tables = shaped_of(wide_records({"rope"}));
  ASSERT_EQ(tables.size(), 4u);
  EXPECT_EQ(tables[3].id, "strategies");
  using Cells = std::vector<std::string>;
  for (const ShapedTable& table : std::span(tables).first(3)) {
    ASSERT_EQ(table.lines.size(), 2u) << table.id;
    EXPECT_EQ(table.lines[0].scene, "rope");
    EXPECT_EQ(table.lines[0].kind, "measured");
    EXPECT_EQ(table.lines[1].kind, "published");
    EXPECT_TRUE(std::ranges::none_of(table.lines[0].cells, &std::string::empty)) << table.id;
  }
  EXPECT_EQ(tables[0].lines[1].cells, (Cells{"48,440", "24,222", "21.5", "30", "100", "3", "83", "6.8",
                                             "28.4", "199", "95", "53", "38 [2, 76]"}));
  EXPECT_EQ(tables[1].lines[1].cells, (Cells{"0.07", "0.16", "0.03", "0.22", "28.4", "18.9", "6"}));
  EXPECT_EQ(tables[2].lines[1].cells, (Cells{"260.1", "25.4", "6.1", "11", "39", "56.1", "99.1", "13.9",
                                             "6.8", "5.4", "16.2", "28.4", "2"}));
}

// Mutation: `today` wins where there are records of both pipelines.
TEST(ShapedTables, ShowThePapersCodeWhereItWasMeasuredAndOthersBelow) {
  std::vector<Record> records = wide_records({"rope"});
  records.push_back(wide_record("rope_contact", Pipeline::vectorised));
  const ShapedTable times = shaped_of(records)[2];
  ASSERT_EQ(times.lines.size(), 3u);
  EXPECT_FALSE(times.lines[0].of_today);
  EXPECT_TRUE(times.begins_today(2));
  EXPECT_EQ(times.lines[2].kind, "") << "nothing was published of it";
  const std::vector<Record> alone = {records[0]};
  EXPECT_NE(shaped_of(alone)[2].lines[0].cells, times.lines[0].cells);
}

TEST(ShapedTables, LeaveOutWhatWasNotMeasured) {
  std::vector<Record> records = wide_records({"rope"});
  for (Record& record : records)
    std::erase_if(record.strategies, [](const StrategyRecord& row) { return row.name == "mcd"; });
  const ShapedTable hierarchies = shaped_of(records)[1];
  EXPECT_EQ(hierarchies.lines[0].cells[1], "");
  EXPECT_NE(hierarchies.lines[0].cells[0], "");
  for (Record& record : records)
    std::erase_if(record.strategies, [](const StrategyRecord& row) { return row.name != "base"; });
  ASSERT_EQ(shaped_of(records).size(), 1u);
  EXPECT_EQ(shaped_of(records)[0].lines.size(), 1u) << "what a query takes base";
}

TEST(ShapedTables, HaveIntervalsOnRequestAlone) {
  const ShapedTable times = shaped_of(wide_records({"rope"}), true)[2];
  ASSERT_EQ(times.lines.size(), 4u);
  EXPECT_EQ(times.lines[1].kind, "low");
  EXPECT_EQ(times.lines[2].kind, "high");
  EXPECT_EQ(times.lines[1].cells[0], "") << "counters have no interval";
  EXPECT_LT(std::stod(times.lines[1].cells[2]), std::stod(times.lines[2].cells[2]));
}

// A time of a strategy that lost a contact carries its mark wherever it is printed, and ratios with it do.
// Mutation: the divisor's mark is forgotten.
TEST(ShapedTables, MarkTimesOfStrategiesThatLostContacts) {
  std::vector<Record> records = wide_records({"rope"});
  EXPECT_FALSE(shaped_of(records)[2].has_marks());
  for (Record& record : records) record.verification.strategies = {{"drvbc", "first_contact", 5, 4, 5, {}}};
  const std::vector<ShapedTable> tables = shaped_of(records);
  EXPECT_FALSE(tables[0].has_marks()) << "preparation and counters are no times of queries";
  EXPECT_FALSE(tables[1].lines[0].cells[0].ends_with(kShortfallMark));
  for (const std::size_t i : {4, 5, 6})
    EXPECT_TRUE(tables[1].lines[0].cells[i].ends_with(kShortfallMark)) << i;
  EXPECT_FALSE(tables[2].lines[0].cells[5].ends_with(kShortfallMark)) << "rvbc";
  EXPECT_TRUE(tables[2].lines[0].cells[11].ends_with(kShortfallMark)) << "drvbc";
  EXPECT_TRUE(shaped_of(records).back().has_marks());
}

// Mutations: records of the pipeline `published` are listed; the scenes with contacts stand among the others.
TEST(PageLists, ShowQuantitiesDownAndScenesAcross) {
  std::vector<Record> records = wide_records({"rope", "hand"});
  records.push_back(wide_record("rope_contact", Pipeline::vectorised));
  for (Record& record : records)
    record.verification.strategies = {{"drvbc_fast", "first_contact", 5, 4, 5, {}}};
  const std::vector<ShapedTable> lists = page_lists(records);
  const auto list = [&](const std::string& id) {
    const auto found = std::ranges::find(lists, id, &ShapedTable::id);
    return found == lists.end() ? ShapedTable() : *found;
  };
  const ShapedTable plain = list("headline"), contacts = list("headline_contacts");
  ASSERT_EQ(plain.columns.size(), 2u);
  EXPECT_EQ(plain.columns[1].head, "hand");
  ASSERT_EQ(plain.lines.size(), 4u);
  EXPECT_EQ(plain.lines[0].scene, "**one query of `drvbc_fast`, ms**: the median interval");
  const Measured fast = median_query("drvbc_fast", records[0]);
  EXPECT_EQ(plain.lines[0].cells[0], text_of(fast, true));
  EXPECT_TRUE(plain.lines[0].cells[0].ends_with("]*"));
  EXPECT_TRUE(plain.lines[1].cells[0].ends_with("]*, `base`")) << "the best baseline";
  EXPECT_TRUE(plain.lines[3].cells[0].ends_with("] (18.9)")) << "published";
  ASSERT_EQ(contacts.columns.size(), 1u);
  EXPECT_EQ(contacts.columns[0].head, "rope_contact");
  EXPECT_EQ(contacts.lines[1].scene, "the mean of all timed intervals, ms");
  EXPECT_EQ(list("door").lines.size(), 1u) << "rows that were not run have no lines";
  EXPECT_EQ(list("cloth").lines[1].cells, plain.lines[0].cells);
  EXPECT_EQ(list("speed").lines[1].scene,
            "all contacts, drvbc_fast_complete: times faster than the best complete baseline");
}

TEST(PageLists, SayWhereThereIsNoFigure) {
  std::vector<Record> records = {wide_record("bag", Pipeline::vectorised),
                                 wide_record("sheet", Pipeline::vectorised)};
  std::erase_if(records[1].strategies, [](const StrategyRecord& row) { return row.name == "drvbc_fast"; });
  for (const ShapedTable& list : page_lists(records))
    if (list.id == "cloth") {
      EXPECT_EQ(list.lines[1].cells[1], "open");
      EXPECT_NE(list.lines[1].cells[0], "open");
      return;
    }
  FAIL() << "no list of cloth";
}

TEST(ShapedTables, MarkTimesWhereAPromiseDoesNotHold) {
  Record record = wide_record("rope", Pipeline::vectorised);
  record.verification.strategies = {{"base", "complete", 0, 0, 0, {}},
                                    {"drvbc", "first_contact", 0, 0, 0, {}}};
  EXPECT_FALSE(median_query("drvbc", record).marked);
  record.verification.unembedded = {0};
  EXPECT_TRUE(median_query("drvbc", record).marked);
  EXPECT_FALSE(median_query("base", record).marked);
}

}  // namespace
}  // namespace cscd::bench
