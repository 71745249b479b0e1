// SPDX-License-Identifier: BSD-3-Clause
// Serves a page at a low priority, so that the team's processes run first.
#include "cli/watch/serve_page.h"

#include <sys/resource.h>

#include "runtime/bus/clock.h"

namespace ergocast::cli {
namespace {

constexpr int kPagePriority = 10;

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

void add_control_option(CLI::App& app, bool& control) {
  app.add_flag("--control", control,
               "Let the page give orders: pause, resume, stop, send an agent home. The printed "
               "address holds the right to it: keep it to yourself")
      ->excludes(app.get_option("--listen"));
}

}  // namespace ergocast::cli
