#include <gtest/gtest.h>
#include <memory>
#include <vector>

#include "bench/harness/contestant.h"
#include "bench/strategies/catalogue.h"
#include "scenes/clip/clip.h"

namespace cscd::bench {
namespace {

// Holds 64 MiB, after having touched twice that.
class Hoarder final : public Detector {
 public:
  Hoarder() : held_(64 << 20, 'x') {}
  Report detect(const Step&, ContactSet& out) override {
    out.contacts.clear();
    return {};
  }

 private:
  std::vector<char> held_;
};

Prepared make_hoarder(const StrategyInput&) {
  {
    // Volatile, or a compiler may see that nobody reads it and leave it out.
    constexpr std::size_t size = 128 << 20, page = 4096;
    const std::unique_ptr<volatile char[]> passing(new volatile char[size]);
    for (std::size_t i = 0; i < size; i += page) passing[i] = 'x';
  }
  return {std::make_unique<Hoarder>(), {}};
}

TEST(Footprint, SeesPeakAndHeldMemory) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer holds on to memory that is freed";
#endif
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<Triangle> triangles = {{VertexId{0}, VertexId{2}, VertexId{1}},
                                           {VertexId{0}, VertexId{1}, VertexId{3}},
                                           {VertexId{0}, VertexId{3}, VertexId{2}},
                                           {VertexId{1}, VertexId{2}, VertexId{3}}};
  auto clip = std::make_unique<scenes::Clip>(scenes::ClipHeader{triangles, 4, {}, false});
  clip->append({corners, {}});
  clip->append({corners, {}});
  Input input{"tetrahedron", std::move(clip), TriangleMesh(triangles, 4), corners, std::nullopt};

  const Strategy hoarder{"hoarder",           "a test",    Guarantee::heuristic, Needs::any_mesh,
                         StrategyKind::fixed, make_hoarder};
  const ElementaryTest& test = elementary_test_named("newton");
  const Footprint footprint = make_contestant(input, {&hoarder}, test, test, 0).footprint;
  constexpr double mebibyte = 1 << 20;
  if (!footprint.peak_bytes || !footprint.held_bytes) GTEST_SKIP() << "the kernel does not say";
  EXPECT_NEAR(static_cast<double>(*footprint.held_bytes) / mebibyte, 64, 8);
  EXPECT_NEAR(static_cast<double>(*footprint.peak_bytes) / mebibyte, 128, 8);
}

}  // namespace
}  // namespace cscd::bench
