#include "bench/cli/output/sha256.h"

#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/error.h"

namespace cscd::bench {
namespace {

// The examples of FIPS 180-4, and their sums as NIST publishes them.
TEST(Sha256, IsThePublishedSum) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, OfAFileIsThatOfItsBytes) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("cscd-sha256-" + std::to_string(getpid()));
  // The file is longer than the block in which it is read, and the last block is not full.
  const std::string bytes(3'000'001, 'x');
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_EQ(sha256_of_file(path), sha256(bytes));
  std::filesystem::remove(path);
  EXPECT_THROW(sha256_of_file(path), InputError);
}

}  // namespace
}  // namespace cscd::bench
