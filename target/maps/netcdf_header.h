// SPDX-License-Identifier: BSD-3-Clause
// Checks the header of a NetCDF file in the classic format, before libnetcdf relies on it.
//
// The header announces lengths of names, attributes and variables. libnetcdf takes memory for them,
// and reads zeros where the file has ended: 1.7 kB can become gigabytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace ergocast {

struct NetcdfHeader {
  /// How many bytes the file must have to hold each variable. Empty for other formats, such
  /// as HDF5, in which libnetcdf looks for every part before it reads it.
  std::map<std::string, std::uint64_t> bytes_up_to;
};

/// Nothing if the header announces more than the file holds.
/// @pre the file can be read
std::optional<NetcdfHeader> read_netcdf_header(const std::filesystem::path& file);

}  // namespace ergocast
