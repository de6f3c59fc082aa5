#include "logbook/hdf5_library.h"

#include "base/shared_library.h"

namespace aircut::logbook {

Expected<Hdf5> open_hdf5() {
  const std::string name = "libhdf5_serial.so.103";
  const auto library =
      open_library(name, "reading and writing .h5 needs it (Debian package libhdf5-103-1)");
  if (!library) return unexpected(library.error());
  Hdf5 out;
  std::string missing;
  const auto find = [&](const char* symbol, auto& function) {
    if (!find_function(*library, symbol, function)) missing = symbol;
  };
  find("H5open", out.H5open);
  find("H5Eset_auto2", out.H5Eset_auto2);
  find("H5Fcreate", out.H5Fcreate);
  find("H5Fopen", out.H5Fopen);
  find("H5Fclose", out.H5Fclose);
  find("H5Gcreate2", out.H5Gcreate2);
  find("H5Gopen2", out.H5Gopen2);
  find("H5Gclose", out.H5Gclose);
  find("H5Pcreate", out.H5Pcreate);
  find("H5Pclose", out.H5Pclose);
  find("H5Pset_chunk", out.H5Pset_chunk);
  find("H5Pset_shuffle", out.H5Pset_shuffle);
  find("H5Pset_deflate", out.H5Pset_deflate);
  find("H5Pset_obj_track_times", out.H5Pset_obj_track_times);
  find("H5Pset_attr_creation_order", out.H5Pset_attr_creation_order);
  find("H5Pset_file_locking", out.H5Pset_file_locking);
  find("H5Screate", out.H5Screate);
  find("H5Screate_simple", out.H5Screate_simple);
  find("H5Sclose", out.H5Sclose);
  find("H5Sselect_hyperslab", out.H5Sselect_hyperslab);
  find("H5Sget_simple_extent_ndims", out.H5Sget_simple_extent_ndims);
  find("H5Sget_simple_extent_dims", out.H5Sget_simple_extent_dims);
  find("H5Dcreate2", out.H5Dcreate2);
  find("H5Dopen2", out.H5Dopen2);
  find("H5Dclose", out.H5Dclose);
  find("H5Dset_extent", out.H5Dset_extent);
  find("H5Dget_space", out.H5Dget_space);
  find("H5Dget_type", out.H5Dget_type);
  find("H5Dget_storage_size", out.H5Dget_storage_size);
  find("H5Dread", out.H5Dread);
  find("H5Dwrite", out.H5Dwrite);
  find("H5Acreate2", out.H5Acreate2);
  find("H5Aclose", out.H5Aclose);
  find("H5Aopen_by_idx", out.H5Aopen_by_idx);
  find("H5Aget_name", out.H5Aget_name);
  find("H5Aget_type", out.H5Aget_type);
  find("H5Aread", out.H5Aread);
  find("H5Awrite", out.H5Awrite);
  find("H5Aget_space", out.H5Aget_space);
  find("H5Tset_cset", out.H5Tset_cset);
  find("H5Tcopy", out.H5Tcopy);
  find("H5Tset_size", out.H5Tset_size);
  find("H5Tget_size", out.H5Tget_size);
  find("H5Tget_class", out.H5Tget_class);
  find("H5Tclose", out.H5Tclose);
  find("H5Lexists", out.H5Lexists);
  find("H5Tis_variable_str", out.H5Tis_variable_str);
  if (missing.empty() && out.H5open() < 0) missing = "a start";
  // Types and classes are variables, filled by the start.
  const auto read = [&](const char* symbol, hid_t& value) {
    const hid_t* variable = nullptr;
    if (find_function(*library, symbol, variable))
      value = *variable;
    else
      missing = symbol;
  };
  read("H5T_NATIVE_DOUBLE_g", out.native_double);
  read("H5T_IEEE_F64LE_g", out.file_double);
  read("H5T_STD_I64LE_g", out.file_int64);
  read("H5T_C_S1_g", out.c_string);
  read("H5P_CLS_FILE_ACCESS_ID_g", out.file_access);
  read("H5P_CLS_GROUP_CREATE_ID_g", out.group_create);
  read("H5P_CLS_DATASET_CREATE_ID_g", out.dataset_create);
  if (!missing.empty()) return unexpected(make_error("output_failed", name + " has no " + missing));
  // Its own reports on stderr; failures come back as values.
  out.H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  return out;
}

}  // namespace aircut::logbook
