// SPDX-License-Identifier: BSD-3-Clause
// Each combination of route and interfaces leads to the right finding and the right commands.
#include "cli/doctor/routing.h"

#include "tests/cli/doctor/fixture.h"

namespace ergocast::doctor {
namespace {

Interface loopback() { return {"lo", true, true, true, false, 65536, "127.0.0.1"}; }
Interface cable(const std::string& name, const std::string& address) {
  return {name, true, true, false, true, 1500, address};
}

TEST(Routing, WithoutARouteTheCommandNamesTheInterfaceThatReachesOthers) {
  Interface no_address = cable("eth7", "");
  const auto findings = routing_findings(url_of("ttl=1"), std::nullopt,
                                         {loopback(), no_address, cable("eth0", "10.0.0.1")});
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].level, Level::kProblem);
  EXPECT_EQ(findings[0].remedy, "ip route add 224.0.0.0/4 dev eth0");
}

TEST(Routing, WithoutARouteATeamOnOneHostGetsLoopback) {
  const auto findings =
      routing_findings(url_of("ttl=0"), std::nullopt, {loopback(), cable("eth0", "10.0.0.1")});
  EXPECT_EQ(findings[0].remedy, "ip link set lo up\nip route add 224.0.0.0/4 dev lo");
}

TEST(Routing, LoopbackIsRightForOneHostAndWrongForSeveral) {
  const std::vector<Interface> all = {loopback(), cable("eth0", "10.0.0.1"),
                                      cable("wlan0", "10.1.0.1")};
  EXPECT_EQ(worst_of(routing_findings(url_of("ttl=0"), "lo", all)), Level::kOk);
  const Finding wrong = routing_findings(url_of("ttl=1"), "lo", all)[0];
  EXPECT_EQ(wrong.level, Level::kProblem);
  EXPECT_EQ(wrong.remedy,
            "ip route replace 224.0.0.0/4 dev eth0\n"
            "ip route replace 224.0.0.0/4 dev wlan0   # or this one");
}

TEST(Routing, OfSeveralInterfacesTheOnesNotUsedAreNamed) {
  const std::vector<Interface> all = {loopback(), cable("eth0", "10.0.0.1"),
                                      cable("wlan0", "10.1.0.1")};
  const Finding finding = routing_findings(url_of("ttl=1"), "eth0", all)[0];
  EXPECT_EQ(finding.level, Level::kNote);
  EXPECT_TRUE(contains(finding.found, "over eth0 (10.0.0.1), and not over wlan0")) << finding.found;
  EXPECT_EQ(finding.remedy, "ip route replace 224.0.0.0/4 dev wlan0");
}

TEST(Routing, InterfacesThatCannotBeUsedAreNoChoice) {
  Interface down = cable("ifb0", "");
  down.up = false;
  EXPECT_EQ(worst_of(routing_findings(url_of("ttl=1"), "eth0",
                                      {loopback(), down, cable("eth0", "10.0.0.1")})),
            Level::kOk);
}

/// The finding about the interface that the route names.
Finding finding_of(const Interface& routed) {
  return routing_findings(url_of("ttl=1"), routed.name, {loopback(), routed})[1];
}

TEST(Routing, AnInterfaceThatCannotCarryMulticastIsNamedWithItsRemedy) {
  Interface one = cable("eth0", "10.0.0.1");
  EXPECT_EQ(finding_of(one).level, Level::kOk);
  one.carrier = false;
  EXPECT_TRUE(contains(finding_of(one).found, "no carrier"));
  one.multicast = false;
  EXPECT_EQ(finding_of(one).remedy, "ip link set eth0 multicast on");
  EXPECT_EQ(finding_of(one).level, Level::kProblem);
}

TEST(Routing, AnMtuBelowOurLongestPacketIsAWarning) {
  Interface one = cable("eth0", "10.0.0.1");
  one.mtu_bytes = 1280;
  EXPECT_EQ(routing_findings(url_of("ttl=1"), "eth0", {one})[2].level, Level::kOk);
  one.mtu_bytes = 1279;
  EXPECT_EQ(routing_findings(url_of("ttl=1"), "eth0", {one})[2].level, Level::kWarning);
}

TEST(Routing, ATtlOfZeroIsANoteUntilOtherHostsAreToReceive) {
  EXPECT_EQ(ttl_finding(url_of("ttl=0"), false).level, Level::kNote);
  EXPECT_EQ(ttl_finding(url_of("ttl=0"), true).level, Level::kProblem);
  EXPECT_EQ(ttl_finding(url_of("ttl=0"), true).remedy,
            "--lcm-url 'udpm://239.255.76.67:24000?ttl=1'");
  EXPECT_EQ(ttl_finding(url_of("ttl=1"), true).level, Level::kOk);
}

TEST(Routing, AFailedSelfTestIsReportedWithoutTheUrlAndItsRemedy) {
  const LcmUrl url = url_of("ttl=0");
  EXPECT_EQ(self_test_finding(url, std::nullopt, true).level, Level::kOk);
  const Finding finding =
      self_test_finding(url, url.base() + ": cannot send\nAs root:\n  ip", true);
  EXPECT_EQ(finding.level, Level::kProblem);
  EXPECT_EQ(finding.found, "cannot send");
  EXPECT_TRUE(contains(finding.remedy, "nft list ruleset"));
  EXPECT_EQ(self_test_finding(url, "no route", false).remedy, "");
}

TEST(Interfaces, LoopbackIsAmongThisMachines) {
  bool found = false;
  for (const Interface& one : interfaces()) {
    if (one.name != "lo") continue;
    found = true;
    EXPECT_TRUE(one.loopback);
    EXPECT_FALSE(one.reaches_others());
    EXPECT_GT(one.mtu_bytes, 0);
  }
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace ergocast::doctor
