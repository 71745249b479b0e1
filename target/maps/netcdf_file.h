// SPDX-License-Identifier: BSD-3-Clause
// One open NetCDF file: its variables, their axes and attributes.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "target/maps/map_file.h"
#include "target/maps/netcdf_header.h"
#include "target/maps/netcdf_library.h"

namespace ergocast {

/// Every function returns nothing, or an empty text, if the file does not have what is asked for.
class NetcdfFile {
 public:
  static Result<std::shared_ptr<NetcdfFile>, MapProblem> open(const std::filesystem::path& file);
  ~NetcdfFile();
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  const std::filesystem::path& name() const { return name_; }

  struct Dimension {
    std::string name;
    std::size_t length;
  };
  using Variable = int;

  std::optional<Variable> variable(const std::string& name) const;
  std::vector<std::string> variables() const;
  std::vector<Dimension> dimensions(Variable variable) const;
  bool holds_numbers(Variable variable) const;
  /// Why read() would take too much memory, or read what is not there. Call it before read().
  std::optional<MapProblem> objection(Variable variable) const;

  std::string text(Variable variable, const char* attribute) const;
  std::optional<double> numeric_attribute(Variable variable, const char* attribute) const;
  /// All numbers of an attribute that has at most 64.
  std::vector<double> numeric_attributes(Variable variable, const char* attribute) const;
  /// A number of netcdf.h such as NC_SHORT; 0 if there is none.
  int type_of(Variable variable) const;
  int type_of(Variable variable, const char* attribute) const;

  /// The numbers as they are stored, from `start` on, `count` along each dimension.
  std::optional<MapProblem> read(Variable variable, std::span<const std::size_t> start,
                                 std::span<const std::size_t> count,
                                 std::span<double> values) const;

 private:
  NetcdfFile(std::filesystem::path name, NetcdfHeader header, const NetcdfLibrary& library,
             int file)
      : name_(std::move(name)), header_(std::move(header)), library_(library), file_(file) {}
  std::string name_of(Variable variable) const;
  std::size_t chunk_bytes(Variable variable) const;

  std::filesystem::path name_;
  NetcdfHeader header_;
  const NetcdfLibrary& library_;
  int file_;
};

}  // namespace ergocast
