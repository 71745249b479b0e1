// SPDX-License-Identifier: BSD-3-Clause
// Asks libnetcdf, and checks each of its answers.
#include "target/maps/netcdf_file.h"

#include <array>
#include <utility>

#include "target/maps/hdf5_storage.h"

namespace ergocast {
namespace {

constexpr int kReadOnly = 0, kText = 2, kLastNumber = 11;  // NC_NOWRITE, NC_CHAR, NC_UINT64
constexpr std::size_t kLongestName = 256;                  // NC_MAX_NAME
constexpr std::size_t kLongestText = 1000;
/// Limit (Files of a scenario): chunk of a NetCDF file [bytes]. Beyond it: the scenario is refused.
constexpr std::size_t kMostChunkBytes = std::size_t{64} << 20;

using Name = std::array<char, kLongestName + 1>;

}  // namespace

Result<std::shared_ptr<NetcdfFile>, MapProblem> NetcdfFile::open(
    const std::filesystem::path& file) {
  if (auto problem = why_unreadable(file)) return failure(*problem);
  const NetcdfLibrary* library = NetcdfLibrary::find();
  if (library == nullptr) {
    return failure(MapProblem{file.string() + " needs libnetcdf, which this machine does not have",
                              "apt install libnetcdf19; on Debian 13 libnetcdf22"});
  }
  auto header = read_netcdf_header(file);
  if (!header) {
    return failure(MapProblem{file.string() + ": its header announces more than the file holds",
                              "write the file again, or copy it anew"});
  }
  if (const auto dataset = stored_elsewhere(file, *library)) {
    return failure(MapProblem{
        file.string() + ": the numbers of " + *dataset + " are in another file, which is not read",
        "write all numbers into one file, as nccopy does"});
  }
  int opened = 0;
  if (const int error = library->nc_open(file.c_str(), kReadOnly, &opened); error != 0) {
    return failure(MapProblem{file.string() + ": " + library->nc_strerror(error),
                              "is it a NetCDF file? ncdump -h shows one"});
  }
  return std::shared_ptr<NetcdfFile>(new NetcdfFile(file, *std::move(header), *library, opened));
}

NetcdfFile::~NetcdfFile() { library_.nc_close(file_); }

std::optional<NetcdfFile::Variable> NetcdfFile::variable(const std::string& name) const {
  int variable = 0;
  if (library_.nc_inq_varid(file_, name.c_str(), &variable) != 0) return std::nullopt;
  return variable;
}

std::vector<std::string> NetcdfFile::variables() const {
  int count = 0;
  if (library_.nc_inq_nvars(file_, &count) != 0) return {};
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) {
    std::string name = name_of(i);
    if (!name.empty()) names.push_back(std::move(name));
  }
  return names;
}

std::string NetcdfFile::name_of(Variable variable) const {
  Name name{};
  return library_.nc_inq_varname(file_, variable, name.data()) == 0 ? name.data() : "";
}

std::vector<NetcdfFile::Dimension> NetcdfFile::dimensions(Variable variable) const {
  int count = 0;
  if (library_.nc_inq_varndims(file_, variable, &count) != 0 || count <= 0) return {};
  std::vector<int> ids(static_cast<std::size_t>(count));
  if (library_.nc_inq_vardimid(file_, variable, ids.data()) != 0) return {};
  std::vector<Dimension> dimensions;
  for (const int id : ids) {
    Name name{};
    std::size_t length = 0;
    if (library_.nc_inq_dim(file_, id, name.data(), &length) != 0) return {};
    dimensions.push_back({name.data(), length});
  }
  return dimensions;
}

bool NetcdfFile::holds_numbers(Variable variable) const {
  int type = 0;
  return library_.nc_inq_vartype(file_, variable, &type) == 0 && type != kText && type > 0 &&
         type <= kLastNumber;
}

std::optional<MapProblem> NetcdfFile::objection(Variable variable) const {
  const std::string name = name_of(variable), place = name_.string() + ": " + name;
  const auto announced = header_.bytes_up_to.find(name);
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(name_, error);
  if (announced != header_.bytes_up_to.end() && !error && announced->second > bytes) {
    return MapProblem{place + " ends at byte " + std::to_string(announced->second) +
                          ", and the file has " + std::to_string(bytes),
                      "write the file again, or copy it anew"};
  }
  if (chunk_bytes(variable) <= kMostChunkBytes) return std::nullopt;
  return MapProblem{place + " is stored in parts of more than 64 MiB",
                    "write it in smaller chunks: nccopy -c"};
}

/// The size of the smallest part that can be read by itself; 0 if rows can.
std::size_t NetcdfFile::chunk_bytes(Variable variable) const {
  constexpr int kChunked = 0;
  std::vector<std::size_t> lengths(dimensions(variable).size());
  int storage = 1;
  if (library_.nc_inq_var_chunking(file_, variable, &storage, lengths.data()) != 0 ||
      storage != kChunked)
    return 0;
  std::size_t bytes = sizeof(double);
  for (const std::size_t length : lengths) {
    if (__builtin_mul_overflow(bytes, length, &bytes)) return SIZE_MAX;
  }
  return bytes;
}

std::string NetcdfFile::text(Variable variable, const char* attribute) const {
  int type = 0;
  std::size_t length = 0;
  if (library_.nc_inq_att(file_, variable, attribute, &type, &length) != 0 || type != kText ||
      length > kLongestText)
    return {};
  std::string text(length, '\0');
  if (library_.nc_get_att_text(file_, variable, attribute, text.data()) != 0) return {};
  return text.substr(0, text.find('\0'));
}

int NetcdfFile::type_of(Variable variable) const {
  int type = 0;
  return library_.nc_inq_vartype(file_, variable, &type) == 0 ? type : 0;
}

int NetcdfFile::type_of(Variable variable, const char* attribute) const {
  int type = 0;
  std::size_t length = 0;
  return library_.nc_inq_att(file_, variable, attribute, &type, &length) == 0 ? type : 0;
}

std::vector<double> NetcdfFile::numeric_attributes(Variable variable, const char* attribute) const {
  constexpr std::size_t kMost = 64;
  int type = 0;
  std::size_t length = 0;
  if (library_.nc_inq_att(file_, variable, attribute, &type, &length) != 0 || length > kMost)
    return {};
  std::vector<double> values(length);
  if (library_.nc_get_att_double(file_, variable, attribute, values.data()) != 0) return {};
  return values;
}

std::optional<double> NetcdfFile::numeric_attribute(Variable variable,
                                                    const char* attribute) const {
  int type = 0;
  std::size_t length = 0;
  double value = 0;
  if (library_.nc_inq_att(file_, variable, attribute, &type, &length) != 0 || length != 1 ||
      library_.nc_get_att_double(file_, variable, attribute, &value) != 0)
    return std::nullopt;
  return value;
}

std::optional<MapProblem> NetcdfFile::read(Variable variable, std::span<const std::size_t> start,
                                           std::span<const std::size_t> count,
                                           std::span<double> values) const {
  const int error =
      library_.nc_get_vara_double(file_, variable, start.data(), count.data(), values.data());
  if (error == 0) return std::nullopt;
  return MapProblem{name_.string() + ": " + library_.nc_strerror(error), "write the file again"};
}

}  // namespace ergocast
