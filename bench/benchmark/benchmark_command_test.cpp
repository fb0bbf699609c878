#include <algorithm>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/output/schema.h"
#include "bench/testing/test_shell.h"

// The benchmark command from outside: what it writes, how it judges, and the program on its page.
namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

class PublicBenchmarkProgram : public Program {
 protected:
  void make(const std::string& words = "--count 30 --scene small --scene-intervals 2") const {
    const Ran ran = run("cscd benchmark make --out made " + words);
    ASSERT_EQ(ran.status, 0) << ran.errors;
  }
  ordered_json score(const std::string& answers) const {
    const Ran ran = run("cscd benchmark judge made " + answers + " --json -");
    EXPECT_EQ(ran.status, 0) << ran.errors;
    const auto document = ordered_json::parse(ran.out);
    EXPECT_EQ(schema_violation(document, "score.schema.json"), "");
    return document;
  }
};

// The Python program on the page of the benchmark.
std::string example() {
  const std::string page = test::read(scenes::scenes_folder().parent_path() / "bench" / "BENCHMARK.md");
  const std::string begin = "```python\n";
  const std::size_t first = page.find(begin) + begin.size();
  return page.substr(first, page.find("```", first) - first);
}

TEST_F(PublicBenchmarkProgram, MakesAnswersAndJudges) {
  const Ran made = run("cscd benchmark make --out made --count 30 --scene small --scene-intervals 2");
  ASSERT_EQ(made.status, 0) << made.errors;
  EXPECT_NE(made.out.find("made: 32 intervals of "), std::string::npos) << made.out;
  const Ran checked = run("cd made && sha256sum -c SHA256SUMS && ls | xargs");
  EXPECT_EQ(checked.status, 0) << checked.out << checked.errors;
  EXPECT_NE(checked.out.find(
                "SHA256SUMS hard.h5 manifest.json random.h5 scene-small.h5 shapes.h5 torn.h5 truth.jsonl"),
            std::string::npos)
      << checked.out;

  const Ran answered = run("cscd benchmark answer made --strategy base --json base.json.gz --repetitions 1");
  ASSERT_EQ(answered.status, 0) << answered.errors;
  EXPECT_EQ(answered.out, "cscd base with filtered_exact answers 32 of 32 intervals\n");
  const Ran judged = run("cscd benchmark judge made base.json.gz");
  EXPECT_EQ(judged.status, 0) << judged.errors;
  EXPECT_NE(judged.out.find("32 of 32"), std::string::npos) << judged.out;
  EXPECT_NE(run("cscd benchmark judge made base.json.gz --families").out.find("scenes/small"),
            std::string::npos);
  const ordered_json right = score("base.json.gz");
  EXPECT_EQ(right["all"]["misses"], 0);
  EXPECT_EQ(right["all"]["inventions"], 0);
  EXPECT_GT(right["all"]["expected"], 100);
  EXPECT_EQ(right["sets"]["scenes"]["intervals"], 2);
  EXPECT_EQ(right["unanswered"].size(), 0u);

  const Ran bones = run("cscd benchmark answer made --strategy drvbc --json drvbc.json --repetitions 1");
  EXPECT_NE(bones.out.find("needs a closed, consistently oriented surface"), std::string::npos) << bones.out;
  EXPECT_NE(bones.out.find("needs bones, and there are none"), std::string::npos) << bones.out;
  const ordered_json partial = score("drvbc.json");
  EXPECT_EQ(partial["all"]["broken"], 0);
  EXPECT_EQ(partial["unanswered"].size() + partial["all"]["answered"].get<std::size_t>(), 32u);

  // Whoever answers otherwise is scored all the same.
  const Ran newton = run("cscd benchmark answer made --strategy base --elementary newton --json newton.json");
  EXPECT_EQ(newton.status, 0) << newton.errors;
  EXPECT_GT(score("newton.json")["fault_count"], 0) << "the published test is not exact";
}

// Every word of the page's example has to be right: it reads the benchmark without any code of this project.
TEST_F(PublicBenchmarkProgram, IsAnsweredByTheExampleOnItsPage) {
  if (run("/usr/bin/python3 -c 'import h5py'").status != 0) GTEST_SKIP() << "no h5py";
  const std::string program = example();
  ASSERT_NE(program.find("import h5py"), std::string::npos);
  EXPECT_LE(std::count(program.begin(), program.end(), '\n'), 32);
  put("example.py", program);
  make();
  const Ran ran = run("/usr/bin/python3 example.py made >answers.json");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  const ordered_json all = score("answers.json")["all"];
  EXPECT_EQ(all["answered"], 32);
  EXPECT_EQ(all["collides_told"], 32);
  EXPECT_EQ(all["milliseconds"]["answers"], 32);
  EXPECT_GT(all["inventions"], 0) << "boxes overlap where nothing touches";
  EXPECT_LT(all["misses"], all["expected"]) << "boxes find what is far apart on the surface";
}

TEST_F(PublicBenchmarkProgram, RefusesWhatItCannotUse) {
  make("--smoke");
  expect_refused(run("cscd benchmark make --out made --smoke"), "made/manifest.json");
  EXPECT_EQ(run("cscd benchmark make --out made --smoke --force").status, 0);
  expect_refused(run("cscd benchmark make --out other --smoke --count 5"), "--count");
  expect_refused(run("cscd benchmark make --out other --scene smal"), "did you mean small?");
  expect_refused(run("cscd benchmark make --out /dev/null/other --smoke"), "cannot be made");
  EXPECT_FALSE(fs::exists(folder / "other/manifest.json"));
  expect_refused(run("cscd benchmark judge scenes answers.json"), "has no manifest.json");
  expect_refused(run("cscd benchmark judge made nothing.json"), "nothing.json: cannot be read");
  put("answers.json",
      "{\"schema\": \"cscd.answers/1\", \"program\": \"p\", \"guarantee\": \"complete\", \"answers\":\n"
      "[{\"id\": \"random-00001\", \"contacts\": [{\"vf\": [0, 1], \"time\": NaN}]}]}");
  expect_refused(run("cscd benchmark judge made answers.json"), "line 2: is no JSON, which has no NaN");
  put("answers.json",
      "{\"schema\": \"cscd.answers/1\", \"program\": \"p\", \"guarantee\": \"complete\", \"answers\":\n"
      "[{\"id\": \"random-77777\", \"contacts\": []}]}");
  expect_refused(run("cscd benchmark judge made answers.json"), "random-77777, which is no interval");
  expect_refused(run("cscd benchmark answer made --strategy bass --json a.json"), "did you mean base?");
  expect_refused(run("cscd benchmark answer made --strategy ablation --json a.json"), "is a group of");
  EXPECT_EQ(run("cp made/truth.jsonl saved; echo >>made/truth.jsonl").status, 0);
  expect_refused(run("cscd benchmark judge made answers.json"),
                 "truth.jsonl: is not the file that the manifest lists");
}

// A folder without a manifest is no benchmark, so what a full disk leaves is never judged by.
TEST_F(PublicBenchmarkProgram, LeavesNoManifestOnAFullOrReadOnlyDisk) {
  const Ran full = run(R"sh(mkdir disk; unshare -m true 2>/dev/null || exit 77
unshare -m bash -c 'mount -t tmpfs -o size=64k none disk || exit 77
cscd benchmark make --out disk --smoke; status=$?; ls disk; exit $status')sh");
  if (full.status == 77) GTEST_SKIP() << "may not mount";
  EXPECT_EQ(full.status, 2) << full.errors;
  EXPECT_EQ(full.errors.find("cscd: output disk/"), 0u) << full.errors;
  EXPECT_EQ(full.out.find("manifest.json"), std::string::npos) << full.out;
  const Ran fixed =
      run(R"sh(unshare -m bash -c 'mount -t tmpfs -o size=1m none disk && mount -o remount,ro disk || exit 77
cscd benchmark make --out disk --smoke')sh");
  EXPECT_EQ(fixed.status, 2) << fixed.errors;
  EXPECT_NE(fixed.errors.find("Read-only file system"), std::string::npos) << fixed.errors;
}

}  // namespace
}  // namespace cscd::bench
