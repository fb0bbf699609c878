#include "scenes/clip/hdf5_file.h"

#include <cstring>

#include "core/base/error.h"

namespace cscd::scenes {

namespace {

// True if the data of the dataset lie in another file. Such data are refused: they would let a cache from a
// stranger read any file that its user may read.
bool lies_elsewhere(hid_t file, const std::string& name, hid_t dataset) {
  for (std::size_t end = name.find('/', 1);; end = name.find('/', end + 1)) {
    H5L_info_t link;
    if (H5Lget_info(file, name.substr(0, end).c_str(), &link, H5P_DEFAULT) < 0 ||
        link.type == H5L_TYPE_EXTERNAL)
      return true;
    if (end == std::string::npos) break;
  }
  const Hdf5Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  return H5Pget_external_count(creation.get()) != 0 || H5Pget_layout(creation.get()) == H5D_VIRTUAL;
}

}  // namespace

std::string shown(const std::vector<hsize_t>& shape) {
  std::string text = "[";
  for (const hsize_t extent : shape) text += (text.size() > 1 ? ", " : "") + std::to_string(extent);
  return text + "]";
}

bool has_object(hid_t file, const std::string& name) {
  for (std::size_t slash = name.find('/', 1); slash != std::string::npos; slash = name.find('/', slash + 1))
    if (H5Lexists(file, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0;
}

Dataset open_dataset(hid_t file, const std::string& path, std::string_view format, const std::string& name,
                     H5T_class_t type_class, std::size_t rank) {
  Dataset dataset;
  dataset.where = path + ", " + name;
  if (!has_object(file, name))
    throw InputError(dataset.where + ": dataset is missing; write it as the " + std::string(format) +
                     " says");
  dataset.id = Hdf5Handle(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.id.valid())
    throw InputError(dataset.where + ": is not a readable dataset; the file may be damaged, write it again");
  if (lies_elsewhere(file, name, dataset.id.get()))
    throw InputError(dataset.where + ": its data lie in another file; store them in this one");

  const Hdf5Handle type(H5Dget_type(dataset.id.get()), H5Tclose);
  const bool fits = H5Tget_class(type.get()) == type_class && H5Tget_size(type.get()) <= 8;
  if (!fits)
    throw InputError(dataset.where + ": has elements of another type; write " +
                     (type_class == H5T_FLOAT ? "float64" : "int32"));
  const Hdf5Handle space(H5Dget_space(dataset.id.get()), H5Sclose);
  const int found = H5Sget_simple_extent_ndims(space.get());
  if (found != static_cast<int>(rank) || H5Sget_simple_extent_type(space.get()) != H5S_SIMPLE)
    throw InputError(dataset.where + ": has " + std::to_string(found) + " dimensions; it needs " +
                     std::to_string(rank));
  dataset.shape.resize(rank);
  H5Sget_simple_extent_dims(space.get(), dataset.shape.data(), nullptr);
  if (rank > 1 && dataset.shape.back() != 3)
    throw InputError(dataset.where + ": has shape " + shown(dataset.shape) + "; its last extent must be 3");
  return dataset;
}

void require_shape(const Dataset& dataset, const std::vector<hsize_t>& wanted, const std::string& why) {
  if (dataset.shape != wanted)
    throw InputError(dataset.where + ": has shape " + shown(dataset.shape) + ", but " + why + " asks for " +
                     shown(wanted));
}

void require_stored(const Dataset& dataset, hsize_t elements) {
  const Hdf5Handle creation(H5Dget_create_plist(dataset.id.get()), H5Pclose);
  const Hdf5Handle type(H5Dget_type(dataset.id.get()), H5Tclose);
  if (H5Pget_nfilters(creation.get()) > 0) return;
  if (H5Dget_storage_size(dataset.id.get()) < elements * H5Tget_size(type.get()))
    throw InputError(dataset.where + ": declares shape " + shown(dataset.shape) +
                     " but stores too little for it; the file may be cut short, write it again");
}

std::vector<std::int64_t> read_integers(const Dataset& dataset) {
  std::size_t count = 1;
  for (const hsize_t extent : dataset.shape) count *= extent;
  std::vector<std::int64_t> values(count);
  if (count > 0 &&
      H5Dread(dataset.id.get(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    throw InputError(dataset.where + ": cannot be read; the file may be damaged, write it again");
  return values;
}

std::optional<std::string> read_text_attribute(hid_t file, const char* name) {
  constexpr std::size_t kMostBytes = 1000;
  const Hdf5Handle attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) return std::nullopt;
  const Hdf5Handle type(H5Aget_type(attribute.get()), H5Tclose),
      space(H5Aget_space(attribute.get()), H5Sclose);
  if (H5Tget_class(type.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1)
    return std::nullopt;
  const Hdf5Handle memory(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_cset(memory.get(), H5Tget_cset(type.get()));
  if (H5Tis_variable_str(type.get()) > 0) {
    H5Tset_size(memory.get(), H5T_VARIABLE);
    char* text = nullptr;
    if (H5Aread(attribute.get(), memory.get(), &text) < 0 || text == nullptr) return std::nullopt;
    std::string out(text, strnlen(text, kMostBytes));
    H5free_memory(text);
    return out;
  }
  if (H5Tget_size(type.get()) > kMostBytes) return std::nullopt;
  char text[kMostBytes + 1] = {};
  H5Tset_size(memory.get(), sizeof text);
  if (H5Aread(attribute.get(), memory.get(), text) < 0) return std::nullopt;
  return std::string(text);
}

Hdf5Handle timeless(hid_t kind) {
  Hdf5Handle creation(H5Pcreate(kind), H5Pclose);
  H5Pset_obj_track_times(creation.get(), false);
  return creation;
}

NewHdf5File::NewHdf5File(std::filesystem::path name, bool force) : path(std::move(name)) {
  silence_hdf5();
  const OutputTarget target = find_output_target(path, force);
  if (target.is_stream) fail("it is a device or a pipe, and HDF5 writes to ordinary files alone");
  unfinished.emplace(target.path, force);
  file = Hdf5Handle(H5Fcreate(unfinished->path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  if (!file.valid()) fail("HDF5 made no file");
}

void NewHdf5File::add_group(const std::string& name) {
  const Hdf5Handle creation = timeless(H5P_GROUP_CREATE);
  const Hdf5Handle group(H5Gcreate2(file.get(), name.c_str(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                         H5Gclose);
  if (!group.valid()) fail("HDF5 made no group " + name);
}

void NewHdf5File::add_dataset(const std::string& name, hid_t type, hid_t memory_type,
                              const std::vector<hsize_t>& shape, const void* values) {
  const Hdf5Handle creation = timeless(H5P_DATASET_CREATE);
  const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Hdf5Handle dataset(
      H5Dcreate2(file.get(), name.c_str(), type, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
      H5Dclose);
  if (!dataset.valid() || H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0)
    refuse(name);
}

void NewHdf5File::add_integers(const std::string& name, const std::vector<hsize_t>& shape,
                               const std::vector<std::int32_t>& values) {
  add_dataset(name, H5T_STD_I32LE, H5T_NATIVE_INT32, shape, values.data());
}

void NewHdf5File::add_numbers(const std::string& name, const std::vector<hsize_t>& shape,
                              const void* values) {
  add_dataset(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, shape, values);
}

void NewHdf5File::refuse(const std::string& name) const {
  fail("HDF5 did not take " + name + " (is the disk full?)");
}

void NewHdf5File::finish() {
  if (!file.close()) fail("the last data did not reach the disk (is it full?)");
  unfinished->finish();
}

void NewHdf5File::fail(const std::string& what) const {
  throw InputError("output " + path.string() + ": cannot be written: " + what + "; choose another place");
}

}  // namespace cscd::scenes
