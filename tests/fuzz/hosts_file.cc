// SPDX-License-Identifier: BSD-3-Clause
// A hosts file: refused with problems, or hosts from which every kind of deployment is written.
#include "cli/deploy/deploy.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(hosts_file) {
  const auto parsed = parse_hosts(text_of(input), "hosts");
  if (!parsed) {
    ERGOCAST_REQUIRE(!parsed.error().empty());
    return;
  }
  const auto& hosts = *parsed;
  for (const DeployHost& host : hosts) {
    ERGOCAST_REQUIRE(!host.name.empty() && !host.address.empty());
    ERGOCAST_REQUIRE(host.name.find('/') == std::string::npos && host.name.front() != '.');
    for (const int id : host.agents) ERGOCAST_REQUIRE(id >= 0 && id < kMaxAgents);
  }
  DeployMission mission;
  mission.name = "mission";
  mission.folder = "/missions";
  mission.files = {"mission.textproto"};
  mission.quorum = 2;
  if (!problems_of(hosts, mission, "hosts", true).empty()) return;
  ERGOCAST_REQUIRE(!ssh_files(hosts, mission).empty());
  ERGOCAST_REQUIRE(!systemd_files(hosts, mission).empty());
  ERGOCAST_REQUIRE(!compose_files(hosts, mission).empty());
}

}  // namespace ergocast::fuzz
