#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/harness/interval_source.h"
#include "bench/measure/studies/scale_input.h"
#include "bench/measure/studies/scale_summary.h"
#include "bench/measure/studies/scaling.h"
#include "bench/measure/studies/small_steps.h"
#include "bench/output/schema.h"
#include "bench/testing/test_program.h"
#include "core/base/error.h"

namespace cscd::bench {
namespace {

TEST(PowerLaw, IsFoundWhereItHolds) {
  const std::vector<double> x = {10, 20, 40, 80, 160};
  std::vector<double> y;
  for (const double value : x) y.push_back(3 * std::pow(value, 1.25));
  const auto law = fit_power_law(x, y);
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, 1.25, 1e-12);
  EXPECT_NEAR(law->factor, 3, 1e-10);
  EXPECT_EQ(law->points, 5u);
}

TEST(PowerLaw, IsTheLeastSquaresOneInLogarithms) {
  const std::vector<double> x = {1, std::exp(1), std::exp(2)}, y = {1, std::exp(1), 1};
  const auto law = fit_power_law(x, y);
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, 0, 1e-15);
  EXPECT_NEAR(std::log(law->factor), 1.0 / 3, 1e-15);
}

TEST(PowerLaw, LeavesOutZerosAndNeedsThreePointsApart) {
  EXPECT_EQ(fit_power_law(std::vector<double>{1, 2, 4, 8}, std::vector<double>{0, 2, 4, 8})->points, 3u);
  EXPECT_FALSE(fit_power_law(std::vector<double>{1, 2, 4}, std::vector<double>{0, 2, 4}));
  EXPECT_FALSE(fit_power_law(std::vector<double>{2, 2, 2}, std::vector<double>{1, 2, 4}));
  EXPECT_FALSE(fit_power_law({}, {}));
}

std::vector<Bone> chain(std::size_t count) {
  std::vector<Bone> bones;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<double>(i);
    bones.push_back({Vec3(at, at * at, 0), Vec3(at + 1, (at + 1) * (at + 1), 0)});
  }
  return bones;
}

TEST(ResampledChain, MergesAndCutsBonesWhereTheirJointsAre) {
  const std::vector<Bone> four = chain(4);
  const auto two = resampled_chain(four, 2), eight = resampled_chain(four, 8),
             same = resampled_chain(four, 4);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].head, four[0].head);
  EXPECT_EQ(two[0].tail, four[1].tail);
  EXPECT_EQ(two[1].tail, four[3].tail);
  ASSERT_EQ(eight.size(), 8u);
  EXPECT_EQ(eight[2].tail, Vec3((four[1].head + four[1].tail) / 2));
  EXPECT_EQ(eight[7].tail, four[3].tail);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(same[i].head, four[i].head);
  for (std::size_t i = 1; i < 8; ++i) EXPECT_EQ(eight[i].head, eight[i - 1].tail);
}

TEST(ResampledChain, IsAskedOfChainsAlone) {
  EXPECT_TRUE(is_chain({{BoneId{-1}, BoneId{0}, BoneId{1}}, chain(3)}));
  EXPECT_FALSE(is_chain({{BoneId{-1}, BoneId{0}, BoneId{0}}, chain(3)}));
  EXPECT_FALSE(is_chain({{}, {}}));
}

TEST(Between, LiesOnTheStraightLines) {
  const Moment a{{{0, 0, 0}, {4, 0, 0}}, {{{0, 0, 0}, {0, 8, 0}}}};
  const Moment b{{{4, 0, 0}, {4, 4, 0}}, {{{0, 0, 4}, {0, 8, 4}}}};
  const Moment quarter = between(a, b, 0.25);
  EXPECT_EQ(quarter.positions[0], Vec3(1, 0, 0));
  EXPECT_EQ(quarter.positions[1], Vec3(4, 1, 0));
  EXPECT_EQ(quarter.bones[0].tail, Vec3(0, 8, 1));
}

TEST(IntervalSource, GivesIntervalsThatNeedNotFollowEachOther) {
  std::vector<std::vector<Vec3>> at;
  for (const double x : {0.0, 1.0, 5.0}) at.push_back({{x, 0, 0}, {x, 1, 0}, {x, 0, 1}});
  const std::pair<std::size_t, std::size_t> ends[] = {{0, 2}, {0, 1}, {2, 1}};
  IntervalSource source({{{VertexId{0}, VertexId{1}, VertexId{2}}}, 3, {}, false}, 2, [&](std::size_t i) {
    return scenes::ClipInterval{Motion(at[ends[i].first], at[ends[i].second]), std::nullopt};
  });
  EXPECT_EQ(source.interval_count(), 2u) << "the third one leads up to another";
  EXPECT_EQ(source.load(0).motion.end()[1], Vec3(5, 1, 0));
  EXPECT_EQ(source.load(2).motion.start()[0], Vec3(5, 0, 0));
  EXPECT_EQ(source.load_frame(1).positions[0], Vec3(0, 0, 0));
  EXPECT_EQ(source.load_frame(2).positions[0], Vec3(1, 0, 0));
}

// Mutations: the intervals that lead up to one are those of another; they end after it starts.
TEST(ScaleInput, LeadsUpToEachIntervalByIntervalsOfItsLength) {
  ScaleSubject subject;
  subject.scene = "urchin";
  subject.triangles = 3000;
  subject.steps = {{"urchin", 0.5}, {"urchin", 3}};
  subject.starts = {10, 100};
  const ScaleInput scaled = scale_input(subject);
  scenes::ClipSource& clip = *scaled.input.clip;
  ASSERT_EQ(clip.interval_count(), 4u);
  const std::size_t expected[] = {20, 24, 3, 24};
  for (std::size_t i = 0; i < 4; ++i) {
    const IntervalRange& lead = scaled.leads[i];
    ASSERT_EQ(lead.last - lead.first, expected[i]);
    std::vector<Vec3> last;
    for (std::size_t k = lead.first; k <= lead.last; ++k) {
      const Motion motion = clip.load(k < lead.last ? k : i).motion;
      const std::vector<Vec3> start(motion.start().begin(), motion.start().end());
      EXPECT_TRUE(k == lead.first || start == last) << i;
      last.assign(motion.end().begin(), motion.end().end());
    }
  }
}

TEST(SpreadStarts, LeaveRoomForTheLongestStep) {
  EXPECT_EQ(spread_starts(241, 3, 16), (std::vector<std::size_t>{37, 112, 186}));
  for (const std::size_t start : spread_starts(20, 4, 2.5)) EXPECT_LT(start + 3, 20u);
  EXPECT_THROW(spread_starts(16, 3, 16), InputError);
}

TEST(ScaleInput, HoldsRecordedIntervalsOfItsSceneAsItPosesThem) {
  ScaleSubject posed;
  posed.scene = "urchin";
  posed.steps = {{"urchin"}};
  posed.starts = {10, 100};
  ScaleSubject recorded = posed;
  recorded.recorded = true;
  recorded.steps.push_back({"urchin_contact"});
  const ScaleInput a = scale_input(posed), b = scale_input(recorded);
  ASSERT_EQ(a.input.clip->interval_count(), 2u);
  ASSERT_EQ(b.input.clip->interval_count(), 4u);
  for (std::size_t i = 0; i < 2; ++i) {
    const scenes::ClipInterval own = a.input.clip->load(i), same = b.input.clip->load(i),
                               other = b.input.clip->load(2 + i);
    double farthest = 0, other_farthest = 0;
    for (std::size_t v = 0; v < own.motion.vertex_count(); ++v) {
      farthest = std::max(farthest, (own.motion.end()[v] - same.motion.end()[v]).norm());
      other_farthest = std::max(other_farthest, (own.motion.end()[v] - other.motion.end()[v]).norm());
    }
    EXPECT_LT(farthest, 1e-12);
    EXPECT_GT(other_farthest, 1e-2) << "spikes of the variant sway wider";
    EXPECT_EQ(own.bones->end.size(), other.bones->end.size());
  }
}

// [scene with or without contacts][repetition]
nlohmann::ordered_json contact_subject(const std::vector<double>& without, const std::vector<double>& with) {
  const auto step = [](const char* scene, const std::vector<double>& samples) {
    const nlohmann::ordered_json row = {
        {"name", "base"}, {"ms", 0}, {"total_samples", samples}, {"median_interval_samples", samples}};
    return nlohmann::ordered_json{{"scene", scene}, {"strategies", nlohmann::ordered_json::array({row})}};
  };
  return {{"study", "contacts"},
          {"steps", nlohmann::ordered_json::array({step("rope", without), step("rope_contact", with)})}};
}

TEST(ContactRatios, AreMediansOfRepetitionsWithOverWithout) {
  const auto ratios = contact_ratios(nlohmann::ordered_json::array(
      {contact_subject({1, 2, 3}, {5, 4, 6}), contact_subject({1, 2, 3}, {9})}));
  ASSERT_EQ(ratios.size(), 4u) << "of the median interval, and of all";
  EXPECT_EQ(ratios[0].at("scene"), "rope");
  EXPECT_EQ(ratios[0].at("with"), "rope_contact");
  EXPECT_EQ(ratios[0].at("of"), "median_interval");
  EXPECT_EQ(ratios[0].at("ratio"), 2.5);
  EXPECT_LT(ratios[0].at("low"), ratios[0].at("high"));
  EXPECT_EQ(ratios[2].at("ratio"), 4.5);
  EXPECT_FALSE(ratios[2].contains("low")) << "one of them was not repeated";
}

// The program, on surfaces so small that it takes seconds.
class ScaleProgram : public testing::Test {
 protected:
  static nlohmann::ordered_json record(std::vector<std::string> arguments, const std::string& name,
                                       const std::vector<std::string>& environment = {}) {
    const std::string out = scratch_->operator/(name);
    arguments.insert(arguments.begin(), "scale");
    arguments.insert(arguments.end(), {"--json", out});
    const Outcome outcome = cscd(arguments, {}, environment);
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
    return nlohmann::ordered_json::parse(read(out));
  }
  static void SetUpTestSuite() { scratch_ = std::make_unique<Scratch>(); }
  static void TearDownTestSuite() { scratch_.reset(); }
  static inline std::unique_ptr<Scratch> scratch_;
};

TEST_F(ScaleProgram, KeepsARecordOfSizesThatFollowsItsSchema) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "a hundred bones take minutes to prepare with sanitizers";
#endif
  const auto out =
      record({"--smoke", "--study", "size", "--scene", "rope", "--sizes", "1000,3000,9000", "--threads", "2"},
             "sizes");
  EXPECT_EQ(schema_violation(out, "scale.schema.json"), "");
  EXPECT_EQ(out.at("command").dump(),
            R"(["cscd","scale","--study","size","--scene","rope","--sizes","1000,3000,9000",)"
            R"("--repetitions","2","--reference-up-to","250000","--seed","2014","--smoke","--threads","2"])");
  ASSERT_EQ(out.at("subjects").size(), 3u);
  for (const auto& subject : out.at("subjects")) {
    EXPECT_EQ(subject.at("study"), "size");
    EXPECT_EQ(subject.at("bones"), 100);
    for (const auto& strategy : subject.at("strategies"))
      EXPECT_EQ(strategy.at("threads"),
                strategy.at("name").get<std::string>().starts_with("drvbc_fast") ? 2 : 1);
    const auto& step = subject.at("steps").at(0);
    EXPECT_EQ(step.at("verified").at("by_reference"), 2);
    for (const auto& row : step.at("strategies")) EXPECT_GT(row.at("ms").at("total"), 0);
  }
  EXPECT_NEAR(out.at("subjects")[2].at("triangles").get<double>(), 9000, 900);
  bool found = false;
  for (const auto& fit : out.at("fits"))
    if (fit.at("strategy") == "base" && fit.at("quantity") == "bvot") {
      found = true;
      EXPECT_GT(fit.at("exponent"), 0.5);
      EXPECT_LT(fit.at("exponent"), 2);
    }
  EXPECT_TRUE(found);

  auto damaged = out;
  damaged["subjects"][0]["steps"][0]["verified"]["by_reference"] = 0;
  EXPECT_NE(schema_violation(damaged, "scale.schema.json"), "") << "no time without a verified answer";
}

TEST_F(ScaleProgram, TakesAsManyThreadsAsTheMachineHas) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "a hundred bones take minutes to prepare with sanitizers";
#endif
  const auto out = record({"--smoke", "--study", "threads", "--scene", "rope,urchin"}, "threads");
  const unsigned machine = std::thread::hardware_concurrency();
  ASSERT_EQ(out.at("subjects").size(), machine >= 2 ? 2u : 1u) << "the rope alone";
  int threads = 0;
  for (const auto& subject : out.at("subjects")) {
    EXPECT_EQ(subject.at("study"), "threads");
    EXPECT_EQ(subject.at("threads"), ++threads);
    for (const auto& strategy : subject.at("strategies")) EXPECT_EQ(strategy.at("threads"), threads);
    EXPECT_EQ(subject.at("steps")[0].at("strategies")[0].at("counts"),
              out.at("subjects")[0].at("steps")[0].at("strategies")[0].at("counts"));
  }
}

// Cloth has no bones, and a sheet has a border. Its variant with contacts is shorter than the scene.
TEST_F(ScaleProgram, LeavesOutRowsThatClothDoesNotAllowAndSaysWhy) {
  const fs::path folder = *scratch_ / "cloth";
  fs::create_directories(folder);
  write(folder / "sheet.json", R"({
    "schema": "cscd.scene/1", "story": "A small sheet falls. It lands on a floor.",
    "shape": {"name": "sheet", "cells": 12, "strips": 14, "edge": 1, "centre": [0, 0, 1], "u": [1, 0, 0],
              "v": [0, 1, 0.2]},
    "frames": 12, "substeps": 4,
    "effects": [{"name": "cloth_dynamics", "gravity": [0, 0, -0.2], "drag": 0.02, "bend_compliance": 0.1,
                 "thickness": 0.9, "floor": 0}]})");
  write(folder / "sheet_contact.json", R"({
    "base": "sheet", "story": "The same sheet falls. It is shown for a shorter time.", "frames": 9,
    "patch": [{"op": "add", "path": "/effects/-", "value": {"name": "contact_response", "pull": 1}}]})");
  const auto out =
      record({"--study", "contacts", "--scene", "sheet", "--intervals", "3", "--repetitions", "2"},
             "cloth.json", {"CSCD_SCENES=" + folder.string(), "CSCD_CACHE=" + folder.string()});
  EXPECT_EQ(schema_violation(out, "scale.schema.json"), "");
  const auto& subject = out.at("subjects").at(0);
  EXPECT_EQ(subject.at("bones"), 0);
  std::vector<std::string> left_out, run;
  for (const auto& row : subject.at("left_out")) {
    left_out.push_back(row.at("name"));
    EXPECT_NE(row.at("why"), "");
  }
  for (const auto& row : subject.at("strategies")) run.push_back(row.at("name"));
  EXPECT_EQ(left_out, (std::vector<std::string>{"drvbc_fast", "drvbc_fast --first", "drvbc"}));
  EXPECT_NE(std::ranges::find(run, "drvbc_fast_complete"), run.end());
  EXPECT_NE(std::ranges::find(run, "base"), run.end());
  for (const auto& step : subject.at("steps")) EXPECT_LT(step.at("starts").back(), 8);
  EXPECT_FALSE(out.at("contact_ratios").empty());
}

TEST_F(ScaleProgram, TakesLongerStepsAndOtherBonesOnTheSameSurface) {
  const auto steps = record(
      {"--smoke", "--study", "step", "--scene", "urchin", "--steps", "0.5,1,3", "--strategy", "base,drvbc"},
      "steps");
  ASSERT_EQ(steps.at("subjects").size(), 1u);
  ASSERT_EQ(steps.at("subjects")[0].at("steps").size(), 3u);
  EXPECT_EQ(steps.at("step_ratios").size(), 6u);
  for (const auto& ratio : steps.at("step_ratios"))
    if (ratio.at("step") == 1) {
      EXPECT_EQ(ratio.at("ratio"), 1);
    }
  const auto pairs = [&](std::size_t step) {
    return steps.at("subjects")[0]
        .at("steps")[step]
        .at("strategies")[0]
        .at("counts")
        .at("pctp")
        .get<double>();
  };
  EXPECT_LT(pairs(0), pairs(1)) << "bounds of longer paths meet more";
  EXPECT_LT(pairs(1), pairs(2));
}

TEST_F(ScaleProgram, TakesTheLargestSizesWhereAsked) {
  const auto out = record({"--smoke", "--largest", "--study", "size", "--scene", "urchin", "--strategy",
                           "drvbc_fast,drvbc", "--reference-up-to", "20000"},
                          "largest");
  ASSERT_EQ(out.at("subjects").size(), 4u);
  const auto& largest = out.at("subjects")[3];
  EXPECT_GT(largest.at("triangles"), 20000);
  EXPECT_EQ(largest.at("steps")[0].at("verified").at("by_reference"), 1);
  EXPECT_EQ(largest.at("steps")[0].at("verified").at("by_each_other"), 1);
}

TEST_F(ScaleProgram, TakesASceneAndItsVariantWithContactsInTurn) {
  const auto out = record({"--smoke", "--study", "contacts", "--strategy", "drvbc --first,base"}, "contacts");
  ASSERT_EQ(out.at("subjects").size(), 1u);
  const auto& subject = out.at("subjects")[0];
  EXPECT_EQ(subject.at("study"), "contacts");
  EXPECT_EQ(subject.at("scene"), "urchin");
  EXPECT_EQ(subject.at("triangles"), 2840);
  EXPECT_EQ(subject.at("steps")[0].at("scene"), "urchin");
  EXPECT_EQ(subject.at("steps")[0].at("colliding"), 0);
  EXPECT_EQ(subject.at("steps")[1].at("scene"), "urchin_contact");
  EXPECT_GT(subject.at("steps")[1].at("colliding"), 0);
  EXPECT_EQ(out.at("contact_ratios").size(), 4u);
  const auto &first = subject.at("steps")[1].at("strategies")[0].at("counts"),
             &all = subject.at("steps")[1].at("strategies")[1].at("counts");
  EXPECT_EQ(subject.at("strategies")[0].at("name"), "drvbc --first");
  EXPECT_LT(first.at("contacts"), all.at("contacts"));
  for (const auto& row : subject.at("steps")[1].at("strategies"))
    EXPECT_FALSE(row.contains("shortfall")) << "a row with --first is asked for no later contact";
  EXPECT_LT(first.at("elementary_tests"), all.at("elementary_tests"));
  EXPECT_TRUE(out.at("fits").empty());
}

// Mutations: the rows are not told the thickness; a start is taken for clear where something is close.
TEST_F(ScaleProgram, TakesTheSameIntervalsAtEveryThickness) {
  const auto out = record({"--smoke", "--study", "thickness"}, "thickness");
  EXPECT_EQ(schema_violation(out, "scale.schema.json"), "");
  ASSERT_EQ(out.at("subjects").size(), 1u);
  const auto& steps = out.at("subjects")[0].at("steps");
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[0].at("thickness"), 0);
  EXPECT_EQ(steps[0].at("clear"), steps[0].at("embedded"));
  EXPECT_EQ(steps[2].at("clear"), 0) << "at a mean edge every surface is close to itself";
  double contacts = -1;
  for (const auto& step : steps) {
    EXPECT_EQ(step.at("verified").at("by_reference"), step.at("starts").size());
    const auto &base = step.at("strategies")[0], &complete = step.at("strategies")[2];
    EXPECT_EQ(base.at("counts").at("contacts"), complete.at("counts").at("contacts"));
    EXPECT_GT(base.at("counts").at("contacts"), contacts);
    contacts = base.at("counts").at("contacts");
    EXPECT_FALSE(base.contains("shortfall") || complete.contains("shortfall"));
    const std::size_t starts = step.at("starts").size(),
                      unclear = starts - step.at("clear").get<std::size_t>();
    const std::string lacking = step.at("strategies")[1].value("shortfall", "");
    EXPECT_EQ(lacking.find("promise void on " + std::to_string(unclear) + " of " + std::to_string(starts)) !=
                  std::string::npos,
              unclear > 0)
        << lacking;
  }
  EXPECT_EQ(out.at("thickness_ratios").size(), 6u);
}

// Mutations: the list is made anew for every step; a step moves as far as the whole interval; a row without a
// proof for a thickness is asked at one.
TEST_F(ScaleProgram, DividesIntervalsIntoSmallSteps) {
  const auto out = record({"--smoke", "--study", "small"}, "small");
  EXPECT_EQ(schema_violation(out, "scale.schema.json"), "");
  const auto& steps = out.at("subjects").at(0).at("steps");
  ASSERT_EQ(steps.size(), 8u);
  for (const auto& step : steps) {
    EXPECT_EQ(step.at("verified").at("by_reference"), step.at("starts").size());
    EXPECT_EQ(step.at("leads"), (nlohmann::ordered_json{24, 20, 16, 12, 8, 4}));
    const auto& rows = step.at("strategies");
    EXPECT_EQ(rows[1].contains("left_out"), step.at("thickness") > 0)
        << "selfccd has no proof for a thickness";
    EXPECT_EQ(rows[2].at("counts").at("contacts"), rows[3].at("counts").at("contacts"));
    EXPECT_GT(rows[3].at("streaming_ms"), 0);
    // Lists spare most steps that creep all overlap tests.
    if (step.at("series") == "iterations" && step.at("thickness") == 0) {
      EXPECT_LT(rows[3].at("counts").at("bvot"), 0.5 * rows[2].at("counts").at("bvot").get<double>());
    }
  }
}

TEST(SeriesOfSteps, BeginWhereThoseBeforeThemEnd) {
  const auto substeps = series_of_steps("substeps", 7, 0.125);
  ASSERT_EQ(substeps.size(), 25u);
  EXPECT_EQ(substeps.front().start, 7);
  EXPECT_EQ(substeps.back().end, 7 + 25 * 0.125);
  for (std::size_t i = 1; i < 25; ++i) EXPECT_EQ(substeps[i].start, substeps[i - 1].end);
  const auto trials = series_of_steps("trials", 7, 0.125);
  EXPECT_EQ(trials[22].start, trials[21].end);
  EXPECT_EQ(trials[24].start, trials[22].start);
  EXPECT_EQ(trials[24].end - trials[24].start, 0.125 / 4);
  const auto iterations = series_of_steps("iterations", 0, 1);
  for (std::size_t i = 1; i < 25; ++i) {
    EXPECT_EQ(iterations[i].start, iterations[i - 1].end);
    EXPECT_NEAR(iterations[i].end - iterations[i].start, std::pow(0.9, i), 1e-13);
  }
  EXPECT_THROW(series_of_steps("jumps", 0, 1), InputError);
}

TEST_F(ScaleProgram, TakesPointCachesAtAThicknessAlone) {
  const fs::path folder = *scratch_ / "one", cache = folder / "step.h5";
  fs::create_directories(folder);
  write(folder / "one.json", R"({
    "schema": "cscd.scene/1", "story": "A small sheet falls. It has one step.", "frames": 2, "substeps": 4,
    "shape": {"name": "sheet", "cells": 12, "strips": 14, "edge": 1, "centre": [0, 0, 1], "u": [1, 0, 0],
              "v": [0, 1, 0.2]},
    "effects": [{"name": "cloth_dynamics", "gravity": [0, 0, -0.2], "drag": 0.02, "bend_compliance": 0.1,
                 "thickness": 0.9, "floor": 0}]})");
  const std::vector<std::string> environment = {"CSCD_SCENES=" + folder.string(),
                                                "CSCD_CACHE=" + folder.string()};
  ASSERT_EQ(cscd({"export", "one", cache}, {}, environment).code, 0);
  const auto out = record({"--smoke", "--study", "thickness", "--scene", cache}, "cache");
  const auto& subject = out.at("subjects").at(0);
  EXPECT_EQ(subject.at("scene"), "step");
  EXPECT_EQ(subject.at("left_out").at(0).at("name"), "drvbc_fast") << "a sheet has a border";
  for (const auto& step : subject.at("steps")) EXPECT_EQ(step.at("starts").size(), 1u);
}

TEST_F(ScaleProgram, RefusesInOneLine) {
  const std::pair<std::vector<std::string>, const char*> refusals[] = {
      {{"--study", "colour"}, "colour not in {size,step,bones,threads,contacts,thickness,small}"},
      {{"--study", "thickness", "--strategy", "mcd"}, "choose one of base, "},
      {{"--scene", "step.h5"}, "leave nothing to measure"},
      {{"--steps", "1,2.5"}, "round it"},
      {{"--steps", "1,500"}, "does not fit"},
      {{"--scene", "nosuch"}, "unknown scene"},
      {{"--strategy", "nosuch"}, "is not known"},
      {{"--scene", "hand_contact"}, "name a scene without it"},
      {{"--study", "bones", "--scene", "urchin"}, "leave nothing to measure"},
      {{"--strategy", "fcl --first"}, "fcl"},
      {{"--study", "contacts", "--scene", "urchin_contact"}, "leave nothing to measure"},
      {{"--smoke", "--json", "/nosuch/folder/x.json"}, "/nosuch/folder"}};
  for (auto [arguments, reason] : refusals) {
    arguments.insert(arguments.begin(), "scale");
    const Outcome outcome = cscd(arguments);
    EXPECT_EQ(outcome.code, 2) << reason;
    EXPECT_EQ(std::ranges::count(outcome.errors, '\n'), 1) << outcome.errors;
    EXPECT_NE(outcome.errors.find(reason), std::string::npos) << outcome.errors;
  }
}

}  // namespace
}  // namespace cscd::bench
