// SPDX-License-Identifier: BSD-3-Clause
// Finds numbers of an HDF5 file that are stored outside of it. NetCDF-4 files are HDF5.
//
// HDF5 can name other files as the storage of a dataset ("external storage"), build a dataset from
// parts of other files ("virtual"), and link to objects of other files. A map from a stranger could
// so make the numbers of any readable file of this host part of a target.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "target/maps/netcdf_library.h"

namespace ergocast {

/// The first dataset of the root group that names another file; nothing for other formats, and for
/// files that HDF5 cannot open. Variables of other groups are never read.
/// @pre the file is not open in `library`
std::optional<std::string> stored_elsewhere(const std::filesystem::path& file,
                                            const NetcdfLibrary& library);

}  // namespace ergocast
