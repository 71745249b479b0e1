#include "runtime/node.h"

#include <lcm/lcm.h>
#include <sys/random.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>

#include "runtime/logging.h"

namespace ergocast {
namespace {

/// A variable's value, or `otherwise` if it is not set or empty.
std::string from_environment(const char* name, const std::string& otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? value : otherwise;
}
std::string default_url() { return from_environment("LCM_DEFAULT_URL", LcmUrl{}.base()); }

void read_url(const std::string& text, LcmUrl& url) {
  auto parsed = LcmUrl::parse(text);
  if (const auto* problem = std::get_if<std::string>(&parsed)) throw CLI::ValidationError(*problem);
  url = std::get<LcmUrl>(parsed);
}

void read_run_id(const std::string& text, RunId& run) {
  char* end = nullptr;
  run = std::strtoull(text.c_str(), &end, 16);
  if (text.empty() || *end != '\0' || text.size() > 16 || run == 0) {
    throw CLI::ValidationError("--run-id: '" + text + "' is not 1 to 16 hex digits, not all zero");
  }
}

/// What was not given.
void complete(const CLI::App& app, BusOptions& options) {
  if (app.count("--lcm-url") == 0) read_url(default_url(), options.url);
}

void read_log_level_from_environment(std::string& level) {
  const std::string wanted = from_environment("ERGOCAST_LOG_LEVEL", level);
  if (std::find(kLogLevels.begin(), kLogLevels.end(), wanted) == kLogLevels.end()) {
    throw CLI::ValidationError("ERGOCAST_LOG_LEVEL", "'" + wanted +
                                   "' is none of trace, debug, info, warn, error");
  }
  level = wanted;
}

}  // namespace

void add_bus_options(CLI::App& app, BusOptions& options) {
  app.add_option_function<std::string>(
         "--lcm-url", [&options](const std::string& text) { read_url(text, options.url); },
         "Base URL: swarm, world and command buses are this port and the next two")
      ->default_str(default_url())
      ->type_name("URL");
  app.add_option_function<std::string>(
         "--run-id", [&options](const std::string& text) { read_run_id(text, options.run); },
         "This run only")
      ->type_name("HEX");
  app.parse_complete_callback([&app, &options] { complete(app, options); });
}

void add_node_options(CLI::App& app, NodeOptions& options) {
  add_bus_options(app, options);
  app.add_option("--log-level", options.log_level, "What is logged: this and what is worse")
      ->default_str(from_environment("ERGOCAST_LOG_LEVEL", options.log_level))
      ->check(CLI::IsMember(kLogLevels))
      ->type_name("LEVEL");
  app.set_version_flag("--version", version_text());
  app.parse_complete_callback([&app, &options] {
    complete(app, options);
    if (app.count("--log-level") == 0) read_log_level_from_environment(options.log_level);
  });
}

int parse_command_line(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return -1;
  } catch (const CLI::ParseError& stop) {
    return app.exit(stop) == 0 ? kExitDone : kExitBadInput;
  }
}

std::string version_text() {
  return "ergocast " + version() + " (LCM " + std::to_string(LCM_MAJOR_VERSION) + "." +
         std::to_string(LCM_MINOR_VERSION) + "." + std::to_string(LCM_MICRO_VERSION) +
         ", built with " ERGOCAST_COMPILER ")";
}

std::string build_text() { return ERGOCAST_COMPILER; }

bool cpu_has_fma() {
#ifdef __x86_64__
  return __builtin_cpu_supports("fma") != 0;
#else
  return true;
#endif
}

std::string version() { return ERGOCAST_VERSION; }

std::uint64_t random_identity() {
  std::uint64_t bits = 0;
  while (bits == 0) {
    if (getrandom(&bits, sizeof bits, 0) != static_cast<ssize_t>(sizeof bits)) bits = 0;
  }
  return bits;
}

std::string host_name() {
  std::array<char, 65> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
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
