#include "bench/output/gzip.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace cscd::bench {
namespace {

constexpr std::size_t kMost = 1 << 20;

std::string text_of(std::size_t bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes; ++i) text += static_cast<char>('a' + i * i % 23);
  return text;
}

TEST(Gzip, GivesBackWhatItWasGivenAndTheSameBytesEachTime) {
  for (const std::size_t bytes : {0, 1, 1000, 300'000}) {
    const std::string text = text_of(bytes), packed = gzipped(text);
    EXPECT_EQ(without_gzip(packed, "a", kMost), text);
    EXPECT_EQ(gzipped(text), packed);
    GzipStream stream;
    std::string pieces;
    for (std::size_t at = 0; at < text.size(); at += 70'000)
      pieces += stream.add(std::string_view(text).substr(at, 70'000), false);
    pieces += stream.add({}, true);
    EXPECT_EQ(pieces, packed);
  }
  EXPECT_LT(gzipped(text_of(300'000)).size(), 10'000u);
}

TEST(Gzip, LeavesPlainTextAlone) {
  for (const std::string text : {"", "{", "{\"a\": 1}"}) EXPECT_EQ(without_gzip(text, "a", kMost), text);
}

// Mutations: an end of the input counts as the end of the file; no limit.
TEST(Gzip, RefusesWhatIsDamagedOrTooLarge) {
  const std::string packed = gzipped(text_of(5000));
  for (const std::size_t kept : {std::size_t{2}, std::size_t{12}, packed.size() / 2, packed.size() - 1})
    EXPECT_THROW(without_gzip(packed.substr(0, kept), "a", kMost), InputError) << kept;
  std::string flipped = packed;
  flipped[packed.size() / 2] ^= 0x40;
  EXPECT_THROW(without_gzip(flipped, "a", kMost), InputError);
  EXPECT_THROW(without_gzip(gzipped(std::string(2 * kMost, 'x')), "a", kMost), InputError);
}

}  // namespace
}  // namespace cscd::bench
