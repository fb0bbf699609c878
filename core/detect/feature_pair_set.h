#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/memory.h"
#include "core/detect/contact.h"

namespace cscd {

// The feature pairs tested in this interval, so that each is tested once however many triangle pairs carry
// it. This keeps rule any-carrier (core/soundness.md): whichever surviving triangle pair comes first brings
// it.
//
// The set uses open addressing with linear probing. An entry carries the interval's number in its top bits,
// so a new interval forgets the old entries without touching them.
class FeaturePairSet {
 public:
  FeaturePairSet() : slots_(std::size_t{1} << (64 - shift_)) {}

  // Empties the set.
  void start_interval() {
    size_ = 0;
    if (++epoch_ == kEpochs) {
      std::fill(slots_.begin(), slots_.end(), 0);
      epoch_ = 1;
    }
  }

  // Fetches where the pair will be looked for. Of many pairs, most are found in no cache otherwise.
  void fetch(const FeaturePair& pair) const {
    __builtin_prefetch(&slots_[place(key(pair) | epoch_ << kKeyBits)], 1);
  }
  // Adds the pair, and returns whether it was new.
  bool insert(const FeaturePair& pair) {
    if (2 * size_ >= slots_.size()) grow();
    const std::uint64_t entry = key(pair) | epoch_ << kKeyBits;
    std::uint64_t& slot = find(entry);
    if (slot == entry) return false;
    slot = entry;
    ++size_;
    return true;
  }

 private:
  static constexpr int kIdBits = 30;
  static constexpr int kKeyBits = 2 * kIdBits;
  static constexpr std::uint64_t kEpochs = std::uint64_t{1} << (64 - kKeyBits);

  // TriangleMesh allows 2^28 vertices and 2^28 triangles, so a mesh has at most 3 * 2^28
  // edges (if no triangles share one). That leaves the last quarter of the 30-bit numbers for
  // the vertex of a vertex-face pair.
  static std::uint64_t key(const FeaturePair& pair) {
    constexpr std::uint64_t first_vertex = std::uint64_t{3} << 28;
    const bool vertex = pair.kind == FeaturePair::Kind::vertex_face;
    const std::uint64_t first = static_cast<std::uint64_t>(pair.a) + (vertex ? first_vertex : 0);
    return first << kIdBits | static_cast<std::uint64_t>(pair.b);
  }
  // Where an entry's probing begins. The top bits depend on the whole key.
  std::size_t place(std::uint64_t entry) const { return (entry * 0x9e3779b97f4a7c15u) >> shift_; }
  std::uint64_t& find(std::uint64_t entry) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = place(entry);
    while (slots_[i] >> kKeyBits == epoch_ && slots_[i] != entry) i = (i + 1) & mask;
    return slots_[i];
  }
  void grow() {
    require_memory(size_, 2 * sizeof(std::uint64_t) * slots_.size());
    std::vector<std::uint64_t> old(2 * slots_.size());  // if it throws, the set is as it was
    --shift_;
    old.swap(slots_);
    for (const std::uint64_t entry : old)
      if (entry >> kKeyBits == epoch_) find(entry) = entry;
  }

  int shift_ = 52;  // 64 minus the binary logarithm of the table's size
  std::vector<std::uint64_t> slots_;
  std::size_t size_ = 0;
  std::uint64_t epoch_ = 1;
};

}  // namespace cscd
