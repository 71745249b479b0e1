// SPDX-License-Identifier: BSD-3-Clause
// The files of a run directory that grow during the run. A logger that continues a record begins
// new files. So an unfinished line of a killed process stays the last of its file.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "logger/line_file.h"

namespace ergocast {

inline constexpr const char* kTrajectoryFile = "trajectory.csv";
inline constexpr const char* kMetricsFile = "metrics.csv";
inline constexpr const char* kSummaryFile = "summary.json";
inline constexpr const char* kScenarioFile = "scenario.textproto";
/// The compiled plan as it was sent: what `ergocast verify` simulates again.
inline constexpr const char* kPlanFile = "plan.binpb";
/// All amendments of the mission, with the numbers of their targets.
inline constexpr const char* kAmendmentsFile = "amendments.json";
/// From which ticks recalled agents rest, until a summary has them.
inline constexpr const char* kRecallsFile = "recalls.json";

/// File `segment` of a table: trajectory.csv, trajectory-001.csv, trajectory-002.csv …
std::filesystem::path segment_file(const std::filesystem::path& folder, const std::string& table,
                                   int segment);
/// The number of segments of the record in `folder`; 0 if there is none. A segment with rows counts
/// even if one of its tables is missing.
int segment_count(const std::filesystem::path& folder);

class RunRecord {
 public:
  using Created = Result<std::unique_ptr<RunRecord>>;

  /// Begins trajectory.csv and metrics.csv in an existing folder. An error names the file. An
  /// existing record stays unchanged.
  static Created create(const std::filesystem::path& folder);
  /// The same for the next segment of the record in `folder`, the first if there is none. Existing
  /// files, damaged or not, stay unchanged.
  static Created go_on(const std::filesystem::path& folder);

  /// Number of the segment, from 0.
  int segment() const { return segment_; }
  std::ostream& trajectory() { return trajectory_; }
  std::ostream& metrics() { return metrics_; }
  bool good() const { return trajectory_.good() && metrics_.good(); }
  const std::filesystem::path& folder() const { return folder_; }

  /// Passes all data to the operating system, also data that it refused before. Returns the write
  /// error, such as a full disk, if any; after it no line is lost and no incomplete line stays.
  std::optional<std::string> flush();

  /// Removes the files of this segment.
  void discard();

 private:
  RunRecord(std::filesystem::path folder, int segment);
  static Created begin(const std::filesystem::path& folder, int segment, const char* if_taken);
  std::filesystem::path trajectory_file() const;
  std::filesystem::path metrics_file() const;

  std::filesystem::path folder_;
  int segment_;
  LineFile trajectory_, metrics_;
};

/// Writes a whole file under another name and renames it, so that readers never see an incomplete
/// file. Nothing on success, otherwise the error.
std::optional<std::string> write_file(const std::filesystem::path& file, std::string_view text);

}  // namespace ergocast
