#include <filesystem>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scenes/clip/point_cache.h"
#include "scenes/clip/test_sparse_cache.h"

namespace cscd::scenes {
namespace {

// A sink that counts frames and keeps none.
class Counter final : public FrameSink {
 public:
  void append(const FrameView& frame, const FrameView*) override {
    ++frames;
    sum += frame.positions.front().x();
  }
  std::size_t frames = 0;
  double sum = 0;
};

std::size_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

// The test reads all frames of a file of 1 GB, in a process of its own, so that the peak of memory is that
// of the reading.
TEST(Streaming, ReadsAllFramesInTheMemoryOfAFew) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("cscd-stream-" + std::to_string(getpid()) + ".h5");
  const test::Shape sphere = test::icosphere(5);
  constexpr hsize_t frames = 4069;
  const hsize_t stored[] = {0, 1, frames - 1};
  write_sparse_cache(path, sphere, frames, stored);
  const std::size_t bytes = frames * sphere.positions.size() * sizeof(Vec3);
  EXPECT_GT(bytes, 1'000'000'000u);
  EXPECT_LT(std::filesystem::file_size(path), 10'000'000u);

  const pid_t child = fork();
  if (child == 0) {
    const std::size_t before = peak_bytes();
    PointCacheReader reader(path);
    Counter counter;
    copy_frames(reader, counter);
    const bool right = counter.frames == frames && counter.sum > static_cast<double>(frames) - 2;
    const bool small = peak_bytes() - before < (std::size_t{64} << 20);
    _exit(right ? small ? 0 : 1 : 2);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  std::filesystem::remove(path);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0) << "1: too much memory, 2: wrong frames";
}

}  // namespace
}  // namespace cscd::scenes
