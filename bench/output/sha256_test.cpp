#include "bench/output/sha256.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/test_folder.h"

namespace cscd::bench {
namespace {

// The examples of FIPS 180-4, and their sums as NIST publishes them.
TEST(Sha256, IsThePublishedSum) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, OfAFileIsThatOfItsBytes) {
  const test::Folder folder;
  // The file is longer than the block in which it is read, and the last block is not full.
  const std::string bytes(3'000'001, 'x');
  test::write(folder / "bytes", bytes);
  EXPECT_EQ(sha256_of_file(folder / "bytes"), sha256(bytes));
  EXPECT_THROW(sha256_of_file(folder / "none"), InputError);
}

}  // namespace
}  // namespace cscd::bench
