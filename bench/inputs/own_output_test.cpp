#include "bench/inputs/own_output.h"

#include <gtest/gtest.h>

#include "bench/output/gzip.h"
#include "core/base/test_folder.h"

namespace cscd::bench {
namespace {

// What is said of a file of this name and content.
std::string said(const std::string& name, const std::string& content) {
  const test::Folder folder;
  test::write(folder / name, content);
  return why_own_output((folder / name).string());
}

TEST(OwnOutput, IsNamedWithTheCommandThatTakesIt) {
  EXPECT_NE(said("r.json", R"({"schema": "cscd.run/2", "environment": {}})")
                .find("is a record of cscd run; cscd tables /"),
            std::string::npos);
  EXPECT_NE(
      said("r.json", "\n {\n \"a\": 1,\n \"schema\" : \"cscd.query/4\"}").find("is an answer of cscd query"),
      std::string::npos);
  EXPECT_NE(
      said("long.json", R"({"intervals": ")" + std::string(1 << 20, 'x') + R"(", "schema": "cscd.query/4"})")
          .find("is an answer of cscd query"),
      std::string::npos)
      << "the schema stands behind all intervals";
  EXPECT_NE(said("r.json.gz", gzipped(R"({"schema": "cscd.scale/1"})")).find("is a record of cscd scale"),
            std::string::npos);
  EXPECT_NE(said("m.json.gz", gzipped(R"({"schema": "cscd.motion/1"})"))
                .find("was written by cscd (cscd.motion/1)"),
            std::string::npos);
  EXPECT_NE(said("queries.csv", "1,2").find("cscd elementary"), std::string::npos);
  EXPECT_NE(said("page.html", "<html>").find("browser"), std::string::npos);
}

TEST(OwnOutput, IsNothingElse) {
  EXPECT_EQ(said("scene.json", R"({"schema": "cscd.scene/1"})"), "");
  EXPECT_EQ(said("other.json", R"({"story": "a schema", "frames": 2})"), "");
  EXPECT_EQ(said("list.json", R"(["schema", "cscd.run/2"])"), "");
  EXPECT_EQ(said("cut.json", R"({"schema": )"), "");
  EXPECT_EQ(said("empty.json", ""), "");
  EXPECT_EQ(said("broken.json.gz", "\x1f\x8b broken"), "");
  EXPECT_EQ(said("model.glb", R"({"schema": "cscd.run/2"})"), "");
  EXPECT_EQ(why_own_output("rope"), "");
  EXPECT_EQ(why_own_output("/no/such/record.json"), "");
}

}  // namespace
}  // namespace cscd::bench
