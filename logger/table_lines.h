// SPDX-License-Identifier: BSD-3-Clause
// Reads a recorded table line by line, all its segments in order as one.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "text/input_file.h"

namespace ergocast {

class TableLines {
 public:
  /// Opens the first segment of `table` ("trajectory.csv") in `run_dir`.
  /// @param headers  those that it may have, at least one
  TableLines(std::filesystem::path run_dir, std::string table, std::vector<std::string> headers);

  /// The next line after a header; false at the end, and from the first problem on. A last line
  /// without its line break comes from a killed process and is ignored.
  bool next(std::string& line);
  /// Continues with the next segment, also after a problem; false if there is none.
  bool skip_segment();
  /// The header of the segment that is being read.
  const std::string& header() const { return header_; }
  /// The place of next()'s last line: "run/trajectory.csv:17: ".
  std::string place() const;
  /// Whether the segment that was read last ends with a line without its line break.
  /// @pre next() returned false
  bool torn() const { return torn_; }
  /// The file that cannot be opened or has a foreign header, with the remedy.
  const std::optional<std::string>& problem() const { return problem_; }

 private:
  bool open_next();
  LineEnd skip_line();

  std::filesystem::path run_dir_;
  std::string table_;
  std::vector<std::string> headers_;
  std::string header_;
  int segments_, opened_ = 0;
  std::filesystem::path file_;
  std::optional<InputFile> in_;
  std::int64_t line_ = 0;
  bool torn_ = false;
  std::optional<std::string> problem_;
};

/// The headers that trajectory.csv may have: of a plane, with objects, with reports, of a box.
std::vector<std::string> trajectory_headers();

/// A line as an error message quotes it.
std::string in_quotes(const std::string& line);

}  // namespace ergocast
