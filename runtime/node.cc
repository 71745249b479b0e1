#include "runtime/node.h"

#include <lcm/lcm.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/random.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <ctime>

namespace ergocast {
namespace {

std::string default_url() {
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  return from_environment != nullptr && *from_environment != '\0' ? from_environment
                                                                  : LcmUrl{}.base();
}

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

}  // namespace

void add_url_option(CLI::App& app, LcmUrl& url) {
  app.add_option_function<std::string>(
         "--lcm-url", [&url](const std::string& text) { read_url(text, url); },
         "Base URL: swarm, world and command buses are this port and the next two")
      ->default_str(default_url())
      ->type_name("URL");
  app.parse_complete_callback([&app, &url] {
    if (app.count("--lcm-url") == 0) read_url(default_url(), url);
  });
}

void add_node_options(CLI::App& app, NodeOptions& options) {
  add_url_option(app, options.url);
  app.add_option_function<std::string>(
         "--run-id", [&options](const std::string& text) { read_run_id(text, options.run); },
         "Take part in this run only")
      ->type_name("HEX");
  app.set_version_flag("--version", version_text());
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

void set_up_logging(const std::string& process_name) {
  auto logger = spdlog::stderr_color_mt(process_name);
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%e %^%l%$ %n: %v");
  logger->flush_on(spdlog::level::trace);
  spdlog::set_default_logger(logger);
}

}  // namespace ergocast
