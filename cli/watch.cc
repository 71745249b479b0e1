// SPDX-License-Identifier: BSD-3-Clause
// `ergocast watch`: a page for browsers, of a record or of a team that flies.
#include <poll.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/commands.h"
#include "cli/find_run.h"
#include "cli/live_watch.h"
#include "cli/report_error.h"
#include "cli/run_directory.h"
#include "report/web_page.h"
#include "runtime/node.h"
#include "runtime/signals.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct WatchOptions : BusOptions {
  fs::path run_dir;
  PageServer::Options server;
};

void announce(const std::string& url) {
  std::printf("open %s in a browser; Ctrl-C ends it\n", url.c_str());
  std::fflush(stdout);
}

int watch_record(const WatchOptions& options, StopSignals& signals) {
  const auto mission = recorded_mission_or_complain(options.run_dir);
  if (!mission) return kExitBadInput;
  auto data = recorded_page_data(options.run_dir, *mission);
  if (const auto* problem = std::get_if<std::string>(&data)) {
    return report_error(kExitBadInput, *problem);
  }
  const Json& found = std::get<Json>(data);
  const std::string page =
      html_file(run_web_page(), found["record"]["mission"]["name"].get<std::string>(), found);
  const auto started = PageServer::start(
      options.server, {[&page] { return page; }, content_security_policy(run_web_page()), {}, {}});
  if (const auto* problem = std::get_if<std::string>(&started)) {
    return report_error(kExitUnavailable, *problem);
  }
  announce(std::get<0>(started)->url());
  wait_for_stop(signals);
  return kExitDone;
}

/// @param run_dir  of the team's run; empty: not known here
int watch_team(const WatchOptions& options, const fs::path& run_dir, StopSignals& signals) {
  auto started = LiveWatch::start({options, run_dir, {}, {}}, options.server);
  if (const auto* problem = std::get_if<std::string>(&started)) {
    return report_error(kExitUnavailable, *problem);
  }
  LiveWatch& watch = *std::get<0>(started);
  announce(watch.url());
  for (bool finished = false; !wait_for_stop(signals, 100);) {
    if (!finished && watch.over()) {
      watch.finish();
      finished = true;
    }
  }
  return kExitDone;
}

}  // namespace

bool wait_for_stop(StopSignals& signals, int timeout_ms) {
  pollfd waiting{signals.fd(), POLLIN, 0};
  poll(&waiting, 1, timeout_ms);
  return signals.take() > 0;
}

void add_page_options(CLI::App& app, PageServer::Options& options) {
  app.add_option("--port", options.port,
                 "Port of the page (default: 8765, or any if that is taken)")
      ->check(CLI::Range(1, 65535));
  app.add_option("--listen", options.listen,
                 "Address on which other hosts reach the page; it then needs the token that is "
                 "printed (default: this host only)")
      ->type_name("ADDRESS");
}

void add_watch(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "watch", "Show a record, or a team that flies, in a browser; only listens");
  auto options = std::make_shared<WatchOptions>();
  command->add_option("RUN_DIR", options->run_dir, "Run directory (default: a team that flies)")
      ->type_name("DIR");
  add_bus_options(*command, *options);
  describe_search(*command);
  add_page_options(*command, options->server);
  command->footer(
      "Serves until Ctrl-C. Exit codes: 0 done; 2 no record, or it is damaged; 3 LCM or the\n"
      "address cannot be used.");
  command->callback([&action, options, command] {
    action = [options, command] {
      StopSignals signals;
      if (command->count("RUN_DIR") > 0) return watch_record(*options, signals);
      fs::path run_dir;
      if (const auto code = find_run(*command, *options, &run_dir)) return *code;
      return watch_team(*options, run_dir, signals);
    };
  });
}

}  // namespace ergocast::cli
