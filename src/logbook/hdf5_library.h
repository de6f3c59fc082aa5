// Private: libhdf5, opened at run time. Linked, it and the thirty libraries behind it would make
// every start of the program slower.
#pragma once

#include <hdf5.h>

#include <utility>

#include "base/base.h"

namespace aircut::logbook {

/// The functions and types of the library that are used, by their own names.
struct Hdf5 {
  decltype(&::H5open) H5open = nullptr;
  decltype(&::H5Eset_auto2) H5Eset_auto2 = nullptr;
  decltype(&::H5Fcreate) H5Fcreate = nullptr;
  decltype(&::H5Fopen) H5Fopen = nullptr;
  decltype(&::H5Fclose) H5Fclose = nullptr;
  decltype(&::H5Gcreate2) H5Gcreate2 = nullptr;
  decltype(&::H5Gopen2) H5Gopen2 = nullptr;
  decltype(&::H5Gclose) H5Gclose = nullptr;
  decltype(&::H5Pcreate) H5Pcreate = nullptr;
  decltype(&::H5Pclose) H5Pclose = nullptr;
  decltype(&::H5Pset_chunk) H5Pset_chunk = nullptr;
  decltype(&::H5Pset_shuffle) H5Pset_shuffle = nullptr;
  decltype(&::H5Pset_deflate) H5Pset_deflate = nullptr;
  decltype(&::H5Pset_obj_track_times) H5Pset_obj_track_times = nullptr;
  decltype(&::H5Pset_attr_creation_order) H5Pset_attr_creation_order = nullptr;
  decltype(&::H5Pset_file_locking) H5Pset_file_locking = nullptr;
  decltype(&::H5Screate) H5Screate = nullptr;
  decltype(&::H5Screate_simple) H5Screate_simple = nullptr;
  decltype(&::H5Sclose) H5Sclose = nullptr;
  decltype(&::H5Sselect_hyperslab) H5Sselect_hyperslab = nullptr;
  decltype(&::H5Sget_simple_extent_ndims) H5Sget_simple_extent_ndims = nullptr;
  decltype(&::H5Sget_simple_extent_dims) H5Sget_simple_extent_dims = nullptr;
  decltype(&::H5Dcreate2) H5Dcreate2 = nullptr;
  decltype(&::H5Dopen2) H5Dopen2 = nullptr;
  decltype(&::H5Dclose) H5Dclose = nullptr;
  decltype(&::H5Dset_extent) H5Dset_extent = nullptr;
  decltype(&::H5Dget_space) H5Dget_space = nullptr;
  decltype(&::H5Dget_type) H5Dget_type = nullptr;
  decltype(&::H5Dget_storage_size) H5Dget_storage_size = nullptr;
  decltype(&::H5Dread) H5Dread = nullptr;
  decltype(&::H5Dwrite) H5Dwrite = nullptr;
  decltype(&::H5Acreate2) H5Acreate2 = nullptr;
  decltype(&::H5Aclose) H5Aclose = nullptr;
  decltype(&::H5Aopen_by_idx) H5Aopen_by_idx = nullptr;
  decltype(&::H5Aget_name) H5Aget_name = nullptr;
  decltype(&::H5Aget_type) H5Aget_type = nullptr;
  decltype(&::H5Aread) H5Aread = nullptr;
  decltype(&::H5Awrite) H5Awrite = nullptr;
  decltype(&::H5Aget_space) H5Aget_space = nullptr;
  decltype(&::H5Tset_cset) H5Tset_cset = nullptr;
  decltype(&::H5Tcopy) H5Tcopy = nullptr;
  decltype(&::H5Tset_size) H5Tset_size = nullptr;
  decltype(&::H5Tget_size) H5Tget_size = nullptr;
  decltype(&::H5Tget_class) H5Tget_class = nullptr;
  decltype(&::H5Tclose) H5Tclose = nullptr;
  decltype(&::H5Lexists) H5Lexists = nullptr;
  decltype(&::H5Tis_variable_str) H5Tis_variable_str = nullptr;
  hid_t native_double = 0, file_double = 0, file_int64 = 0, c_string = 0;
  hid_t file_access = 0, group_create = 0, dataset_create = 0;  ///< classes of property lists
};

/// Opens the library. Error kind `output_failed` when it is not there.
Expected<Hdf5> open_hdf5();

/// An identifier of the library, closed at the end of its life.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*closer)(hid_t)) : id_(id), close_(closer) {}
  Handle(Handle&& other) noexcept { *this = std::move(other); }
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { close(); }
  /// Below 0 when that failed.
  herr_t close() {
    const hid_t id = std::exchange(id_, -1);
    return id >= 0 && close_ ? close_(id) : 0;
  }
  hid_t id() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

}  // namespace aircut::logbook
