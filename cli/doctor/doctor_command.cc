// SPDX-License-Identifier: BSD-3-Clause
// `ergocast doctor`: reports what prevents agents on this host and on others from communicating.
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "cli/commands.h"
#include "cli/doctor/examination.h"
#include "cli/doctor/peer_exchange.h"
#include "cli/doctor/print.h"
#include "relay/question.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {
namespace {

using doctor::Finding;
using doctor::Findings;
using doctor::Level;

struct DoctorOptions {
  LcmUrl url;
  MessageAuthenticator authenticator;
  std::optional<int> peer_seconds;
  std::optional<relay::HostAndPort> relay;
  bool json = false;
};

doctor::Look look_of_standard_output() {
  const bool terminal = isatty(STDOUT_FILENO) == 1;
  const char* no_colour = std::getenv("NO_COLOR");
  doctor::Look look{terminal && (no_colour == nullptr || *no_colour == '\0'), 100};
  winsize size{};
  if (terminal && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
    look.columns = std::clamp<int>(size.ws_col, 60, 100);
  }
  return look;
}

Finding not_tried(const doctor::Examination& host, int seconds) {
  if (!host.lcm_usable) {
    return {"peers", Level::kProblem, "not tried: LCM cannot be used on this host",
            "Mend the other problems first.", ""};
  }
  return {
      "peers", Level::kWarning, "not tried: the port is in use",
      "Probes would disturb the processes at this port. With another port, they take the same way:",
      "ergocast doctor --peer " + std::to_string(seconds) + " --lcm-url '" + host.port_taken +
          "'   # on every host"};
}

doctor::PeerTest try_peers(const LcmUrl& url, const MessageAuthenticator& authenticator,
                           int seconds) {
  if (isatty(STDERR_FILENO) == 1) {
    std::fprintf(stderr,
                 "Listening for other hosts for %d s. Start the same there now:\n"
                 "    ergocast doctor --peer %d --lcm-url '%s'\n",
                 seconds, seconds, url.base().c_str());
  }
  return doctor::try_peers(url, authenticator, std::chrono::seconds(seconds));
}

Finding relay_finding(const relay::HostAndPort& hub, const MessageAuthenticator& authenticator) {
  const auto report = relay::ask_hub(hub, authenticator);
  const std::string name = relay::to_text(hub);
  if (report) return {"relay", Level::kOk, name + ": " + *report, "", ""};
  return {"relay", Level::kProblem, name + ": " + report.error(),
          "Without its hub each site is alone. On the hub's host, which needs an open UDP port:",
          "ergocast-relay --hub --listen :" + std::to_string(hub.port) + " --key-file FILE"};
}

int diagnose(const DoctorOptions& options) {
  const LcmUrl& url = options.url;
  doctor::Examination host =
      doctor::examine(url, options.authenticator, options.peer_seconds.has_value());
  doctor::PeerTest test;
  if (options.peer_seconds && host.lcm_usable && host.port_taken.empty()) {
    test = try_peers(url, options.authenticator, *options.peer_seconds);
    const Findings more =
        doctor::peer_findings(url, test, version(), options.authenticator.fingerprint());
    host.findings.insert(host.findings.end(), more.begin(), more.end());
  } else if (options.peer_seconds) {
    host.findings.push_back(not_tried(host, *options.peer_seconds));
  }
  if (options.relay) host.findings.push_back(relay_finding(*options.relay, options.authenticator));
  if (options.json) {
    std::fputs(doctor::json_of(url, host.findings, test.peers).c_str(), stdout);
  } else {
    const std::string table = doctor::text_of(test.peers);
    std::fputs(doctor::text_of(url, host.findings, look_of_standard_output()).c_str(), stdout);
    if (!table.empty()) std::printf("\n%s", table.c_str());
  }
  if (!host.lcm_usable) return kExitUnavailable;
  return doctor::worst_of(host.findings) >= Level::kWarning ? kExitDiffers : kExitDone;
}

}  // namespace

void add_doctor(CLI::App& app, Action& action) {
  const auto options = std::make_shared<DoctorOptions>();
  auto* command = app.add_subcommand(
      "doctor", "Find what prevents communication between hosts, and the commands that repair it");
  add_url_option(*command, options->url);
  add_key_option(*command, options->authenticator);
  command
      ->add_option_function<int>(
          "--peer", [options](int seconds) { options->peer_seconds = seconds; },
          "Started on several hosts at about the same time: which hosts receive each other, loss "
          "and round trips "
          "(default 10 s)")
      ->expected(0, 1)
      ->default_str("10")
      ->check(CLI::Range(1, doctor::kMaxPeerSeconds))
      ->type_name("SECONDS");
  command
      ->add_option_function<std::string>(
          "--relay",
          [options](const std::string& text) {
            auto hub = relay::HostAndPort::parse_hub(text);
            if (!hub) throw CLI::ValidationError("--relay", hub.error());
            options->relay = *std::move(hub);
          },
          "Ask this hub of relays for its sites: round trips, loss both ways, dropped messages")
      ->type_name("HOST:PORT");
  command->add_flag("--json", options->json, "Print JSON");
  command->footer(
      "Changes nothing on this host, and sends nothing without --peer or --relay. With --peer it "
      "sends 20\n"
      "datagrams a second to the URL's first port, unless a team uses that port.\n"
      "Exit codes: 0 nothing worse than notes; 1 warnings or problems; 2 bad arguments;\n"
      "3 LCM cannot be used on this host.");
  command->callback([options, &action] { action = [options] { return diagnose(*options); }; });
}

}  // namespace ergocast::cli
