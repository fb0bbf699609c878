// What a strategy promises by `Strategy::settles`: once a detector has seen its largest interval, answering
// another interval allocates no memory. The test counts every allocation of its program.

#include <atomic>
#include <cstdlib>
#include <gtest/gtest.h>
#include <new>

#include "bench/rows/catalogue.h"
#include "core/base/error.h"
#include "scenes/clip/clip.h"
#include "scenes/random/random_interval.h"

namespace {

std::atomic<std::size_t> g_allocations = 0;

void* allocate(std::size_t bytes, std::size_t alignment) {
  ++g_allocations;
  const std::size_t rounded = (bytes + alignment - 1) / alignment * alignment;
  if (void* memory = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded)) return memory;
  throw std::bad_alloc();
}

// Apart, because gcc takes memory from operator new that free() gets for an error once it sees both.
__attribute__((noinline)) void release(void* memory) {
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t bytes) {
  return allocate(bytes, alignof(std::max_align_t));
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return allocate(bytes, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  try {
    return allocate(bytes, alignof(std::max_align_t));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* memory) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  release(memory);
}

namespace cscd::bench {
namespace {

// Mutation: a vector that is made anew in every interval.
TEST(Allocation, ADetectorThatSettlesAllocatesNothingOnceItIsWarm) {
  const ElementaryTest& test = elementary_test_named("filtered_exact");
  std::size_t contacts = 0, first_allocations = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    scenes::RandomInterval random = scenes::make_random_interval(seed);
    const TriangleMesh mesh(random.clip.header().triangles, random.clip.header().vertex_count);
    const std::optional<Rig> rig = scenes::rig_of(random.clip);
    const scenes::ClipInterval interval = random.clip.interval(0);
    for (const Strategy& strategy : strategies()) {
      if (!strategy.settles) continue;
      const auto detector =
          strategy.make({mesh, random.clip.frame(0).positions, rig ? &*rig : nullptr, test}).detector;
      ContactSet found;
      const auto allocations = [&] {
        const std::size_t before = g_allocations;
        detector->detect(interval.motion, interval.bones ? &*interval.bones : nullptr, found);
        return g_allocations - before;
      };
      first_allocations += allocations();
      allocations();
      EXPECT_EQ(allocations(), 0u) << strategy.name << ", seed " << seed;
      contacts += found.contacts.size();
    }
  }
  EXPECT_GT(first_allocations, 100u) << "allocations are counted";
  EXPECT_GT(contacts, 100u) << "keeping contacts is part of it";
}

}  // namespace
}  // namespace cscd::bench
