#pragma once

#include <cstddef>
#include <vector>

#include "core/base/ids.h"
#include "core/detect/counts.h"
#include "core/detect/radial_view.h"
#include "core/mesh/motion.h"
#include "core/mesh/rig.h"

namespace cscd {

struct TrianglePair {
  TriangleId a, b;
};

// Takes potentially colliding triangle pairs one by one and hands them on in blocks.
class TrianglePairSink {
 public:
  explicit TrianglePairSink(std::size_t block = 1 << 15) { block_.reserve(block); }
  virtual ~TrianglePairSink() = default;

  void add(TriangleId a, TriangleId b) {
    block_.push_back({a, b});
    ++count_;
    if (block_.size() == block_.capacity()) flush();
  }
  void flush() {
    if (!block_.empty()) take(block_);
    block_.clear();
  }
  std::uint64_t count() const { return count_; }
  void restart() {
    block_.clear();
    count_ = 0;
  }

 private:
  virtual void take(const std::vector<TrianglePair>& block) = 0;
  std::vector<TrianglePair> block_;
  std::uint64_t count_ = 0;
};

// A culling strategy: which triangle pairs have to be looked at in an interval. Virtual calls happen three
// times an interval, never per pair. Scratch is the culler's own and is reused; results depend on the
// interval alone.
class Culler {
 public:
  virtual ~Culler() = default;

  // Computes the bounds of this interval. Stage `refit`.
  virtual void refit(const Motion& motion) = 0;
  // Computes orientation classes and clusters. Stage `rv_update`; returns false where the strategy has no
  // such stage. `bones` is null for a mesh without a rig.
  virtual bool classify(const Motion& /*motion*/, const Rig::Interval* /*bones*/) { return false; }
  // Passes every pair that is not proven apart to the sink. Stage `traversal`.
  virtual CullCounts cull(TrianglePairSink& sink) = 0;
  virtual RadialView radial_view() const { return {}; }
};

}  // namespace cscd
