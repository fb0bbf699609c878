#include "scenes/catalog/plain_name.h"

#include <gtest/gtest.h>

namespace cscd::scenes {
namespace {

TEST(PlainName, IsTheStemInSafeCharacters) {
  EXPECT_EQ(plain_name("rope"), "rope");
  EXPECT_EQ(plain_name("/some/where/my scene.json"), "my_scene");
  EXPECT_EQ(plain_name("../up/a*b\n.glb"), "a_b_");
  EXPECT_EQ(plain_name("Bär-1.2.fbx"), "Bär-1.2");
  EXPECT_EQ(plain_name("-rf"), "_rf");
  EXPECT_EQ(plain_name(".."), "_.");
  EXPECT_EQ(plain_name("folder/"), "unnamed");
  EXPECT_EQ(plain_name(""), "unnamed");
}

TEST(PlainName, IsNotLong) {
  EXPECT_EQ(plain_name(std::string(300, 'x')).size(), 64u);
  std::string umlauts = "x";
  for (int i = 0; i < 100; ++i) umlauts += "ä";
  EXPECT_EQ(plain_name(umlauts).size(), 63u) << "no character is cut in two";
}

}  // namespace
}  // namespace cscd::scenes
