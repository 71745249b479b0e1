// SPDX-License-Identifier: BSD-3-Clause
// Each kind of broken connection between two hosts has its finding and its level.
#include "cli/doctor/peer_exchange.h"
#include "tests/cli/doctor/fixture.h"

namespace ergocast::doctor {
namespace {

/// A host that is connected in both directions, with `received` of 150 short and 50 long probes
/// received.
Peer peer(ProbeCount received) {
  Peer one{"robot-1", "0.1.0", "10.0.0.2", {{150, 50}, received}, Loss{{150, 50}, received},
           {0.001},   0};
  return one;
}

Finding finding_of(const Peer& one, std::uint64_t key = 0) {
  return peer_findings(url_of("ttl=1"), {{one}, 0, 200, ""}, "0.1.0", key).at(0);
}

TEST(PeerFindings, AllRight) { EXPECT_EQ(finding_of(peer({150, 50})).level, Level::kOk); }

TEST(PeerFindings, NoOtherHostIsAProblem) {
  const auto findings = peer_findings(url_of("ttl=1"), {{}, 0, 200, ""}, "0.1.0");
  EXPECT_EQ(findings.at(0).level, Level::kProblem);
  EXPECT_TRUE(contains(findings[0].found, "no probe of another host arrived (200 sent)"));
}

TEST(PeerFindings, OneWayIsAProblem) {
  Peer deaf = peer({150, 50});
  deaf.to_it.reset();
  EXPECT_EQ(finding_of(deaf).level, Level::kProblem);
  EXPECT_TRUE(contains(finding_of(deaf).found, "one-way"));
}

TEST(PeerFindings, AFewProbesAreNotJudged) {
  Peer brief = peer({3, 1});
  brief.to_it.reset();
  EXPECT_EQ(finding_of(brief).level, Level::kNote);
}

TEST(PeerFindings, LossOfLongOnesAloneIsTheMtus) {
  EXPECT_TRUE(contains(finding_of(peer({149, 0})).found, "only short datagrams arrive"));
  EXPECT_TRUE(contains(finding_of(peer({149, 0})).why, "MTU"));
  EXPECT_FALSE(contains(finding_of(peer({75, 25})).found, "only short"));
  EXPECT_FALSE(contains(finding_of(peer({3, 0})).found, "only short"));
}

TEST(PeerFindings, LossIsAWarningInEitherDirection) {
  Peer lossy = peer({150, 50});
  lossy.to_it->received = {135, 45};
  EXPECT_EQ(finding_of(lossy).level, Level::kWarning);
  EXPECT_TRUE(contains(finding_of(lossy).found, "0.0 % from it, 10.0 % to it"))
      << finding_of(lossy).found;
  std::swap(lossy.from_it, *lossy.to_it);
  EXPECT_EQ(finding_of(lossy).level, Level::kWarning);
}

TEST(PeerFindings, AnotherVersionIsAWarningThatNamesTheHostToUpdate) {
  Peer other = peer({150, 50});
  other.version = "0.0.9";
  EXPECT_EQ(finding_of(other).level, Level::kWarning);
  EXPECT_TRUE(contains(finding_of(other).remedy, "# update " + other.host + " to 0.1.0"))
      << finding_of(other).remedy;
  other.version = "0.10.0";
  EXPECT_TRUE(contains(finding_of(other).remedy, "# update this host to 0.10.0"));
}

TEST(PeerFindings, AnotherMissionKeyIsAWarningThatNamesWhichHostHasOne) {
  Peer one = peer({150, 50});
  EXPECT_TRUE(contains(finding_of(one, 7).found, "it has no mission key and this host has one"));
  one.key = 8;
  EXPECT_TRUE(contains(finding_of(one, 7).found, "it has another mission key"));
  EXPECT_TRUE(contains(finding_of(one, 0).found, "it has a mission key and this host has none"));
  EXPECT_EQ(finding_of(one, 0).level, Level::kWarning);
  EXPECT_TRUE(contains(finding_of(one, 0).remedy, "--key-file"));
  EXPECT_EQ(finding_of(one, 8).level, Level::kOk);
}

TEST(PeerFindings, DuplicatesAreANote) {
  Peer twice = peer({150, 50});
  twice.duplicates = 7;
  EXPECT_EQ(finding_of(twice).level, Level::kNote);
}

TEST(PeerFindings, AHostThatOnlyOthersReceiveIsAProblem) {
  const auto findings = peer_findings(url_of("ttl=1"), {{peer({150, 50})}, 1, 200, ""}, "0.1.0");
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[1].level, Level::kProblem);
}

}  // namespace
}  // namespace ergocast::doctor
