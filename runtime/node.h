// SPDX-License-Identifier: BSD-3-Clause
// What the command lines of all processes have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "core/ids.h"
#include "lcmtypes/seal.h"
#include "runtime/lcm_url.h"

namespace ergocast {

/// Exit codes of every program of Ergocast.
enum ExitCode {
  kExitDone = 0,
  kExitDiffers = 1,      ///< `verify`, `status`, `doctor`: not all is as it should be
  kExitBadInput = 2,     ///< arguments, scenario or run directory
  kExitUnavailable = 3,  ///< LCM cannot be used on this machine
  kExitFailed = 4,       ///< the mission failed
};

struct BusOptions {
  LcmUrl url;
  RunId run = 0;  ///< 0: not given
  Seal seal;      ///< without a key unless one was given
  std::string key_file;
};

/// --lcm-url (default: $LCM_DEFAULT_URL, or LCM's own group).
void add_url_option(CLI::App& app, LcmUrl& url);

/// --key-file (default: $ERGOCAST_KEY_FILE, or no key; that variable, empty, is refused). `file` gets
/// its name. Takes the command's parse-complete callback.
void add_key_option(CLI::App& app, Seal& seal, std::string* file = nullptr);

/// What to say of a key that only the coordinator's file would do for.
std::string cannot_sign(const std::string& key_file);

/// --lcm-url, --key-file and --run-id.
void add_bus_options(CLI::App& app, BusOptions& options);

/// Of the programs that take part in a mission.
struct NodeOptions : BusOptions {
  std::string log_level = "info";
};

/// Besides, --log-level (default: $ERGOCAST_LOG_LEVEL, or info) and --version.
void add_node_options(CLI::App& app, NodeOptions& options);

/// --event-log-limit: of those who write one. @param mib  its default
void add_event_log_option(CLI::App& app, std::int64_t& mib);

/// Parses, and says what an unknown word may have meant; the exit code if the program has to end here (0 after --help), −1 if it goes on.
int parse_command_line(CLI::App& app, int argc, char** argv);

/// --version's text: ours, LCM's and the compiler's.
std::string version_text();
/// "GNU 12.2.0, Release".
std::string build_text();
/// Whether this processor multiplies and adds in one rounding: glibc's sin and cos depend on it.
bool cpu_has_fma();
/// "0.2.0": what has to be equal in a team.
std::string version();

/// 64 random bits of the operating system's, not 0.
std::uint64_t random_identity();
std::string host_name();
/// Now, by the wall clock, as "2026-01-31T12:00:00Z".
std::string wall_clock_text();

}  // namespace ergocast
