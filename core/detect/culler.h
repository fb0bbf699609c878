#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/ids.h"
#include "core/detect/counts.h"
#include "core/detect/radial_view.h"
#include "core/detect/step.h"

namespace cscd {

namespace fast {
struct PatchTree;  // core/fast/prepare/patches.h
}

// Two different triangles that may touch in the interval.
struct TrianglePair {
  TriangleId a, b;
};

// Takes potentially colliding triangle pairs one by one and hands them on in blocks of a fixed size. A sink
// that is closed takes no more pairs, and a culler may stop looking for them.
class TrianglePairSink {
 public:
  explicit TrianglePairSink(std::size_t block = 1 << 15) { block_.reserve(block); }
  virtual ~TrianglePairSink() = default;

  void add(TriangleId a, TriangleId b) {
    if (closed_) return;
    block_.push_back({a, b});
    ++count_;
    if (block_.size() == block_.capacity()) flush();
  }
  void flush() {
    if (!block_.empty()) take(block_);
    block_.clear();
  }
  // The culler calls this before it passes on all pairs of the interval once more.
  virtual void begin_again() {}
  // The culler calls this when it has passed on all pairs that may touch at t = 0.
  virtual void leave_start() {}
  std::uint64_t count() const { return count_; }
  bool closed() const { return closed_; }
  // Returns whether until() may come to be less than 1, and asks the culler to call tell() now and then.
  virtual bool first_only() const { return false; }
  // From here on, with `alone`, a pair of triangles needs to be tested only for the feature pairs that it
  // owns (feature_owners.h): of every other feature pair that it carries, the culler passes on the owners, or
  // has proven the feature pair apart.
  virtual void test_owned(bool /*alone*/) {}
  // Returns the time up to which the sink needs pairs that may touch, by what it has looked at so far.
  virtual double until() const { return 1; }
  void tell() {
    if (block_.size() >= kWorthTaking) flush();
  }
  void restart() {
    block_.clear();
    count_ = 0;
    closed_ = false;
  }

 protected:
  void close() { closed_ = true; }

 private:
  static constexpr std::size_t kWorthTaking = 256;  // fewer pairs are not worth a look at them by themselves
  virtual void take(const std::vector<TrianglePair>& block) = 0;
  std::vector<TrianglePair> block_;
  std::uint64_t count_ = 0;
  bool closed_ = false;
};

// A culling strategy: it decides which triangle pairs have to be tested in an interval. The virtual functions
// are called a few times an interval, never once per pair. A culler owns its scratch memory and reuses it;
// its results depend on the interval alone, unless the strategy follows the surface (rule fresh-detector,
// core/soundness.md).
class Culler {
 public:
  virtual ~Culler() = default;

  // Whether its proofs hold for a thickness above 0. Where they do, "apart" means farther than the thickness
  // in every comment below.
  virtual bool knows_distance(const Thickness& /*thickness*/) const { return false; }
  // Computes the bounds of this interval. Stage `refit`.
  virtual void refit(const Step& step) = 0;
  // Does what refit() does, where only pairs that may touch until a time are needed, which is at most 1.
  virtual void refit_beginning(const Step& step, double /*until*/) { refit(step); }
  // Computes orientation classes and clusters. Stage `classify`; returns false where the strategy has no
  // such stage. Where the step starts embedded, cull() may look for the first contact alone, and cull_rest()
  // then passes on the others.
  virtual bool classify(const Step& /*step*/) { return false; }
  // Passes every triangle pair that is not proven apart to `sink` and returns the culling counters, except
  // pctp, which the caller takes from the sink. Stage `traversal`.
  virtual CullCounts cull(TrianglePairSink& sink) = 0;
  // Called after cull() has passed on a pair that touches: passes on all pairs that cull() may have left out
  // because it looked for the first contact alone. Returns the number of overlap tests; nothing where cull()
  // has kept all contacts. Stage `traversal`.
  virtual std::optional<std::uint64_t> cull_rest(TrianglePairSink& /*sink*/) { return std::nullopt; }
  // Whether every pair of triangles that cull() does not pass on carries no contact until the sink's last
  // time. Asked after classify() and after cull(); cull_rest() always passes on all others.
  virtual bool keeps_all() const { return false; }
  // Forgets all intervals (Detector::forget).
  virtual void forget() {}
  // Returns what preparation has found out (Detector::saved_preparation).
  virtual std::vector<std::byte> saved_preparation() const { return {}; }
  // How preparation has cut the surface into patches (Detector::patches).
  virtual const fast::PatchTree* patches() const { return nullptr; }
  // The orientation of the surface in the last interval, for pictures.
  virtual RadialView radial_view() const { return {}; }
};

}  // namespace cscd
