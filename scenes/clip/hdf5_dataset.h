#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/clip/hdf5_handle.h"

namespace cscd::scenes {

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

}  // namespace cscd::scenes
