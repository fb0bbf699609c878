// Meshes without bones: what soft bodies and simulations leave.
#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "bench/testing/test_program.h"
#include "scenes/clip/point_cache.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

// Frames of a random interval, its bones left out, and the last `open` of its triangles.
void write_without_bones(const fs::path& file, std::uint64_t seed, std::size_t open = 0) {
  const scenes::RandomInterval random = scenes::make_random_interval(seed);
  scenes::ClipHeader header = random.clip.header();
  header.bone_parent.clear();
  header.triangles.resize(header.triangles.size() - open);
  scenes::PointCacheWriter writer(file, header, true);
  for (const std::size_t frame : {std::size_t{0}, std::size_t{1}})
    writer.append({random.clip.frame(frame).positions, {}});
  writer.finish();
}

// Features and times of an answer's contacts.
std::set<std::pair<std::string, double>> contacts_in(const nlohmann::json& interval) {
  std::set<std::pair<std::string, double>> contacts;
  for (const nlohmann::json& contact : interval["contacts"])
    contacts.emplace(contact["kind"].get<std::string>() + contact["vertices"].dump(), contact["time"]);
  return contacts;
}

// Mutation: a row that promises the first contact alone is taken.
TEST(Boneless, QueryTakesTheBestStrategyAndFindsEveryContact) {
  const Scratch scratch;
  const std::string file = scratch / "soft.h5";
  std::size_t at_stake = 0;
  for (std::uint64_t seed = 1; seed <= 22; ++seed) {
    write_without_bones(file, seed);
    const nlohmann::json answer = document_of({"query", file}),
                         truth = document_of({"query", file, "--strategy", "brute"});
    EXPECT_EQ(answer["strategy"], "drvbc_fast_all") << seed;
    const nlohmann::json &own = answer["intervals"][0], &judge = truth["intervals"][0];
    EXPECT_TRUE(own["proven"]) << seed;
    EXPECT_EQ(own["collides"], judge["collides"]) << seed;
    EXPECT_EQ(own["time"], judge["time"]) << seed;
    EXPECT_EQ(contacts_in(own), contacts_in(judge)) << seed;
    at_stake += judge["starts_embedded"].get<bool>() && judge["collides"].get<bool>();
  }
  EXPECT_GE(at_stake, 10u);
}

// A vertex of no face is a point of a sequence, as it is of a point cache. Mutations: it is left out; no name
// stands for it, so that nothing ignores it.
TEST(Boneless, PointsOfASequenceTouchFacesAndCanBeIgnored) {
  const Scratch scratch;
  for (const auto& [frame, z] : {std::pair("0", "1"), {"1", "-1"}})
    std::ofstream(scratch / ("p." + std::string(frame) + ".obj"))
        << "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 " << z << "\nf 1 2 3\n";
  const std::string file = scratch / "p.0.obj";
  const nlohmann::json answer = document_of({"query", file});
  EXPECT_EQ(answer["import"]["notes"][1],
            "1 vertex is of no face: a point that touches faces, and crosses nothing");
  EXPECT_EQ(answer["summary"]["met"][0]["first"], "a point");
  const nlohmann::json& contact = answer["intervals"][0]["contacts"][0];
  EXPECT_EQ(contact["time"], 0.5);
  EXPECT_EQ(contact["first"]["part"], "a point");
  EXPECT_EQ(contact["first"]["source"]["vertices"], nlohmann::json({3}));
  for (const char* pair : {"*:*", "a point:*", "the surface:*", "the surface:a point"}) {
    const nlohmann::json without = document_of({"query", file, "--ignore", pair});
    EXPECT_EQ(without["summary"]["verdict"], "clear") << pair;
    EXPECT_EQ(without["summary"]["ignored"][0]["contacts"], 1) << pair << without["summary"]["ignored"];
  }
  EXPECT_EQ(document_of({"query", file, "--ignore", "the surface:the surface"})["summary"]["verdict"],
            "touches");
}

TEST(Boneless, InspectSaysWhoTakesThem) {
  const Scratch scratch;
  const std::string file = scratch / "soft.h5";
  for (const std::size_t open : {std::size_t{0}, std::size_t{1}}) {
    write_without_bones(file, 11, open);
    const nlohmann::json document = document_of({"inspect", file});
    const auto row_of = [&](const char* name) {
      const nlohmann::json& rows = document["together"]["strategies"];
      const auto row = std::ranges::find(rows, name, [](const nlohmann::json& each) { return each["name"]; });
      EXPECT_NE(row, rows.end()) << name;
      return row == rows.end() ? nlohmann::json{{"can", nullptr}, {"why_not", ""}} : *row;
    };
    const nlohmann::json drvbc = row_of("drvbc");
    EXPECT_EQ(drvbc["can"], false);
    EXPECT_NE(drvbc["why_not"].get<std::string>().find("bones"), std::string::npos) << drvbc;
    EXPECT_EQ(row_of("drvbc_fast")["can"], open == 0);
    EXPECT_EQ(row_of("base")["can"], true);
    EXPECT_EQ(document_of({"query", file})["strategy"], open == 0 ? "drvbc_fast_all" : "drvbc_fast_complete");
  }
}

}  // namespace
}  // namespace cscd::bench
