#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/command_line/usage.h"
#include "bench/query/view/viewer_page.h"
#include "bench/testing/test_queries.h"

// cscd view from outside: the page that it writes, and what a browser makes of it.
namespace cscd::bench {
namespace {

using nlohmann::json;

constexpr char kHostile[] = "<img src=x onerror=alert(1)>";

// A figure whose parts and bones are named by somebody who wishes readers ill.
scenes::Character hostile_figure() {
  scenes::Character figure = scenes::walking_figure();
  for (scenes::Node& node : figure.nodes) node.name = kHostile + node.name + "</script>";
  for (scenes::Part& part : figure.parts) part.name = kHostile + part.name;
  return figure;
}

class View : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    if (viewer_page().empty()) GTEST_SKIP() << "built without the viewer";
    put("figure.glb", scenes::to_glb(scenes::walking_figure()));
  }

  // Has a browser open and use a page of the folder (page/test/check.mjs).
  void use_in_browser(const std::string& page, const std::string& expected) const {
    const Ran ran = run("'" CSCD_NODE "' '" CSCD_PAGE_TESTS "/check.mjs' '" CSCD_PAGE_PACKAGES "' " + page +
                        " --text \"" + expected + "\"");
    if (ran.status == 77) GTEST_SKIP() << ran.out;
    EXPECT_EQ(ran.status, 0) << ran.out << ran.errors;
    std::printf("%s", ran.out.c_str());
  }
};

TEST_F(View, WritesThePageBesideTheInputsName) {
  const Ran ran = run("cscd view small");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(files(), "figure.glb small.html");
  EXPECT_NE(ran.out.find("does not touch itself"), std::string::npos) << ran.out;
  // A page of its own is replaced, and nothing else is.
  EXPECT_EQ(run("cscd view small --frames 0:2").status, 0);
  EXPECT_EQ(header_of(text("small.html"))["clip"]["frames"], 3);
  for (const char* other :
       {"", "<!doctype html><p>cscd view", "notes\n<meta name=\"generator\" content=\"cscd view\">"}) {
    put("small.html", other);
    expect_refused(run("cscd view small"), "small.html");
    EXPECT_EQ(text("small.html"), other);
  }
  EXPECT_EQ(run("cscd view small --force").status, 0);
  EXPECT_EQ(run("cscd view small -o - | head -c 15").out, "<!doctype html>");
}

TEST_F(View, ShowsTheTrueMotion) {
  const std::string options = "figure.glb --clip hug --fps 3 ";
  ASSERT_EQ(run("cscd view " + options + "--true-motion -o page.html").status, 0);
  const json moments = header_of(text("page.html"))["true_motion"];
  const json query = json::parse(run("cscd query " + options + "--true-motion --json -").out);
  std::size_t shown = 0;
  for (const json& interval : query["intervals"]) {
    const json& own = interval["true_motion"];
    if (own["verdict"] == "clear" && !own["differs"]) continue;
    ASSERT_LT(shown, moments.size());
    EXPECT_EQ(moments[shown]["interval"], interval["index"]);
    for (const char* key : {"verdict", "differs", "pair"}) EXPECT_EQ(moments[shown][key], own[key]) << key;
    ++shown;
  }
  EXPECT_EQ(shown, moments.size());
  EXPECT_GT(shown, 0u);
  ASSERT_EQ(run("cscd view " + options + "-o lines.html").status, 0);
  EXPECT_TRUE(header_of(text("lines.html"))["true_motion"].is_null());
}

TEST_F(View, GivesTheAnswersOfAQuery) {
  ASSERT_EQ(run("cscd view figure.glb --clip hug --strategy drvbc_fast_complete --strategy base -o page.html")
                .status,
            0);
  const json header = header_of(text("page.html"));
  EXPECT_EQ(header["up"]["axis"], "y");
  EXPECT_EQ(header["up"]["because"], "glTF files have it so");
  EXPECT_TRUE(header["engine_colours"]);
  for (const char* strategy : {"drvbc_fast_complete", "base"}) {
    json query =
        json::parse(run(std::string("cscd query figure.glb --clip hug --json - --strategy ") + strategy).out);
    json row = header["strategies"][strategy == std::string("base") ? 1 : 0];
    EXPECT_EQ(row["name"], strategy);
    for (json* summary : {&row["summary"], &query["summary"]}) {
      EXPECT_GT((*summary)["ms"]["preparation"], 0);
      summary->erase("ms");
    }
    EXPECT_EQ(row["summary"], query["summary"]);
    EXPECT_EQ(header["rest"], query["rest_crossings"]);
  }
  ASSERT_EQ(run("cscd view figure.glb --clip hug --frames 3:7 -o part.html").status, 0);
  EXPECT_EQ(header_of(text("part.html"))["clip"]["frames"], 5);
}

TEST_F(View, HoldsCoversPatchesAndObservers) {
  ASSERT_EQ(run("cscd view small --strategy drvbc_fast --strategy drvbc --strategy base -o page.html").status,
            0);
  const json header = header_of(text("page.html"));
  const auto bytes_of = [&](const std::string& name) {
    for (const json& section : header["sections"])
      if (section["name"] == name) return section["raw"].get<int>();
    return -1;
  };
  EXPECT_EQ(header["up"]["axis"], "z");  // its chain falls the other way
  EXPECT_TRUE(header["strategies"][0]["has_patches"]);
  EXPECT_FALSE(header["strategies"][1]["has_patches"]);
  EXPECT_GT(header["strategies"][0]["covers"], 0);
  EXPECT_EQ(header["strategies"][2]["covers"], 0);
  EXPECT_EQ(bytes_of("s0.patch"), 4 * header["clip"]["triangles"].get<int>());
  EXPECT_EQ(bytes_of("s0.cover0.observer_count"), bytes_of("s0.clusters"));
  for (const char* cover : {"s0.cover0", "s1.cover0"}) {
    const std::string prefix = std::string(cover) + ".observer_";
    EXPECT_GT(bytes_of(prefix + "cluster"), 0);
    EXPECT_EQ(bytes_of(prefix + "place"), 12 * bytes_of(prefix + "cluster"));
  }
  EXPECT_EQ(bytes_of("s2.cover0.observer_count"), -1);
  // A scene's bones have the names of its file, or of its shape.
  EXPECT_NE(header["texts"].dump().find("bone_1"), std::string::npos) << header["texts"];
}

// Up is what the input says, or the user. A point cache that says nothing has y up, and the page says why.
TEST_F(View, SaysWhichAxisPointsUp) {
  const auto up_of = [&](const std::string& command) {
    const Ran ran = run("cscd view " + command + " -o page.html --force");
    EXPECT_EQ(ran.status, 0) << ran.errors;
    return header_of(text("page.html"))["up"];
  };
  EXPECT_EQ(up_of("small"), (json{{"axis", "z"}, {"because", "things fall the other way"}}));
  ASSERT_EQ(run("cscd export small small.h5").status, 0);
  EXPECT_EQ(up_of("small.h5"), (json{{"axis", "z"}, {"because", "the file says so"}}));
  EXPECT_EQ(up_of("small.h5 --up -x"), (json{{"axis", "-x"}, {"because", "--up says so"}}));
  ASSERT_EQ(run("cscd export figure.glb frames.ply").status, 0);
  EXPECT_EQ(up_of("frames.0000.ply"), (json{{"axis", "y"}, {"because", ""}}));
  expect_refused(run("cscd view small --up up"), "--up");
}

// Contacts that are ignored are counted and named, in the text, in the JSON and in the page.
TEST_F(View, IgnoresWhatItIsToldTo) {
  const std::string asked = "figure.glb --clip hug --ignore-neighbours 1 ";
  const json query = json::parse(run("cscd query " + asked + "--json -").out);
  const Ran ran = run("cscd view " + asked + "-o page.html");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_NE(ran.out.find("(--ignore-neighbours 1)"), std::string::npos) << ran.out;
  const json header = header_of(text("page.html"));
  const json& row = header["strategies"][0];
  EXPECT_EQ(query["ignore"], (json{{"pairs", json::array()}, {"neighbours", 1}}));
  EXPECT_EQ(row["summary"]["ignored"], query["summary"]["ignored"]);
  EXPECT_NE(row["details"].get<std::string>().find("(--ignore-neighbours 1)"), std::string::npos)
      << row["details"];
  EXPECT_NE(row["details"].get<std::string>().find(". Answered by "), std::string::npos) << row["details"];
}

// The page with the engine is a file beside the program, in its build folder or in the prefix that it is
// installed to. Where there is none, the option is refused.
TEST_F(View, PutsTheEngineIntoAPage) {
  constexpr char kCopy[] = R"sh(mkdir -p prefix/bin; cp -l "$(command -v cscd)"{,-*} prefix/bin 2>/dev/null ||
cp "$(command -v cscd)"{,-*} prefix/bin; PATH=$PWD/prefix/bin:$PATH
)sh";
  const auto view = [&](const std::string& words) { return run(kCopy + ("cscd view " + words)); };
  const auto page_of = [](const std::string& version) {
    return "<!doctype html><body data-version=\"" + version + "\">the engine<!--data-->";
  };
  expect_refused(view("small --with-engine -o page.html"), "scripts/check wasm BUILD");
  EXPECT_FALSE(fs::exists(folder / "page.html"));
  for (const char* place : {"prefix/share/cscd", "prefix/bin/share/cscd"}) {
    fs::create_directories(folder / place);
    put(std::string(place) + "/engine_view.html", page_of(version_number()));
    const Ran ran = view("small --with-engine --thickness 0.1e -o page.html --force");
    ASSERT_EQ(ran.status, 0) << ran.errors;
    const std::string page = text("page.html");
    EXPECT_NE(page.find("the engine<script"), std::string::npos);
    const json header = header_of(page), &engine = header["engine"];
    EXPECT_EQ(engine["subject"], "small");
    EXPECT_EQ(engine["asked"], (json{{"thickness", "0.1e"}, {"neighbours", nullptr}}));
    EXPECT_GT(engine["mean_edge"], 0);
    std::map<std::string, std::size_t> bytes;
    for (const json& section : header["sections"]) bytes[section["name"]] = section["raw"];
    const std::size_t frames = header["clip"]["frames"], pose = 24 * header["clip"]["vertices"].get<int>();
    EXPECT_EQ(bytes["exact.rest"], pose);
    EXPECT_EQ(bytes["exact.starts"], frames * pose);
    EXPECT_EQ(bytes["exact.ends"], 0u);  // intervals end where the next ones start
    EXPECT_EQ(bytes["exact.place_number"], 4 * header["clip"]["triangles"].get<std::size_t>());
    fs::remove_all(folder / place);
  }
  // A file of another kind is no page, and one of another version may know other data.
  fs::create_directories(folder / "prefix/share/cscd");
  put("prefix/share/cscd/engine_view.html", "<!doctype html>");
  expect_refused(view("small --with-engine -o -"), "there is no share/cscd/engine_view.html");
  put("prefix/share/cscd/engine_view.html", page_of("0.0.1"));
  expect_refused(view("small --with-engine -o -"), "is of another version");
}

TEST_F(View, RefusesToAskAPagesEngineWhatItDoesNotKnow) {
  for (const char* words : {"--true-motion", "--first", "--new-contacts", "--ignore bone_0:bone_1",
                            "--exclude-rings 1", "--exclude-near-rest 0.1"}) {
    const std::string option = std::string(words).substr(0, std::string(words).find(' '));
    expect_refused(run(std::string("cscd view figure.glb --with-engine ") + words),
                   "--with-engine with " + option + ":");
  }
  EXPECT_EQ(files(), "figure.glb");
}

TEST_F(View, RefusesWhatItCannotShow) {
  expect_refused(run("cscd view small --strategy drvbc-fast"), "did you mean drvbc_fast?");
  expect_refused(run("cscd view small -o page.txt"), "page.txt");
  expect_refused(run("cscd view small --first --elementary newton"), "--first");
  expect_refused(run("cscd view figure.glb --clip all --frames 0:1"), "is for one clip");
  std::string many = "cscd view small";
  for (int i = 0; i < 7; ++i) many += " --strategy base";
  expect_refused(run(many), "up to 6");
  EXPECT_EQ(files(), "figure.glb");
}

TEST_F(View, ABrowserShowsTheFirstContactAndHostileNamesAsText) {
  put("hostile.glb", scenes::to_glb(hostile_figure()));
  const Ran ran =
      run("cscd view hostile.glb --clip hug --component largest --strategy drvbc --strategy drvbc_fast -o "
          "page.html");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const std::string page = text("page.html");
  EXPECT_EQ(page.find("<img"), std::string::npos);
  use_in_browser("page.html", "first at frame 25.75 (0.8585 s): <img src=x onerror=alert(1)>");
}

TEST_F(View, HoldsOneClipOrAll) {
  const Ran first = run("cscd view figure.glb -o one.html");
  ASSERT_EQ(first.status, 0) << first.errors;
  EXPECT_NE(first.out.find("it is the first clip that moves the surface"), std::string::npos) << first.out;
  const json one = header_of(text("one.html"))["strategies"][0];
  EXPECT_NE(one["details"].get<std::string>().find("the first clip that moves"), std::string::npos);

  const Ran all = run("cscd view figure.glb --clip all -o all.html");
  ASSERT_EQ(all.status, 0);
  // One line of each clip, however much of each the page says.
  EXPECT_NE(all.out.find("clip 'hug' (2nd of 2 clips)"), std::string::npos) << all.out;
  EXPECT_EQ(all.out.find(" to find contacts"), std::string::npos) << all.out;
  EXPECT_LT(std::ranges::count(all.out, '\n'), 12) << all.out;
  const json header = header_of(text("all.html")),
             query = json::parse(run("cscd query figure.glb --json -").out);
  ASSERT_EQ(header["clips"].size(), 2u);
  for (std::size_t c = 0; c < 2; ++c) {
    const json& row = header["clips"][c]["strategies"][0];
    EXPECT_EQ(row["summary"]["sentence"], query["clips"][c]["summary"]["sentence"]);
    EXPECT_EQ(row["details"].get<std::string>().find("the first clip that moves"), std::string::npos);
  }
  EXPECT_EQ(one["summary"]["sentence"], query["clips"][0]["summary"]["sentence"]);
  use_in_browser("all.html", "clip 'hug' (2nd of 2 clips)");
}

TEST_F(View, ABrowserShowsAClipThatTouchesNothing) {
  ASSERT_EQ(run("cscd view small -o page.html").status, 0);
  use_in_browser("page.html", "small does not touch itself in frames 0 to 5");
}

TEST_F(View, ABrowserShowsWhatComesClose) {
  ASSERT_EQ(run("cscd view figure.glb --clip hug --frames 0:25 --thickness 0.3e -o page.html").status, 0);
  const json header = header_of(text("page.html"));
  EXPECT_EQ(header["thickness"], "0.3e");
  EXPECT_GT(header["strategies"][0]["summary"]["close"], 0);
  EXPECT_TRUE(
      header["strategies"][0]["summary"]["headline"].is_null());  // so it opens at the first close pair
  use_in_browser("page.html", "comes within 0.3e of itself");
}

TEST_F(View, ADamagedPageSaysSoInOneLine) {
  ASSERT_EQ(run("cscd view small -o page.html").status, 0);
  const std::string whole = text("page.html");
  for (const auto& [element, filler] : {std::pair("arrays", 'A'), {"header", '{'}}) {
    std::string page = whole;
    page.replace(page.find("id=\"" + std::string(element) + "\">") + 200, 40, std::string(40, filler));
    put("page.html", page);
    const Ran ran = run("'" CSCD_NODE "' '" CSCD_PAGE_TESTS "/check.mjs' '" CSCD_PAGE_PACKAGES "' page.html");
    if (ran.status == 77) GTEST_SKIP() << ran.out;
    EXPECT_EQ(ran.status, 1);
    EXPECT_NE(ran.out.find("is damaged"), std::string::npos) << ran.out;
  }
}

}  // namespace
}  // namespace cscd::bench
