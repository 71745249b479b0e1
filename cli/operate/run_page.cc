// SPDX-License-Identifier: BSD-3-Clause
// `ergocast run-page`: `ergocast run --watch` and `ergocast watch --control` start it to serve
// their page (cli/watch/page_process.h).
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/commands.h"
#include "cli/operate/live_displays.h"
#include "cli/record/run_directory.h"
#include "cli/report_error.h"
#include "cli/watch/client_list.h"
#include "cli/watch/live_watch.h"
#include "cli/watch/page_control.h"
#include "cli/watch/page_process.h"
#include "cli/watch/serve_page.h"
#include "report/target_density.h"
#include "runtime/bus/clock.h"
#include "runtime/process/signals.h"

namespace ergocast::cli {
namespace {

struct RunPageOptions : BusOptions {
  std::filesystem::path run_dir;
  PageOptions page;
  DisplayOptions displays;
};

/// The memory limit of this process while the mission runs. Above it the process ends, and a new
/// one replaces it. Browsers and the network can cause only a small part of it.
/// Limit (Page): memory of the page's process while a mission runs [bytes]. Beyond it: it ends and
/// is started again.
constexpr rlim_t kMostMemory = rlim_t{512} << 20;

/// The memory that RLIMIT_DATA counts [bytes].
rlim_t allocated() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    rlim_t kib = 0;
    if (word == "VmData:" && status >> kib) return kib << 10;
  }
  return 0;
}

/// The previous limit.
rlimit limit_memory() {
  rlimit former{};
  getrlimit(RLIMIT_DATA, &former);
  const rlimit limit{std::min(former.rlim_cur, allocated() + kMostMemory), former.rlim_max};
  setrlimit(RLIMIT_DATA, &limit);
  return former;
}

/// Whether the other end of the pipe is closed.
bool closed(int pipe) {
  pollfd end{pipe, 0, 0};
  return poll(&end, 1, 0) > 0;
}

/// The control that this process was handed, if any.
std::optional<PageControl> page_control() {
  const char* token = std::getenv(kControlToken);
  auto link = token != nullptr ? ControlLink::inherited(kPageControl) : std::nullopt;
  if (!link) return std::nullopt;
  return PageControl(std::move(*link), token);
}

/// Reads the certificate, also if it has expired since the mission began.
std::optional<std::string> read_tls(PageOptions& page) {
  if (page.tls_files.certificate.empty()) return std::nullopt;
  auto tls = TlsServer::read(page.tls_files);
  if (!tls) return tls.error();
  page.tls = *std::move(tls);
  return std::nullopt;
}

/// The socket that this process was handed.
Result<PageSocket> page_socket(PageOptions& page) {
  if (auto problem = read_tls(page)) return failure(*problem);
  const char* token = std::getenv(kPageToken);
  return PageSocket::inherited(kPageSocket, page, token != nullptr ? token : "");
}

int run_page(RunPageOptions& options) {
  StopSignals signals;
  auto socket = page_socket(options.page);
  if (!socket) {
    return report_error(kExitBadInput,
                        socket.error() + "; `ergocast run --watch` starts this command");
  }
  LiveWatch::Source source{options, options.run_dir, {}, {}};
  if (!options.run_dir.empty()) {
    source.mission = recorded_mission_or_complain(options.run_dir);
    if (!source.mission) return kExitBadInput;
    source.density = read_target_density(options.run_dir / kTargetDensityFile).value_or(Field());
  }
  auto displays = LiveDisplays::open(options.displays, options.page, options.run_dir);
  if (!displays) displays = LiveDisplays::open({}, options.page, options.run_dir);
  if (!displays) return displays.error();
  LiveDisplays& others = **displays;
  const bool has_log = !options.run_dir.empty();
  std::unique_ptr<LiveWatch> live;
  ClientList clients(has_log ? options.run_dir / "log/page.log" : "", "page",
                     [&live, has_log](const std::string& sentence) {
                       if (live && !has_log) live->log(sentence);
                     });
  others.begin([&clients](const std::string& sentence) { clients.note(sentence); });
  source.displays = others.displays();
  auto opened = LiveWatch::open(std::move(source));
  if (!opened) return report_error(kExitUnavailable, opened.error());
  eventfd_write(kPageListens, 1);
  live = *std::move(opened);
  LiveWatch& watch = *live;
  const rlimit former = limit_memory();
  auto control = page_control();
  const auto server = PageServer::make(
      *std::move(socket), control ? control->joined(watch.content()) : watch.content());
  serve_until_stop(*server, signals, [&, over = false]() mutable {
    watch.listen(server->fd());
    others.serve(now());
    clients.update(watch.run(), together(server->clients(), others.clients()), now());
    if (control) control->listen(now());
    if (over || !closed(kPageUntil)) return;
    over = true;
    setrlimit(RLIMIT_DATA, &former);  // a long record may need more; the mission is over
    watch.finish();
  });
  return kExitDone;
}

}  // namespace

void add_run_page(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("run-page", "The page's process of `run --watch`");
  command->group("");  // hidden: it is not started by hand
  auto options = std::make_shared<RunPageOptions>();
  command->add_option("RUN_DIR", options->run_dir, "Run directory, if this host has it")
      ->type_name("DIR");
  add_bus_options(*command, *options);
  command->add_option("--listen", options->page.listen, "Address that the socket is bound to");
  command->add_option("--tls-cert", options->page.tls_files.certificate, "The page's certificate");
  command->add_option("--tls-key", options->page.tls_files.key, "Its key");
  add_display_options(*command, options->displays);
  command->add_option("--foxglove-socket", options->displays.foxglove_socket, "Its descriptor");
  command->callback([&action, options] { action = [options] { return run_page(*options); }; });
}

}  // namespace ergocast::cli
