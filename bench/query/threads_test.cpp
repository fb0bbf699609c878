// --threads changes how long an answer takes and nothing else.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/testing/test_program.h"
#include "scenes/clip/point_cache.h"
#include "scenes/random/random_interval.h"

namespace cscd::bench {
namespace {

class Threads : public testing::Test {
 protected:
  Threads() {
    scenes::RandomInterval random = scenes::make_random_interval(11);
    scenes::PointCacheWriter writer(file, random.clip.header(), false);
    scenes::copy_frames(random.clip, writer);
    writer.finish();
  }
  const Scratch scratch;
  const std::string file = scratch / "ball.h5", out = scratch / "out.json";
};

TEST_F(Threads, ChangeNoAnswer) {
  const nlohmann::json alone = document_of({"query", file, "--strategy", "drvbc_fast"});
  EXPECT_EQ(alone["threads"], 1);
  EXPECT_EQ(alone["intervals"][0]["collides"], true);
  for (const char* threads : {"2", "7"}) {
    const nlohmann::json shared =
        document_of({"query", file, "--strategy", "drvbc_fast", "--threads", threads});
    EXPECT_EQ(shared["threads"], std::stoi(threads));
    EXPECT_EQ(shared["intervals"][0]["contacts"], alone["intervals"][0]["contacts"]);
    EXPECT_EQ(shared["intervals"][0]["counts"], alone["intervals"][0]["counts"]);
  }
}

TEST_F(Threads, AreSaidForEveryStrategy) {
  EXPECT_EQ(document_of({"query", file, "--strategy", "base", "--threads", "2"})["threads"], 1);
  const nlohmann::json record =
      document_of({"run", "--input", file, "--strategy", "drvbc_fast,base", "--smoke", "--threads", "2"});
  EXPECT_EQ(record["strategies"][0]["threads"], 2);
  EXPECT_EQ(record["strategies"][1]["threads"], 1);
}

TEST_F(Threads, AreRefusedInOneLineUnlessAtLeastOne) {
  for (const char* threads : {"0", "-1", "two", "1.5", ""})
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"query", file}, {"run", "--input", file}, {"scale", "--smoke"}}) {
      std::vector<std::string> arguments = command;
      arguments.insert(arguments.end(), {"--json", out, "--threads", threads});
      SCOPED_TRACE(command[0] + " --threads '" + threads + "'");
      expect_refused(arguments, "--threads");
      EXPECT_FALSE(fs::exists(out));
    }
}

}  // namespace
}  // namespace cscd::bench
