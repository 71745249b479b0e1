// SPDX-License-Identifier: BSD-3-Clause
// Opens one segment after the other, checks its header, and hands out its lines.
#include "logger/table_lines.h"

#include <algorithm>
#include <limits>

#include "logger/recorder.h"
#include "logger/run_record.h"

namespace ergocast {
namespace {

/// More bytes than nine numbers have.
/// Limit (Record): length of a row of a recorded table [bytes]. Beyond it: `verify`, `report` and
/// other commands refuse the record.
constexpr std::size_t kLongestRow = 4096;

}  // namespace

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
  in_.emplace(file_);
  const auto& problem = in_->problem();
  if (!problem) return true;
  const bool other = problem->kind == FileProblem::Kind::kNoFile;
  problem_ = file_.string() + ": " + (other ? problem->what : "cannot be opened") +
             ": give the directory of a run, with trajectory.csv "
             "and metrics.csv readable in it";
  return false;
}

bool TableLines::next(std::string& line) {
  while (!problem_) {
    LineEnd end = next_line(*in_, line, kLongestRow);
    if (end == LineEnd::kMore) end = skip_line();
    if (end == LineEnd::kFile) torn_ = true;
    if (end == LineEnd::kFile || end == LineEnd::kNone) {
      if (!open_next()) return false;
    } else if (++line_ > 1) {
      if (!problem_) return true;
    } else if (std::ranges::find(headers_, line) != headers_.end()) {
      header_ = line;
    } else if (!problem_) {
      problem_ = place() + "the header is " + in_quotes(line) + ", not \"" + headers_.front() +
                 "\": use the version of ergocast that recorded the run";
    }
  }
  return false;
}

/// Skips a line that is too long for a row. It is no problem if the file ends in it: after a power
/// failure, millions of zeros may be there.
LineEnd TableLines::skip_line() {
  in_->ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  if (in_->eof()) return LineEnd::kFile;
  problem_ = file_.string() + ':' + std::to_string(line_ + 1) + ": is longer than any row, " +
             std::to_string(kLongestRow) + " bytes: copy the file again from where it was recorded";
  return LineEnd::kBreak;
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
  return {kTrajectoryHeader, kTrajectoryHeaderWithObjects, kTrajectoryHeaderWithReports,
          kTrajectoryHeaderInSpace};
}

std::string in_quotes(const std::string& line) {
  constexpr std::size_t kLongest = 60;
  return '"' + (line.size() <= kLongest ? line : line.substr(0, kLongest) + "…") + '"';
}

}  // namespace ergocast
