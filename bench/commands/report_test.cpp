#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/testing/test_shell.h"
#include "bench/view/viewer_page.h"

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

TEST_F(ReportPage, ABrowserShowsIt) {
  ASSERT_EQ(run("cscd report small.json -o site").status, 0);
  const Ran ran =
      run("'" CSCD_NODE "' '" CSCD_PAGE_TESTS "/check_report.mjs' '" CSCD_PAGE_PACKAGES "' site/index.html");
  if (ran.status == 77) GTEST_SKIP() << ran.out;
  EXPECT_EQ(ran.status, 0) << ran.out << ran.errors;
  std::printf("%s", ran.out.c_str());
}

}  // namespace
}  // namespace cscd::bench
