// Runs a fuzz target without libFuzzer:
//
//   fuzz_NAME_replay [--random COUNT] [FILE|FOLDER]...
//
// on each file, and then on COUNT inputs that are made at random, always the same ones: random bytes, and the
// files with some bytes changed, removed or doubled.
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/target.h"

namespace {

namespace fs = std::filesystem;
using Input = std::vector<std::uint8_t>;

constexpr std::size_t kLongest = 4096;  // of random bytes

Input read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<fs::path> files_of(const fs::path& path) {
  if (!fs::is_directory(path)) return {path};
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class Maker {
 public:
  explicit Maker(const std::vector<Input>& stored) : stored_(stored) {}

  Input next() {
    if (stored_.empty() || random_() % 4 == 0) return noise();
    Input input = stored_[random_() % stored_.size()];
    for (std::size_t changes = 1 + random_() % 8; changes > 0 && !input.empty(); --changes) change(input);
    return input;
  }

 private:
  Input noise() {
    Input input(random_() % kLongest);
    for (std::uint8_t& byte : input) byte = static_cast<std::uint8_t>(random_());
    return input;
  }
  void change(Input& input) {
    const auto at = input.begin() + static_cast<std::ptrdiff_t>(random_() % input.size());
    const auto length =
        std::min<std::ptrdiff_t>(1 + static_cast<std::ptrdiff_t>(random_() % 32), input.end() - at);
    switch (random_() % 5) {
      case 0:
        *at = static_cast<std::uint8_t>(random_());
        break;
      case 1:
        *at ^= static_cast<std::uint8_t>(1U << random_() % 8);
        break;
      case 2:
        input.erase(at, at + length);
        break;
      case 3: {
        const Input copy(at, at + length);
        input.insert(at, copy.begin(), copy.end());
        break;
      }
      default:
        *at = random_() % 2 == 0 ? 0 : 0xff;
    }
  }

  const std::vector<Input>& stored_;
  std::mt19937 random_{1};
};

}  // namespace

int main(int count, char** words) {
  std::size_t random = 0;
  std::vector<Input> stored;
  for (int i = 1; i < count; ++i) {
    if (std::string_view(words[i]) != "--random") {
      for (const fs::path& file : files_of(words[i])) stored.push_back(read(file));
      continue;
    }
    const std::string_view number = i + 1 < count ? words[++i] : "";
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), random);
    if (error != std::errc() || end != number.data() + number.size()) {
      std::fprintf(stderr, "usage: %s [--random COUNT] [FILE|FOLDER]...\n", words[0]);
      return 2;
    }
  }
  for (const Input& input : stored) cscd::fuzz::target(input);
  Maker maker(stored);
  for (std::size_t i = 0; i < random; ++i) cscd::fuzz::target(maker.next());
  std::printf("%zu stored and %zu random inputs: every promise is kept\n", stored.size(), random);
  return 0;
}
