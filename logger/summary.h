// SPDX-License-Identifier: BSD-3-Clause
// summary.json: the description and the result of a run, for people and programs.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "logger/recorder.h"
#include "team/messages.h"

namespace ergocast {

/// The facts that the recorder cannot know.
struct RunContext {
  RunId run = 0;
  std::string started;  ///< wall-clock time, ISO 8601
  std::string version, build;
  std::string scenario_hash;  ///< of the compiled plan
  bool simulated = false;     ///< in one process, without a network
  std::string own_law{};      ///< name of a law that is none of the scenario's; empty: none
  double wall_time_s = 0;     ///< of the current segment
  int segments = 1;
  int interruptions = 0;    ///< how often the files could not be written for a time
  int events_removed = 0;   ///< segments of the event log, removed because of its limit
  RefusalCounts refused{};  ///< by the recording process
  std::int64_t kernel_drops = 0;
  bool cpu_has_fma = false;
};

/// The summary as far as the record determines it. Keys are documented in docs/run_directory.md.
nlohmann::ordered_json summarize(const Recorder& recorder, const RunContext& context);

/// The name of the modes of φ², for the summary and others: "cosines", "modes of the free domain".
const char* name_of_basis(const Basis& basis);

/// The agents that were recalled, as JSON: each with the first tick at which it rests for that
/// reason, and whether it was sent out of the mission.
nlohmann::ordered_json recalls_json(const Recorder& recorder);

/// From which tick on the recalled agents of a run directory rest: from recalls.json, else from
/// `summary`. recalls.json exists until the logger writes a summary. Empty if the content is
/// impossible.
std::map<AgentId, Tick> recorded_recalls(const std::filesystem::path& run_dir,
                                         const nlohmann::ordered_json& summary);

/// The text of the file. Bytes that are not UTF-8 are replaced, because the network may bring some.
std::string to_text(const nlohmann::ordered_json& summary);

/// The summary of a run directory: any JSON value if the file is JSON, null if there is no file.
/// Otherwise an error that names the file.
Result<nlohmann::ordered_json> read_summary(const std::filesystem::path& run_dir);

}  // namespace ergocast
