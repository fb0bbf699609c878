#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>

#include "scenes/character/pose.h"
#include "scenes/clip/hdf5_file.h"
#include "scenes/import/read_model.h"

// Compares model files with one unusual feature each against positions that an independent program computed
// from the formats' specifications. The files lie in $CSCD_IMPORT, or else in shared/import beside the
// repository or above it; they are not part of the repository.
namespace cscd::scenes {
namespace {

namespace fs = std::filesystem;

constexpr double kFramesPerSecond = 30;

// Reads the dataset /positions [frames, vertices, 3] of an HDF5 file that need not be a point cache. Returns
// [frames][vertices], empty if there is no such dataset.
std::vector<std::vector<Vec3>> read_truth(const std::filesystem::path& path) {
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const Hdf5Handle positions(H5Dopen2(file.get(), "/positions", H5P_DEFAULT), H5Dclose);
  const Hdf5Handle space(H5Dget_space(positions.get()), H5Sclose);
  hsize_t shape[3] = {0, 0, 0};
  if (H5Sget_simple_extent_ndims(space.get()) != 3) return {};
  H5Sget_simple_extent_dims(space.get(), shape, nullptr);
  std::vector<double> numbers(shape[0] * shape[1] * 3);
  H5Dread(positions.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
  std::vector<std::vector<Vec3>> frames(shape[0]);
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    frames[i / 3 / shape[1]].emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return frames;
}

fs::path import_folder() {
  if (const char* named = std::getenv("CSCD_IMPORT")) return named;
  for (fs::path folder = fs::current_path(); folder.has_relative_path(); folder = folder.parent_path())
    if (fs::is_directory(folder / "shared" / "import")) return folder / "shared" / "import";
  return {};
}

std::vector<fs::path> samples(const std::string& extension) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(import_folder(), ignored)) {
    const fs::path& file = entry.path();
    if (file.extension() == extension && fs::exists(fs::path(file).replace_extension(".truth.h5")))
      files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  return files;
}

class Truth : public testing::TestWithParam<const char*> {};

TEST_P(Truth, EveryVertexIsWhereTheFormatsSpecificationPutsIt) {
  const std::vector<fs::path> files = samples(GetParam());
  if (files.empty()) GTEST_SKIP() << "no samples";
  for (const fs::path& file : files) {
    SCOPED_TRACE(file.filename());
    const Character character = read_model(file, {});
    const auto truth = read_truth(fs::path(file).replace_extension(".truth.h5"));
    const Animation& clip = character.animations.at(0);
    EXPECT_EQ(static_cast<std::size_t>(std::lround(clip.seconds * kFramesPerSecond)) + 1, truth.size());
    for (std::size_t f = 0; f < truth.size(); ++f) {
      const double seconds = clip.start + static_cast<double>(f) / kFramesPerSecond;
      std::vector<Vec3> positions;
      skin(character, pose_at(character, clip, seconds), weights_at(character, clip, seconds), positions);
      ASSERT_EQ(positions.size(), truth[f].size());
      for (std::size_t v = 0; v < positions.size(); ++v)
        ASSERT_LT((positions[v] - truth[f][v]).norm(), 1e-6) << "frame " << f << ", vertex " << v;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Truth, testing::Values(".glb", ".fbx"),
                         [](const auto& format) { return std::string(format.param).substr(1); });

}  // namespace
}  // namespace cscd::scenes
