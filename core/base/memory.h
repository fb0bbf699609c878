#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <string_view>
#include <vector>

// How much memory is left, for work whose results may be more than memory holds. Linux hands out more memory
// than there is and ends the process that uses it, so that no allocation fails; whoever gathers much has to
// look ahead.
namespace cscd {

// Returns how many bytes this process may still take: the least of what the machine has available, what the
// limit on the address space (ulimit -v) leaves, and what the control groups of the process leave. What
// cannot be read limits nothing.
std::uint64_t available_memory();

// Thrown before memory runs out, where the pairs of features that are being gathered would not fit.
class MemoryShortage : public std::bad_alloc {
 public:
  // So many pairs are there, going on with them takes `needed` bytes, and `left` are available.
  MemoryShortage(std::size_t pairs, std::uint64_t needed, std::uint64_t left) noexcept;
  // The finding and how a user of the library mends it.
  const char* what() const noexcept override { return text_; }
  // The finding alone, as a sentence goes on from it.
  std::string_view finding() const { return {text_, finding_}; }

 private:
  char text_[320];
  std::size_t finding_;
};

// Throws MemoryShortage if so many bytes, for so many pairs of features, are more than is available. A few
// mebibytes are not worth a look, which takes some ten microseconds.
void require_memory(std::size_t pairs, std::uint64_t bytes);

// Looks ahead while pairs are gathered, whenever their number has grown by an eighth.
class MemoryWatch {
 public:
  void start() { next_ = kFirst; }
  // Each further pair takes so many bytes.
  void look(std::size_t pairs, std::size_t each) {
    if (pairs >= next_) look_now(pairs, std::uint64_t{pairs / 8} * each);
  }
  // Each further pair takes a place in a list, which grows to twice its size.
  template <class Item>
  void look(const std::vector<Item>& list) {
    if (list.size() < next_) return;
    const bool grows = list.size() + list.size() / 8 >= list.capacity();
    look_now(list.size(), grows ? 2 * sizeof(Item) * std::uint64_t{list.capacity()} : 0);
  }

 private:
  static constexpr std::size_t kFirst = std::size_t{1} << 16;  // fewer pairs take a few mebibytes

  void look_now(std::size_t pairs, std::uint64_t bytes) {
    constexpr std::size_t kNoted = 16;  // bytes that callers note of each pair later
    require_memory(pairs, bytes + kNoted * std::uint64_t{pairs});
    next_ = pairs + pairs / 8;
  }

  std::size_t next_ = kFirst;
};

}  // namespace cscd
