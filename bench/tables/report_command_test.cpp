#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/query/view/viewer_page.h"
#include "bench/testing/test_shell.h"

// cscd report from outside: the page that it writes, and what a browser makes of it.
namespace cscd::bench {
namespace {

class ReportPage : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    if (report_page().empty()) GTEST_SKIP() << "built without the pages";
    const Ran ran =
        run("cscd run --scene small --strategy base,mcd,drvbc,drvbc_fast --repetitions 2 --json small.json");
    ASSERT_EQ(ran.status, 0) << ran.errors;
  }
  // What a browser makes of a page; status 77 where there is none.
  Ran in_a_browser(const std::string& page) const {
    return run("'" CSCD_NODE "' '" CSCD_PAGE_TESTS "/check_report.mjs' '" CSCD_PAGE_PACKAGES "' " + page);
  }
  static constexpr char kAccuracy[] =
      "cscd accuracy --smoke --elementary newton,filtered_exact --hard-queries 20 --json a.json";
};

TEST_F(ReportPage, ShowsTheFiguresOfItsRecord) {
  const Ran ran = run("cscd report small.json -o site && cscd tables small.json --out .");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const std::string page = text("site/index.html"), begin = "id=\"header\">";
  const std::size_t from = page.find(begin) + begin.size();
  const auto document = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  EXPECT_EQ(document["tables"], nlohmann::json::parse(text("tables.json")));
  EXPECT_EQ(document["records"][0]["file"], "../small.json");
  const auto record = nlohmann::json::parse(text("small.json"));
  for (std::size_t s = 0; s < record["strategies"].size(); ++s)
    EXPECT_EQ(document["records"][0]["strategies"][s]["counts"]["pctp"],
              record["strategies"][s]["counts"]["pctp"]);
  expect_refused(run("cscd report small.json -o site"), "index.html");
  expect_refused(run("cscd report small.json small.json -o other"), "second record of scene");
}

TEST_F(ReportPage, TakesRecordsOfOtherStudies) {
  ASSERT_EQ(run(kAccuracy).status, 0);
  expect_refused(run("cscd report a.json -o site"), "a.json holds no record of cscd run");
  expect_refused(run("cscd report a.json"), "--out or --json");
  const auto alone = nlohmann::json::parse(run("cscd report a.json --json -").out);
  EXPECT_TRUE(alone["tables"].is_null());
  EXPECT_GT(alone["accuracy"]["data"]["all"]["newton"]["queries"], 0);
  expect_refused(run("cscd report small.json a.json a.json -o site"), "a second record of this study");
  expect_refused(run("echo {} > empty.json; cscd report empty.json -o site"), "empty.json");
  expect_refused(run("echo nothing > text.json; cscd report text.json -o site"),
                 "text.json: is no JSON and so no record");
  expect_refused(
      run("sed 's/\"workloads\"/\"no\"/' a.json > broken.json; cscd report small.json broken.json -o site"),
      "does not follow its schema");
  expect_refused(run("cscd report small.json --history nowhere -o site"), "nowhere");
  EXPECT_EQ(run("ls site").out, "");
}

// Also in records of cscd.scale/1, which do not say it in so many words.
TEST_F(ReportPage, MarksTimesOfRowsThatAnswerLess) {
  ASSERT_EQ(
      run("cscd scale --smoke --study thickness --scene small --strategy base,drvbc_fast --json s.json; "
          "grep -v '\"shortfall\"' s.json | sed s,cscd.scale/2,cscd.scale/1, > old.json; "
          "grep -q '\"shortfall\"' s.json")
          .status,
      0);
  for (const std::string record : {"s.json", "old.json"}) {
    ASSERT_EQ(run("cscd report small.json " + record + " --force -o site").status, 0);
    const std::string page = text("site/index.html"), begin = "id=\"header\">";
    const std::size_t from = page.find(begin) + begin.size();
    const auto document = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
    std::size_t marked = 0;
    for (const auto& point : document["growth"]["data"]["points"]) {
      EXPECT_FALSE(point["strategy"] == "base" && point["marked"]);
      if (point["strategy"] == "drvbc_fast" && point["size"] == 1) {
        EXPECT_TRUE(point["marked"]) << "at a mean edge every surface is close to itself";
      }
      marked += point["marked"].get<bool>();
    }
    EXPECT_GT(marked, 0u) << record;
  }
}

TEST_F(ReportPage, ADamagedPageSaysSoInOneLine) {
  ASSERT_EQ(run("cscd report small.json -o site").status, 0);
  std::string page = text("site/index.html");
  page.replace(page.find("id=\"header\">") + 300, 40, std::string(40, '{'));
  put("page.html", page);
  const Ran ran = in_a_browser("page.html");
  if (ran.status == 77) GTEST_SKIP() << ran.out;
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.out.find("The page is damaged"), std::string::npos) << ran.out;
}

TEST_F(ReportPage, HostileNamesAreText) {
  ASSERT_EQ(run("sed 's/\"name\": \"small\"/\"name\": \"<img src=x onerror=alert(1)>\"/' small.json > "
                "hostile.json; "
                "cscd report hostile.json -o site")
                .status,
            0);
  EXPECT_EQ(text("site/index.html").find("<img"), std::string::npos);
  EXPECT_NE(text("site/index.html").find("\\u003cimg"), std::string::npos);
  const Ran ran = in_a_browser("site/index.html");
  if (ran.status == 77) GTEST_SKIP() << ran.out;
  EXPECT_EQ(ran.status, 0) << ran.out << ran.errors;
}

// Everything at once: records of all kinds, a history and replays.
TEST_F(ReportPage, ABrowserShowsIt) {
  ASSERT_EQ(run(kAccuracy).status, 0);
  ASSERT_EQ(
      run("cscd scale --smoke --study size --scene small --strategy drvbc_fast,base --json s.json").status,
      0);
  ASSERT_EQ(run("cp small.json clean.json").status, 0);
  commit_for("clean.json");
  ASSERT_EQ(run("cscd history h --keep clean.json").status, 0);
  const Ran made = run("cscd report small.json a.json s.json --history h --view -o site");
  ASSERT_EQ(made.status, 0) << made.errors;
  const Ran ran = in_a_browser("site/index.html");
  if (ran.status == 77) GTEST_SKIP() << ran.out;
  EXPECT_EQ(ran.status, 0) << ran.out << ran.errors;
  std::printf("%s", ran.out.c_str());
}

}  // namespace
}  // namespace cscd::bench
