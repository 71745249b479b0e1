// SPDX-License-Identifier: BSD-3-Clause
// Runs each check and passes results that later checks need: the route, the failure of LCM, a free
// port.
#include "cli/doctor/examination.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "cli/doctor/bus_listener.h"
#include "cli/doctor/fragment_rule.h"
#include "cli/doctor/host_conditions.h"
#include "cli/doctor/interfaces.h"
#include "cli/doctor/kernel_limits.h"
#include "cli/doctor/ports.h"
#include "cli/doctor/routing.h"
#include "runtime/bus/random_identity.h"
#include "runtime/process/program_options.h"
#include "runtime/process/shipped_folder.h"

namespace ergocast::doctor {
namespace {

using namespace std::chrono_literals;

constexpr auto kListening = 1s;  // agents send a status every 0.5 s

std::optional<int> some_free_base_port() {
  const auto free = PortReservation::take(random_identity());
  return free ? std::optional(free->base_port()) : std::nullopt;
}

/// Checks ports and swarm bus.
void examine_bus(const LcmUrl& url, const MessageAuthenticator& authenticator, Examination& all) {
  const auto everybody = holders("/proc", url);
  std::string refusal;
  Overheard overheard(authenticator);
  if (all.lcm_usable) overheard = listen_to_swarm(url, authenticator, kListening, refusal);
  const auto free = everybody.empty() && refusal.empty() && !overheard.anything()
                        ? std::nullopt
                        : some_free_base_port();
  all.findings.push_back(ports_finding(url, everybody, refusal, free));
  if (!all.lcm_usable || !refusal.empty()) return;
  all.findings.push_back(overheard.finding(url, free));
  // Another `ergocast` on the port is a doctor like this one.
  const bool held = std::any_of(everybody.begin(), everybody.end(), [&url](const SocketOwner& one) {
    return one.port == url.base_port && one.program != "ergocast";
  });
  if (held || overheard.anything()) {
    LcmUrl other = url;
    if (free) other.base_port = *free;
    all.port_taken = other.base();
  }
}

}  // namespace

Examination examine(const LcmUrl& url, const MessageAuthenticator& authenticator,
                    bool several_hosts) {
  Examination all;
  Findings& findings = all.findings;
  const auto every = interfaces();
  const auto routed = routed_interface(url.group);
  const auto failure = why_unreachable(url);
  all.lcm_usable = !failure.has_value();
  std::vector<std::string> names;
  for (const Interface& one : every) names.push_back(one.name);

  findings = routing_findings(url, routed, every);
  findings.push_back(ttl_finding(url, several_hosts));
  findings.push_back(self_test_finding(url, failure, routed.has_value()));
  examine_bus(url, authenticator, all);
  findings.push_back(authentication_finding(authenticator.keyed()));
  findings.push_back(receive_buffer_finding(url, measure_receive_buffer(url)));
  findings.push_back(fragments_finding("/proc"));
  if (routed) findings.push_back(reverse_path_finding("/proc", *routed));
  findings.push_back(bridges_finding("/sys", names));
  if (const auto firewall = firewall_finding(firewall_rules(), url.group)) {
    findings.push_back(*firewall);
  }
  const auto rules = shipped_folder("nftables", "packaging/nftables") / "ergocast.nft";
  findings.push_back(fragment_rule_finding(url, nft_ruleset(), rules));
  findings.push_back(clock_finding(clock_is_synchronised()));
  const char* path = std::getenv("PATH");
  findings.push_back(spy_finding("/", path == nullptr ? "" : path, !spy_jar().empty()));
  return all;
}

}  // namespace ergocast::doctor
