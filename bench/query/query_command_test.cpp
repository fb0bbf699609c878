#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/output/data.h"
#include "bench/output/schema.h"
#include "bench/testing/test_queries.h"
#include "scenes/catalog/scene.h"

// The query command from outside: what it prints, where, and the form of its JSON.
namespace cscd::bench {
namespace {

using nlohmann::json;

constexpr char kSchema[] = "query.schema.json";

class Query : public QueryProgram {};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// A scene whose bones would be taken if the strategy got them. Mutation: one of the two gets the bones.
TEST_F(Query, TheDefaultCountsWhatIsMeasuredOfItsRow) {
  fs::copy(scenes::scenes_folder() / "urchin.json", folder / "scenes" / "urchin.json");
  put("scenes/few.json",
      R"({"schema": "cscd.scene/1", "base": "urchin", "story": "A few frames.", "frames": 5})");
  const json document = answer("few");
  const Ran ran = run("cscd run --scene few --strategy " + document["strategy"].get<std::string>() +
                      " --repetitions 1 --json run.json");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const json counts = json::parse(text("run.json"))["strategies"][0]["counts"];
  ASSERT_EQ(document["intervals"].size(), 4u);
  for (std::size_t i = 0; i < document["intervals"].size(); ++i)
    for (const char* quantity : {"bvot", "pctp", "clusters"})
      EXPECT_EQ(document["intervals"][i]["counts"][quantity], counts[quantity][i]) << quantity << ", " << i;
}

TEST_F(Query, AnswersAPersonWhoeverReads) {
  for (const char* script : {"cscd query small", "cscd query small | cat"}) {
    const Ran ran = run(script);
    EXPECT_EQ(ran.status, 0) << ran.errors;
    EXPECT_EQ(ran.out.find("small does not touch itself in frames 0 to 5.\n  5 intervals: "), 0u) << ran.out;
    EXPECT_TRUE(has(ran.out, " clear, 0 touch, 0 cross at their start")) << ran.out;
    EXPECT_TRUE(has(ran.out, "every answer proven")) << ran.out;
  }
}

TEST_F(Query, GivesJsonWhereThatIsAskedAndTextBesideIt) {
  const Ran ran = run("cscd query small --json - | cat");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(json::parse(ran.out)["schema"], "cscd.query/4");
  EXPECT_TRUE(has(ran.errors, "does not touch itself")) << ran.errors;
  const Ran both = run("cscd query small --json answer.json");
  EXPECT_TRUE(has(both.out, "does not touch itself")) << "a file beside it leaves the text where it is";
  EXPECT_EQ(json::parse(text("answer.json"))["input"], "small");
}

TEST_F(Query, SaysHowDeepItLiesInItself) {
  const json events = answer("figure.glb --clip hug")["summary"]["events"];
  ASSERT_FALSE(events.empty());
  double deepest = 0;
  for (const json& event : events) deepest = std::max(deepest, event["depth"]["at_least"].get<double>());
  ASSERT_GT(deepest, 0);
  const json summary = answer("figure.glb --clip hug")["summary"], &headline = summary["headline"];
  EXPECT_EQ(headline["depth"]["at_least"], deepest);
  const json& event = events[headline["event"].get<std::size_t>()];
  for (const char* key : {"first", "second", "begins", "deepest", "ends", "depth", "at_rest"})
    EXPECT_EQ(headline[key], event[key]) << key;
  EXPECT_TRUE(has(summary["sentence"], ": " + headline["text"].get<std::string>() + ". "));
  const auto status = [&](const std::string& length) {
    return run("cscd query figure.glb --clip hug --fail-deeper-than " + length).status;
  };
  EXPECT_EQ(status(std::to_string(0.9 * deepest)), 3);
  EXPECT_EQ(status(std::to_string(1.1 * deepest)), 0);
  const std::string query = "cscd query figure.glb --clip hug --fail-deeper-than ";
  EXPECT_TRUE(has(run(query + std::to_string(0.9 * deepest)).out, ": fails, because something lies "));
  EXPECT_TRUE(
      has(run(query + std::to_string(1.1 * deepest)).out, ": passes: nothing is known to lie deeper"));
  expect_refused(run("cscd query small --json ''"), "argument 4, after --json, is empty");
  EXPECT_TRUE(has(run("cscd query figure.glb --clip hug").out, "  lies in itself in "));
  EXPECT_TRUE(answer("small")["summary"]["events"].empty());
  expect_refused(run("cscd query small --fail-deeper-than much"), "--fail-deeper-than much");
}

// glTF is in metres. Mutations: a unit is left out, or taken for that of the positions.
TEST_F(Query, TakesAndSaysLengthsInUnits) {
  const Ran ran = run("cscd query figure.glb --clip hug --thickness 1cm --fail-deeper-than 500mm");
  EXPECT_EQ(ran.status, 3) << ran.errors;
  EXPECT_TRUE(has(ran.out, ": left_arm_2 is 2.88 m deep in right_arm_2, ")) << ran.out;
  EXPECT_TRUE(has(ran.out, "  --fail-deeper-than 500mm: fails, because something lies deeper: 2.88 m\n"))
      << ran.out;
  EXPECT_EQ(run("cscd query figure.glb --clip hug --fail-deeper-than 5m").status, 0);
  EXPECT_EQ(answer("figure.glb --clip hug --thickness 1cm")["thickness"]["length"], 0.01);
  expect_refused(run("cscd query small --thickness 1cm"), "--thickness 1cm: small does not tell");
  expect_refused(run("cscd query small --fail-deeper-than 1cm"),
                 "--fail-deeper-than 1cm: small does not tell");
}

TEST_F(Query, CountsNewContactsAloneWhereThatIsAsked) {
  const json all = answer("figure.glb --clip hug")["summary"],
             fresh = answer("figure.glb --clip hug --new-contacts")["summary"];
  EXPECT_GT(fresh["old"]["contacts"], 0);
  EXPECT_GT(fresh["old"]["start_pairs"], 0);
  EXPECT_EQ(all["old"]["contacts"], 0);
  EXPECT_TRUE(all["headline"].is_object());
  EXPECT_TRUE(fresh["headline"].is_null()) << "what is left out is not what is said first";
  EXPECT_LT(fresh["intersects_at_start"], all["intersects_at_start"]);
  EXPECT_EQ(fresh["events"], all["events"]) << "what is left out is known all the same";
  expect_refused(run("cscd query figure.glb --clip hug --new-contacts --first"),
                 "--new-contacts with --first");
}

TEST_F(Query, FailsOnContactWhereThatIsAsked) {
  EXPECT_EQ(run("cscd query figure.glb --clip hug --fail-on-contact").status, 3);
  EXPECT_EQ(run("cscd query figure.glb --clip hug").status, 0);
  EXPECT_EQ(run("cscd query small --fail-on-contact").status, 0);
}

// Whoever ignores a pair of places that meets is told of the others, and of how much is ignored.
TEST_F(Query, IgnoresWhatItIsToldTo) {
  const json whole = answer("figure.glb --clip hug"), met = whole["summary"]["met"];
  EXPECT_EQ(whole["ignore"], nullptr);
  EXPECT_EQ(whole["summary"]["with_ignored"], 0);
  const std::string first = met[0]["first"], second = met[0]["second"];
  const json without = answer("figure.glb --clip hug --ignore " + first + ":" + second);
  EXPECT_EQ(without["ignore"]["pairs"], json::array({json::array({first, second})}));
  const json& ignored = without["summary"]["ignored"];
  ASSERT_EQ(ignored.size(), 1u);
  EXPECT_EQ(ignored[0]["first"], first);
  EXPECT_EQ(ignored[0]["second"], second);
  for (const json& row : without["summary"]["met"])
    EXPECT_FALSE(row["first"] == first && row["second"] == second) << row;
  std::size_t contacts = 0, pairs = 0;
  for (std::size_t i = 0; i < whole["intervals"].size(); ++i) {
    const json &all = whole["intervals"][i], &some = without["intervals"][i];
    contacts += some["ignored"]["contacts"].get<std::size_t>();
    pairs += some["ignored"]["start_pairs"].get<std::size_t>();
    EXPECT_LE(some["start_pairs_total"], all["start_pairs_total"]) << i;
  }
  EXPECT_EQ(ignored[0]["contacts"], contacts);
  EXPECT_EQ(ignored[0]["start_pairs"], pairs);
  EXPECT_GT(contacts + pairs, 0u);
  expect_refused(run("cscd query figure.glb --ignore " + first + "x:" + second),
                 "did you mean " + first + "?");
  expect_refused(run("cscd query figure.glb --ignore " + first), "has no colon");
}

TEST_F(Query, SpeaksOfACharacterInItsOwnNamesAndTimes) {
  const Ran ran = run("cscd query figure.glb --clip HUG");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_TRUE(has(ran.out,
                  "1 s as 31 frames, from frame 0 to 30, 30 frames a second, because the file does "
                  "not say (--fps); drives 4 of "))
      << ran.out;
  EXPECT_TRUE(has(ran.out, "\nfigure.glb, clip 'hug' (2nd of 2 clips): left_arm_2 is ")) << ran.out;
  EXPECT_TRUE(has(ran.out, "all 4 components")) << ran.out;
  EXPECT_TRUE(has(ran.out, "first at frame ")) << ran.out;
  EXPECT_TRUE(has(ran.out, "right_eye in skin: ") && has(ran.out, "left_eye in skin: ")) << ran.out;

  const json whole = answer("figure.glb --clip hug --from-bind-pose");
  EXPECT_EQ(whole["import"]["lead_in_frames"], 15);
  EXPECT_TRUE(whole["rest_crossings"]["left_out"]);
  std::size_t by_part = 0;
  for (const json& row : whole["rest_crossings"]["parts"]) by_part += row["pairs"].get<std::size_t>();
  EXPECT_EQ(whole["rest_crossings"]["pairs"], by_part);
  EXPECT_GT(by_part, 0u);
  const json& intervals = whole["intervals"];
  EXPECT_EQ(intervals[0]["seconds"], -0.5);
  EXPECT_EQ(intervals[15]["seconds"], 0);
  EXPECT_EQ(intervals[18]["frame"], 3);
  std::size_t contacts = 0;
  for (const json& interval : intervals) {
    EXPECT_GT(interval["left_out"]["start_pairs"], 0) << "the eyes";
    for (const json& contact : interval["contacts"]) {
      ++contacts;
      const bool face = contact["kind"] == "vf";
      const json& weights = contact[face ? "barycentric" : "edge_parameters"];
      if (face) {
        EXPECT_NEAR(weights[0].get<double>() + weights[1].get<double>() + weights[2].get<double>(), 1, 1e-12);
      }
      const auto n = contact["normal"].get<std::vector<double>>();
      EXPECT_NEAR(std::hypot(n[0], n[1], n[2]), 1, 1e-12);
      for (const char* side : {"first", "second"}) {
        EXPECT_TRUE(contact[side]["bone"].is_string());
        const json& source = contact[side]["source"];
        EXPECT_EQ(source["mesh"], whole["import"]["parts"][source["part"].get<std::size_t>()]["mesh"]);
        const std::size_t vertices = !face ? 2 : side == std::string("first") ? 1 : 3;
        EXPECT_EQ(source["vertices"].size(), vertices);
      }
    }
  }
  EXPECT_GT(contacts, 0u);
  const json& summary = whole["summary"];
  EXPECT_EQ(summary["intervals"], intervals.size());
  EXPECT_EQ(summary["clear"].get<int>() + summary["touches"].get<int>() +
                summary["intersects_at_start"].get<int>() + summary["undecided"].get<int>(),
            intervals.size());
  const auto first = std::find_if(intervals.begin(), intervals.end(),
                                  [](const json& interval) { return interval["collides"] == true; });
  ASSERT_NE(first, intervals.end());
  EXPECT_EQ(summary["first"]["interval"], (*first)["index"]);
}

TEST_F(Query, AnswersAllClipsInOneRun) {
  const json all = answer("figure.glb --clip all");
  ASSERT_EQ(all["clips"].size(), 2u);
  for (std::size_t c = 0; c < 2; ++c) {
    json one = answer("figure.glb --clip " + std::to_string(c))["summary"];
    json same = all["clips"][c]["summary"];
    EXPECT_GT(same["ms"]["wall"], 0);
    one.erase("ms"), same.erase("ms");  // no two runs take the same time
    EXPECT_EQ(same, one);
    EXPECT_EQ(all["clips"][c]["import"]["clip"], c);
  }
  EXPECT_EQ(all["import"]["clip"], nullptr);
  EXPECT_EQ(run("cscd query figure.glb --clip all --fail-on-contact").status, 3);
  expect_refused(run("cscd inspect figure.glb --clip all"), "only query and view take all clips");
}

// Mutation: without a name, the first clip alone.
TEST_F(Query, AnswersAllClipsUnlessOneIsNamed) {
  const json named = answer("figure.glb --clip all"), unnamed = answer("figure.glb");
  EXPECT_EQ(unnamed["summary"], named["summary"]);
  ASSERT_EQ(unnamed["clips"].size(), 2u);
  const Ran ran = run("cscd query figure.glb");
  const char* const kNamed[] = {"figure.glb, clip 'walk' (1st of 2 clips)",
                                "figure.glb, clip 'hug' (2nd of 2 clips)"};
  std::size_t at = 0;
  for (std::size_t c = 0; c < 2; ++c) {
    const std::string sentence = unnamed["clips"][c]["summary"]["sentence"];
    EXPECT_EQ(sentence.find(kNamed[c]), 0u) << sentence;
    // The worst has a line of its own.
    const json& headline = unnamed["clips"][c]["summary"]["headline"];
    const bool crosses = unnamed["clips"][c]["summary"]["verdict"] == "intersects_at_start";
    ASSERT_EQ(headline.is_object(), crosses);
    const std::string first =
        crosses ? kNamed[c] + (": " + headline["text"].get<std::string>()) + "." : sentence;
    EXPECT_EQ(sentence.find(first), 0u) << sentence;
    at = ran.out.find("\n" + first + "\n", at);
    EXPECT_NE(at, std::string::npos) << "no '" << sentence << "' in " << ran.out;
  }
  EXPECT_NE(ran.out.find("\n" + unnamed["summary"]["sentence"].get<std::string>() + "\n", at),
            std::string::npos);
  EXPECT_LE(std::ranges::count(ran.out, '\n'), 12) << "a file of many clips fits a screen: " << ran.out;
  EXPECT_TRUE(has(ran.out, "--clip NAME says more of one"));
  EXPECT_TRUE(has(unnamed["summary"]["sentence"], "figure.glb, 2 clips in all: ")) << unnamed["summary"];
  EXPECT_TRUE(has(unnamed["summary"]["sentence"], "('hug')")) << unnamed["summary"];
  // The worst of all clips comes first.
  json worst = unnamed["clips"][1]["summary"]["headline"];
  EXPECT_TRUE(
      has(unnamed["summary"]["sentence"], "in all: in 'hug' " + worst["text"].get<std::string>() + "; "))
      << unnamed["summary"];
  worst["clip"] = 1;
  EXPECT_EQ(unnamed["summary"]["headline"], worst);
  EXPECT_TRUE(has(unnamed["summary"]["sentence"], "; all of this apart from what crosses at rest."));
  expect_refused(run("cscd query figure.glb --frames 0:1"), "has 2; name one with --clip");

  // A clip that moves nothing is not said to be clear alone.
  scenes::Character still = scenes::walking_figure();
  for (scenes::Channel& channel : still.animations[1].channels)
    for (auto& key : channel.rotations) key.value = channel.rotations.front().value;
  put("still.glb", scenes::to_glb(still));
  EXPECT_TRUE(has(run("cscd query still.glb --clip hug").out,
                  "clip 'hug' (2nd of 2 clips), does not move in frames 0 to 30, "));

  // A file of one clip is answered by itself.
  scenes::Character one = scenes::walking_figure();
  one.animations.resize(1);
  put("one.glb", scenes::to_glb(one));
  EXPECT_EQ(
      answer("one.glb")["summary"]["sentence"].get<std::string>().find(
          "one.glb, clip 'walk' (the only one), touches itself in frames 0 to 30 only in what crosses "),
      0u);
  EXPECT_EQ(answer("one.glb --clip all")["clips"].size(), 1u);
}

// The arms of the figure hug from frame 900 of 24 a second on.
TEST_F(Query, CountsFramesAsTheTimeLineOfTheFile) {
  scenes::Character late = scenes::walking_figure();
  late.animations.erase(late.animations.begin());
  scenes::Animation& hug = late.animations[0];
  for (scenes::Channel& channel : hug.channels)
    for (auto& key : channel.rotations) key.time += 37.5;
  auto& turns = hug.channels[0].rotations;
  const auto first = turns.front();
  turns.insert(turns.begin() + 1, 23, first);
  for (std::size_t i = 1; i < 24; ++i) turns[i].time += static_cast<double>(i) / 24;
  put("late.glb", scenes::to_glb(late));
  const json whole = answer("late.glb --from-bind-pose");
  EXPECT_EQ(whole["import"]["fps"], 24);
  EXPECT_EQ(whole["import"]["fps_from"], "keys");
  EXPECT_EQ(whole["import"]["clips"][0]["first_frame"], 900);
  EXPECT_EQ(whole["import"]["lead_in_frames"], 12);
  EXPECT_EQ(whole["intervals"][0]["frame"], -12);
  EXPECT_EQ(whole["intervals"][12]["frame"], 900);
  EXPECT_EQ(whole["intervals"][12]["seconds"], 0);
  const json part = answer("late.glb --frames 910:915");
  ASSERT_EQ(part["intervals"].size(), 5u);
  EXPECT_EQ(part["intervals"][0]["index"], 10);
  EXPECT_EQ(part["intervals"][0]["frame"], 910);
  expect_refused(run("cscd query late.glb --frames 10:15"), "not inside the clip's frames 900 to 924");
  const Ran text = run("cscd query late.glb");
  EXPECT_TRUE(has(text.out, "from frame 900 to 924, 24 frames a second, as the keys of the file are spaced"))
      << text.out;
  EXPECT_TRUE(has(text.out, " s into the clip): ")) << text.out;
  const json asked = answer("late.glb --fps 30");
  EXPECT_EQ(asked["import"]["fps_from"], "asked");
  EXPECT_EQ(asked["intervals"][0]["frame"], 1125);
}

// Two tetrahedra in one place, as a coat that was copied from a body.
TEST_F(Query, GivesCopiesAtRestALineOfTheirOwn) {
  for (int frame = 0; frame < 2; ++frame) {
    std::string obj;
    for (int copy = 0; copy < 2; ++copy)
      for (const char* vertex : {"0 0 ", "1 0 ", "0 1 ", "0.2 0.2 1"})
        obj += std::string("v ") + vertex + std::to_string(frame) + "\n";
    put("copy." + std::to_string(frame) + ".obj",
        obj + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n");
  }
  const Ran ran = run("cscd query copy.0.obj");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_TRUE(has(ran.out, "\n  lies on itself at rest, as copies of one surface do: ")) << ran.out;
  EXPECT_TRUE(has(ran.out, ": 4 triangles in one place, 16 pairs that meet; left out of 1 interval"))
      << ran.out;
  EXPECT_TRUE(has(ran.out, "(--keep-rest-crossings counts both)")) << ran.out;
  EXPECT_FALSE(has(ran.out, "\n  crosses at rest")) << ran.out;
}

// Mutations: the file is written and never read; a strategy without a preparation takes the option.
TEST_F(Query, KeepsAPreparation) {
  const auto counted = [&](const std::string& words) { return timeless(answer(words))["intervals"]; };
  const json plain = counted("small");
  EXPECT_EQ(counted("small --preparation kept.preparation"), plain);
  const std::string kept = text("kept.preparation");
  EXPECT_GT(kept.size(), 1000u);
  EXPECT_EQ(counted("small --preparation kept.preparation"), plain);
  EXPECT_EQ(text("kept.preparation"), kept);

  expect_refused(run("cscd query figure.glb --clip hug --preparation kept.preparation"),
                 "--preparation kept.preparation: was made for another surface; prepare anew without it");
  put("kept.preparation", kept.substr(0, kept.size() / 2));
  expect_refused(run("cscd query small --preparation kept.preparation"),
                 "--preparation kept.preparation: is damaged");
  put("kept.preparation", "");
  expect_refused(run("cscd query small --preparation kept.preparation"), "is empty; remove it");
  expect_refused(run("cscd query small --strategy base --preparation other.preparation"),
                 "strategy base has no preparation worth keeping");
}

// Mutation: the sentence counts the triangles that were there.
TEST_F(Query, SaysWhatIsNewToAPreparation) {
  ASSERT_EQ(run("cscd export small walk.obj").status, 0);
  EXPECT_FALSE(has(run("cscd query walk.0000.obj --preparation kept").out, "preparation kept"));
  ASSERT_EQ(run("for f in walk.*.obj; do awk '/^v / && !n++ {$2 += 1e-4} 1' $f > t && mv t $f; done").status,
            0);
  const Ran changed = run("cscd query walk.0000.obj --preparation kept");
  EXPECT_EQ(changed.status, 0) << changed.errors;
  std::size_t fresh = 0, all = 0;
  const std::size_t at = changed.out.find("preparation kept: ");
  ASSERT_NE(at, std::string::npos) << changed.out;
  ASSERT_EQ(
      std::sscanf(changed.out.c_str() + at, "preparation kept: %zu of %zu triangles are new", &fresh, &all),
      2);
  EXPECT_GT(fresh, 0u);
  EXPECT_LT(fresh, all / 4);
}

TEST_F(Query, ListsAsManyStartPairsAsAsked) {
  const auto longest = [&](const std::string& words) {
    std::size_t most = 0, total = 0;
    const json whole = answer("figure.glb --clip hug --keep-rest-crossings " + words);
    for (const json& interval : whole["intervals"]) {
      most = std::max(most, interval["start_pairs"].size());
      total = std::max(total, interval["start_pairs_total"].get<std::size_t>());
      EXPECT_EQ(interval["verdict"], "intersects_at_start") << "the eyes count";
      EXPECT_EQ(interval["collides"], true);
    }
    EXPECT_GE(total, most);
    return std::pair(most, total);
  };
  EXPECT_EQ(longest("--start-pairs 7").first, 7u);
  const auto [all, total] = longest("--start-pairs all");
  EXPECT_EQ(all, total);
  expect_refused(run("cscd query small --start-pairs few"), "--start-pairs few");
}

// The schema says what each field means, and refuses what it does not know.
void expect_described(const json& schema, const std::string& where, std::size_t& fields) {
  if (schema.is_array())
    for (const json& each : schema) expect_described(each, where, fields);
  if (!schema.is_object()) return;
  if (schema.contains("properties"))
    for (const auto& [name, field] : schema["properties"].items()) {
      ++fields;
      const bool said = field.contains("description") || field.contains("$ref") || field.contains("anyOf");
      EXPECT_TRUE(said) << where << "/" << name;
    }
  for (const auto& [name, inner] : schema.items()) expect_described(inner, where + "/" + name, fields);
}

TEST(QuerySchema, DescribesEveryField) {
  std::size_t fields = 0;
  expect_described(json(data_json(kSchema)), "", fields);
  EXPECT_GT(fields, 80u);
}

TEST_F(Query, KeepsToTheSchemaWithBonesWithoutAndWhenUndecided) {
  answer("small");
  answer("small --first --strategy base");
  answer("small --elementary newton --strategy base --frames 0:2");
  const auto document = nlohmann::ordered_json::parse(run("cscd query small --json -").out);
  for (const auto& [name, value] : document.items()) {
    auto spoiled = document;
    spoiled.erase(name);
    if (name != "import") {
      EXPECT_NE(schema_violation(spoiled, kSchema), "") << "without " << name;
    }
  }
  auto spoiled = document;
  spoiled["intervals"][0]["verdict"] = "perhaps";
  EXPECT_NE(schema_violation(spoiled, kSchema), "");
  spoiled = document;
  spoiled["intervals"][0]["surprise"] = 1;
  EXPECT_NE(schema_violation(spoiled, kSchema), "");
}

TEST_F(Query, InspectFitsAScreenWhateverTheFileHolds) {
  std::string tetrahedra;
  for (int k = 0; k < 300; ++k) {
    const std::string x = std::to_string(3 * k), beside = std::to_string(3 * k + 1);
    tetrahedra += "v " + x + " 0 0\nv " + beside + " 0 0\nv " + x + " 1 0\nv " + x +
                  " 0 1\nf -4 -2 -3\nf -4 -3 -1\nf -4 -1 -2\nf -3 -2 -1\n";
  }
  put("many.1.obj", tetrahedra);
  put("many.2.obj", tetrahedra);
  const Ran ran = run("cscd inspect many.1.obj --json many.json");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_LT(std::ranges::count(ran.out, '\n'), 40) << ran.out;
  EXPECT_NE(ran.out.find("and 292 more components; --json FILE lists all"), std::string::npos) << ran.out;
  EXPECT_EQ(json::parse(text("many.json"))["components"].size(), 300u);
}

}  // namespace
}  // namespace cscd::bench
