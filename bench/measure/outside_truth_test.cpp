#include "bench/inputs/outside_truth.h"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "bench/inputs/input.h"
#include "bench/output/gzip.h"
#include "bench/strategies/catalogue.h"
#include "bench/testing/test_shell.h"
#include "scenes/catalog/scene.h"
#include "scenes/clip/point_cache.h"

// Truth from outside is a gate of `cscd run`: a table beside a point cache decides whether the run passes.
namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

constexpr char kHead[] = "kind,v0,v1,v2,v3,truth,shares_vertex\n";
// Vertex 3 passes through triangle 0 1 2, and nothing else touches. Corners and ends stand in any order.
constexpr char kRight[] = "vf,3,2,0,1,1,0\nvf,4,0,1,2,0,0\nee,4,3,1,0,0,0\nee,0,1,1,2,1,1\n";

class TruthBesideCache : public Program {
 protected:
  static constexpr char kRun[] =
      "cscd run --input step.h5 --strategy base,drvbc_fast_complete --repetitions 1 ";

  // A triangle that a corner of another one passes through in each of the steps.
  void put_cache(std::size_t steps = 1) const {
    scenes::ClipHeader header;
    header.vertex_count = 6;
    header.triangles = {{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{3}, VertexId{4}, VertexId{5}}};
    scenes::PointCacheWriter writer(folder / "step.h5", header, true);
    for (std::size_t frame = 0; frame <= steps; ++frame) {
      const double z = frame % 2 == 0 ? 1 : -1;
      const std::vector<Vec3> positions = {{0, 0, 0},     {1, 0, 0},         {0, 1, 0},
                                           {0.2, 0.2, z}, {0.2, 0.2, z + 4}, {0.3, 0.2, z + 4}};
      writer.append({positions, {}});
    }
    writer.finish();
  }
  void put_truth(const std::string& lines) const { put("step.truth.csv.gz", gzipped(kHead + lines)); }
  ordered_json truth_of(const std::string& record) const {
    return ordered_json::parse(text(record)).at("verification").value("truth", ordered_json());
  }
};

TEST_F(TruthBesideCache, IsHeldAgainstAndSaidInTheRecord) {
  put_cache();
  ASSERT_EQ(run(std::string(kRun) + "--json without.json").status, 0);
  EXPECT_EQ(truth_of("without.json"), ordered_json());
  put_truth(kRight);
  const Ran ran = run(std::string(kRun) + "--json right.json && cscd tables right.json");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_NE(ran.out.find("held against step.truth.csv.gz (3 pairs, 1 contacts): 0 missed, 0 invented\n"),
            std::string::npos)
      << ran.out;
  EXPECT_EQ(truth_of("right.json"),
            ordered_json::parse(R"({"file": "step.truth.csv.gz", "pairs": 3, "contacts": 1, "missed": 0,
                                    "invented": 0, "differences": []})"));
}

// Mutation: VerificationRecord::ok() does not look at the truth.
TEST_F(TruthBesideCache, FailsARunThatMissesOrInvents) {
  put_cache();
  const struct {
    std::string lines;
    int missed, invented;
    std::string difference;
  } cases[] = {{std::string(kRight) + "ee,5,4,2,1,1,0\n", 1, 0, "missed ee 1 2 4 5"},
               {"vf,3,0,1,2,0,0\n", 0, 1, "invented vf 3 0 1 2"},
               {"", 0, 1, "invented vf 3 0 1 2"},  // what the table does not list does not touch
               {"vf,4,0,1,2,1,0\n", 1, 1, "missed vf 4 0 1 2"}};
  for (const auto& [lines, missed, invented, difference] : cases) {
    put_truth(lines);
    const Ran ran = run(std::string(kRun) + "--force --json record.json");
    EXPECT_EQ(ran.status, 1) << lines << ran.errors;
    EXPECT_NE(ran.out.find(difference), std::string::npos) << ran.out;
    const ordered_json truth = truth_of("record.json");
    EXPECT_EQ(truth.at("missed"), missed) << lines;
    EXPECT_EQ(truth.at("invented"), invented) << lines;
    EXPECT_EQ(ordered_json::parse(text("record.json")).at("strategies").at(0).contains("ms"), false);
    expect_refused(run("cscd tables record.json"), "its verification failed");
  }
}

TEST_F(TruthBesideCache, IsRefusedWhereItIsDamaged) {
  put_cache();
  const auto refused = [&](const std::string& reason) {
    expect_refused(run(std::string(kRun) + "--json record.json"), reason);
    EXPECT_EQ(files(), "step.h5 step.truth.csv.gz") << reason;
  };
  const std::pair<const char*, const char*> lines[] = {
      {"vf,3,0,1,2,1\n", "line 2: it does not have seven columns"},
      {"vf,3,0,1,2,1,0,0\n", "line 2: something follows its seven columns"},
      {"vv,3,0,1,2,1,0\n", "line 2: its kind is neither vf nor ee"},
      {"vf,3,0,1,2,1,0\nvf,3,0,x,2,1,0\n", "line 3: a column behind the kind is no whole number"},
      {"vf,3,0,1,6,1,0\n", "line 2: it names vertex 6, and the cache has 6 vertices"},
      {"vf,-1,0,1,2,1,0\n", "line 2: it names vertex -1"},
      {"vf,3,0,1,2,2,0\n", "have to be 0 or 1"},
      {"ee,0,1,1,2,0,0\n", "line 2: its shares_vertex is not what its vertices say"},
      {"vf,3,0,1,2,1,0\nvf,3,0,2,1,0,0\n", "says of vf 3 0 1 2 that it touches and that it does not"}};
  for (const auto& [text, reason] : lines) {
    put_truth(text);
    refused(reason);
  }
  put("step.truth.csv.gz", gzipped("kind,v0\n"));
  refused("line 1: is not the head kind,v0,v1");
  put("step.truth.csv.gz", gzipped(kHead).substr(0, 30));
  refused("step.truth.csv.gz: is a damaged gzip file");
}

// Mutation: an answer is not cut down to its first contacts before it is judged.
TEST_F(TruthBesideCache, IsNoGateOfTheFirstContactAlone) {
  put_cache();
  put_truth(kRight);
  const Ran ran =
      run("cscd run --input step.h5 --strategy 'base,drvbc_fast_complete --first' --repetitions 1 --json "
          "first.json");
  EXPECT_EQ(ran.status, 0) << ran.out << ran.errors;
  const ordered_json row = ordered_json::parse(text("first.json")).at("strategies").at(1);
  EXPECT_EQ(row.at("name"), "drvbc_fast_complete --first");
  EXPECT_EQ(row.at("counts").at("contacts"), ordered_json::parse("[1]"));
  EXPECT_TRUE(row.at("ms").contains("traversal"));
  expect_refused(run("cscd run --input step.h5 --strategy 'fcl --first' --json x.json"), "leave --first out");
}

TEST_F(TruthBesideCache, MakesATableOfTheCachesOfAFolder) {
  put_cache();
  put_truth(kRight);
  const Ran ran =
      run("mkdir steps && mv step.* steps && cp steps/step.h5 steps/other.h5\n"
          "cscd run --input steps --strategy base,drvbc_fast_complete --repetitions 1 --json out && ls out");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_TRUE(ran.out.ends_with("other.json\nstep.json\n")) << ran.out;
  const std::string tables = run("cscd tables out").out;
  const std::size_t begin = tables.find("Steps held against truth from outside");
  ASSERT_NE(begin, std::string::npos) << tables;
  const std::string table = tables.substr(begin, tables.find("\n\n", begin) - begin);
  EXPECT_NE(table.find("\nstep "), std::string::npos) << table;
  EXPECT_EQ(table.find("other"), std::string::npos) << table;  // no truth lies beside it
  expect_refused(run("mkdir none && cscd run --input none --json out2"),
                 "none: holds no point cache (.h5) and no moving surface");
}

// Mutation: a folder is one of point caches alone.
TEST_F(TruthBesideCache, IsNotAskedOfTheFolderOfASequence) {
  const Ran ran =
      run("mkdir walk && cd walk && for z in 1 2; do printf \"v 0 0 0\\nv 1 0 0\\nv 0 1 $z\\nf 1 2 3\\n\" > "
          "w.$z.obj; "
          "done\ncd .. && cscd run --input walk --strategy base,drvbc_fast_complete --repetitions 1 --json "
          "walk.json");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_TRUE(ran.out.ends_with("record: walk.json\n")) << ran.out;
  EXPECT_EQ(truth_of("walk.json"), ordered_json());
}

TEST_F(TruthBesideCache, IsOfOneStepAlone) {
  put_cache(2);
  put_truth(kRight);
  expect_refused(run(std::string(kRun) + "--json record.json"), "is of one step, and step.h5 has 2;");
}

fs::path real_folder() {
  if (const char* named = std::getenv("CSCD_REAL")) return named;
  return scenes::scenes_folder().parent_path() / ".." / "shared" / "real";
}

// The steps of real simulations, which are not part of the repository ($CSCD_REAL, else ../shared/real).
TEST(RealSteps, TouchWhereTheirTruthSays) {
  std::error_code absent;
  std::size_t steps = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(real_folder(), absent)) {
    if (!is_point_cache(entry.path())) continue;
    const Input input = open_input(entry.path());
    const auto truth = outside_truth(entry.path(), input.mesh);
    ASSERT_TRUE(truth) << entry.path();
    ContactSet found;
    complete_fallback()
        .make(input.setup(elementary_test_named("filtered_exact")))
        .detector->detect({input.clip->load(0).motion}, found);
    std::vector<VerticesOfPair> contacts;
    for (const Contact& contact : found.contacts)
      contacts.push_back(VerticesOfPair::of(input.mesh, contact.pair));
    std::ranges::sort(contacts);
    EXPECT_TRUE(contacts == truth->contacts) << entry.path() << " has " << contacts.size() << " contacts";
    ++steps;
  }
  if (steps == 0) GTEST_SKIP() << "no steps in " << real_folder();
}

}  // namespace
}  // namespace cscd::bench
