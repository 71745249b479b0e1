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
#include "cli/foxglove/foxglove_output.h"
#include "cli/operate/controlled_page.h"
#include "cli/operate/team_command.h"
#include "cli/record/origin_option.h"
#include "cli/record/run_directory.h"
#include "cli/report_error.h"
#include "cli/tak/cot_output.h"
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
  CotOptions cot;
  int foxglove_port = 0;  ///< 0: Foxglove is not served
};

void announce(const std::string& url) {
  std::printf("open %s in a browser; Ctrl-C ends it\n", url.c_str());
  std::fflush(stdout);
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

/// The output to TAK; or prints an error, and returns the exit code.
Result<CotOutput, int> open_cot(const CotOptions& options, const fs::path& run_dir) {
  std::optional<GeoPlace> origin = options.origin;
  if (!origin) {
    auto recorded = recorded_origin(run_dir);
    if (!recorded) return failure(report_error(kExitBadInput, recorded.error()));
    origin = *recorded;
  }
  if (!origin)
    return failure(report_error(
        kExitBadInput,
        run_dir.empty() ? "--cot: the scenario of this team is not on this host; say where its (0, "
                          "0) is, with --origin LATITUDE,LONGITUDE"
                        : "--cot: the scenario has no origin; add origin { latitude_deg: … "
                          "longitude_deg: … } to it, or say --origin LATITUDE,LONGITUDE"));
  auto output = CotOutput::open(*options.to, *origin);
  if (!output) return failure(report_error(kExitUnavailable, output.error()));
  return *std::move(output);
}

/// The server for Foxglove; or prints an error, and returns the exit code.
/// @param clients  gets sentences about clients; outlives the server
Result<std::unique_ptr<FoxgloveOutput>, int> open_foxglove(const WatchOptions& options,
                                                           const fs::path& run_dir,
                                                           ClientList& clients) {
  if (options.foxglove_port == options.page.port)
    return failure(report_error(kExitBadInput, "--foxglove and --port name the same port, " +
                                                   std::to_string(options.foxglove_port) +
                                                   "; the page needs its own"));
  FoxgloveOutput::Setup setup{
      .port = options.foxglove_port,
      .page = options.page,
      .origin = options.cot.origin,
      .target = {},
      .note = [&clients](const std::string& sentence) { clients.note(sentence); }};
  if (!run_dir.empty()) {
    setup.target = read_target_density(run_dir / kTargetDensityFile).value_or(Field());
    if (!setup.origin) setup.origin = recorded_origin(run_dir).value_or(std::nullopt);
  }
  auto output = FoxgloveOutput::open(std::move(setup));
  if (!output) return failure(report_error(kExitUnavailable, output.error()));
  std::printf("connect Foxglove to %s\n", (*output)->url().c_str());
  return *std::move(output);
}

std::vector<std::string> names_of_clients(const PageServer& page, const FoxgloveOutput* foxglove,
                                          const std::optional<CotOutput>& cot) {
  std::vector<std::string> names = page.clients();
  if (foxglove != nullptr)
    for (std::string& name : foxglove->clients()) names.push_back(std::move(name));
  if (cot) names.push_back(cot->name());
  return names;
}

/// @param run_dir  the team's run directory; empty: not known here
int watch_team(const WatchOptions& options, const fs::path& run_dir, StopSignals& signals) {
  LiveWatch::Source source{options, run_dir, {}, {}};
  std::optional<CotOutput> cot;
  if (options.cot.to) {
    auto output = open_cot(options.cot, run_dir);
    if (!output) return output.error();
    cot = *std::move(output);
    source.displays.push_back(&*cot);
  }
  std::unique_ptr<LiveWatch> live;
  const bool has_log = !run_dir.empty();
  ClientList clients(has_log ? run_dir / "log/watch.log" : "", "watch",
                     [&live, has_log](const std::string& sentence) {
                       if (!sentence.starts_with("browser ")) print_message(sentence);
                       if (live && !has_log) live->log(sentence);
                     });
  std::unique_ptr<FoxgloveOutput> foxglove;
  if (options.foxglove_port > 0) {
    auto output = open_foxglove(options, run_dir, clients);
    if (!output) return output.error();
    foxglove = *std::move(output);
    source.displays.push_back(foxglove.get());
  }
  auto opened = LiveWatch::open(std::move(source));
  if (!opened) return report_error(kExitUnavailable, opened.error());
  live = *std::move(opened);
  LiveWatch& watch = *live;
  auto socket = PageSocket::open(options.page);
  if (!socket) return report_error(kExitUnavailable, socket.error());
  announce(socket->url());
  const auto server = PageServer::make(*std::move(socket), watch.content());
  serve_until_stop(*server, signals, [&] {
    watch.listen(server->fd());
    if (foxglove) foxglove->serve(now());
    clients.update(watch.run(), names_of_clients(*server, foxglove.get(), cot), now());
    if (watch.over()) watch.finish();
  });
  if (cot && !cot->losses().empty()) print_message(cot->losses());
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
  auto started = ControlledPage::start(options, run_dir, options.page, true, display);
  if (!started) return report_error(kExitUnavailable, started.error());
  ControlledPage& watched = **started;
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
  CLI::Option* const cot = add_cot_option(*command, options->cot);
  cot->excludes("RUN_DIR")->excludes("--control");
  add_foxglove_option(*command, options->foxglove_port)->excludes("RUN_DIR")->excludes("--control");
  add_origin_option(*command, options->cot.origin)->excludes("RUN_DIR");
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
      if (options->cot.origin && !options->cot.to && options->foxglove_port == 0)
        return report_error(kExitBadInput,
                            "--origin is for --cot and --foxglove; give one of them");
      if (command->count("RUN_DIR") > 0) return watch_record(*options, signals);
      fs::path run_dir;
      if (const auto code = find_run(*command, *options, &run_dir)) return *code;
      if (options->control) return control_team(*options, run_dir, signals);
      return watch_team(*options, run_dir, signals);
    };
  });
}

}  // namespace ergocast::cli
