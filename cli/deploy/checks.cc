// SPDX-License-Identifier: BSD-3-Clause
// Compares the roles of all hosts with the mission, and lists the processes that each host
// starts.
#include <algorithm>

#include "cli/deploy/deploy.h"

namespace ergocast {
namespace {

using Hosts = std::vector<DeployHost>;

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text;
}

std::vector<std::string> names_with(const Hosts& hosts, bool DeployHost::*role) {
  std::vector<std::string> names;
  for (const DeployHost& host : hosts) {
    if (host.*role) names.push_back(host.name);
  }
  return names;
}

void check_single_roles(const Hosts& hosts, const std::string& file,
                        std::vector<Problem>& problems) {
  const auto at_most_one = [&](const char* role, const std::vector<std::string>& names) {
    if (names.size() < 2) return;
    problems.push_back({file, std::string(role) + " is the role of several hosts: " + joined(names),
                        std::string("leave ") + role + " to one of them"});
  };
  const auto coordinators = names_with(hosts, &DeployHost::coordinator);
  at_most_one("coordinator", coordinators);
  if (coordinators.empty()) {
    problems.push_back({file, "no host is the coordinator", "give the role coordinator to one"});
  }
  at_most_one("logger", names_with(hosts, &DeployHost::logger));
  const auto worlds = names_with(hosts, &DeployHost::sim);
  const auto drivers = names_with(hosts, &DeployHost::driver);
  at_most_one("sim", worlds);
  if (worlds.empty() && drivers.empty()) {
    problems.push_back({file, "no host moves the vehicles",
                        "give the role sim to one host, or the role driver to each host whose own "
                        "program moves vehicles"});
  }
  if (!worlds.empty() && !drivers.empty()) {
    problems.push_back(
        {file, "there are a simulated world and drivers", "leave out sim, or every driver"});
  }
}

void check_relays(const Hosts& hosts, const DeployMission& mission, const std::string& file,
                  std::vector<Problem>& problems) {
  const bool relays = !names_with(hosts, &DeployHost::relay).empty();
  const bool hubs = std::ranges::any_of(hosts, [](const auto& host) { return !host.hub.empty(); });
  if (relays && !hubs) {
    problems.push_back({file, "no host is the hub that the relays join",
                        "give the role hub=HOST:PORT to a host that all sites reach there by UDP"});
  }
  if (hubs && !relays) {
    problems.push_back(
        {file, "a hub has no relays", "give the role relay to one host of each site"});
  }
  if ((relays || hubs) && mission.keys.empty()) {
    problems.push_back({file, "relays carry only messages with the team's key",
                        "run `ergocast keygen NAME`, and give --keys NAME"});
  }
}

/// The options of a host's relay, hub, or peer, which is both.
std::vector<std::string> relay_options(const DeployHost& host) {
  std::vector<std::string> options;
  if (host.hub.empty()) {
    options.push_back("--to");
    options.insert(options.end(), host.hubs.begin(), host.hubs.end());
  } else {
    if (!host.relay) options.push_back("--hub");
    options.insert(options.end(), {"--listen", host.hub.substr(host.hub.rfind(':'))});
  }
  if (host.relay_kbit_per_s > 0)
    options.insert(options.end(), {"--max-rate", std::to_string(host.relay_kbit_per_s)});
  return options;
}

}  // namespace

std::vector<Problem> problems_of(const Hosts& hosts, const DeployMission& mission,
                                 const std::string& file, bool apart) {
  std::vector<Problem> problems;
  check_single_roles(hosts, file, problems);
  check_relays(hosts, mission, file, problems);
  std::size_t agents = 0;
  for (const DeployHost& host : hosts) agents += host.agents.size();
  if (agents < static_cast<std::size_t>(mission.quorum)) {
    problems.push_back({file,
                        std::to_string(agents) + " agents are fewer than the quorum of " +
                            std::to_string(mission.quorum) + " of " + mission.name,
                        "add agents, or lower agents.quorum in the scenario"});
  }
  if (mission.lockstep && !names_with(hosts, &DeployHost::driver).empty()) {
    problems.push_back(
        {file,
         mission.name + " is in lockstep, and robots follow the clock: drivers refuse lockstep",
         "give --realtime, or write pace: REALTIME in the scenario, or give the role "
         "sim instead of driver"});
  }
  if (apart && mission.url.ttl == 0) {
    LcmUrl wider = mission.url;
    wider.ttl = 1;
    problems.push_back({"--lcm-url",
                        "ttl=0 keeps every message on its own host or in its own container",
                        "give '" + wider.base() + "'"});
  }
  return problems;
}

std::string roles_of(const DeployHost& host) {
  std::vector<std::string> roles;
  if (host.coordinator) roles.push_back("coordinator");
  if (host.logger) roles.push_back("logger");
  if (host.sim) roles.push_back("simulated world");
  if (host.driver) roles.push_back("driver (your program)");
  if (!host.hub.empty()) roles.push_back("hub " + host.hub);
  if (host.relay) roles.push_back("relay");
  std::string ids;
  for (const int id : host.agents) ids += ' ' + std::to_string(id);
  if (!ids.empty()) roles.push_back((host.agents.size() == 1 ? "agent" : "agents") + ids);
  return joined(roles);
}

std::vector<DeployProcess> processes_of(const DeployHost& host) {
  std::vector<DeployProcess> processes;
  if (host.relay || !host.hub.empty()) {
    DeployProcess relay{kRelayProcess, {"ergocast-relay"}};
    const auto options = relay_options(host);
    relay.command.insert(relay.command.end(), options.begin(), options.end());
    processes.push_back(std::move(relay));
  }
  if (host.logger) processes.push_back({"logger", {"ergocast-logger", "--out", "record"}});
  if (host.sim) processes.push_back({"sim", {"ergocast-sim"}});
  for (const int id : host.agents) {
    const std::string number = std::to_string(id);
    processes.push_back({"agent-" + number, {"ergocast-agent", "--id", number}});
  }
  return processes;
}

}  // namespace ergocast
