#include "scenes/clip/new_hdf5_file.h"

#include "core/base/error.h"

namespace cscd::scenes {

NewHdf5File::NewHdf5File(std::filesystem::path name, bool force) : path(std::move(name)) {
  silence_hdf5();
  const OutputTarget target = find_output_target(path, force);
  if (target.is_stream) fail("it is a device or a pipe, and HDF5 writes to ordinary files alone");
  unfinished.emplace(target.path, force);
  file = Hdf5Handle(H5Fcreate(unfinished->path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  if (!file.valid()) fail("HDF5 made no file");
}

void NewHdf5File::finish() {
  if (!file.close()) fail("the last data did not reach the disk (is it full?)");
  unfinished->finish();
}

void NewHdf5File::fail(const std::string& what) const {
  throw InputError("output " + path.string() + ": cannot be written: " + what + "; choose another place");
}

}  // namespace cscd::scenes
