// SPDX-License-Identifier: BSD-3-Clause
// The functions of libnetcdf, loaded when a file needs them: no program has to load HDF5 to start,
// and only machines that read such files need the library.
#pragma once

#include <cstddef>

namespace ergocast {

/// The functions with the names and types of netcdf.h, version 4.
struct NetcdfLibrary {
  int (*nc_open)(const char* path, int mode, int* file);
  int (*nc_close)(int file);
  int (*nc_inq_nvars)(int file, int* count);
  int (*nc_inq_varid)(int file, const char* name, int* variable);
  int (*nc_inq_varname)(int file, int variable, char* name);
  int (*nc_inq_varndims)(int file, int variable, int* count);
  int (*nc_inq_vardimid)(int file, int variable, int* dimensions);
  int (*nc_inq_vartype)(int file, int variable, int* type);
  int (*nc_inq_dim)(int file, int dimension, char* name, size_t* length);
  int (*nc_inq_att)(int file, int variable, const char* name, int* type, size_t* length);
  int (*nc_get_att_text)(int file, int variable, const char* name, char* text);
  int (*nc_get_att_double)(int file, int variable, const char* name, double* values);
  int (*nc_get_vara_double)(int file, int variable, const size_t* start, const size_t* count,
                            double* values);
  int (*nc_inq_var_chunking)(int file, int variable, int* storage, size_t* lengths);
  const char* (*nc_strerror)(int error);
  void* handle;  ///< of dlopen(), for functions of the libraries that it uses

  /// Null if the machine does not have it.
  static const NetcdfLibrary* find();
};

}  // namespace ergocast
