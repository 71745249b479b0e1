// SPDX-License-Identifier: BSD-3-Clause
// `ergocast spy`: LCM's own viewer, lcm-spy, with Ergocast's message types and a view
// of the team.
//
// Debian 12's script `lcm-spy` fails with Java 17, so the viewer's class is started directly.
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/report_error.h"
#include "cli/watch/find_run.h"
#include "runtime/bus/lcm_url.h"
#include "runtime/process/program_options.h"
#include "runtime/process/shipped_folder.h"
#include "text/shell_word.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;

struct SpyOptions : BusOptions {
  Bus bus = Bus::kSwarm;
  bool print = false;
};

/// The first of `places` that exists; nothing if none does.
std::optional<fs::path> first_of(const std::vector<fs::path>& places) {
  std::error_code none;
  for (const fs::path& place : places) {
    if (fs::exists(place, none)) return fs::canonical(place, none);
  }
  return std::nullopt;
}

std::optional<fs::path> java_on_path() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
  std::vector<fs::path> places;
  for (std::string folder; std::getline(folders, folder, ':');)
    places.push_back(fs::path(folder) / "java");
  return first_of(places);
}

/// Whether this Java lacks the libraries for windows, as Debian's "headless" packages do.
bool is_headless(const fs::path& java) {
  const fs::path libraries = java.parent_path().parent_path() / "lib";
  return fs::exists(libraries / "libawt_headless.so") && !fs::exists(libraries / "libawt_xawt.so");
}

/// The command to start, and missing packages.
struct Viewer {
  std::vector<std::string> command;
  std::string packages;  ///< Debian packages to be installed, each after a space
  bool jar_missing = false;
};

Viewer viewer_for(const SpyOptions& options) {
  Viewer viewer;
  const auto need = [&viewer](const std::optional<fs::path>& found, const char* package) {
    if (!found) viewer.packages += std::string(" ") + package;
    return found.value_or("").string();
  };
  auto java = java_on_path();
  if (java && is_headless(*java)) java.reset();
  const fs::path ours = spy_jar();
  viewer.jar_missing = ours.empty();
  const std::string program = need(java, "default-jre");
  const std::string jars = need(first_of({"/usr/share/java/lcm.jar"}), "liblcm-java") + ":" +
                           need(first_of({"/usr/share/java/jchart2d.jar"}), "libjchart2d-java") +
                           ":" + ours.string();
  viewer.command = {program,
                    "-Djava.net.preferIPv4Stack=true",
                    "-Xmx256m",
                    "-Dergocast.url=" + options.url.base(),
                    "-cp",
                    jars,
                    "lcm.spy.Spy",
                    "-l",
                    options.url.of(options.bus)};
  return viewer;
}

int print_command(const Viewer& viewer) {
  std::string line;
  for (const std::string& word : viewer.command)
    line += (line.empty() ? "" : " ") + shell_word(word);
  std::printf("%s\n", line.c_str());
  return kExitDone;
}

int spy(const SpyOptions& options) {
  Viewer viewer = viewer_for(options);
  if (!viewer.packages.empty()) {
    return report_error(kExitUnavailable,
                        "lcm-spy needs Debian packages that are not installed. As root:\n"
                        "  apt-get install" +
                            viewer.packages);
  }
  if (viewer.jar_missing) {
    return report_error(
        kExitUnavailable,
        "ergocast-spy.jar was not built, because a JDK or lcm.jar was missing. As root:\n"
        "  apt-get install default-jdk liblcm-java\n"
        "Then configure and build again: cmake BUILD && cmake --build BUILD --target spy");
  }
  if (options.print) return print_command(viewer);
  const char* display = std::getenv("DISPLAY");
  if (display == nullptr || *display == '\0') {
    return report_error(
        kExitUnavailable,
        "lcm-spy draws windows, and there is no screen: DISPLAY is not set. Start it from a "
        "desktop, or log in with ssh -X");
  }
  if (const auto problem = why_unreachable(options.url))
    return report_error(kExitUnavailable, *problem);
  std::vector<char*> arguments;
  for (std::string& word : viewer.command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(arguments.front(), arguments.data());
  return report_error(kExitUnavailable, viewer.command.front() + ": " + std::strerror(errno));
}

}  // namespace

void add_spy(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("spy", "Watch a mission's messages in LCM's viewer");
  const auto options = std::make_shared<SpyOptions>();
  add_url_option(*command, options->url);
  add_run_id_option(*command, options->run);
  describe_search(*command);
  const std::map<std::string, Bus> buses{
      {"swarm", Bus::kSwarm}, {"world", Bus::kWorld}, {"command", Bus::kCommand}};
  command->add_option("--bus", options->bus, "The bus whose channels are listed")
      ->transform(CLI::CheckedTransformer(buses).description(""))
      ->default_str("swarm")
      ->type_name("swarm|world|command");
  command->add_flag("--print", options->print, "Print the command that starts the viewer, and end");
  command->callback([options, command, &action] {
    action = [options, command] {
      if (const auto code = find_run(*command, *options)) return *code;
      return spy(*options);
    };
  });
}

}  // namespace ergocast::cli
