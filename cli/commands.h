// SPDX-License-Identifier: BSD-3-Clause
// What `ergocast` can do, one function a command. Each returns the program's exit code.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/seal.h"
#include "runtime/event_log.h"
#include "runtime/lcm_url.h"
#include "scenario/scenario.h"

namespace ergocast::cli {

/// What the command line asks for; returns the program's exit code. A command that says what its
/// options are (`add_…`) puts it here when it is the one that was typed.
using Action = std::function<int()>;

/// What `run` and `simulate` are told.
struct MissionOptions {
  std::filesystem::path scenario;
  std::filesystem::path out;     ///< empty: runs/<scenario>-<time>
  Overrides overrides;
  std::optional<LcmUrl> url;     ///< nothing: this host only, on ports of the run's own
  Seal seal;
  std::string key_file;          ///< whence its key is; empty: none
  std::int64_t event_log_mib = kEventLogMib;  ///< `run` only
};

/// The mission as processes over LCM on this host.
int run(const MissionOptions& options);

/// The mission in this process, in virtual time.
int simulate(const MissionOptions& options);

struct Seeds {
  std::uint64_t first = 1, last = 1;
  std::uint64_t count() const { return last - first + 1; }
};

/// What `simulate --seeds` is told besides.
struct TrialsOptions {
  MissionOptions mission;  ///< `out` is a CSV file here; empty: none
  std::string faults;      ///< a file, "swarm", or empty: none
  Seeds seeds;
  int jobs = 1;
};

/// One mission under faults for each seed.
int trials(const TrialsOptions& options);

/// A field and the values it takes one after the other.
struct Variation {
  std::string path;
  std::vector<std::string> values;
};

/// What `study` is told.
struct StudyOptions {
  std::vector<std::filesystem::path> scenarios;
  std::vector<Variation> variations;
  std::optional<double> duration_s;
  Seeds seeds;
  int jobs = 1;
  std::filesystem::path out;
};

/// Scenarios × variations × seeds, each flown once.
int study(const StudyOptions& options);

/// What a team that is flying looks like, from any host on its buses.
void add_status(CLI::App& app, Action& action);

/// Ends somebody's mission, in order or at once.
void add_stop(CLI::App& app, Action& action);

/// Every problem of a scenario; with `print`, the scenario as it would be run.
int check(const std::filesystem::path& scenario, bool print);

/// (Re)makes the report of a run directory.
int report(const std::filesystem::path& run_dir);

/// Simulates a recorded run again and compares the trajectories.
int verify(const std::filesystem::path& run_dir);

/// `deploy`: the texts that start a mission on several hosts.
void add_deploy(CLI::App& app, Action& action);
/// `spy`: LCM's viewer on one bus of a mission.
void add_spy(CLI::App& app, Action& action);
/// `keygen`: a mission key.
void add_keygen(CLI::App& app, Action& action);
/// What keeps hosts from hearing each other, and the commands that mend it.
void add_doctor(CLI::App& app, Action& action);

}  // namespace ergocast::cli
