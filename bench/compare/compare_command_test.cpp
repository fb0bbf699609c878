#include <nlohmann/json.hpp>

#include "bench/output/schema.h"
#include "bench/testing/test_shell.h"

// These tests compare and keep records as a user of a shell does.
namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

class CompareCommand : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    const Ran ran = run("cscd run --smoke --strategy base,aabb --scene small --json old.json");
    ASSERT_EQ(ran.status, 0) << ran.errors;
  }
  // Writes NAME, a copy of the record after a command of sed.
  void put_changed(const std::string& name, const std::string& command) const {
    const Ran ran = run("sed '" + command + "' old.json > " + name + "; ! cmp -s old.json " + name);
    ASSERT_EQ(ran.status, 0) << command << " changes nothing";
  }
};

TEST_F(CompareCommand, EndsWithWhatItFound) {
  EXPECT_EQ(run("cscd compare old.json old.json --lane counters").status, 0);
  const Ran one = run("cscd compare old.json old.json");
  EXPECT_EQ(one.status, 2);
  EXPECT_EQ(one.out.find("verdict: nothing worse in what was compared; small: times not compared: "), 0u)
      << one.out;
  EXPECT_NE(one.out.find("small: times not compared: the smaller side has 1 process"), std::string::npos)
      << one.out;
  put_changed("dearer.json", R"(s/"bvot": \[[0-9]*/&9/)");
  const Ran dearer = run("cscd compare old.json dearer.json");
  EXPECT_EQ(dearer.status, 1) << dearer.out;
  EXPECT_NE(dearer.out.find("verdict: worse"), std::string::npos) << dearer.out;
  EXPECT_EQ(run("cscd compare dearer.json old.json --lane counters").status, 0);
  put_changed("other.json", R"(s/"digests": \["[0-9a-f]*"/"digests": ["0"/)");
  const Ran other = run("cscd compare old.json other.json");
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.out.find("verdict: less true"), std::string::npos) << other.out;
}

TEST_F(CompareCommand, WritesJsonAndMarkdown) {
  const Ran ran = run("cscd compare old.json old.json --lane counters --json c.json --markdown c.md");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(schema_violation(ordered_json::parse(text("c.json")), "compare.schema.json"), "");
  EXPECT_NE(text("c.md").find("## Verdict: nothing worse"), std::string::npos) << text("c.md");
  EXPECT_EQ(schema_violation(ordered_json::parse(run("cscd compare old.json old.json --json - | cat").out),
                             "compare.schema.json"),
            "");
}

TEST_F(CompareCommand, RefusesWhatIsNoRecord) {
  expect_refused(run("cscd compare old.json none.json"), "none.json: cannot be read");
  expect_refused(run("echo {} > empty.json; cscd compare old.json empty.json"), "empty.json");
  expect_refused(run("mkdir f; cscd compare f old.json"), "holds no record");
  expect_refused(run("echo text > text.md; cscd compare old.json text.md"),
                 "record text.md: is no JSON and so no record");
}

TEST_F(CompareCommand, ReadsFilesOfGoogleBenchmark) {
  put("g.json", R"({"context": {"executable": "sort"}, "benchmarks": [
    {"name": "sort/8", "real_time": 2, "time_unit": "ms"}, {"name": "sort/8", "real_time": 3, "time_unit": "ms"}]})");
  const Ran same = run("cscd compare g.json g.json");
  EXPECT_NE(same.out.find("times of a whole query without a verdict"), std::string::npos) << same.out;
  const Ran nothing = run("cscd compare g.json g.json --lane counters");
  EXPECT_EQ(nothing.status, 2) << "such a file has times alone";
  EXPECT_NE(nothing.out.find("share no answer and no counter"), std::string::npos) << nothing.out;
}

TEST_F(CompareCommand, KeepsAHistoryThatIsNeverRewritten) {
  put_changed("clean.json", R"(s/"dirty": \(true\|false\)/"dirty":  false/)");
  const std::string keep = "cscd history h --keep clean.json";
  expect_refused(run(keep), "git knows no commit ");
  commit_for("clean.json");
  const Ran kept = run(keep);
  EXPECT_EQ(kept.status, 0) << kept.errors;
  EXPECT_NE(kept.out.find("/2026-11-25-"), std::string::npos) << kept.out;
  EXPECT_NE(text(kept.out.substr(6, kept.out.size() - 7)).find(R"("committed": "2026-11-25T10:00:00+00:00")"),
            std::string::npos);
  expect_refused(run(keep), "never rewritten");
  expect_refused(run("for f in h/*/*.json; do mv $f ${f%/*}/2026-11-24-${f##*-}; done; " + keep),
                 "never rewritten");
  expect_refused(run(keep + " --committed 2026-11-25T12:00:00+00:00"), "unknown option --committed");
  EXPECT_NE(run("cscd history h --stage total").out.find("of a single commit; --all"), std::string::npos);
  const Ran shown = run("cscd history h --row base --stage total --all --json courses.json");
  EXPECT_EQ(shown.status, 0) << shown.errors;
  EXPECT_NE(shown.out.find("small, base, total"), std::string::npos) << shown.out;
  EXPECT_EQ(ordered_json::parse(text("courses.json")).at("courses").size(), 1u);
  expect_refused(run("cscd history nowhere"), "holds no entry");
}

}  // namespace
}  // namespace cscd::bench
