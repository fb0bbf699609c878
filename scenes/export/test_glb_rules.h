#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

// Checks the rules of the glTF 2.0 specification that a reader may rely on, on the bytes of a .glb file.
namespace cscd::scenes {

class GlbRules {
 public:
  explicit GlbRules(const std::string& bytes) : bytes_(bytes) { check(); }

  nlohmann::json file;

 private:
  void check() {
    const std::string& bytes = bytes_;
    ASSERT_GE(bytes.size(), 28u);
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(word(4), 2u);
    EXPECT_EQ(word(8), bytes.size());
    const std::size_t text = word(12);
    EXPECT_EQ(text % 4, 0u);
    EXPECT_EQ(bytes.substr(16, 4), "JSON");
    file = nlohmann::json::parse(bytes.substr(20, text));
    binary_ = 28 + text;
    EXPECT_EQ(word(20 + text) % 4, 0u);
    EXPECT_EQ(bytes.substr(24 + text, 4), std::string("BIN\0", 4));
    ASSERT_EQ(binary_ + word(20 + text), bytes.size());
    EXPECT_EQ(file["buffers"][0]["byteLength"], word(20 + text));
    for (const auto& view : file["bufferViews"]) {
      EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
      ASSERT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(),
                word(20 + text));
    }
    for (const auto& mesh : file["meshes"]) check_mesh(mesh["primitives"][0]);
    if (file.contains("skins"))
      for (const auto& skin : file["skins"]) check_skin(skin);
    if (file.contains("animations"))
      for (const auto& clip : file["animations"]) check_clip(clip);
  }

  std::uint32_t word(std::size_t at) const {
    std::uint32_t number = 0;
    std::memcpy(&number, bytes_.data() + at, sizeof number);
    return number;
  }

  // Returns the numbers of an accessor as doubles.
  std::vector<double> numbers(const nlohmann::json& index, int component, const char* type,
                              std::size_t width) {
    const auto& accessor = file["accessors"][index.get<std::size_t>()];
    EXPECT_EQ(accessor["componentType"], component);
    EXPECT_EQ(accessor["type"], type);
    const auto& view = file["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t count = accessor["count"].get<std::size_t>() * width, size = component == 5123 ? 2 : 4;
    EXPECT_GT(count, 0u);
    EXPECT_EQ(view["byteLength"], count * size);
    std::vector<double> out;
    for (std::size_t i = 0; i < count; ++i) {
      const char* at = bytes_.data() + binary_ + view["byteOffset"].get<std::size_t>() + i * size;
      float real = 0;
      std::uint16_t small = 0;
      std::uint32_t large = 0;
      if (component == 5126) std::memcpy(&real, at, size), out.push_back(static_cast<double>(real));
      if (component == 5123) std::memcpy(&small, at, size), out.push_back(small);
      if (component == 5125) std::memcpy(&large, at, size), out.push_back(large);
    }
    return out;
  }

  void expect_bounds(const nlohmann::json& index, const std::vector<double>& values, std::size_t width) {
    const auto& accessor = file["accessors"][index.get<std::size_t>()];
    ASSERT_EQ(accessor["min"].size(), width);
    for (std::size_t k = 0; k < width; ++k) {
      double low = values[k], high = values[k];
      for (std::size_t i = k; i < values.size(); i += width)
        low = std::min(low, values[i]), high = std::max(high, values[i]);
      EXPECT_EQ(accessor["min"][k].get<double>(), low);
      EXPECT_EQ(accessor["max"][k].get<double>(), high);
    }
  }

  int target(const nlohmann::json& index) {
    const auto& accessor = file["accessors"][index.get<std::size_t>()];
    return file["bufferViews"][accessor["bufferView"].get<std::size_t>()].value("target", 0);
  }

  void check_mesh(const nlohmann::json& primitive) {
    const auto& attributes = primitive["attributes"];
    const std::vector<double> positions = numbers(attributes["POSITION"], 5126, "VEC3", 3);
    expect_bounds(attributes["POSITION"], positions, 3);
    for (const auto& [name, accessor] : attributes.items()) EXPECT_EQ(target(accessor), 34962) << name;
    EXPECT_EQ(target(primitive["indices"]), 34963);
    const std::vector<double> corners = numbers(primitive["indices"], 5125, "SCALAR", 1);
    EXPECT_EQ(corners.size() % 3, 0u);
    for (const double corner : corners) ASSERT_LT(corner, static_cast<double>(positions.size()) / 3);
    std::vector<double> sum(positions.size() / 3, 0);
    std::size_t sets = 0;
    for (; attributes.contains("JOINTS_" + std::to_string(sets)); ++sets) {
      const std::vector<double> weights =
          numbers(attributes.at("WEIGHTS_" + std::to_string(sets)), 5126, "VEC4", 4);
      const std::vector<double> joints =
          numbers(attributes.at("JOINTS_" + std::to_string(sets)), 5123, "VEC4", 4);
      ASSERT_EQ(weights.size(), 4 * sum.size());
      ASSERT_EQ(joints.size(), weights.size());
      for (std::size_t i = 0; i < weights.size(); ++i) {
        sum[i / 4] += weights[i];
        EXPECT_GE(weights[i], 0);
        if (weights[i] == 0) {
          EXPECT_EQ(joints[i], 0);
        }
        EXPECT_LT(joints[i], static_cast<double>(file["skins"][0]["joints"].size()));
      }
    }
    for (const double s : sum) {
      ASSERT_NEAR(s, sets > 0 ? 1 : 0, 2e-7 * 4 * static_cast<double>(sets) + 1e-300);
    }
  }

  void check_skin(const nlohmann::json& skin) {
    const std::vector<double> offsets = numbers(skin["inverseBindMatrices"], 5126, "MAT4", 16);
    EXPECT_EQ(offsets.size(), 16 * skin["joints"].size());
    for (std::size_t i = 0; i < offsets.size(); i += 16)
      EXPECT_EQ(std::vector<double>({offsets[i + 3], offsets[i + 7], offsets[i + 11], offsets[i + 15]}),
                (std::vector<double>{0, 0, 0, 1}));
    std::set<int> in_scene;
    std::vector<int> open = file["scenes"][0]["nodes"].get<std::vector<int>>();
    while (!open.empty()) {
      const int node = open.back();
      open.pop_back();
      EXPECT_TRUE(in_scene.insert(node).second) << "two parents";
      for (const int child :
           file["nodes"][static_cast<std::size_t>(node)].value("children", std::vector<int>{}))
        open.push_back(child);
    }
    EXPECT_EQ(in_scene.size(), file["nodes"].size());
    for (const int joint : skin["joints"]) EXPECT_TRUE(in_scene.contains(joint));
  }

  void check_clip(const nlohmann::json& clip) {
    for (const auto& channel : clip["channels"]) {
      const auto& sampler = clip["samplers"][channel["sampler"].get<std::size_t>()];
      const std::vector<double> times = numbers(sampler["input"], 5126, "SCALAR", 1);
      expect_bounds(sampler["input"], times, 1);
      for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GT(times[i], times[i - 1]);
      if (channel["target"]["path"] != "rotation") {
        EXPECT_EQ(numbers(sampler["output"], 5126, "VEC3", 3).size(), 3 * times.size());
        continue;
      }
      const std::vector<double> turns = numbers(sampler["output"], 5126, "VEC4", 4);
      ASSERT_EQ(turns.size(), 4 * times.size());
      const auto dot = [&](std::size_t a, std::size_t b) {
        double product = 0;
        for (std::size_t k = 0; k < 4; ++k) product += turns[4 * a + k] * turns[4 * b + k];
        return product;
      };
      for (std::size_t i = 0; i < times.size(); ++i) {
        EXPECT_NEAR(dot(i, i), 1, 1e-6);
        EXPECT_GE(dot(i, i > 0 ? i - 1 : 0), 0) << "the shorter way";
      }
    }
  }

  const std::string& bytes_;
  std::size_t binary_ = 0;
};

}  // namespace cscd::scenes
