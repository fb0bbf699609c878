#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scenes/base/output_target.h"
#include "scenes/clip/hdf5_handle.h"

namespace cscd::scenes {

// An HDF5 file that is being written. It has its name only once it is finished, and vanishes if it is not.
// Whoever derives from it holds the datasets, which are then closed before the file is.
struct NewHdf5File {
  std::filesystem::path path;
  std::optional<UnfinishedFile> unfinished;
  Hdf5Handle file;

  // Throws InputError if nothing can be written there, or, without `force`, if a file stands there.
  NewHdf5File(std::filesystem::path name, bool force);
  NewHdf5File(const NewHdf5File&) = delete;
  NewHdf5File& operator=(const NewHdf5File&) = delete;

  // Gives the file its name. All datasets have to be closed. Throws InputError if the disk did not take it.
  void finish();
  [[noreturn]] void fail(const std::string& what) const;
};

}  // namespace cscd::scenes
