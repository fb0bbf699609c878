#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "bench/cli/output/json_text.h"
#include "bench/cli/output/schema.h"
#include "bench/measure/replay/replay.h"
#include "bench/measure/shards/code_version.h"
#include "bench/measure/shards/plan.h"
#include "bench/testing/test_shell.h"

// These tests plan, measure and merge cells as a user of a shell does: in any order, interrupted, on full
// disks and beyond limits.
namespace cscd::bench {
namespace {

using nlohmann::ordered_json;

class Shards : public Program {
 protected:
  static constexpr char kPlan[] =
      "cscd plan --scene small --strategy base,drvbc,drvbc_fast --cell-intervals 1 ";

  void plan_counts() const { ASSERT_EQ(run(std::string(kPlan) + "--out plan.json").status, 0); }
  void plan_timings() const {
    ASSERT_EQ(run(std::string(kPlan) + "--kind timings --repetitions 2 --out plan.json").status, 0);
  }
  Ran merged(const std::string& name, const std::string& folders = "cells") const {
    return run("cscd merge --plan plan.json " + folders + " --out " + name);
  }
  // The statuses of a shard's cells, as its state tells them.
  std::string statuses(const std::string& folder_name, const std::string& shard = "1-of-1") const {
    const Ran state = run("cat " + folder_name + "/*-shard-" + shard + ".json");
    const ordered_json json = ordered_json::parse(state.out);
    EXPECT_EQ(schema_violation(json, "shard.schema.json"), "");
    std::string out;
    for (const ordered_json& cell : json.at("cells"))
      out += (out.empty() ? "" : " ") + cell.at("status").get<std::string>();
    return out;
  }
  // Changes the results in a folder that have a name like this, by a command of sed.
  void change_results(const std::string& pattern, const std::string& command) const {
    const Ran ran = run("for file in " + pattern + "; do gzip -dc $file >+old; sed '" + command +
                        "' +old >+new; cmp -s +old +new && exit 1; gzip -c +new >$file; done");
    ASSERT_EQ(ran.status, 0) << command << " changes nothing";
  }
};

std::multiset<std::string> words_of(const std::string& text) {
  std::istringstream words(text);
  return {std::istream_iterator<std::string>(words), {}};
}

TEST_F(Shards, MergeToWhatOneRunCounts) {
  plan_counts();
  EXPECT_EQ(schema_violation(ordered_json::parse(text("plan.json")), "plan.schema.json"), "");
  const Ran ran = run("cscd run --plan plan.json --into cells");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(statuses("cells"), "done done done done done");
  ASSERT_EQ(merged("merged.json").status, 0);
  ASSERT_EQ(
      run("cscd run --scene small --strategy base,drvbc,drvbc_fast --repetitions 1 --json run.json").status,
      0);
  const ordered_json one = ordered_json::parse(text("run.json")),
                     many = ordered_json::parse(text("merged.json"));
  for (const char* key : {"schema", "pipeline", "elementary", "seed", "intervals", "counted_intervals"})
    EXPECT_EQ(one.at(key), many.at(key)) << key;
  EXPECT_EQ(one.at("scene").at("digest"), many.at("scene").at("digest"));
  for (const char* key : {"ok", "reference", "intervals", "unembedded", "colliding", "disagreeing", "excused",
                          "strategies", "accuracy"})
    EXPECT_EQ(one.at("verification").at(key), many.at("verification").at(key)) << key;
  ASSERT_EQ(many.at("strategies").size(), 3u);
  for (std::size_t s = 0; s < 3; ++s)
    for (const char* key : {"name", "guarantee", "counts", "digests", "first_times"})
      EXPECT_EQ(one.at("strategies").at(s).at(key), many.at("strategies").at(s).at(key)) << key;
  EXPECT_EQ(schema_violation(many, "run.schema.json"), "");
  EXPECT_EQ(run("cscd tables merged.json").status, 0);
}

TEST_F(Shards, MergeToTheSameBytesInAnyOrderAndNumber) {
  plan_counts();
  ASSERT_EQ(
      run("cscd run --plan plan.json --into one && cscd merge --plan plan.json one --out one.json").status,
      0);
  const Ran ran = run(R"sh(for i in 3 1; do cscd run --plan plan.json --shard $i/3 --into here || exit 1; done
cscd run --plan plan.json --shard 2/3 --into there || exit 1
for i in 1 2 3 4 5 6 7; do cscd run --plan plan.json --shard $i/7 --into seven >/dev/null & done; wait
cscd merge --plan plan.json there here --out three.json && cscd merge --plan plan.json seven --out seven.json)sh");
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(text("one.json"), text("three.json"));
  EXPECT_EQ(text("one.json"), text("seven.json"));
}

TEST_F(Shards, KeepTimesOfEveryCell) {
  plan_timings();
  ASSERT_EQ(run("cscd run --plan plan.json --into cells").status, 0);
  ASSERT_EQ(merged("merged.json").status, 0);
  const ordered_json record = ordered_json::parse(text("merged.json"));
  EXPECT_EQ(schema_violation(record, "run.schema.json"), "");
  EXPECT_EQ(record.at("processes"), 5);
  EXPECT_EQ(record.at("timed_intervals").size(), 5u);
  for (const ordered_json& strategy : record.at("strategies")) {
    ASSERT_EQ(strategy.at("ms").at("traversal").size(), 2u);
    for (const ordered_json& repetition : strategy.at("ms").at("traversal")) EXPECT_EQ(repetition.size(), 5u);
  }
  ASSERT_EQ(run("cscd tables merged.json --out .").status, 0);
  EXPECT_NE(text("tables.md").find("| 2 by 5 processes |"), std::string::npos) << text("tables.md");
}

TEST_F(Shards, GoOnWhereTheyStopped) {
  plan_counts();
  ASSERT_EQ(run("cscd run --plan plan.json --shard 1/2 --into cells").status, 0);
  const Ran missing = merged("merged.json");
  EXPECT_EQ(missing.status, 2);
  EXPECT_NE(missing.errors.find("2 of 5 cells have no result"), std::string::npos) << missing.errors;
  EXPECT_NE(missing.out.find("frames 1:2\nmissing: "), std::string::npos) << missing.out;
  EXPECT_FALSE(fs::exists(folder / "merged.json"));
  const Ran rest =
      run("stat -c '%n %y' cells/*.gz >before; cscd run --plan plan.json --into cells || exit 1\n"
          "while read -r line; do stat -c '%n %y' cells/*.gz | grep -qxF \"$line\" || exit 1; done <before");
  EXPECT_EQ(rest.status, 0) << "a result that was there was measured again";
  EXPECT_EQ(rest.out.find("frames 0:1"), std::string::npos);
  EXPECT_NE(rest.out.find("frames 1:2: done"), std::string::npos) << rest.out;
  EXPECT_EQ(merged("merged.json").status, 0);
}

TEST_F(Shards, TellWhichLimitACellMet) {
  plan_counts();
  const Ran late = run("cscd run --plan plan.json --into cells --cell-seconds 0.001");
  EXPECT_EQ(late.status, 2);
  EXPECT_NE(late.errors.find("5 of 5 cells have no result"), std::string::npos) << late.errors;
  EXPECT_EQ(statuses("cells"), "time_limit time_limit time_limit time_limit time_limit");
  EXPECT_EQ(run("cscd run --plan plan.json --into cells --cell-seconds 600 --cell-memory 4096").status, 0);
  EXPECT_EQ(statuses("cells"), "done done done done done");
}

#if !defined(__SANITIZE_ADDRESS__)  // which limits no memory
TEST_F(Shards, TellThatMemoryIsShort) {
  std::string large = scenes::kSmallScene;
  for (const auto& [from, to] :
       {std::pair("\"rings\": 10, \"sides\": 8", "\"rings\": 800, \"sides\": 100"),
        {"\"frames\": 6", "\"frames\": 3"},
        {"\"vertices\": 82, \"triangles\": 160", "\"vertices\": 80002, \"triangles\": 160000"},
        {", \"digest\": \"0000000000000000\"", ""}})
    large.replace(large.find(from), std::string(from).size(), to);
  put("scenes/large.json", large);
  ASSERT_EQ(run("cscd plan --scene large --strategy base --cell-intervals 1 --out plan.json").status, 0);
  const Ran ran = run("cscd run --plan plan.json --into cells --cell-memory 192");
  EXPECT_EQ(ran.status, 2) << ran.out;
  EXPECT_EQ(statuses("cells"), "memory_limit memory_limit") << ran.out;
  EXPECT_NE(ran.out.find("raise --cell-memory"), std::string::npos) << ran.out;
}
#endif

TEST_F(Shards, GoOnWhereTheDiskIsFull) {
  plan_counts();
  const Ran ran = run(R"sh(cscd run --plan plan.json --into whole && mkdir disk || exit 1
unshare -m true 2>/dev/null || exit 77
unshare -m bash -c 'mount -t tmpfs -o size=16k none disk || exit 77
  cscd run --plan plan.json --into disk >out; echo $? >status
  rm disk/*.gz; cscd run --plan plan.json --shard 1/5 --into disk && cp disk/*.gz kept')sh");
  if (ran.status == 77) GTEST_SKIP() << "may not mount";
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(text("status"), "2\n");
  EXPECT_NE(text("out").find("done\n"), std::string::npos) << text("out");
  EXPECT_NE(text("out").find("disk_full: cscd: output "), std::string::npos) << text("out");
  EXPECT_EQ(run("for file in whole/*.gz; do cmp -s $file kept && exit; done; exit 1").status, 0);
}

TEST_F(Shards, RefuseAFolderThatIsReadOnly) {
  plan_counts();
  const Ran ran = run(R"sh(mkdir disk; unshare -m true 2>/dev/null || exit 77
unshare -m bash -c 'mount -t tmpfs -o size=1m none disk && mount -o remount,ro disk || exit 77
  cscd run --plan plan.json --into disk')sh");
  if (ran.status == 77) GTEST_SKIP() << "may not mount";
  expect_refused(ran, "Read-only file system");
}

// Starts a worker and stops one of its cells in the middle, whichever that is. A cell that is ending takes
// the signal and is not stopped.
constexpr char kStopACell[] = R"sh(worker=$!
until cell=$(pgrep -n -P $worker) && kill -STOP $cell 2>/dev/null && sleep 0.02 &&
  grep -q '^State:.T' /proc/$cell/status 2>/dev/null; do
  kill -0 $worker || exit 78
done
)sh";

TEST_F(Shards, GoOnWhereACellTakesTooLong) {
  plan_counts();
  const Ran ran = run("cscd run --plan plan.json --into cells --cell-seconds 5 & " + std::string(kStopACell) +
                      "wait $worker");
  ASSERT_NE(ran.status, 78) << "no cell was at work";
  EXPECT_EQ(ran.status, 2) << ran.out << ran.errors;
  const std::string became = statuses("cells");
  EXPECT_EQ(std::multiset<std::string>({"time_limit", "done", "done", "done", "done"}), words_of(became))
      << became;
  EXPECT_NE(ran.out.find("; raise --cell-seconds, or plan smaller cells\n"), std::string::npos) << ran.out;
  EXPECT_EQ(run("cscd run --plan plan.json --into cells").status, 0);
  EXPECT_EQ(statuses("cells"), "done done done done done");
}

TEST_F(Shards, TellThatTheFolderHasBecomeReadOnly) {
  plan_counts();
  const Ran ran =
      run("mkdir disk; unshare -m true 2>/dev/null || exit 77\nunshare -m bash -c '"
          "mount -t tmpfs -o size=1m none disk || exit 77\n"
          "cscd run --plan plan.json --into disk >out & " +
          std::string(kStopACell) +
          "until mount -o remount,ro disk 2>/dev/null; do sleep 0.05; done\n"
          "kill -CONT $cell; wait $worker; echo $? >status; mount -o remount,rw disk || exit\n"
          "cscd run --plan plan.json --into disk && cp -r disk kept'");
  if (ran.status == 77) GTEST_SKIP() << "may not mount";
  ASSERT_NE(ran.status, 78) << "no cell was at work";
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(text("status"), "2\n");
  EXPECT_NE(text("out").find(": read_only: cscd: output "), std::string::npos) << text("out");
  EXPECT_EQ(statuses("kept"), "done done done done done");
}

TEST_F(Shards, LeaveAValidStateAtSignals) {
  plan_counts();
  ASSERT_EQ(
      run("cscd run --plan plan.json --into whole && cscd merge --plan plan.json whole --out whole.json")
          .status,
      0);
  for (const std::string signal : {"INT", "TERM"})
    for (const std::string delay : {"0.02", "0.08", "0.3"}) {
      const Ran ran =
          run("set -m\nrm -rf cells\ncscd run --plan plan.json --into cells >/dev/null & worker=$!\nsleep " +
              delay + "\nkill -" + signal +
              " $worker; wait $worker; ended=$?; sleep 0.1\n"
              "[ $ended = 0 ] || [ $ended = " +
              (signal == "INT" ? "130" : "143") +
              " ] || exit 4\n"
              "for file in cells/*.gz; do [ ! -e $file ] || gzip -t $file || exit 1; done\n"
              "[ -z \"$(find . -name '.cscd-unfinished-*')\" ] || exit 2\n"
              "cscd run --plan plan.json --into cells >/dev/null || exit 3\n"
              "cscd merge --plan plan.json cells --out merged.json --force >/dev/null && "
              "cmp merged.json whole.json");
      EXPECT_EQ(ran.status, 0) << signal << " after " << delay << ": " << ran.errors;
    }
}

TEST_F(Shards, RefuseToMixBuildsAndMachines) {
  plan_timings();
  ASSERT_EQ(run("cscd run --plan plan.json --into cells && cp -r cells kept").status, 0);
  const std::string one = "$(ls cells/*.gz | tail -1)";
  for (const auto& [change, reason] :
       {std::pair("s/\"cpu\": \"/&other /", "differ in their environment (cpu: "),
        {"s/\"kernel\": \"/&other /", "differ in their environment (kernel: "},
        {"s/\"compiler\": \"/&other /", "differ in their environment (compiler: "},
        {"s/\"commit\": \"/&0/", "its commit and instruction set are not those of cell"},
        {"s/\"counted_intervals\": \\[/&7, /", "not one a counted interval"},
        {"s/\"digest\": \"/&0/", "its frames are not those of cell"}}) {
    change_results(one, change);
    expect_refused(merged("merged.json"), reason);
    run("rm -r cells; cp -r kept cells");
  }
  change_results(one, "s/\"date\": \"/&1/");
  EXPECT_EQ(merged("merged.json").status, 0) << "a moment is no machine";
}

TEST_F(Shards, AreOfOneVersionOfTheCodeAndOneInput) {
  setenv("CSCD_SCENES", (folder / "scenes").c_str(), 1);
  setenv("CSCD_CACHE", (folder / "cache").c_str(), 1);
  ReplayRequest request;
  request.scene = "small";
  request.strategies = {"base"};
  Input input = open_input(request.scene);
  const auto plan = [&](const ordered_json& code) {
    return make_plan(input, resolve(input, request, ReplayKind::counts), 2, code);
  };
  ordered_json other = code_version();
  other["commit"] = "0123456789";
  EXPECT_NE(plan(code_version()).cells.front().id, plan(other).cells.front().id);
  EXPECT_EQ(plan(code_version()).cells.front().id, plan(code_version()).cells.front().id);
  put("other.json", json_text(to_json(plan(other))));
  expect_refused(run("cscd run --plan other.json --into cells"),
                 "make the plan anew, or run the program that made it");

  plan_counts();
  expect_refused(
      run("sed 's/\"seed\": 2014/\"seed\": 2015/' plan.json >p.json; cscd run --plan p.json --into cells"),
      "is not what its id says");
  expect_refused(
      run("sed 's/cscd.plan.1/cscd.plan.9/' plan.json >p.json; cscd run --plan p.json --into cells"),
      "does not follow its schema");
  expect_refused(run("echo {} >p.json; cscd merge --plan p.json cells --out m.json"),
                 "does not follow its schema");
  expect_refused(run("cscd merge --plan none.json cells --out m.json"), "plan none.json: cannot be read");

  std::string scene = scenes::small_scene_with_digest();
  scene.replace(scene.find("\"rings\": 10"), 11, "\"rings\": 11");
  scene.replace(scene.find(", \"digest\""), 30, "");
  put("scenes/small.json", scene);
  const Ran changed = run("cscd run --plan plan.json --into cells");
  EXPECT_EQ(changed.status, 2);
  EXPECT_EQ(statuses("cells"), "failed failed failed failed failed") << changed.out;
}

TEST_F(Shards, NeedWhatTheyAreTold) {
  plan_counts();
  expect_refused(run("cscd run --plan plan.json"), "--into is required");
  expect_refused(run("cscd run --plan plan.json --scene small --into cells"), "--scene");
  expect_refused(run("cscd run --shard 1/2 --json x.json"), "--plan");
  expect_refused(run("cscd run --plan plan.json --into cells --shard 3/2"), "is no shard");
  expect_refused(run("cscd run --plan plan.json --into cells --cell 0123456789abcdef"),
                 "is none of plan plan.json");
  expect_refused(run("cscd plan --scene all --out p.json"), "all");
  expect_refused(run("cscd plan --scene small --kind neither --out p.json"), "--kind");
  expect_refused(run(std::string(kPlan) + "--out plan.json"), "exists");
}

TEST_F(Shards, AreSubmittedToWorkersHere) {
  plan_counts();
  ASSERT_EQ(
      run("cscd run --plan plan.json --into one && cscd merge --plan plan.json one --out one.json").status,
      0);
  const Ran ran = run("cscd submit --plan plan.json --into cells --workers 3");
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_EQ(statuses("cells", "3-of-3"), "done");
  ASSERT_EQ(merged("merged.json").status, 0);
  EXPECT_EQ(text("one.json"), text("merged.json"));
  EXPECT_EQ(run("cscd submit --plan plan.json --into late --workers 2 --cell-seconds 0.001").status, 2);
}

// scripts/check-slurm runs these scripts in Slurm. Its place is taken here by a program that runs the tasks
// of the script that it reads.
TEST_F(Shards, AreSubmittedToSlurm) {
  plan_counts();
  const std::string submit = "cscd submit --plan plan.json --into cells --workers 2 --executor slurm";
  expect_refused(run("PATH=${PATH%%:*} cscd submit --plan plan.json --into cells --executor slurm"),
                 "sbatch: did not take the job (there is no such program); ");
  const auto put_sbatch = [&](const std::string& text) {
    ASSERT_EQ(
        run("mkdir -p bin; cat >bin/sbatch <<'TEXT'\n#!/bin/bash\n" + text + "\nTEXT\nchmod +x bin/sbatch")
            .status,
        0);
  };
  put_sbatch("echo sbatch: a hint >&2; echo sbatch: error: no such partition >&2; exit 1");
  expect_refused(run("PATH=$PWD/bin:$PATH " + submit),
                 "sbatch: did not take the job (sbatch: error: no such partition); ");
  put_sbatch(R"sh(echo sbatch: a hint >&2; cat >job
tasks=$(sed -n 's/^#SBATCH --array=1-//p' job)
for ((task = 1; task <= tasks; task++)); do SLURM_ARRAY_TASK_ID=$task bash job || exit 1; done)sh");
  const Ran sent = run("PATH=$PWD/bin:$PATH " + submit + " --cell-seconds 600");
  EXPECT_EQ(sent.status, 0) << sent.errors;
  EXPECT_EQ(sent.errors, "sbatch: a hint\n");
  EXPECT_EQ(statuses("cells", "1-of-2"), "done done done");
  EXPECT_EQ(merged("merged.json").status, 0);
  ASSERT_EQ(run(submit + " --script job.sbatch --cell-seconds 600").status, 0);
  EXPECT_EQ(text("job.sbatch"), text("job"));
  expect_refused(run("cscd submit --plan plan.json --into cells --script job.sbatch"),
                 "is of --executor slurm");
}

TEST_F(Shards, ShareNodesUnlessTheyTakeTimes) {
  const auto script = [&](const std::string& words) {
    const Ran ran = run("cscd submit --plan plan.json --into cells --executor slurm --script - " + words);
    EXPECT_EQ(ran.status, 0) << ran.errors;
    return ran.out;
  };
  plan_counts();
  const std::string counts = script("--workers 200");
  EXPECT_NE(counts.find("#SBATCH --oversubscribe\n"), std::string::npos) << counts;
  EXPECT_EQ(counts.find("--exclusive"), std::string::npos) << counts;
  EXPECT_NE(counts.find("#SBATCH --array=1-5\n"), std::string::npos) << "there are five cells: " << counts;
  EXPECT_NE(counts.find("\"$SLURM_ARRAY_TASK_ID/5\""), std::string::npos) << counts;
  ASSERT_EQ(
      run(std::string(kPlan) + "--kind timings --repetitions 2 --threads 3 --force --out plan.json").status,
      0);
  const std::string timings = script("--workers 2");
  EXPECT_NE(timings.find("#SBATCH --exclusive\n"), std::string::npos) << timings;
  EXPECT_EQ(timings.find("--oversubscribe"), std::string::npos) << timings;
  EXPECT_NE(timings.find("#SBATCH --cpus-per-task=3\n"), std::string::npos) << timings;
  expect_refused(run("cscd submit --plan plan.json --into cells --workers 2"), "would slow each other down");
}

}  // namespace
}  // namespace cscd::bench
