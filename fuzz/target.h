#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <unistd.h>

// A fuzz target is one function that takes any bytes. libFuzzer searches for bytes that break a promise of
// the code behind it (entry.cpp, scripts/find-faults fuzz); replay.cpp runs stored and random bytes in every
// build.
namespace cscd::fuzz {

using Bytes = std::span<const std::uint8_t>;

// Defined once in each program. Returns where the code does what it promises, a refusal by InputError
// included.
void target(Bytes bytes);

// Says which promise is broken, and ends the program abnormally.
[[noreturn]] inline void broken(const std::string& promise) {
  std::fprintf(stderr, "broken: %s\n", promise.c_str());
  std::abort();
}

// A file in memory that holds the bytes, for code that takes a path.
class InputFile {
 public:
  explicit InputFile(Bytes bytes) : descriptor_(memfd_create("input", MFD_CLOEXEC)) {
    if (descriptor_ < 0 ||
        write(descriptor_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
      throw std::runtime_error("no file in memory");
  }
  ~InputFile() { close(descriptor_); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace cscd::fuzz
