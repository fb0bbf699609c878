#include "baselines/brute.h"

#include "core/detect/compose.h"

namespace cscd {
namespace {

class BruteCuller : public Culler {
 public:
  explicit BruteCuller(std::int32_t triangles) : triangles_(triangles) {}

  void refit(const Motion&) override {}
  CullCounts cull(TrianglePairSink& sink) override {
    for (std::int32_t a = 0; a < triangles_; ++a)
      for (std::int32_t b = a + 1; b < triangles_; ++b) sink.add(TriangleId{a}, TriangleId{b});
    return {};
  }

 private:
  std::int32_t triangles_;
};

}  // namespace

Prepared make_brute(const StrategyInput& setup) {
  auto culler = std::make_unique<BruteCuller>(static_cast<std::int32_t>(setup.mesh.triangle_count()));
  return {compose(std::move(culler), setup), {}};
}

}  // namespace cscd
