#include "bench/tables/filled_tables.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "bench/output/data.h"
#include "bench/output/json_text.h"
#include "bench/output/schema.h"
#include "bench/tables/claims.h"
#include "bench/tables/tables_json.h"
#include "core/base/split.h"
#include "core/base/test_refusal.h"

namespace cscd::bench {
namespace {

// Two strategies, two timed of three intervals, three repetitions; `swift` is three times as fast in every
// one.
Record sample_record() {
  Record record;
  record.environment = {{"cpu", "a, \"quoted\" machine"}, {"commit", "0123456789abcdef"}, {"dirty", false}};
  record.command = {"cscd", "run"};
  record.scene = {"rope", "A rope.", "00ff", 4, 8, 1, 4};
  record.elementary = "newton";
  record.intervals = 3;
  record.counted_intervals = {0, 1, 2};
  record.timed_intervals = {0, 2};
  record.verification.reference = "slow";
  record.verification.elementary = "exact";
  record.verification.intervals = {0, 1, 2};
  record.verification.strategies = {{"slow", "complete", 2, 2, 1, {}},
                                    {"swift", "first_contact", 2, 1, 1, {}}};
  StrategyRecord slow;
  slow.name = "slow";
  slow.guarantee = "complete";
  slow.counts = {{"bvot", {100, 200, 300}}};
  slow.digests = {"a", "b", "c"};
  slow.ms = {{"refit", {{1, 1}, {1, 1}, {1, 1}}}, {"traversal", {{6, 12}, {30, 60}, {3, 9}}}};
  StrategyRecord swift = slow;
  swift.name = "swift";
  swift.counts = {{"bvot", {10, 20, 30}}};
  swift.ms["traversal"] = {{1, 3}, {5, 15}, {1, 1}};
  swift.ms["rv_update"] = {{1, 1}, {5, 5}, {1, 1}};
  swift.preparation.decomposition_ms = {4, 2};
  swift.preparation.atomic_clusters = 7;
  record.strategies = {slow, swift};
  return record;
}

nlohmann::ordered_json one_column(const nlohmann::ordered_json& column) {
  return {{"tables", {{{"id", "t"}, {"title", "T"}, {"columns", {column}}}}}};
}

Cell cell(nlohmann::ordered_json column) {
  column["key"] = column["title"] = "k";
  const nlohmann::ordered_json published = {{"t", {{"rope", {{"k", 2.5}}}}}};
  const std::vector<Record> records = {sample_record()};
  return filled_tables(one_column(column), published, records).at(0).rows.at(0).cells.at(0);
}

TEST(FilledTables, PublishedFiguresStandBesideMeasuredOnes) {
  using Paths = std::vector<std::string>;
  const auto published = [](const Paths& paths) {
    return cell({{"quantity", "scene.triangles"}, {"published", paths}}).published;
  };
  EXPECT_EQ(published({"t.{scene}.k"}), 2.5);
  EXPECT_EQ(published({"t.{scene}.other", "t.{scene}.k"}), 2.5);
  EXPECT_FALSE(published({"t.{scene}.other"}));
  EXPECT_FALSE(cell({{"quantity", "scene.triangles"}}).published);
}

TEST(FilledTables, AColumnForEachStrategyOfTheRecords) {
  const std::vector<Record> records = {sample_record()};
  nlohmann::ordered_json definitions = one_column({{"key", "{strategy}.k"},
                                                   {"title", "{strategy} / swift"},
                                                   {"each_strategy", true},
                                                   {"quantity", "counts.bvot"},
                                                   {"strategy", "{strategy}"},
                                                   {"over", "swift"}});
  const FilledTable table = filled_tables(definitions, {}, records).at(0);
  ASSERT_EQ(table.columns.size(), 1u);  // none for a strategy beside itself
  EXPECT_EQ(table.columns[0].key, "slow.k");
  EXPECT_EQ(table.columns[0].title, "slow / swift");
  EXPECT_EQ(table.rows.at(0).cells.at(0).measured.value, 10);
}

// Times stand once for each pipeline, counters once. Mutation: figures of one pipeline under the other's
// name.
TEST(FilledTables, ShowBothPipelinesWhereTheyDiffer) {
  std::vector<Record> records = {sample_record(), sample_record()};
  records[1].pipeline = Pipeline::published;
  for (StrategyRecord& row : records[1].strategies)
    for (auto& repetition : row.ms["refit"])
      for (double& ms : repetition) ms *= 4;
  records[0].strategies.push_back(records[0].strategies[0]);
  records[0].strategies.back().name = "own";  // has no published twin
  nlohmann::ordered_json definitions =
      one_column({{"key", "refit"}, {"title", "refit"}, {"quantity", "ms.refit"}, {"strategy", "slow"}});
  auto& columns = definitions["tables"][0]["columns"];
  columns.push_back({{"key", "bvot"}, {"title", "bvot"}, {"quantity", "counts.bvot"}, {"strategy", "slow"}});
  columns.push_back({{"key", "own"}, {"title", "own"}, {"quantity", "counts.bvot"}, {"strategy", "own"}});
  const FilledTable table = filled_tables(definitions, {}, records).at(0);
  ASSERT_EQ(table.columns.size(), 4u);
  const std::vector<Cell>& cells = table.rows.at(0).cells;
  EXPECT_EQ(table.columns[0].pipeline, Pipeline::published);
  EXPECT_EQ(cells[0].measured.value, 4);
  EXPECT_EQ(table.columns[1].pipeline, Pipeline::vectorised);
  EXPECT_EQ(cells[1].measured.value, 1);
  EXPECT_EQ(table.columns[2].pipeline, std::nullopt);
  EXPECT_EQ(cells[2].measured.value, 200);
  EXPECT_EQ(table.columns[3].pipeline, Pipeline::vectorised);

  records.push_back(sample_record());
  records.back().scene.name = "hand";
  const FilledTable uneven = filled_tables(definitions, {}, records).at(0);
  EXPECT_EQ(uneven.rows.at(1).cells.at(0).measured.reason,
            "no record of hand in the pipeline published was given");
}

// The definitions that ship: every published figure has its column, and every column that names a published
// figure finds it.
TEST(FilledTables, ShippedDefinitionsCoverThePublishedFigures) {
  const nlohmann::ordered_json definitions = data_json("table_definitions.json"),
                               published = data_json("published.json");
  std::vector<std::string> named;
  for (const auto& table : definitions["tables"])
    for (const auto& column : table["columns"])
      for (const std::string path : column.value("published", nlohmann::ordered_json::array()))
        named.push_back(path);

  std::size_t figures = 0;
  for (const char* part : {"table1", "table2", "table3", "text"}) {
    const nlohmann::ordered_json flat = published[part].flatten();
    for (const auto& [pointer, figure] : flat.items()) {
      if (pointer.starts_with("/parameters") || !figure.is_number()) continue;
      std::string path = part;
      const std::vector<std::string> keys = split(pointer, '/');
      for (const std::string& key : std::span(keys).subspan(1))
        path += published["scenes"].contains(key) ? ".{scene}" : "." + key;
      EXPECT_NE(std::ranges::find(named, path), named.end()) << path;
      ++figures;
    }
  }
  std::vector<Record> records;
  for (const auto& [scene, sizes] : published["scenes"].items()) records.emplace_back().scene.name = scene;
  std::size_t shown = 0;
  for (const FilledTable& table : filled_tables(definitions, published, records))
    for (const Row& row : table.rows) {
      for (std::size_t i = 0; i < row.cells.size(); ++i)
        shown += row.cells[i].published && !table.columns[i].key.starts_with("triangles") &&
                 !table.columns[i].key.starts_with("vertices");
    }
  EXPECT_EQ(shown, figures);
}

TEST(Record, SurvivesBeingWrittenAndRead) {
  const Record record = sample_record();
  const std::string text = json_text(to_json(record));
  EXPECT_EQ(json_text(to_json(record_from(nlohmann::ordered_json::parse(text), "test"))), text);
}

TEST(Record, CallsAFileByAPlainNameBesideItsPath) {
  Record record = sample_record();
  record.scene.name = "hand_1";
  record.scene.path = "/models/hand 1.glb";
  const Record read = record_from(to_json(record), "test");
  EXPECT_EQ(read.scene.name, "hand_1");
  EXPECT_EQ(read.scene.path, "/models/hand 1.glb");
  EXPECT_EQ(schema_violation(to_json(record), "run.schema.json"), "");
}

TEST(FilledTables, ShowAnOwnSceneInPlaceOfThePapers) {
  Record record = sample_record();
  record.scene.path = "my/rope.json";  // has the name of one of the paper's
  for (StrategyRecord& row : record.strategies)
    for (auto& [stage, repetitions] : row.ms)
      repetitions.resize(5, repetitions.front());  // enough for claims
  const std::vector<Record> own = {record};
  std::size_t rows = 0;
  for (const FilledTable& table : filled_tables(own))
    for (const Row& row : table.rows) {
      ++rows;
      EXPECT_EQ(row.scene, "rope");
      for (const Cell& cell : row.cells) EXPECT_FALSE(cell.published) << table.id;
    }
  EXPECT_GT(rows, 4u);
  for (const ClaimResult& claim : judge_claims(own)) EXPECT_TRUE(claim.evidence.empty()) << claim.id;
  record.scene.path.clear();
  const std::vector<Record> papers = {record};
  EXPECT_TRUE(filled_tables(papers).front().rows.front().cells.front().published);
  for (const ClaimResult& claim : judge_claims(papers))
    if (claim.id == "bvot-fewest") {
      EXPECT_FALSE(claim.evidence.empty());
    }
}

TEST(Schema, HoldsForWhatIsWritten) {
  const std::vector<Record> records = {sample_record()};
  EXPECT_EQ(schema_violation(to_json(records[0]), "run.schema.json"), "");
  nlohmann::ordered_json document = tables_json(
      filled_tables(records), shaped_tables(filled_tables(records), records), judge_claims(records), records);
  EXPECT_EQ(schema_violation(document, "tables.schema.json"), "");
  EXPECT_NE(document.dump().find("\"marked\":true"), std::string::npos);
  document["tables"][0]["rows"][0]["cells"][1]["measured"] = "many";
  const std::string violation = schema_violation(document, "tables.schema.json");
  EXPECT_NE(violation.find("[measured]"), std::string::npos) << violation;
}

TEST(Record, RefusesWhatIsNotWhole) {
  const nlohmann::ordered_json whole = to_json(sample_record());
  const auto refusal = [](const nlohmann::ordered_json& document) -> std::string {
    return test::refusal([&] { record_from(document, "r.json"); });
  };
  EXPECT_EQ(refusal(whole), "");
  nlohmann::ordered_json other = whole, short_counts = whole, short_times = whole, keyless = whole;
  other["schema"] = "cscd.run/0";
  EXPECT_NE(refusal(other).find("its schema is cscd.run/0"), std::string::npos);
  short_counts["strategies"][0]["counts"]["bvot"].erase(0);
  EXPECT_NE(refusal(short_counts).find("counts of bvot"), std::string::npos);
  short_times["strategies"][1]["ms"]["refit"].erase(0);
  EXPECT_NE(refusal(short_times).find("times of"), std::string::npos);
  keyless.erase("verification");
  EXPECT_NE(refusal(keyless).find("r.json"), std::string::npos);
}

TEST(TablesJson, CsvHasOneLineACellAndQuotesCommas) {
  const std::vector<Record> records = {sample_record()};
  const nlohmann::ordered_json column = {
      {"key", "k"}, {"title", "swift, slow"}, {"quantity", "ms.traversal"}, {"strategy", "slow"}};
  nlohmann::ordered_json definitions = one_column(column);
  const auto tables = filled_tables(definitions, {}, records);
  EXPECT_EQ(tables_csv(tables),
            "table,scene,key,title,unit,published,measured,low,high,reason,pipeline,marked\n"
            "t,rope,k,\"swift, slow\",,,9,6,45,,today,\n");
}

}  // namespace
}  // namespace cscd::bench
