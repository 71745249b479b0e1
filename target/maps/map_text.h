// SPDX-License-Identifier: BSD-3-Clause
// Parses numbers in text files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "target/maps/map_file.h"
#include "text/input_file.h"

namespace ergocast {

/// The text without blanks around it.
std::string_view trimmed(std::string_view text);

/// A word as an error message quotes it.
std::string quoted_word(std::string_view word);

/// The number that the whole of `text` represents, in C's notation and any locale; else nothing.
std::optional<double> number_in(std::string_view text);

/// The density of a cell, or its error, which begins with `where`.
Result<double, MapProblem> density_in(std::string_view text, const std::string& where);
std::optional<MapProblem> check_density(double value, const std::string& where);

/// Words between white space, with their line numbers.
class WordReader {
 public:
  explicit WordReader(const std::filesystem::path& file) : file_(file) {}

  /// The next word, empty at the end of the file; only the beginning of a very long one.
  std::string_view next();
  /// The line number of the last word, from 1.
  long long line() const { return line_; }

 private:
  InputFile file_;
  std::string word_;
  long long line_ = 1;
};

}  // namespace ergocast
