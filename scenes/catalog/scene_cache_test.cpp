#include "scenes/catalog/scene_cache.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "scenes/base/test_says.h"

namespace cscd::scenes {
namespace {

const Expected kExpected{8, 12, 0, "ab"};
const std::string kValue = R"({"vertices": 8, "triangles": 12, "bones": 0, "digest": "ab"})";

std::string changed(const std::string& text) {
  return with_expected(text, kExpected, "x.json");
}

TEST(ExpectedText, ChangesNothingElse) {
  EXPECT_EQ(changed("{ \"a\":[1,  2], \"expected\" : {\"digest\": \"}]\"} ,\n\"b\": \"\\\"expected\" }\n"),
            "{ \"a\":[1,  2], \"expected\" : " + kValue + " ,\n\"b\": \"\\\"expected\" }\n");
  EXPECT_EQ(changed("{\n  \"a\": {\"expected\": 1}\n}\n"),
            "{\n  \"a\": {\"expected\": 1},\n  \"expected\": " + kValue + "\n}\n");
  EXPECT_EQ(changed("{\"expected\": null}"), "{\"expected\": " + kValue + "}");
  EXPECT_EQ(changed("{}"), "{\n  \"expected\": " + kValue + "}");
}

TEST(ExpectedText, IsRightWhateverTheTextLooksLike) {
  EXPECT_TRUE(says(changed("{\"\\u0065xpected\": 1}"), "\"ab\"")) << "the key in other letters";
  EXPECT_TRUE(says(changed("{\"expected\": 1, \"expected\": 2}"), kValue));
  EXPECT_THROW(changed("[1]"), InputError);
  EXPECT_THROW(changed("{"), InputError);
  EXPECT_THROW(changed(""), InputError);
}

}  // namespace
}  // namespace cscd::scenes
