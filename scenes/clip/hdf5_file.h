#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <hdf5.h>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/base/output_target.h"

namespace cscd::scenes {

// Owns an HDF5 identifier. `close` returns false if HDF5 reports an error.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Hdf5Handle() { close(); }

  hid_t get() const { return id_; }
  bool valid() const { return id_ >= 0; }
  bool close() {
    const hid_t id = std::exchange(id_, -1);
    return id < 0 || close_(id) >= 0;
  }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

// Stops HDF5 from printing its error stack on standard error: we report each error in one line of our own.
// Call this before any other function of HDF5.
inline void silence_hdf5() {
  // At the end of the process HDF5 (1.10.8) tries again to close files that it could not close, and crashes
  // if a disk was full. This switches that off; all files are closed by their handles.
  [[maybe_unused]] static const herr_t no_cleaning = H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

// A dataset of an HDF5 file whose shape and type have been checked.
struct Dataset {
  Hdf5Handle id;
  std::string where;  // "file.h5, /positions"
  std::vector<hsize_t> shape;
};

std::string shown(const std::vector<hsize_t>& shape);

bool has_object(hid_t file, const std::string& name);

// Opens a dataset and checks its type, its rank and, where the rank is above 1, that its last extent is 3.
// Refuses data that lie in another file. `format` names the format of the file in error texts. Throws
// InputError.
Dataset open_dataset(hid_t file, const std::string& path, std::string_view format, const std::string& name,
                     H5T_class_t type_class, std::size_t rank);

// Throws InputError if the dataset has another shape; `why` names what asks for it.
void require_shape(const Dataset& dataset, const std::vector<hsize_t>& wanted, const std::string& why);

// Throws InputError if the file stores fewer elements of the dataset than `elements`. This guards
// allocations against declared sizes without data behind them. A dataset with a filter is not checked,
// because a filter may pack data.
void require_stored(const Dataset& dataset, hsize_t elements);

// Returns all elements. Throws InputError if they cannot be read.
std::vector<std::int64_t> read_integers(const Dataset& dataset);

// Returns the text of an attribute of the file's root; nothing if it is no single text of up to 1000 bytes.
std::optional<std::string> read_text_attribute(hid_t file, const char* name);

// Returns properties of an object without a time of creation, so that equal data give equal bytes.
Hdf5Handle timeless(hid_t kind);

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

  // Add a group, or a dataset with the values [shape]. Throw InputError if HDF5 does not take them.
  void add_group(const std::string& name);
  void add_integers(const std::string& name, const std::vector<hsize_t>& shape,
                    const std::vector<std::int32_t>& values);
  void add_numbers(const std::string& name, const std::vector<hsize_t>& shape, const void* values);
  [[noreturn]] void refuse(const std::string& name) const;  // of what HDF5 did not take

  // Gives the file its name. All datasets have to be closed. Throws InputError if the disk did not take it.
  void finish();
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void add_dataset(const std::string& name, hid_t type, hid_t memory_type, const std::vector<hsize_t>& shape,
                   const void* values);
};

}  // namespace cscd::scenes
