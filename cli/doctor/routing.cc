// SPDX-License-Identifier: BSD-3-Clause
// Compares the interface of the route with those that reach other hosts, and composes the `ip`
// commands.
#include "cli/doctor/routing.h"

#include <algorithm>

namespace ergocast::doctor {
namespace {

/// One `ip route` command for each possible interface.
std::string route_commands(const char* verb, const std::vector<std::string>& names) {
  std::vector<std::string> lines;
  for (const std::string& name : names) {
    lines.push_back(std::string("ip route ") + verb + " 224.0.0.0/4 dev " + name +
                    (lines.empty() ? "" : "   # or this one"));
  }
  return joined(lines, "\n");
}

std::vector<std::string> names_that_reach_others(const std::vector<Interface>& all) {
  std::vector<std::string> names;
  for (const Interface& one : all) {
    if (one.reaches_others()) names.push_back(one.name);
  }
  return names;
}

Finding no_route(const LcmUrl& url, const std::vector<std::string>& others) {
  Finding finding{
      "route", Level::kProblem, "no route to " + url.group,
      "LCM sends to a multicast group. Without a route for it nothing is sent, not even "
      "to a process on this host.",
      ""};
  if (url.ttl > 0 && !others.empty()) {
    finding.remedy = route_commands("add", others);
    return finding;
  }
  finding.remedy = "ip link set lo up\n" + route_commands("add", {"lo"});
  if (url.ttl > 0) {
    finding.why +=
        " No interface but lo is up, has an IPv4 address and can multicast: only teams "
        "on this host are possible until one is.";
  }
  return finding;
}

Finding goes_to_loopback(const LcmUrl& url, const std::vector<std::string>& others) {
  Finding finding{"route", Level::kProblem,
                  url.group + " goes to lo, yet the URL says ttl=" + std::to_string(url.ttl),
                  "Such a TTL is for teams on several hosts, but nothing that is sent to lo leaves "
                  "this host.",
                  route_commands("replace", others)};
  if (others.empty()) {
    finding.why += " No other interface is up, has an IPv4 address and can multicast.";
    finding.remedy = "ip address   # which interface leads to the other hosts? ip link set IT up";
  }
  return finding;
}

Finding route_finding(const LcmUrl& url, const Interface& routed,
                      const std::vector<Interface>& all) {
  std::vector<std::string> others = names_that_reach_others(all);
  if (routed.loopback && url.ttl > 0) return goes_to_loopback(url, others);
  const std::string name =
      routed.name + (routed.address.empty() ? "" : " (" + routed.address + ")");
  Finding finding{"route", Level::kOk, url.group + " goes over " + name, "", ""};
  std::erase(others, routed.name);
  if (url.ttl == 0 || others.empty()) return finding;
  finding.level = Level::kNote;
  finding.found += ", and not over " + joined(others);
  finding.why =
      "LCM cannot choose an interface: the routing table decides, on every host of the "
      "team by itself. If the others are on another network, change it here.";
  finding.remedy = route_commands("replace", others);
  return finding;
}

Finding interface_finding(const Interface& routed) {
  Finding finding{"interface", Level::kOk, routed.name + " is up", "", ""};
  // An interface that is down does not occur here: the kernel removes its routes.
  if (!routed.multicast && !routed.loopback) {
    finding = {"interface", Level::kProblem, routed.name + " is not set to multicast",
               "The route to the group names it, but it does not take part in multicast.",
               "ip link set " + routed.name + " multicast on"};
  } else if (!routed.carrier && !routed.loopback) {
    finding = {"interface", Level::kProblem, routed.name + " has no carrier",
               "The cable or radio has no other end, so no other host receives this one.",
               "ip link show " + routed.name + "   # plug it in, or join the network"};
  }
  return finding;
}

Finding mtu_finding(const Interface& routed) {
  const std::string found = routed.name + ": " + std::to_string(routed.mtu_bytes) + " bytes";
  if (routed.mtu_bytes >= kLongestPacketBytes) return {"MTU", Level::kOk, found, "", ""};
  return {"MTU", Level::kWarning, found,
          "Messages are packets of up to " + std::to_string(kLongestPacketBytes) +
              " bytes. Longer than the MTU, they travel in fragments, and one lost fragment loses "
              "them whole; where the MTU shrinks on the way, they are lost always.",
          "ip link set " + routed.name + " mtu 1500"};
}

}  // namespace

Findings routing_findings(const LcmUrl& url, const std::optional<std::string>& routed,
                          const std::vector<Interface>& all) {
  if (!routed) return {no_route(url, names_that_reach_others(all))};
  const auto at = std::find_if(all.begin(), all.end(),
                               [&](const Interface& one) { return one.name == *routed; });
  if (at == all.end()) return {no_route(url, names_that_reach_others(all))};
  return {route_finding(url, *at, all), interface_finding(*at), mtu_finding(*at)};
}

Finding ttl_finding(const LcmUrl& url, bool several_hosts) {
  const std::string found = "ttl=" + std::to_string(url.ttl);
  if (url.ttl > 0) return {"TTL", Level::kOk, found + ": reaches the local network", "", ""};
  LcmUrl wider = url;
  wider.ttl = 1;
  return {"TTL", several_hosts ? Level::kProblem : Level::kNote, found + ": never leaves this host",
          "Right for a team on one host. On several, no host receives the others without ttl=1 in "
          "the URL, on every host.",
          "--lcm-url '" + wider.base() + "'"};
}

Finding self_test_finding(const LcmUrl& url, const std::optional<std::string>& failure,
                          bool has_route) {
  if (!failure) {
    return {"self test", Level::kOk, "a datagram to " + url.group + " came back", "", ""};
  }
  // The first line has the cause. The other checks cover the rest better.
  std::string found = failure->substr(0, failure->find('\n'));
  if (found.starts_with(url.base() + ": ")) found.erase(0, url.base().size() + 2);
  const std::string why =
      "Every program of Ergocast tests itself in the same way, and none starts. ";
  if (!has_route) return {"self test", Level::kProblem, found, why + "It needs the route.", ""};
  return {"self test", Level::kProblem, found,
          why + "If route and interface are right, a firewall drops what comes in.",
          "nft list ruleset   # as root: what drops udp to " + url.group + "?"};
}

}  // namespace ergocast::doctor
