// SPDX-License-Identifier: BSD-3-Clause
// Command-line options, exit codes and version of all programs.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "lcmtypes/message_authenticator.h"
#include "runtime/bus/lcm_url.h"

namespace ergocast {

/// Exit codes of every program of Ergocast.
enum ExitCode {
  kExitDone = 0,
  kExitDiffers = 1,      ///< `verify`, `status`, `doctor`: a difference or trouble was found
  kExitBadInput = 2,     ///< arguments, scenario or run directory
  kExitUnavailable = 3,  ///< LCM cannot be used on this machine
  kExitFailed = 4,       ///< the mission failed
};

struct BusOptions {
  LcmUrl url;
  RunId run = 0;                       ///< 0: not given
  MessageAuthenticator authenticator;  ///< without a key unless one was given
  std::string key_file;
};

/// --lcm-url (default: $LCM_DEFAULT_URL, or LCM's own group).
void add_url_option(CLI::App& app, LcmUrl& url);

/// --key-file (default: $ERGOCAST_KEY_FILE, or no key; an empty variable is refused). `file` gets
/// its name. Uses the command's parse-complete callback.
void add_key_option(CLI::App& app, MessageAuthenticator& authenticator,
                    std::string* file = nullptr);

/// Why a team without a key cannot fly this mission; nothing if it can, or if there is a key.
std::optional<std::string> why_key_is_needed(const Mission& mission,
                                             const MessageAuthenticator& authenticator);
/// The error text for a command that needs the coordinator's key file.
std::string cannot_sign(const std::string& key_file);

/// --run-id.
void add_run_id_option(CLI::App& app, RunId& run);

/// --lcm-url, --key-file and --run-id.
void add_bus_options(CLI::App& app, BusOptions& options);

/// The options of the programs that take part in a mission.
struct NodeOptions : BusOptions {
  std::string log_level = "info";
  std::string modes_problem;  ///< why --modes gave no table; empty: no problem
};

/// Adds the bus options, --log-level (default: $ERGOCAST_LOG_LEVEL, or info), --version and
/// --modes, which keeps the table in this process. A file that is no table is no error: the table
/// is computed.
void add_node_options(CLI::App& app, NodeOptions& options);

/// --plan: the compiled plan of a mission, as in plan.binpb of its record. `plan` gets the checked
/// bytes.
CLI::Option* add_plan_option(CLI::App& app, std::vector<std::byte>& plan);

/// --event-log-limit, for programs that write an event log. @param mib  its default
void add_event_log_options(CLI::App& app, std::int64_t& mib, bool& compressed);

/// Parses the command line and suggests names for unknown words. Returns the exit code if the
/// program must end here (0 after --help), −1 if it continues.
int parse_command_line(CLI::App& app, int argc, char** argv);

/// The text of --version: our version, LCM's and the compiler's.
std::string version_text();
/// "GNU 12.2.0, Release".
std::string build_text();
/// Whether this processor has fused multiply-add, which changes the results of glibc's sin and cos.
bool cpu_has_fma();
/// "0.3.0": must be equal in a team.
std::string version();

std::string host_name();
/// "anna": the account of this process; its number if it has no name.
std::string user_name();
/// The current wall-clock time as "2026-01-31T12:00:00Z".
std::string wall_clock_text();

}  // namespace ergocast
