#pragma once

#include <cstddef>
#include <fstream>
#if __has_include(<sys/resource.h>)
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace cscd::test {

// Leaves this process so many bytes more of address space than it has now, for as long as the object lives.
class MemoryLimit {
 public:
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;
#if defined(_WIN32)
  explicit MemoryLimit(std::size_t) {}
#else
  explicit MemoryLimit(std::size_t bytes) {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    getrlimit(RLIMIT_AS, &before_);
    rlimit limit = before_;
    limit.rlim_cur = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + bytes;
    setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() {
    setrlimit(RLIMIT_AS, &before_);
  }

 private:
  rlimit before_{};
#endif
};

// Sanitizers take address space without end, Windows limits none, and emulators may not hand the limit on.
inline bool memory_can_be_limited() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || defined(_WIN32)
  return false;
#else
  const MemoryLimit limit(std::size_t{1} << 30);
  rlimit now{};
  getrlimit(RLIMIT_AS, &now);
  return now.rlim_cur != RLIM_INFINITY;
#endif
}

}  // namespace cscd::test
