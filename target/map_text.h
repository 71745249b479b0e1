// SPDX-License-Identifier: BSD-3-Clause
// Numbers in text files.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "target/map_file.h"

namespace ergocast {

/// The number that `text` is, the whole of it, in C's notation whatever the locale; else nothing.
std::optional<double> number_in(std::string_view text);

/// The density in a cell, or what is wrong with it. `where` begins what is said.
std::variant<double, MapProblem> density_in(std::string_view text, const std::string& where);
std::optional<MapProblem> check_density(double value, const std::string& where);

/// Words between white space, and the lines they stand in.
class WordReader {
 public:
  explicit WordReader(const std::filesystem::path& file);

  /// The next word, empty at the end of the file; of a very long one its beginning.
  std::string_view next();
  /// Number of the line in which the last word stands, from 1.
  long long line() const { return line_; }

 private:
  std::filebuf file_;
  std::string word_;
  long long line_ = 1;
};

}  // namespace ergocast
