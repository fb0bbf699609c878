#include "bench/inputs/input.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <stdexcept>
#include <string>

#include "core/base/test_folder.h"
#include "core/base/test_refusal.h"

namespace cscd::bench {
namespace {

// The message with which work about the input walk.fbx fails.
std::string said(const std::string& what) {
  return test::refusal([&] { name_input("walk.fbx", [&] { throw InputError(what); }); });
}

// Mutations: the name is put before every message; other faults are taken for faults of the input.
TEST(NameInput, LetsFaultsOfAnInputBeginWithItsName) {
  EXPECT_EQ(said("no frame moves it"), "walk.fbx: no frame moves it");
  EXPECT_EQ(said("cannot read walk.fbx"), "cannot read walk.fbx");
  EXPECT_THROW(name_input("walk.fbx", [] { throw std::logic_error("a fault of ours"); }), std::logic_error);
}

// A folder is an input, but it hides no scene. Mutation: it does.
TEST(ModelFile, IsNoFolderThatIsCalledLikeAScene) {
  const test::Folder scratch;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(scratch.path);
  std::filesystem::create_directory("man");
  std::filesystem::create_directory("frames");
  EXPECT_FALSE(is_model_file("man"));
  EXPECT_TRUE(is_model_file("./man"));
  EXPECT_TRUE(is_model_file("frames"));
  std::filesystem::current_path(before);
}

TEST(ShortName, IsTheLastPartOfAPath) {
  for (const char* name : {"walk", "a/walk", "./walk", "walk/", "a/walk//", "a/b/../walk/."})
    EXPECT_EQ(short_name(name), "walk") << name;
  EXPECT_EQ(short_name("a/walk.fbx"), "walk.fbx");
  EXPECT_EQ(short_name("."), std::filesystem::current_path().filename().string());
  EXPECT_EQ(short_name("./"), short_name("."));
}

}  // namespace
}  // namespace cscd::bench
