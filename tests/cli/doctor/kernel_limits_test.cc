// SPDX-License-Identifier: BSD-3-Clause
// Settings in artificial /proc and /sys folders lead to the right finding and the right commands.
#include "cli/doctor/kernel_limits.h"

#include "tests/cli/doctor/fixture.h"

namespace ergocast::doctor {
namespace {

class KernelLimits : public Folder {};

constexpr int kDebians_bytes = 212992, kRecommended_bytes = 4194304;

TEST(ReceiveBufferFinding, AKernelThatAllowsLittleIsANoteWithTheCommand) {
  const Finding finding =
      receive_buffer_finding(url_of("ttl=0"), {kDebians_bytes, 2 * kDebians_bytes});
  EXPECT_EQ(finding.level, Level::kNote);
  EXPECT_TRUE(contains(finding.found, "about 92 datagrams")) << finding.found;
  EXPECT_TRUE(contains(finding.remedy, "sysctl -w net.core.rmem_max=4194304")) << finding.remedy;
  EXPECT_FALSE(contains(finding.remedy, "--lcm-url")) << finding.remedy;
}

TEST(ReceiveBufferFinding, AUrlThatAsksForLittleIsBetterWithoutIt) {
  const Finding finding = receive_buffer_finding(url_of("ttl=0&recv_buf_size=100000"),
                                                 {kDebians_bytes, 2 * kRecommended_bytes});
  EXPECT_EQ(finding.level, Level::kNote);
  EXPECT_FALSE(contains(finding.remedy, "sysctl")) << finding.remedy;
  EXPECT_TRUE(contains(finding.remedy, "?ttl=0'")) << finding.remedy;
}

TEST(ReceiveBufferFinding, MeasuresWhatOurProgramsAskFor) {
  const ReceiveBuffer asked = measure_receive_buffer(url_of("ttl=0"));
  EXPECT_EQ(asked.granted_bytes, std::min(asked.most_bytes, 2 * kReceiveBufferBytes));
}

TEST(ReceiveBufferFinding, AUrlThatAsksForMoreThanItGetsIsWarned) {
  const LcmUrl url = url_of("ttl=0&recv_buf_size=1000000");
  const Finding finding = receive_buffer_finding(url, {2 * kDebians_bytes, 2 * kDebians_bytes});
  EXPECT_EQ(finding.level, Level::kWarning);
  EXPECT_TRUE(contains(finding.remedy, "sysctl -w net.core.rmem_max=1000000")) << finding.remedy;
}

TEST(ReceiveBufferFinding, WhatIsRecommendedAndGrantedIsFine) {
  const LcmUrl url = url_of("ttl=0&recv_buf_size=4194304");
  EXPECT_EQ(receive_buffer_finding(url, {2 * kRecommended_bytes, 2 * kRecommended_bytes}).level,
            Level::kOk);
}

TEST(ReceiveBufferFinding, ThisKernelGrantsTwiceWhatItAllows) {
  const ReceiveBuffer small = measure_receive_buffer(url_of("ttl=0&recv_buf_size=50000"));
  EXPECT_EQ(small.granted_bytes, 100000);
  EXPECT_GE(small.most_bytes, small.granted_bytes);
}

TEST_F(KernelLimits, LittleRoomForFragmentsIsANote) {
  EXPECT_EQ(fragments_finding(root_).level, Level::kOk);  // not told
  write("sys/net/ipv4/ipfrag_high_thresh", "4194304\n");
  EXPECT_EQ(fragments_finding(root_).level, Level::kOk);
  write("sys/net/ipv4/ipfrag_high_thresh", "262144\n");
  const Finding finding = fragments_finding(root_);
  EXPECT_EQ(finding.level, Level::kNote);
  // Another finding's setting may already be in the file.
  EXPECT_TRUE(contains(finding.remedy, " >> /etc/sysctl.d/")) << finding.remedy;
}

TEST_F(KernelLimits, TheLargerReversePathFilterCounts) {
  write("sys/net/ipv4/conf/all/rp_filter", "1\n");
  write("sys/net/ipv4/conf/eth0/rp_filter", "0\n");
  EXPECT_EQ(reverse_path_finding(root_, "eth0").level, Level::kNote);
  write("sys/net/ipv4/conf/eth0/rp_filter", "2\n");
  EXPECT_EQ(reverse_path_finding(root_, "eth0").level, Level::kOk);
  write("sys/net/ipv4/conf/all/rp_filter", "0\n");
  EXPECT_EQ(reverse_path_finding(root_, "eth1").level, Level::kOk);
}

TEST_F(KernelLimits, OnlyOwnBridgesThatSnoopWithoutAQuerierAreNamed) {
  const auto bridge = [this](const std::string& name, const char* snooping, const char* querier) {
    write("class/net/" + name + "/bridge/multicast_snooping", snooping);
    write("class/net/" + name + "/bridge/multicast_querier", querier);
  };
  bridge("br0", "1\n", "0\n");
  bridge("br1", "1\n", "1\n");
  bridge("br2", "0\n", "0\n");
  bridge("other", "1\n", "0\n");
  const Finding finding = bridges_finding(root_, {"lo", "br0", "br1", "br2"});
  EXPECT_EQ(finding.level, Level::kNote);
  EXPECT_EQ(finding.remedy, "ip link set br0 type bridge mcast_querier 1");
  EXPECT_EQ(bridges_finding(root_, {"lo", "br1"}).level, Level::kOk);
}

}  // namespace
}  // namespace ergocast::doctor
