// SPDX-License-Identifier: BSD-3-Clause
// `ergocast watch`: serves a page of a record or of a running team.
#include <poll.h>
#include <sys/resource.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/commands.h"
#include "cli/record/run_directory.h"
#include "cli/report_error.h"
#include "cli/watch/find_run.h"
#include "cli/watch/live_watch.h"
#include "cli/watch/serve_page.h"
#include "report/web_page.h"
#include "runtime/bus/clock.h"
#include "runtime/process/program_options.h"
#include "runtime/process/signals.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The period with which deadlines of the page's clients are checked.
constexpr int kServeMs = 50;
/// The priority is low, so that the team's processes run first.
constexpr int kPagePriority = 10;

struct WatchOptions : BusOptions {
  fs::path run_dir;
  PageOptions page;
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
  const Connections::Text page = recorded_page(std::get<Json>(data));
  auto socket = PageSocket::open(options.page);
  if (const auto* problem = std::get_if<std::string>(&socket)) {
    return report_error(kExitUnavailable, *problem);
  }
  announce(std::get<PageSocket>(socket).url());
  const auto server =
      PageServer::make(std::get<PageSocket>(std::move(socket)),
                       {[&page] { return page; }, content_security_policy(run_web_page()), {}, {}});
  pollfd waiting[]{{server->fd(), POLLIN, 0}, {signals.fd(), POLLIN, 0}};
  serve_until_stop(*server, signals, [&waiting] { poll(waiting, std::size(waiting), kServeMs); });
  return kExitDone;
}

/// @param run_dir  the team's run directory; empty: not known here
int watch_team(const WatchOptions& options, const fs::path& run_dir, StopSignals& signals) {
  auto opened = LiveWatch::open({options, run_dir, {}, {}});
  if (const auto* problem = std::get_if<std::string>(&opened)) {
    return report_error(kExitUnavailable, *problem);
  }
  LiveWatch& watch = *std::get<0>(opened);
  auto socket = PageSocket::open(options.page);
  if (const auto* problem = std::get_if<std::string>(&socket)) {
    return report_error(kExitUnavailable, *problem);
  }
  announce(std::get<PageSocket>(socket).url());
  const auto server = PageServer::make(std::get<PageSocket>(std::move(socket)), watch.content());
  serve_until_stop(*server, signals, [&] {
    watch.listen(server->fd());
    if (watch.over()) watch.finish();
  });
  return kExitDone;
}

}  // namespace

void serve_until_stop(PageServer& server, StopSignals& signals, const std::function<void()>& wait) {
  setpriority(PRIO_PROCESS, 0, kPagePriority);
  while (signals.take() == 0) {
    wait();
    server.serve(now());
  }
}

void add_page_options(CLI::App& app, PageOptions& options) {
  app.add_option("--port", options.port,
                 "Port of the page (default: 8765, or any if that is taken)")
      ->check(CLI::Range(1, 65535));
  app.add_option("--listen", options.listen,
                 "Address on which other hosts reach the page; it then needs the token that is "
                 "printed (default: this host only)")
      ->type_name("ADDRESS");
}

void add_watch(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("watch", "Show a record or a running team in a browser; sends nothing");
  auto options = std::make_shared<WatchOptions>();
  command->add_option("RUN_DIR", options->run_dir, "Run directory (default: a running team)")
      ->type_name("DIR");
  add_bus_options(*command, *options);
  describe_search(*command);
  add_page_options(*command, options->page);
  command->footer(
      "Serves the page until Ctrl-C. Exit codes: 0 done; 2 no record, or it is damaged; 3 LCM or "
      "the\n"
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
