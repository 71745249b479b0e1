// SPDX-License-Identifier: BSD-3-Clause
// Declares the options that all programs share, and suggests the nearest name for a mistyped
// argument.
#include "runtime/process/program_options.h"

#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <span>
#include <sstream>
#include <utility>

#include "modes/provide.h"
#include "modes/table_file.h"
#include "plan/plan.h"
#include "runtime/process/build_facts.h"
#include "runtime/process/key_file.h"
#include "runtime/process/logging.h"
#include "text/input_file.h"
#include "text/likeness.h"
#include "text/printable.h"

namespace ergocast {
namespace {

constexpr const char* kKeyVariable = "ERGOCAST_KEY_FILE";

void read_url(const std::string& text, LcmUrl& url) {
  auto parsed = LcmUrl::parse(text);
  if (!parsed) throw CLI::ValidationError(parsed.error());
  url = *parsed;
}

void read_run_id(const std::string& text, RunId& run) {
  char* end = nullptr;
  run = std::strtoull(text.c_str(), &end, 16);
  if (text.empty() || *end != '\0' || text.size() > 16 || run == 0) {
    throw CLI::ValidationError("--run-id: '" + text + "' is not 1 to 16 hex digits, not all zero");
  }
}

/// Refuses an empty variable: it would count as unset, and the team would run without a key.
void refuse_empty_key_variable(const CLI::Option& option) {
  const char* file = std::getenv(kKeyVariable);
  if (file == nullptr || *file != '\0' || option.count() > 0) return;
  throw CLI::ValidationError(kKeyVariable,
                             "is set, and empty; name the key file in it, or unset it to "
                             "run without a key");
}

/// "did you mean NAME?", or how to list all names.
std::string remedy_for(const std::string& word, const std::vector<std::string>& names) {
  const std::string meant = nearest(word, names);
  return meant.empty() ? "--help lists what there is" : "did you mean " + meant + "?";
}

/// The first word of a command line that is neither a command nor an option, with the likely
/// meaning; empty if all are known. CLI11's own message names no such alternative and may blame the
/// next word.
std::string unknown_word(const CLI::App& app, int argc, char** argv) {
  const CLI::App* command = &app;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i], option = word.substr(0, word.find('='));
    if (word == "--") break;
    std::vector<std::string> names;
    if (option.starts_with("--")) {
      for (const CLI::Option* one : command->get_options()) {
        for (const std::string& name : one->get_lnames()) names.push_back("--" + name);
      }
      if (std::find(names.begin(), names.end(), option) != names.end()) continue;
      return command->get_name() + ": there is no option " + option + "; " +
             remedy_for(option, names);
    }
    const auto commands = command->get_subcommands([](const CLI::App*) { return true; });
    if (commands.empty() || word.starts_with('-')) continue;
    for (const CLI::App* one : commands) names.push_back(one->get_name());
    const auto known = std::find(names.begin(), names.end(), word);
    if (known == names.end() && command->get_require_subcommand_min() == 0) continue;
    if (known == names.end()) {
      return command->get_name() + ": there is no command " + word + "; " + remedy_for(word, names);
    }
    command = commands[static_cast<std::size_t>(known - names.begin())];
  }
  return "";
}

/// The bytes of a plan that this program can run, or why the file has none.
Result<std::vector<std::byte>> read_plan(const std::string& file) {
  const auto text = read_whole(file, kMaxPlanBytes);
  if (!text) return failure(text.error().what);
  const auto bytes = std::as_bytes(std::span(*text));
  const auto decoded = decode_plan(bytes);
  if (!decoded) return failure(decoded.error());
  return std::vector<std::byte>(bytes.begin(), bytes.end());
}

}  // namespace

void add_url_option(CLI::App& app, LcmUrl& url) {
  app.add_option_function<std::string>(
         "--lcm-url", [&url](const std::string& text) { read_url(text, url); },
         "Base URL: swarm, world and command buses are this port and the next two")
      ->default_str(url.base())
      ->envname("LCM_DEFAULT_URL")
      ->type_name("URL");
}

void add_key_option(CLI::App& app, MessageAuthenticator& authenticator, std::string* file) {
  const CLI::Option* option =
      app.add_option_function<std::string>(
             "--key-file",
             [&authenticator, file](const std::string& name) {
               if (name.empty()) {
                 throw CLI::ValidationError("--key-file",
                                            "no name; leave it out to run without a key");
               }
               const auto key = read_key_file(name);
               if (!key) throw CLI::ValidationError("--key-file", key.error());
               authenticator = MessageAuthenticator(*key);
               if (file != nullptr) *file = name;
             },
             "Mission key of the team, as `ergocast keygen` writes it; without a key, any host on "
             "the network can send messages of the team")
          ->envname(kKeyVariable)
          ->type_name("FILE");
  app.parse_complete_callback([option] { refuse_empty_key_variable(*option); });
}

std::optional<std::string> why_key_is_needed(const Mission& mission,
                                             const MessageAuthenticator& authenticator) {
  if (mission.objects.end_when_found == 0 || authenticator.keyed()) return std::nullopt;
  return "world.objects.end_when_found: without a key any program on the network could end the "
         "mission with a forged find (make a key with `ergocast keygen`, or leave the field out)";
}

std::string cannot_sign(const std::string& key_file) {
  return key_file +
         ": cannot begin or end missions, nor pause them; take the file NAME.coordinator.key that "
         "`ergocast keygen` wrote together with it";
}

void add_run_id_option(CLI::App& app, RunId& run) {
  app.add_option_function<std::string>(
         "--run-id", [&run](const std::string& text) { read_run_id(text, run); }, "This run only")
      ->type_name("HEX");
}

void add_bus_options(CLI::App& app, BusOptions& options) {
  add_url_option(app, options.url);
  add_key_option(app, options.authenticator, &options.key_file);
  add_run_id_option(app, options.run);
}

void add_node_options(CLI::App& app, NodeOptions& options) {
  add_bus_options(app, options);
  app.add_option("--log-level", options.log_level, "Least severity of the lines in the log")
      ->capture_default_str()
      ->envname("ERGOCAST_LOG_LEVEL")
      ->check(CLI::IsMember(kLogLevels))
      ->type_name("LEVEL");
  app.add_option_function<std::string>(
         "--modes",
         [&options](const std::string& file) {
           auto table = load_table(file);
           if (table) {
             keep_table(*std::move(table));
           } else {
             options.modes_problem = table.error();
           }
         },
         "Table of the modes of a mission with basis.free_domain; without, or if it is damaged: "
         "computed in a second or more")
      ->envname("ERGOCAST_MODES")
      ->type_name("FILE");
  app.set_version_flag("--version", version_text());
  app.footer(
      "Exit codes: 0 done; 2 bad arguments; 3 LCM cannot be used on this machine; 4 the mission\n"
      "failed.");
}

CLI::Option* add_plan_option(CLI::App& app, std::vector<std::byte>& plan) {
  return app
      .add_option_function<std::string>(
          "--plan",
          [&plan](const std::string& file) {
            auto read = read_plan(file);
            if (!read) throw CLI::ValidationError("--plan", file + ": " + read.error());
            plan = *std::move(read);
          },
          "The compiled plan of the mission, as plan.binpb of a record; no option changes it")
      ->type_name("FILE");
}

void add_event_log_options(CLI::App& app, std::int64_t& mib, bool& compressed) {
  app.add_option("--event-log-limit", mib,
                 "Greatest size of all events-*.lcm together; the oldest are removed first")
      ->capture_default_str()
      ->check(CLI::Range(128, 1 << 30))  // at least two segments
      ->type_name("MIB");
  app.add_flag("--event-log-zstd", compressed,
               "Compress each finished segment of the event log; zstd -d makes it readable again");
}

int parse_command_line(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return -1;
  } catch (const CLI::ParseError& stop) {
    if (stop.get_exit_code() == 0) return app.exit(stop);
    std::string problem = unknown_word(app, argc, argv);
    if (problem.empty()) {
      std::ostringstream output;
      app.exit(stop, output, output);
      problem = output.str();
    } else {
      problem += "\nRun with --help for more information.\n";
    }
    std::fputs(printable(problem).c_str(), stderr);
    return kExitBadInput;
  }
}

std::string version_text() { return facts_text(); }

std::string build_text() { return ERGOCAST_COMPILER; }

bool cpu_has_fma() { return processor_has_fma(); }

std::string version() { return ERGOCAST_VERSION; }

std::string host_name() {
  std::array<char, 65> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

std::string user_name() {
  const uid_t account = geteuid();
  const passwd* const entry = getpwuid(account);
  return entry != nullptr ? entry->pw_name : std::to_string(account);
}

std::string wall_clock_text() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

}  // namespace ergocast
