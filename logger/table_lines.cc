// SPDX-License-Identifier: BSD-3-Clause
// Opens one segment after the other, checks its header, and hands out its lines.
#include "logger/table_lines.h"

#include <algorithm>

#include "logger/recorder.h"
#include "logger/run_record.h"
#include "text/regular_file.h"

namespace ergocast {

TableLines::TableLines(std::filesystem::path run_dir, std::string table,
                       std::vector<std::string> headers)
    : run_dir_(std::move(run_dir)),
      table_(std::move(table)),
      headers_(std::move(headers)),
      header_(headers_.front()),
      segments_(std::max(1, segment_count(run_dir_))) {
  open_next();
}

bool TableLines::open_next() {
  if (problem_ || opened_ == segments_) return false;
  file_ = segment_file(run_dir_, table_, opened_++);
  line_ = 0;
  torn_ = false;
  if (const auto why = why_not_regular(file_)) {
    problem_ = file_.string() + ": " + *why;
    return false;
  }
  in_ = std::ifstream(file_, std::ios::binary);
  if (in_) return true;
  problem_ = file_.string() +
             ": cannot be opened: give the directory of a run, with trajectory.csv "
             "and metrics.csv readable in it";
  return false;
}

bool TableLines::next(std::string& line) {
  while (!problem_) {
    const bool some = static_cast<bool>(std::getline(in_, line));
    if (some && !in_.eof()) {
      if (++line_ > 1) return true;
      if (std::ranges::find(headers_, line) != headers_.end()) {
        header_ = line;
        continue;
      }
      problem_ = place() + "the header is " + in_quotes(line) + ", not \"" + headers_.front() +
                 "\": use the version of ergocast that recorded the run";
    } else {
      if (some) torn_ = true;
      if (!open_next()) return false;
    }
  }
  return false;
}

bool TableLines::skip_segment() {
  if (opened_ == segments_) return false;
  problem_.reset();
  open_next();
  return true;
}

std::string TableLines::place() const {
  return file_.string() + ':' + std::to_string(line_) + ": ";
}

std::vector<std::string> trajectory_headers() {
  return {kTrajectoryHeader, kTrajectoryHeaderInSpace};
}

std::string in_quotes(const std::string& line) {
  constexpr std::size_t kLongest = 60;
  return '"' + (line.size() <= kLongest ? line : line.substr(0, kLongest) + "…") + '"';
}

}  // namespace ergocast
