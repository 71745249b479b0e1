// SPDX-License-Identifier: BSD-3-Clause
// The commands of `ergocast`, one function for each command. Each function returns the program's
// exit code.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/page_server.h"
#include "cli/study_directory.h"
#include "lcmtypes/message_authenticator.h"
#include "runtime/event_log.h"
#include "runtime/lcm_url.h"
#include "runtime/signals.h"
#include "scenario/scenario.h"

namespace ergocast::cli {

/// Runs the command that the command line selects; returns the program's exit code. A command that
/// declares its own options (`add_…`) stores its action here when it is selected.
using Action = std::function<int()>;

/// The options of `run` and `simulate`.
struct MissionOptions {
  std::filesystem::path scenario;
  std::filesystem::path out;  ///< empty: runs/<scenario>-<time>
  Overrides overrides;
  std::optional<LcmUrl> url;  ///< nothing: this host only, on ports that the run reserves
  MessageAuthenticator authenticator;
  std::string key_file;  ///< the file of the key in `authenticator`; empty: none
  std::int64_t event_log_mib = kEventLogMib;  ///< `run` only
  bool event_log = false;                     ///< `simulate` only; `run` always writes one
  bool event_log_zstd = false;                ///< `run` only
  std::filesystem::path world;                ///< `run` only; empty: ergocast-sim
  std::vector<std::string> world_arguments;   ///< of that program
  bool watch = false;                         ///< `run` only: serves a page
  PageOptions page;
};

/// Runs the mission as processes over LCM on this host.
int run(const MissionOptions& options);

/// Runs the mission in this process, in virtual time.
int simulate(const MissionOptions& options);

struct Seeds {
  std::uint64_t first = 1, last = 1;
  std::uint64_t count() const { return last - first + 1; }
};

/// The options of `simulate --seeds`.
struct TrialsOptions {
  MissionOptions mission;  ///< `out` is a CSV file here; empty: none
  std::string faults;      ///< a file, "swarm", or empty: none
  Seeds seeds;
  int jobs = 1;
};

/// Runs one mission under faults for each seed.
int trials(const TrialsOptions& options);

/// A field and the values that the study gives it.
struct Variation {
  std::string path;
  std::vector<std::string> values;
};

/// The options of `study`.
struct StudyOptions {
  std::vector<std::filesystem::path> scenarios;
  std::vector<FieldValue> settings;  ///< of every mission
  std::vector<Variation> variations;
  std::optional<double> duration_s;
  Seeds seeds;
  std::optional<StudyShard> shard;  ///< index and number only
  int jobs = 1;
  std::filesystem::path out;
};

/// Simulates each combination of scenario, variation and seed once.
int study(const StudyOptions& options);

/// The options of `study merge`.
struct MergeOptions {
  std::vector<std::filesystem::path> shards;  ///< their folders
  std::filesystem::path out;
};

/// Makes the folder of the whole study from its shards.
int merge_studies(const MergeOptions& options);

/// `list`: the live runs of this user on this host.
void add_list(CLI::App& app, Action& action);

/// `status`: shows the state of a running team, from any host on its buses.
void add_status(CLI::App& app, Action& action);

/// `watch`: shows a record or a running team in a browser.
void add_watch(CLI::App& app, Action& action);
/// --port and --listen.
void add_page_options(CLI::App& app, PageOptions& options);
/// Serves until Ctrl-C or SIGTERM comes, at a low priority.
/// @param wait  waits until the server, or what it shows, has something to do, at most 0.1 s
void serve_until_stop(PageServer& server, StopSignals& signals, const std::function<void()>& wait);
/// `run-page`: serves the page of `run --watch`; only that command starts it.
void add_run_page(CLI::App& app, Action& action);

/// `export`: writes a record in the formats of other tools.
void add_export(CLI::App& app, Action& action);

/// `replay`: sends a recorded run again, for displays.
void add_replay(CLI::App& app, Action& action);

/// `stop`: ends a mission that another command started, in order or at once.
void add_stop(CLI::App& app, Action& action);

/// `pause` and `resume`: stop and continue a running mission.
void add_pause(CLI::App& app, Action& action);

/// Reports every problem of a scenario. With `print`, prints the scenario with all defaults.
int check(const std::filesystem::path& scenario, const Overrides& overrides, bool print);

/// Makes the report of a run directory; replaces an existing report.
int report(const std::filesystem::path& run_dir);

/// Simulates a recorded run again and compares every file of the record.
int verify(const std::filesystem::path& run_dir);

/// `deploy`: writes the files that start a mission on several hosts.
void add_deploy(CLI::App& app, Action& action);
/// `spy`: starts LCM's viewer on one bus of a mission.
void add_spy(CLI::App& app, Action& action);
/// `keygen`: makes a mission key.
void add_keygen(CLI::App& app, Action& action);
/// `doctor`: finds what prevents communication between hosts, and prints commands that repair it.
void add_doctor(CLI::App& app, Action& action);

}  // namespace ergocast::cli
