// SPDX-License-Identifier: BSD-3-Clause
// The files of a record besides its trajectory, each held against what makes it: the scenario, the
// simulated recorder, or the other files.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "logger/recorder.h"
#include "scenario/scenario.h"

namespace ergocast::cli {

/// What became of one file of a record.
struct FileComparison {
  std::string file;        ///< its path within the run directory
  std::string compared;    ///< what of it is as it should be; empty: nothing was compared
  std::string left_out;    ///< what was not compared, and why; empty: all was
  std::string difference;  ///< the first: where, and both values, in lines; empty: none
};

/// What a record should say, as a recorder knows it that has seen the recorded trajectory.
struct Expectation {
  const Recorder& recorder;
  std::string metrics;       ///< what it has written of metrics.csv
  bool simulation = false;   ///< the record is that of a simulation
  bool whole = false;        ///< and all of it: nothing in it depended on a network, or a Ctrl-C
  bool complete = false;     ///< it has the plan's last tick
  bool closed = false;       ///< its recorder ended in order: no row may be missing at its end
  std::int64_t clamped_commands = 0;  ///< of the simulation; counts if `complete`
};

/// scenario.textproto, plan.binpb and target_density.csv against each other and the summary's hash.
/// @param mission  read from plan.binpb
/// @param summary  an object
std::vector<FileComparison> compare_sources(const std::filesystem::path& run_dir, const Mission& mission,
                                            const nlohmann::ordered_json& summary);

/// metrics.csv, all segments.
FileComparison compare_metrics(const std::filesystem::path& run_dir, const Expectation& expectation);

/// summary.json, value by value.
/// @param recorded  an object
FileComparison compare_summary(const std::filesystem::path& run_dir, const Mission& mission,
                               const nlohmann::ordered_json& recorded,
                               const Expectation& expectation);

/// report.html and the figures against what the other files make. Where the summary or the target's
/// picture is not there, they may have been drawn while it was.
std::vector<FileComparison> compare_report(const std::filesystem::path& run_dir,
                                           const Mission& mission);

}  // namespace ergocast::cli
