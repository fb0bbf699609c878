#pragma once

#include <filesystem>
#include <vector>

#include "core/base/vec3.h"
#include "scenes/clip/hdf5_handle.h"

namespace cscd::scenes {

// For tests only: positions that another program has computed. Reads the dataset /positions [frames,
// vertices, 3] of an HDF5 file that need not be a point cache. Returns [frames][vertices], empty if there
// is no such dataset.
inline std::vector<std::vector<Vec3>> read_truth(const std::filesystem::path& path) {
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

}  // namespace cscd::scenes
