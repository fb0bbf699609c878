#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/testing/test_program.h"
#include "scenes/clip/test_sparse_cache.h"

namespace cscd::bench {
namespace {

// 20 GB of frames, nearly all of them a hole in the file, at both ends of the clip.
TEST(LargeClips, AreStreamed) {
  const Scratch scratch;
  const std::string file = scratch / "large.h5";
  const test::Shape sphere = test::icosphere(4);
  constexpr hsize_t frames = 330'000;
  const hsize_t stored[] = {0, 1, 2, frames - 2, frames - 1};
  scenes::write_sparse_cache(file, sphere, frames, stored);
  ASSERT_GT(frames * sphere.positions.size() * sizeof(Vec3), 20'000'000'000u);
  Limits limits;
  limits.memory_bytes = std::size_t{1} << 30;
#ifdef __SANITIZE_ADDRESS__
  limits.seconds = 600;
#endif
  for (const char* range : {"0:2", "329998:329999"}) {
    const Outcome outcome =
        cscd({"query", file, "--frames", range, "--json", scratch / "out.json", "--force"}, limits);
    ASSERT_EQ(outcome.end, Outcome::End::exited) << to_text(outcome);
    EXPECT_EQ(outcome.code, 0) << outcome.errors;
#if !defined(__SANITIZE_ADDRESS__)
    EXPECT_LT(outcome.peak_bytes, std::size_t{200} << 20);
#endif
    const auto answer = nlohmann::json::parse(read(scratch / "out.json"));
    for (const auto& interval : answer["intervals"]) {
      EXPECT_EQ(interval["starts_embedded"], true) << "the frame that is stored there";
      EXPECT_EQ(interval["collides"], false);
    }
  }
}

}  // namespace
}  // namespace cscd::bench
