// SPDX-License-Identifier: BSD-3-Clause
// Looks for the library under the names of its releases, once.
#include "target/maps/netcdf_library.h"

#include <dlfcn.h>

#include <optional>

#include "target/maps/symbol.h"

namespace ergocast {
namespace {

/// The functions above are the same in all these releases.
constexpr const char* kNames[] = {"libnetcdf.so.19", "libnetcdf.so.22", "libnetcdf.so.18",
                                  "libnetcdf.so"};

std::optional<NetcdfLibrary> load() {
  void* handle = nullptr;
  for (const char* name : kNames) {
    if (handle == nullptr) handle = dlopen(name, RTLD_NOW | RTLD_LOCAL);
  }
  if (handle == nullptr) return std::nullopt;
  NetcdfLibrary library{};
  library.handle = handle;
  bool complete = true;
  const auto find = [&](auto& function, const char* name) {
    complete = find_symbol(handle, name, function) && complete;
  };
  find(library.nc_open, "nc_open");
  find(library.nc_close, "nc_close");
  find(library.nc_inq_nvars, "nc_inq_nvars");
  find(library.nc_inq_varid, "nc_inq_varid");
  find(library.nc_inq_varname, "nc_inq_varname");
  find(library.nc_inq_varndims, "nc_inq_varndims");
  find(library.nc_inq_vardimid, "nc_inq_vardimid");
  find(library.nc_inq_vartype, "nc_inq_vartype");
  find(library.nc_inq_dim, "nc_inq_dim");
  find(library.nc_inq_att, "nc_inq_att");
  find(library.nc_get_att_text, "nc_get_att_text");
  find(library.nc_get_att_double, "nc_get_att_double");
  find(library.nc_get_vara_double, "nc_get_vara_double");
  find(library.nc_inq_var_chunking, "nc_inq_var_chunking");
  find(library.nc_strerror, "nc_strerror");
  if (!complete) return std::nullopt;
  return library;
}

}  // namespace

const NetcdfLibrary* NetcdfLibrary::find() {
  static const std::optional<NetcdfLibrary> library = load();
  return library ? &*library : nullptr;
}

}  // namespace ergocast
