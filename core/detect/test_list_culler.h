#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/detect/culler.h"

namespace cscd::test {

// Passes on these pairs, whatever the step.
class ListCuller : public Culler {
 public:
  explicit ListCuller(std::vector<TrianglePair> pairs, bool classifies = false)
      : pairs_(std::move(pairs)), classifies_(classifies) {}
  void refit(const Step&) override {}
  bool classify(const Step&) override { return classifies_; }
  CullCounts cull(TrianglePairSink& sink) override {
    for (const TrianglePair& pair : pairs_) sink.add(pair.a, pair.b);
    return {};
  }
  RadialView radial_view() const override { return {{7}, {true}}; }

 private:
  std::vector<TrianglePair> pairs_;
  bool classifies_;
};

inline std::vector<TrianglePair> all_pairs(const TriangleMesh& mesh) {
  std::vector<TrianglePair> pairs;
  const auto count = static_cast<std::int32_t>(mesh.triangle_count());
  for (std::int32_t a = 0; a < count; ++a)
    for (std::int32_t b = a + 1; b < count; ++b) pairs.push_back({TriangleId{a}, TriangleId{b}});
  return pairs;
}

}  // namespace cscd::test
