#pragma once

#include <hdf5.h>
#include <utility>

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

}  // namespace cscd::scenes
