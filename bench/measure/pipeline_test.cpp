// The pipeline `published`: the paper's code around every method of the paper, which changes times and
// nothing that is counted.
#include "core/base/pipeline.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bench/harness/contestant.h"
#include "bench/strategies/catalogue.h"
#include "bench/testing/test_shell.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

Answered answered(const Strategy& strategy, const StrategyInput& setup,
                  const scenes::ClipInterval& interval) {
  Answered out;
  out.report = strategy.make(setup).detector->detect({interval.motion, &*interval.bones}, out.found);
  out.found.sort();
  return out;
}

bool has_line(const std::string& text, const std::string& begin, const std::string& end) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(begin) && line.ends_with(end)) return true;
  return false;
}

void expect_same_counters(const Report& a, const Report& b, const std::string& of) {
  EXPECT_EQ(a.cull.bvot, b.cull.bvot) << of;
  EXPECT_EQ(a.cull.pctp, b.cull.pctp) << of;
  EXPECT_EQ(a.cull.contour_box_tests, b.cull.contour_box_tests) << of;
  EXPECT_EQ(a.pairs.adjacent_pctp, b.pairs.adjacent_pctp) << of;
  EXPECT_EQ(a.pairs.relative_dropped, b.pairs.relative_dropped) << of;
  EXPECT_EQ(a.pairs.feature_pairs, b.pairs.feature_pairs) << of;
  ASSERT_EQ(a.cull.radial.has_value(), b.cull.radial.has_value()) << of;
  if (!a.cull.radial) return;
  EXPECT_EQ(a.cull.radial->positive, b.cull.radial->positive) << of;
  EXPECT_EQ(a.cull.radial->negative, b.cull.radial->negative) << of;
  EXPECT_EQ(a.cull.radial->uncertain, b.cull.radial->uncertain) << of;
  EXPECT_EQ(a.cull.radial->clusters, b.cull.radial->clusters) << of;
}

// Mutation: scalar code that classifies towards the observer of another cluster, or a bound that is drawn in.
TEST(Pipeline, ChangesNothingThatTheMethodCounts) {
  const ElementaryTest& exact = elementary_test_named("exact");
  std::size_t rows = 0, contacts = 0;
  std::uint64_t left_today = 0, left_published = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    scenes::RandomInterval random = scenes::make_random_interval(seed);
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    const std::optional<Rig> rig = scenes::rig_of(random.clip);
    const scenes::ClipInterval interval = random.clip.interval(0);
    for (const Strategy& strategy : strategies()) {
      if (strategy.kind != StrategyKind::published) continue;
      StrategyInput setup{mesh, random.clip.frame(0).positions, &*rig, exact};
      const Answered today = answered(strategy, setup, interval);
      setup.pipeline = Pipeline::published;
      const Answered published = answered(strategy, setup, interval);
      const std::string of = std::string(strategy.name) + ", seed " + std::to_string(seed);
      expect_same_counters(today.report, published.report, of);
      for (const Contact& contact : published.found.contacts)
        EXPECT_TRUE(std::ranges::any_of(today.found.contacts,
                                        [&](const Contact& other) { return other.pair == contact.pair; }))
            << of << ": a contact that today's pipeline does not have";
      left_today += today.report.pairs.elementary_tests;
      left_published += published.report.pairs.elementary_tests;
      contacts += published.found.contacts.size();
      ++rows;
    }
  }
  EXPECT_GE(rows, 200u);
  EXPECT_GT(contacts, 300u);
  EXPECT_GT(left_published, left_today) << "the filter of today goes on behind the published one";
}

class PipelineRun : public Program {};

TEST_F(PipelineRun, IsNamedByRecordsTablesAndClaims) {
  const std::string cscd_run =
      "cscd run --scene small --strategy base,mcd,rvbc,drvbc --repetitions 2 --json ";
  const Ran ran =
      run(cscd_run + "today.json && " + cscd_run +
          "published.json --pipeline published && cscd tables today.json published.json --out . && "
          "cscd report today.json published.json -o site");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const auto today = nlohmann::json::parse(text("today.json")),
             published = nlohmann::json::parse(text("published.json"));
  EXPECT_EQ(today["pipeline"], "today");
  EXPECT_EQ(published["pipeline"], "published");
  EXPECT_TRUE(published["verification"]["ok"]);
  EXPECT_NE(published["command"].dump().find(R"("--pipeline","published")"), std::string::npos);
  for (std::size_t s = 0; s < today["strategies"].size(); ++s)
    for (const char* counter : {"bvot", "pctp", "feature_pairs", "contacts"})
      EXPECT_EQ(today["strategies"][s]["counts"][counter], published["strategies"][s]["counts"][counter]);

  const std::string page = text("tables.md"), csv = text("tables.csv");
  EXPECT_NE(page.find("| small, published |"), std::string::npos) << page;
  EXPECT_NE(page.find("| small, today |"), std::string::npos) << page;
  for (const char* pipeline : {"published", "today"}) {
    EXPECT_TRUE(has_line(csv, "beside,small,base.refit,", "," + std::string(pipeline) + ",")) << csv;
  }
  EXPECT_TRUE(has_line(csv, "beside,small,base.pctp,", ",both,")) << "counters stand once";

  // A record without the field is an old one.
  nlohmann::json old = today;
  old.erase("pipeline");
  put("old.json", old.dump());
  const Ran read = run("cscd tables old.json");
  EXPECT_EQ(read.status, 0) << read.errors;
  EXPECT_NE(read.out.find("(pipeline today)"), std::string::npos) << read.out;
  expect_refused(run("cscd tables old.json today.json"), "in the pipeline today");
}

TEST_F(PipelineRun, RefusesWhatThePaperDoesNotHave) {
  const std::string begin = "cscd run --scene small --json r.json --pipeline ";
  expect_refused(run(begin + "published --strategy drvbc_fast"), "not of the paper");
  expect_refused(run(begin + "published --elementary cubic"), "leave --elementary out");
  expect_refused(run(begin + "tomorrow"), "tomorrow not in {today,published}");
  EXPECT_EQ(files(), "");
}

// A folder that scripts/reproduce wrote holds tables.json.gz too. Mutation: what is no record of a run is
// read.
TEST_F(PipelineRun, TablesAndReportsTakeAFolder) {
  const Ran made = run(
      "mkdir results && cscd run --scene small --strategy base,mcd,drvbc,drvbc_fast --repetitions 2 --json "
      "results/r.json.gz && cscd tables results --out results && gzip results/tables.json");
  ASSERT_EQ(made.status, 0) << made.errors;
  const Ran folder = run("cscd tables results"), files = run("cscd tables results/*.json.gz");
  EXPECT_EQ(folder.status, 0) << folder.errors;
  EXPECT_EQ(folder.errors, "");
  EXPECT_NE(folder.out.find("Table 3. "), std::string::npos) << folder.out;
  EXPECT_EQ(files.status, 0) << files.errors;
  EXPECT_NE(files.errors.find("left out: results/tables.json.gz"), std::string::npos) << files.errors;
  EXPECT_EQ(folder.out.substr(0, folder.out.rfind('\n', folder.out.size() - 2)),
            files.out.substr(0, files.out.rfind('\n', files.out.size() - 2)))
      << "but for the place of the page";
  EXPECT_NE(run("cscd tables results --intervals").out.find(" low "), std::string::npos);
  EXPECT_EQ(folder.out.find(" low "), std::string::npos);
  const Ran report = run("cscd report results/ -o results/site && cscd tables results");
  EXPECT_EQ(report.status, 0) << report.errors;
  EXPECT_NE(report.out.find("page        cscd report results"), std::string::npos) << report.out;
  expect_refused(run("mkdir none && cscd tables none"), "none holds no record of cscd run");
  expect_refused(run("cscd tables results/tables.json.gz"), "holds no record of cscd run");
  expect_refused(run("echo '{' >results/broken.json; cscd tables results"),
                 "broken.json: is no JSON and so no record");
  expect_refused(run("cscd tables nowhere"), "nowhere");
}

}  // namespace
}  // namespace cscd::bench
