// The files of a run directory that grow during the run.
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace ergocast {

inline constexpr const char* kTrajectoryFile = "trajectory.csv";
inline constexpr const char* kMetricsFile = "metrics.csv";
inline constexpr const char* kSummaryFile = "summary.json";
inline constexpr const char* kScenarioFile = "scenario.textproto";
/// The compiled plan as it was sent: what `ergocast verify` simulates again.
inline constexpr const char* kPlanFile = "plan.binpb";

class RunRecord {
 public:
  /// Begins trajectory.csv and metrics.csv in an existing folder. An error names the file; a record
  /// that is already there is left alone.
  static std::variant<std::unique_ptr<RunRecord>, std::string> create(
      const std::filesystem::path& folder);

  std::ostream& trajectory() { return trajectory_; }
  std::ostream& metrics() { return metrics_; }
  bool good() const { return trajectory_.good() && metrics_.good(); }
  const std::filesystem::path& folder() const { return folder_; }

  /// Hands everything to the operating system. The first write error, such as a full disk, if any.
  std::optional<std::string> flush();

 private:
  explicit RunRecord(std::filesystem::path folder);
  std::filesystem::path folder_;
  std::ofstream trajectory_, metrics_;
};

/// Writes a whole file under another name and renames it, so that nobody ever sees half of it.
/// Nothing on success, otherwise the error.
std::optional<std::string> write_file(const std::filesystem::path& file, std::string_view text);

}  // namespace ergocast
