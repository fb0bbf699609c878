#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/mesh/test_shapes.h"
#include "scenes/clip/hdf5_file.h"

namespace cscd::scenes {

// For tests only: writes a point cache of a shape in which only the frames `stored` are stored; frame f is
// moved to (f, 0, 0). HDF5 allocates a chunk when it is written and reads other chunks as zeros. So a file
// of any length takes almost no space.
inline void write_sparse_cache(const std::filesystem::path& path, const test::Shape& shape, hsize_t frames,
                               std::span<const hsize_t> stored) {
  const Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  const hsize_t triangle_shape[2] = {shape.triangles.size(), 3};
  const Hdf5Handle triangle_space(H5Screate_simple(2, triangle_shape, nullptr), H5Sclose);
  const Hdf5Handle triangles(H5Dcreate2(file.get(), "/triangles", H5T_STD_I32LE, triangle_space.get(),
                                        H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                             H5Dclose);
  H5Dwrite(triangles.get(), H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, shape.triangles.data());

  const hsize_t extent[3] = {frames, shape.positions.size(), 3}, chunk[3] = {1, shape.positions.size(), 3};
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(creation.get(), 3, chunk);
  const Hdf5Handle space(H5Screate_simple(3, extent, nullptr), H5Sclose);
  const Hdf5Handle positions(H5Dcreate2(file.get(), "/positions", H5T_IEEE_F64LE, space.get(), H5P_DEFAULT,
                                        creation.get(), H5P_DEFAULT),
                             H5Dclose);
  const Hdf5Handle memory(H5Screate_simple(3, chunk, nullptr), H5Sclose);
  for (const hsize_t frame : stored) {
    std::vector<Vec3> moved = shape.positions;
    for (Vec3& x : moved) x.x() += static_cast<double>(frame);
    const hsize_t start[3] = {frame, 0, 0};
    H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start, nullptr, chunk, nullptr);
    H5Dwrite(positions.get(), H5T_NATIVE_DOUBLE, memory.get(), space.get(), H5P_DEFAULT, moved.data());
  }
}

}  // namespace cscd::scenes
