// SPDX-License-Identifier: BSD-3-Clause
// Datagrams of runs, foreign senders and random bytes lead to the right finding and do no harm.
#include "cli/doctor/bus_listener.h"

#include <cstring>
#include <random>

#include "lcmtypes/codec.h"
#include "tests/cli/doctor/fixture.h"

namespace ergocast::doctor {
namespace {

/// A datagram as LCM sends a short message.
std::vector<std::byte> datagram(const std::string& channel, const std::vector<std::byte>& payload) {
  std::vector<std::byte> bytes(8 + channel.size() + 1);
  std::memcpy(bytes.data(), "LC02", 4);
  std::memcpy(bytes.data() + 8, channel.c_str(), channel.size());
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return bytes;
}

std::vector<std::byte> status_of_an_agent() {
  AgentStatus status;
  status.header = {0xabc, 3, 77, 1, 0};
  status.host = "robot-3";
  std::vector<std::byte> bytes;
  encode(status, bytes);
  return bytes;
}

TEST(BusListener, ARunIsNamedWithItsHosts) {
  Overheard overheard;
  overheard.take(datagram("ERGOCAST_AGENT_STATUS_3", status_of_an_agent()));
  const Finding finding = overheard.finding(url_of("ttl=1"), {});
  EXPECT_EQ(finding.level, Level::kNote);
  EXPECT_EQ(finding.found, "run 0000000000000abc, 1 agent on robot-3");
}

TEST(BusListener, TheVersionIsReportedWhereAProcessSendsIt) {
  Hello hello;
  hello.header = {0xabc, kUnassigned, 77, 1, 0};
  hello.host = "robot-4";
  hello.version = "0.1.0";
  std::vector<std::byte> bytes;
  encode(hello, bytes);
  Overheard overheard;
  overheard.take(datagram("ERGOCAST_HELLO", bytes));
  EXPECT_EQ(overheard.finding(url_of("ttl=1"), {}).found,
            "run 0000000000000abc on robot-4, version 0.1.0");
}

TEST(BusListener, OtherLcmTrafficIsAWarningWithItsChannels) {
  Overheard overheard;
  overheard.take(datagram("POSE\033[2J", std::vector<std::byte>(100)));
  const Finding finding = overheard.finding(url_of("ttl=1"), 24006);
  EXPECT_EQ(finding.level, Level::kWarning);
  EXPECT_TRUE(contains(finding.found, "POSE?[2J")) << finding.found;
  EXPECT_TRUE(contains(finding.remedy, ":24006")) << finding.remedy;
}

TEST(BusListener, ATeamWithAKeyIsDistinguishedFromAStranger) {
  MissionKey key;
  const MessageAuthenticator ours(key);
  key.shared[0] = std::byte{1};
  const MessageAuthenticator theirs(key);
  AgentStatus status;
  status.header = {0xabc, 3, 77, 1, 0};
  const auto overheard = [&](const MessageAuthenticator& said_with,
                             const MessageAuthenticator& heard_with) {
    std::vector<std::byte> bytes;
    encode(status, bytes, said_with, "ERGOCAST_AGENT_STATUS_3");
    Overheard ear(heard_with);
    ear.take(datagram("ERGOCAST_AGENT_STATUS_3", bytes));
    EXPECT_TRUE(ear.anything());
    return ear.finding(url_of("ttl=1"), {});
  };
  EXPECT_TRUE(contains(overheard(ours, ours).found, "run 0000000000000abc"));
  EXPECT_TRUE(contains(overheard(ours, MessageAuthenticator()).found, "a team with a mission key"));
  EXPECT_EQ(overheard(ours, MessageAuthenticator()).level, Level::kNote);
  EXPECT_EQ(overheard(MessageAuthenticator(), ours).level, Level::kWarning);
  EXPECT_TRUE(contains(overheard(MessageAuthenticator(), ours).found, "without a mission key"));
  EXPECT_EQ(overheard(theirs, ours).level, Level::kWarning);
  EXPECT_TRUE(contains(overheard(theirs, ours).found, "does not open"));
}

TEST(BusListener, NoBytesHurtAndNoneBecomeARun) {
  std::mt19937 random(1);
  const auto honest = datagram("ERGOCAST_AGENT_STATUS_3", status_of_an_agent());
  Overheard overheard;
  for (int i = 0; i < 20000; ++i) {
    auto bytes = honest;
    bytes.resize(random() % (honest.size() + 8));
    // The tag covers every byte of the payload, but not LCM's header.
    if (bytes.size() >= honest.size()) bytes.resize(honest.size() + 1);
    if (i % 2 == 0 && !bytes.empty()) bytes[random() % bytes.size()] ^= std::byte{0x40};
    overheard.take(bytes);
  }
  EXPECT_FALSE(contains(overheard.finding(url_of("ttl=1"), {}).found, "run "));
}

}  // namespace
}  // namespace ergocast::doctor
