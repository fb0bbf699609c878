#include "core/detect/start/embedding.h"

#include <algorithm>

#include "core/detect/plain_culler.h"
#include "core/elementary/exact/static_contact.h"

namespace cscd {
namespace {

// Tests every pair of triangles that a culler passes on, until found() returns false.
class ExactTester : public TrianglePairSink {
 public:
  ExactTester(const TriangleMesh& mesh, std::span<const Vec3> positions,
              const std::function<bool(const CrossingPair&)>& found)
      : TrianglePairSink(kBlock), mesh_(mesh), positions_(positions), found_(found) {}

 private:
  static constexpr std::size_t kBlock = 64;  // a closed sink is noticed after so many pairs

  void take(const std::vector<TrianglePair>& block) override {
    for (const TrianglePair& pair : block) {
      const CrossingPair crossing(std::min(pair.a, pair.b), std::max(pair.a, pair.b));
      if (!closed() && triangles_meet(mesh_, positions_, pair.a, pair.b) && !found_(crossing)) close();
    }
  }

  const TriangleMesh& mesh_;
  std::span<const Vec3> positions_;
  const std::function<bool(const CrossingPair&)>& found_;
};

}  // namespace

EmbeddingTest::EmbeddingTest(const TriangleMesh& mesh, std::span<const Vec3> reference)
    : mesh_(&mesh), reference_(reference.begin(), reference.end()) {}

EmbeddingTest::EmbeddingTest(const TriangleMesh& mesh, std::unique_ptr<Culler> culler)
    : mesh_(&mesh), culler_(std::move(culler)) {}

void EmbeddingTest::search(std::span<const Vec3> positions,
                           const std::function<bool(const CrossingPair&)>& found) {
  if (!culler_) {
    culler_ = std::make_unique<PlainCuller<Kdop16>>(*mesh_, reference_);
    reference_ = {};
  }
  const Step at_rest{Motion(positions, positions)};
  ExactTester tester(*mesh_, positions, found);
  culler_->refit(at_rest);
  culler_->classify(at_rest);
  culler_->cull(tester);
  tester.flush();
  pairs_tested_ = tester.count();
}

std::optional<CrossingPair> EmbeddingTest::find_intersection(std::span<const Vec3> positions) {
  std::optional<CrossingPair> first;
  search(positions, [&](const CrossingPair& pair) {
    first = pair;
    return false;
  });
  return first;
}

Crossings EmbeddingTest::find_all(std::span<const Vec3> positions, std::size_t most) {
  Crossings all;
  search(positions, [&](const CrossingPair& pair) {
    if (all.total++ < most) all.pairs.push_back(pair);
    return true;
  });
  std::sort(all.pairs.begin(), all.pairs.end());
  return all;
}

}  // namespace cscd
