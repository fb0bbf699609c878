#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <string>
#include <vector>

#include "bench/query/view/clip_recording.h"
#include "bench/query/view/html.h"
#include "bench/query/view/position_coder.h"
#include "bench/query/view/recording.h"
#include "bench/query/view/sections.h"
#include "bench/query/view/viewer_page.h"
#include "core/base/test_refusal.h"
#include "core/mesh/test_shapes.h"

// What the page is made of: arrays, places on a grid, and text that cannot leave its element.
namespace cscd::bench {
namespace {

TEST(Sections, WritesBase64) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64(std::string("\xff\x00\xfe", 3)), "/wD+");
}

TEST(Sections, SayWhereEachArrayLies) {
  Sections sections;
  const std::vector<std::uint16_t> shorts(1000, 7);
  const std::vector<float> none;
  sections.add("shorts", shorts);
  sections.add("none", none);
  const nlohmann::json& table = sections.table();
  ASSERT_EQ(table.size(), 2u);
  EXPECT_EQ(table[0]["type"], "u16");
  EXPECT_EQ(table[0]["raw"], 2000);
  EXPECT_LT(table[0]["bytes"], 100);
  EXPECT_EQ(table[1]["type"], "f32");
  EXPECT_EQ(table[1]["offset"], table[0]["bytes"]);
  EXPECT_EQ(sections.bytes().size(),
            table[1]["offset"].get<std::size_t>() + table[1]["bytes"].get<std::size_t>());
}

// Reads places as the page does (page/src/data.js).
std::vector<std::vector<std::uint16_t>> decoded(const std::vector<std::uint8_t>& bytes, std::size_t frames,
                                                std::size_t n) {
  std::vector<std::vector<std::uint16_t>> places;
  std::size_t at = 0;
  for (std::size_t f = 0; f < frames; ++f) {
    const int predictor = bytes[at++];
    std::vector<std::uint16_t> frame(n);
    int miss = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const unsigned coded = bytes[at + i] | unsigned{bytes[at + n + i]} << 8;
      miss += static_cast<int>(coded >> 1) ^ -static_cast<int>(coded & 1);
      int prediction = 0;
      if (predictor == 1) prediction = places[f - 1][i];
      if (predictor == 2) prediction = 2 * places[f - 1][i] - places[f - 2][i];
      frame[i] = static_cast<std::uint16_t>(prediction + miss);
    }
    at += 2 * n;
    places.push_back(std::move(frame));
  }
  EXPECT_EQ(at, bytes.size());
  return places;
}

TEST(PositionCoder, GivesPlacesBackWithinHalfAStep) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  constexpr std::size_t kVertices = 50, kFrames = 12;
  std::vector<std::vector<Vec3>> frames;
  for (std::size_t f = 0; f < kFrames; ++f) {
    std::vector<Vec3> frame;
    for (std::size_t v = 0; v < kVertices; ++v) {
      const double wild =
          f < 6 ? 0 : uniform(random);  // a smooth motion, and then jumps across the whole box
      frame.push_back(Vec3(std::sin(0.1 * static_cast<double>(v + f)), 1e-3 * static_cast<double>(v), -3) +
                      wild * Vec3(1, 0.5, 2));
    }
    frames.push_back(std::move(frame));
  }
  ViewGrid grid;
  for (const auto& frame : frames) grid.include(frame);
  PositionCoder coder(grid);
  for (const auto& frame : frames) coder.append(frame);
  const auto places = decoded(coder.bytes(), kFrames, 3 * kVertices);
  for (std::size_t f = 0; f < kFrames; ++f)
    for (std::size_t v = 0; v < kVertices; ++v)
      for (int axis = 0; axis < 3; ++axis) {
        const double back =
            grid.origin()[axis] + grid.step() * places[f][static_cast<std::size_t>(axis) * kVertices + v];
        EXPECT_NEAR(back, frames[f][v][axis], 0.51 * grid.step());
      }
}

TEST(PositionCoder, TakesASurfaceOfOnePoint) {
  const std::vector<Vec3> point(4, Vec3(1, 2, 3));
  ViewGrid grid;
  grid.include(point);
  PositionCoder coder(grid);
  coder.append(point);
  EXPECT_EQ(decoded(coder.bytes(), 1, 12)[0], std::vector<std::uint16_t>(12, 0));
}

TEST(ClipRecording, RefusesMoreThanABrowserOpens) {
  const test::Shape shape = test::octahedron();
  Input input{"long", nullptr, shape.mesh(), shape.positions, {}};
  const std::string text = test::refusal([&] { ClipRecording(input, {0, 100'000'000}); });
  EXPECT_NE(text.find("--frames A:B"), std::string::npos) << text;
}

TEST(ViewBits, AreDifferencesFromTheRowBefore) {
  ViewBits bits;
  bits.append({true, false, false, false, false, false, false, false, true});
  bits.append({true, true, false, false, false, false, false, false, true});
  EXPECT_EQ(bits.bytes(), (std::vector<std::uint8_t>{1, 1, 2, 0}));
}

TEST(ObserverRecording, KeepsWhereObserversStood) {
  ViewGrid grid;
  grid.include(std::vector<Vec3>{Vec3(-1, -1, -1), Vec3(3, 0, 0)});
  ObserverRecording recording;
  const Vec3 head(1, 0.5, -2), tail(2.5, 0, 7);
  const RadialView::Observer far{0, {Vec3::Constant(1e9), head}, {head, head}};
  recording.add({{3, {head, tail}, {tail, head}}, far}, grid,
                [](std::int32_t cluster) { return static_cast<std::uint16_t>(10 * cluster); });
  EXPECT_EQ(recording.clusters(), (std::vector<std::uint16_t>{30, 0}));
  const std::vector<std::int16_t>& places = recording.places();
  ASSERT_EQ(places.size(), 24u);
  const Vec3 expected[] = {head, tail, tail, head};
  for (int i = 0; i < 12; ++i)
    EXPECT_NEAR(grid.origin()[i % 3] + 4 * grid.step() * places[static_cast<std::size_t>(i)],
                expected[i / 3][i % 3], 4.001 * grid.step());
  EXPECT_EQ(places[12], 32767);  // far outside the box: moved to the border
}

TEST(Html, NoTextLeavesItsElement) {
  if (viewer_page().empty()) GTEST_SKIP() << "built without the viewer";
  Sections sections;
  const std::string hostile = "</script><img src=x onerror=alert(1)><!-- \xff";
  const std::string page = viewer_with(viewer_page(), {{"name", hostile}}, sections);
  EXPECT_EQ(page.find("<img"), std::string::npos);
  const std::string begin = "id=\"header\">";
  const std::size_t from = page.find(begin) + begin.size(), to = page.find("</script>", from);
  const auto header = nlohmann::json::parse(page.substr(from, to - from));
  EXPECT_EQ(header["name"].get<std::string>().substr(0, 40), hostile.substr(0, 40));
}

TEST(Html, ThePageAllowsItsOwnScriptAloneAndNoNetwork) {
  const std::string page(viewer_page());
  if (page.empty()) GTEST_SKIP() << "built without the viewer";
  EXPECT_NE(page.find("default-src 'none'; script-src 'sha256-"), std::string::npos);
  for (const char* outside : {"unsafe-inline", "unsafe-eval", "src=\"http", "href=\"http", "@import"})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
}

}  // namespace
}  // namespace cscd::bench
