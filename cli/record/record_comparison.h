// SPDX-License-Identifier: BSD-3-Clause
// Compares the files of a record, except its trajectory, with their sources: the scenario, the
// simulated recorder, or the other files.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "logger/received_amendments.h"
#include "logger/recorder.h"
#include "scenario/scenario.h"

namespace ergocast::cli {

/// The result of comparing one file of a record.
struct FileComparison {
  std::string file;        ///< its path within the run directory
  std::string compared;    ///< the parts that are as expected; empty: nothing was compared
  std::string left_out;    ///< the parts that were not compared, and why; empty: all were
  std::string difference;  ///< the first: place and both values, in lines; empty: none
};

/// The expected contents of a record, computed by a recorder that received the recorded trajectory.
struct Expectation {
  const Recorder& recorder;
  std::string metrics;                   ///< what it wrote to metrics.csv
  const ReceivedAmendments& amendments;  ///< those of the record: it knew them one by one
  bool simulation = false;               ///< the record is of a simulation
  bool whole = false;     ///< the simulation is complete: no network and no Ctrl-C affected it
  bool complete = false;  ///< it has the plan's last tick
  bool closed = false;    ///< its recorder ended in order: no row may be missing at its end
  std::int64_t clamped_commands = 0;  ///< of the simulation; counts if `complete`
};

/// Compares scenario.textproto, plan.binpb and target_density.csv with each other and with the
/// summary's hash.
/// @param mission  read from plan.binpb
/// @param summary  an object
std::vector<FileComparison> compare_sources(const std::filesystem::path& run_dir,
                                            const Mission& mission,
                                            const nlohmann::ordered_json& summary);

/// metrics.csv, all segments.
FileComparison compare_metrics(const std::filesystem::path& run_dir,
                               const Expectation& expectation);

/// summary.json, value by value.
/// @param recorded  an object
FileComparison compare_summary(const std::filesystem::path& run_dir, const Mission& mission,
                               const nlohmann::ordered_json& recorded,
                               const Expectation& expectation);

/// Compares report.html with what the other files produce. If the summary or the target's picture
/// is missing, it may have existed when the page was made.
FileComparison compare_report(const std::filesystem::path& run_dir, const Mission& mission);

}  // namespace ergocast::cli
