// SPDX-License-Identifier: BSD-3-Clause
// `ergocast watch`: serves a page of a record or of a running team. With --control, operators give
// orders on the page. With --cot, it also sends the team to clients of TAK, with --foxglove to
// Foxglove.
#include <poll.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/operate/controlled_page.h"
#include "cli/operate/live_displays.h"
#include "cli/operate/team_command.h"
#include "cli/record/run_directory.h"
#include "cli/report_error.h"
#include "cli/watch/client_list.h"
#include "cli/watch/find_run.h"
#include "cli/watch/live_watch.h"
#include "cli/watch/serve_page.h"
#include "report/target_density.h"
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

using namespace std::chrono_literals;

/// The longest time between two looks at the page's requests.
constexpr auto kControlPeriod = 50ms;
/// After the mission's end the coordinator still reports the reason, and the logger closes the
/// record.
constexpr auto kLinger = 1s;
/// An order is judged in this time (cli/operate/stop_order.cc).
constexpr auto kLongestStop = 20s;

struct WatchOptions : BusOptions {
  fs::path run_dir;
  PageOptions page;
  bool control = false;
  DisplayOptions displays;
};

void announce(const std::string& url) {
  std::printf("open %s in a browser; Ctrl-C ends it\n", url.c_str());
  std::fflush(stdout);
}

/// Prints the address for Foxglove, if it is served.
void announce_foxglove(const LiveDisplays& displays) {
  const std::string url = displays.foxglove_url();
  if (!url.empty()) std::printf("connect Foxglove to %s\n", url.c_str());
}

int watch_record(const WatchOptions& options, StopSignals& signals) {
  const auto mission = recorded_mission_or_complain(options.run_dir);
  if (!mission) return kExitBadInput;
  auto data = recorded_page_data(options.run_dir, *mission);
  if (!data) return report_error(kExitBadInput, data.error());
  const Connections::Text page = recorded_page(*data);
  auto socket = PageSocket::open(options.page);
  if (!socket) return report_error(kExitUnavailable, socket.error());
  announce(socket->url());
  const auto server =
      PageServer::make(*std::move(socket),
                       {[&page] { return page; }, content_security_policy(run_web_page()), {}, {}});
  pollfd waiting[]{{server->fd(), POLLIN, 0}, {signals.fd(), POLLIN, 0}};
  serve_until_stop(*server, signals, [&waiting] { poll(waiting, std::size(waiting), kServeMs); });
  return kExitDone;
}

/// @param run_dir  the team's run directory; empty: not known here
int watch_team(const WatchOptions& options, const fs::path& run_dir, StopSignals& signals) {
  const auto opened_displays = LiveDisplays::open(options.displays, options.page, run_dir);
  if (!opened_displays) return opened_displays.error();
  LiveDisplays& displays = **opened_displays;
  announce_foxglove(displays);
  std::unique_ptr<LiveWatch> live;
  const bool has_log = !run_dir.empty();
  ClientList clients(has_log ? run_dir / "log/watch.log" : "", "watch",
                     [&live, has_log](const std::string& sentence) {
                       if (!sentence.starts_with("browser ")) print_message(sentence);
                       if (live && !has_log) live->log(sentence);
                     });
  displays.begin([&clients](const std::string& sentence) { clients.note(sentence); });
  auto opened = LiveWatch::open({options, run_dir, {}, {}, displays.displays()});
  if (!opened) return report_error(kExitUnavailable, opened.error());
  live = *std::move(opened);
  LiveWatch& watch = *live;
  auto socket = PageSocket::open(options.page);
  if (!socket) return report_error(kExitUnavailable, socket.error());
  announce(socket->url());
  const auto server = PageServer::make(*std::move(socket), watch.content());
  serve_until_stop(*server, signals, [&] {
    watch.listen(server->fd());
    displays.serve(now());
    clients.update(watch.run(), together(server->clients(), displays.clients()), now());
    if (watch.over()) watch.finish();
  });
  if (const std::string losses = displays.losses(); !losses.empty()) print_message(losses);
  return kExitDone;
}

/// Finds the only run on a URL.
class RunFinder : public TeamCommand {
 public:
  using TeamCommand::TeamCommand;
  RunId run() const { return runs_.begin()->first; }

 private:
  int act() override { return choose_run().value_or(kExitDone); }
};

/// The page has a process of its own, and this one gives the orders.
int control_team(WatchOptions options, const fs::path& run_dir, StopSignals& signals) {
  RunFinder finder(options);
  if (const int code = finder.carry_out(); code != kExitDone) return code;
  options.run = finder.run();
  ProgressDisplay display;
  display.stamp();
  auto displays = LiveDisplays::open(options.displays, options.page, run_dir);
  if (!displays) return displays.error();
  auto started =
      ControlledPage::start(options, run_dir, options.page, true, (*displays)->handed(), display);
  if (!started) return report_error(kExitUnavailable, started.error());
  ControlledPage& watched = **started;
  announce_foxglove(**displays);
  announce(watched.page().url());
  display.also_to([&watched](const std::string& line) { watched.page().print(line); });
  std::optional<Instant> over_since;
  bool ended = false;
  while (signals.take() == 0) {
    watched.control()->listen(now() + kControlPeriod, signals.fd());
    if (ended) {
      watched.page().attend(now());
      continue;
    }
    watched.attend(now());
    if (watched.control()->over() && !over_since) over_since = now();
    const bool is_settled = watched.control()->is_settled();
    if (!over_since || now() - *over_since < (is_settled ? kLinger : kLongestStop)) continue;
    watched.end_control(now());
    watched.page().finish();
    ended = true;
  }
  return kExitDone;
}

}  // namespace

void add_watch(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("watch", "Show a record or a running team in a browser");
  auto options = std::make_shared<WatchOptions>();
  command->add_option("RUN_DIR", options->run_dir, "Run directory (default: a running team)")
      ->type_name("DIR");
  add_bus_options(*command, *options);
  describe_search(*command);
  add_page_options(*command, options->page);
  add_control_option(*command, options->control);
  command->get_option("--control")->excludes("RUN_DIR");
  add_display_options(*command, options->displays);
  for (const char* option : {"--cot", "--foxglove", "--origin"})
    command->get_option(option)->excludes("RUN_DIR");
  command->footer(
      "Serves the page until Ctrl-C. Sends the team nothing, unless --control is given. Exit "
      "codes:\n"
      "0 done; 2 no record, or it is damaged, or several runs are found, or a bad certificate, or "
      "--cot\nwithout an origin; 3 LCM or an address cannot be used; 4 --control finds no team.");
  command->callback([&action, options, command] {
    action = [options, command]() -> int {
      StopSignals signals;
      if (const auto problem = read_certificate(options->page, options->control))
        return report_error(kExitBadInput, *problem);
      if (const auto problem = why_refused(options->displays, options->page))
        return report_error(kExitBadInput, *problem);
      if (command->count("RUN_DIR") > 0) return watch_record(*options, signals);
      fs::path run_dir;
      if (const auto code = find_run(*command, *options, &run_dir)) return *code;
      if (options->control) return control_team(*options, run_dir, signals);
      return watch_team(*options, run_dir, signals);
    };
  });
}

}  // namespace ergocast::cli
