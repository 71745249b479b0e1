// SPDX-License-Identifier: BSD-3-Clause
// Asks the HDF5 library that libnetcdf uses about each object of the root group.
#include "target/maps/hdf5_storage.h"

#include <array>
#include <cstddef>
#include <cstdint>

#include "target/maps/symbol.h"

namespace ergocast {
namespace {

using Id = std::int64_t;  // hid_t since HDF5 1.10; negative: an error

/// The functions with the names and types of hdf5.h.
struct Hdf5Library {
  int (*H5Eset_auto2)(Id stack, void* function, void* data);
  Id (*H5Fopen)(const char* name, unsigned flags, Id access);
  int (*H5Fclose)(Id file);
  std::ptrdiff_t (*H5Fget_name)(Id object, char* name, std::size_t size);
  std::ptrdiff_t (*H5Lget_name_by_idx)(Id location, const char* group, int index, int order,
                                       std::uint64_t n, char* name, std::size_t size, Id access);
  Id (*H5Oopen)(Id location, const char* name, Id access);
  int (*H5Oclose)(Id object);
  int (*H5Iget_type)(Id object);
  Id (*H5Dget_create_plist)(Id dataset);
  int (*H5Pget_external_count)(Id properties);
  int (*H5Pget_layout)(Id properties);
  int (*H5Pclose)(Id properties);
};

/// Nothing if libnetcdf was built without HDF5; then it opens no such file.
std::optional<Hdf5Library> load(void* netcdf) {
  Hdf5Library library{};
  bool complete = true;
  const auto find = [&](auto& function, const char* name) {
    complete = find_symbol(netcdf, name, function) && complete;
  };
  find(library.H5Eset_auto2, "H5Eset_auto2");
  find(library.H5Fopen, "H5Fopen");
  find(library.H5Fclose, "H5Fclose");
  find(library.H5Fget_name, "H5Fget_name");
  find(library.H5Lget_name_by_idx, "H5Lget_name_by_idx");
  find(library.H5Oopen, "H5Oopen");
  find(library.H5Oclose, "H5Oclose");
  find(library.H5Iget_type, "H5Iget_type");
  find(library.H5Dget_create_plist, "H5Dget_create_plist");
  find(library.H5Pget_external_count, "H5Pget_external_count");
  find(library.H5Pget_layout, "H5Pget_layout");
  find(library.H5Pclose, "H5Pclose");
  if (!complete) return std::nullopt;
  return library;
}

std::string file_of(const Hdf5Library& hdf5, Id object) {
  constexpr std::size_t kLongestPath = 4096;
  std::string name(kLongestPath, '\0');
  const std::ptrdiff_t length = hdf5.H5Fget_name(object, name.data(), name.size());
  return length < 0 ? "" : name.substr(0, name.find('\0'));
}

bool names_another_file(const Hdf5Library& hdf5, Id file, Id object) {
  constexpr int kDataset = 5, kVirtual = 3;  // H5I_DATASET, H5D_VIRTUAL
  if (file_of(hdf5, object) != file_of(hdf5, file)) return true;
  if (hdf5.H5Iget_type(object) != kDataset) return false;
  const Id properties = hdf5.H5Dget_create_plist(object);
  if (properties < 0) return true;
  const bool elsewhere =
      hdf5.H5Pget_external_count(properties) != 0 || hdf5.H5Pget_layout(properties) == kVirtual;
  hdf5.H5Pclose(properties);
  return elsewhere;
}

std::optional<std::string> first_elsewhere(const Hdf5Library& hdf5, Id file) {
  constexpr int kByName = 0, kIncreasing = 0;  // H5_INDEX_NAME, H5_ITER_INC
  std::array<char, 1024> name{};
  for (std::uint64_t i = 0; hdf5.H5Lget_name_by_idx(file, "/", kByName, kIncreasing, i, name.data(),
                                                    name.size(), 0) >= 0;
       ++i) {
    const Id object = hdf5.H5Oopen(file, name.data(), 0);
    if (object < 0) continue;  // nothing can be read of it
    const bool elsewhere = names_another_file(hdf5, file, object);
    hdf5.H5Oclose(object);
    if (elsewhere) return name.data();
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> stored_elsewhere(const std::filesystem::path& file,
                                            const NetcdfLibrary& library) {
  static const std::optional<Hdf5Library> hdf5 = load(library.handle);
  if (!hdf5) return std::nullopt;
  hdf5->H5Eset_auto2(0, nullptr, nullptr);  // it would print each error
  constexpr unsigned kReadAccess = 0;       // H5F_ACC_RDONLY
  const Id opened = hdf5->H5Fopen(file.c_str(), kReadAccess, 0);
  if (opened < 0) return std::nullopt;
  auto name = first_elsewhere(*hdf5, opened);
  hdf5->H5Fclose(opened);
  return name;
}

}  // namespace ergocast
