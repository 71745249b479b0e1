// SPDX-License-Identifier: BSD-3-Clause
// Serves a page at a low priority, so that the team's processes run first.
#include "cli/watch/serve_page.h"

#include <sys/resource.h>

#include <chrono>

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
  app.add_option("--tls-cert", options.tls_files.certificate,
                 "With --tls-key: serve the page by https only, with this certificate in PEM "
                 "format; those that lead to its root may follow in the file")
      ->type_name("FILE");
  app.add_option("--tls-key", options.tls_files.key,
                 "The certificate's private key in PEM format, without a password; only you may "
                 "read the file")
      ->type_name("FILE");
}

void add_control_option(CLI::App& app, bool& control) {
  app.add_flag("--control", control,
               "Let the page give orders: pause, resume, stop, send an agent home. The printed "
               "address holds the right to it: keep it to yourself. With --listen it needs "
               "--tls-cert and --tls-key");
}

std::optional<std::string> read_certificate(PageOptions& options, bool control) {
  const TlsFiles& files = options.tls_files;
  if (files.certificate.empty() != files.key.empty())
    return "--tls-cert and --tls-key belong together: name both";
  if (!files.certificate.empty()) {
    auto tls = TlsServer::read(files);
    if (!tls) return tls.error();
    if (auto problem = (*tls)->why_not_valid(std::chrono::system_clock::now())) return problem;
    options.tls = *std::move(tls);
  }
  if (!control || options.listen.empty() || options.tls) return std::nullopt;
  const std::string port = std::to_string(options.port > 0 ? options.port : PageSocket::kUsualPort);
  return "--control with --listen needs --tls-cert and --tls-key: without TLS, the network could "
         "read the right to give orders. Or leave out --listen, and reach the page from another "
         "host through SSH: ssh -L " +
         port + ":127.0.0.1:" + port + " HOST";
}

}  // namespace ergocast::cli
