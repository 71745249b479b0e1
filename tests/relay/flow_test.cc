// SPDX-License-Identifier: BSD-3-Clause
// Sites and hubs as values: which sites join, what is carried, and what is not.
#include <algorithm>

#include "tests/relay/small_network.h"

namespace ergocast::relay {
namespace {

struct Relays : ::testing::Test {
  SmallNetwork network;
};

TEST_F(Relays, CarryADatagramUnchangedToAllOtherSites) {
  network.add_hub(1);
  for (const int host : {2, 3, 4}) network.add_site(host, {1}, host);
  network.settle();
  const Datagram sent = datagram_of(status(1), key(1));
  network.send(2, sent);
  EXPECT_TRUE(network.arrived(2).empty());
  EXPECT_EQ(network.arrived(3), std::vector<Datagram>(1, sent));
  EXPECT_EQ(network.arrived(4), std::vector<Datagram>(1, sent));
}

TEST_F(Relays, DoNotCarryWhatHasAnotherKey) {
  network.add_hub(1);
  network.add_site(2, {1}, 2);
  network.add_site(3, {1}, 3);
  network.settle();
  network.send(2, datagram_of(status(1), key(2)));
  network.send(2, datagram_of(status(2), {}));
  EXPECT_TRUE(network.arrived(3).empty());
}

TEST_F(Relays, CarryCommandsOnlyToSitesWhereAProcessReceivesThem) {
  network.add_hub(1);
  for (const int host : {2, 3, 4, 5}) network.add_site(host, {1}, host);
  network.settle();
  std::int64_t sequence = 0;
  const auto send = [&](int site, Message message, Bus bus) {
    std::visit([&](auto& m) { m.header.sequence = ++sequence; }, message);
    network.send(site, datagram_of(message, key(1)), bus);
  };
  const auto commands_at = [&] {
    for (const int site : {2, 3, 4, 5}) network.arrived(site).clear();
    Command command = test::command();
    for (const Incarnation asked_by : {0, 7}) {
      command.asked_by = asked_by;
      send(5, command, Bus::kCommand);
    }
    std::vector<std::size_t> counts;
    for (const int site : {2, 3, 4}) counts.push_back(network.arrived(site).size());
    return counts;
  };
  const std::vector<std::size_t> all{2, 2, 2}, few{2, 0, 2};
  network.pass(11s);
  EXPECT_EQ(commands_at(), all) << "nobody knows where the world is";
  send(2, test::world_state(), Bus::kWorld);
  send(4, test::record_ack(), Bus::kCommand);
  EXPECT_EQ(commands_at(), few);
  network.add_site(6, {1}, 6);
  network.settle();
  EXPECT_EQ(commands_at(), few);
  EXPECT_EQ(network.arrived(6).size(), 2U) << "a new site may have a world that has yet to send";
  network.pass(11s);
  EXPECT_EQ(commands_at(), all) << "the world may have moved to another site";
}

TEST_F(Relays, CarryACopyOnlyAfterASecond) {
  network.add_hub(1);
  network.add_site(2, {1}, 2);
  network.add_site(3, {1}, 3);
  network.settle();
  const Datagram sent = datagram_of(status(1), key(1));
  network.send(2, sent);
  network.pass(900ms);
  network.send(2, sent);
  EXPECT_EQ(network.arrived(3).size(), 1U);
  network.pass(200ms);
  network.send(2, sent);
  EXPECT_EQ(network.arrived(3).size(), 2U);
}

TEST_F(Relays, TwoAtOneSiteMakeNoCircleAndNoDoubles) {
  network.add_hub(1);
  network.add_site(2, {1}, 10);
  network.add_site(3, {1}, 10);
  network.add_site(4, {1}, 20);
  network.settle();
  for (std::int64_t i = 1; i <= 5; ++i) {
    network.send(10, datagram_of(status(2 * i), key(1)));
    network.send(20, datagram_of(status(2 * i + 1), key(1)));
  }
  EXPECT_EQ(network.arrived(10).size(), 5U);
  EXPECT_EQ(network.arrived(20).size(), 5U);
  const std::int64_t before = network.packets;
  network.pass(30s);
  EXPECT_LE(network.packets - before, 30 * 3 * 2) << "nothing but pings";
}

TEST_F(Relays, AnEchoIsNotCarriedBackHoweverLateItComes) {
  network.add_hub(1);
  network.add_site(2, {1}, 2);
  Site& late = network.add_site(3, {1}, -3);
  network.settle();
  const Datagram sent = datagram_of(status(1), key(1));
  network.send(2, sent);
  ASSERT_EQ(network.arrived(-3).size(), 1U);
  network.pass(20s);
  late.take_local(Bus::kSwarm, sent, network.now);
  network.settle();
  EXPECT_EQ(network.arrived(2).size(), 0U);
  late.take_local(Bus::kSwarm, sent, network.now);
  network.settle();
  EXPECT_EQ(network.arrived(2).size(), 1U) << "a repeat by somebody else";
}

TEST_F(Relays, ALostEchoHidesNoRepeatAMinuteLater) {
  network.add_hub(1);
  network.add_site(2, {1}, 2);
  Site& deaf = network.add_site(3, {1}, -3);
  network.settle();
  const Datagram sent = datagram_of(test::stop(), key(1));
  network.send(2, sent);
  ASSERT_EQ(network.arrived(-3).size(), 1U);
  network.pass(Echoes::kTime, 1s);
  deaf.take_local(Bus::kSwarm, sent, network.now);
  network.settle();
  EXPECT_EQ(network.arrived(2).size(), 1U);
}

TEST_F(Relays, ACutOffSiteCarriesOnWithWhatIsNewOnceThePathIsBack) {
  network.add_hub(1);
  Site& site = network.add_site(2, {1}, 2);
  network.add_site(3, {1}, 3);
  network.settle();
  network.cut(true);
  network.pass(30s);
  EXPECT_FALSE(site.joined());
  network.send(2, datagram_of(status(1), key(1)));
  network.cut(false);
  network.pass(5s);
  EXPECT_TRUE(site.joined());
  EXPECT_TRUE(network.arrived(3).empty());
  network.send(2, datagram_of(status(2), key(1)));
  EXPECT_EQ(network.arrived(3).size(), 1U);
  EXPECT_EQ(site.counts().no_path, 1);
}

TEST_F(Relays, GiveTheStopsOfTheLastMinuteToASiteThatJoins) {
  network.add_hub(1);
  network.add_site(2, {1}, 2);
  network.settle();
  const Datagram stop = datagram_of(test::stop(), key(1));
  network.send(2, stop);
  network.send(2, datagram_of(status(1), key(1)));
  network.pass(30s);
  network.add_site(3, {1}, 3);
  network.settle();
  EXPECT_EQ(network.arrived(3), std::vector<Datagram>(1, stop)) << "as soon as there is a path";
  network.pass(20s);
  const std::size_t given = network.arrived(3).size();
  EXPECT_GE(given, 4U) << "again, because packets are lost";
  EXPECT_LE(given, 7U);
  network.pass(11s);
  network.add_site(4, {1}, 4);
  network.settle();
  EXPECT_TRUE(network.arrived(4).empty()) << "it is too old";
}

TEST_F(Relays, AStopOfASiteThatIsCutOffPassesOnceThePathIsBack) {
  network.add_hub(1);
  network.add_site(3, {1}, 3);
  Site& site = network.add_site(2, {1}, 2);
  network.settle();
  network.cut(true);
  network.pass(30s);
  ASSERT_FALSE(site.joined());
  network.send(2, datagram_of(test::stop(), key(1)));
  network.cut(false);
  network.pass(5s);
  ASSERT_TRUE(site.joined());
  EXPECT_GE(network.arrived(3).size(), 1U);
}

TEST_F(Relays, AShortCutHidesNoStop) {
  network.add_hub(1);
  network.add_site(2, {1}, 2);
  Site& site = network.add_site(3, {1}, 3);
  network.settle();
  network.cut(true);
  network.pass(2s);
  network.pass(4s);
  ASSERT_FALSE(site.joined());
  network.cut(false);
  network.send(2, datagram_of(test::stop(), key(1)));
  network.pass(3s);
  EXPECT_GE(network.arrived(3).size(), 1U);
}

TEST_F(Relays, WhatASiteCouldNotSendIsNoCopyOnceThePathIsBack) {
  network.add_hub(1);
  network.add_site(3, {1}, 3);
  network.settle();
  Site& site = network.add_site(2, {1}, 2);
  const Datagram sent = datagram_of(status(1), key(1));
  network.send(2, sent);
  ASSERT_TRUE(site.joined());
  ASSERT_EQ(site.counts().no_path, 1);
  network.send(2, sent);
  EXPECT_EQ(network.arrived(3).size(), 1U);
}

TEST_F(Relays, AHubReportsLossesOfWhatASiteHasCounted) {
  const Hub::Settings with_group{
      .has_group = true, .most_bytes_per_s = 0, .others = false, .secret = {}};
  Hub& hub = network.add_hub(1, key(1), with_group);
  network.add_site(2, {1}, 2);
  network.settle();
  const auto send = [&](std::int64_t sequence) {
    hub.take_local(Bus::kSwarm, datagram_of(status(sequence), key(1)), network.now);
    network.settle();
  };
  const auto report_has = [&](const std::string& loss) {
    return hub.report(network.now).find(loss + " % from it") != std::string::npos;
  };
  for (int i = 0; i < 3; ++i) {
    send(1 + i);
    EXPECT_TRUE(report_has(" 0.0")) << hub.report(network.now);
    network.pass(700ms);
  }
  network.cut(true);
  send(4);
  network.cut(false);
  network.pass(3s);
  EXPECT_TRUE(report_has(" 25.0")) << hub.report(network.now);
}

TEST_F(Relays, ASiteWithANewAddressJoinsAgainAndTakesNoSecondPlace) {
  Hub& hub = network.add_hub(1);
  network.add_site(2, {1}, 2);
  network.add_site(3, {1}, 3);
  network.settle();
  network.move_site(0, 9);
  network.pass(3s);
  network.send(3, datagram_of(status(1), key(1)));
  EXPECT_EQ(network.arrived(2).size(), 1U);
  EXPECT_EQ(hub.sites(), 2U);
}

TEST_F(Relays, SitesJoinARestartedHubAgain) {
  network.add_hub(1);
  network.add_site(2, {1}, 2);
  network.add_site(3, {1}, 3);
  network.settle();
  network.add_hub(1);
  network.pass(3s);
  network.send(3, datagram_of(status(1), key(1)));
  EXPECT_EQ(network.arrived(2).size(), 1U);
}

TEST_F(Relays, SitesMeetAtTheNextHubAndReturnToTheFirst) {
  network.add_hub(1);
  network.add_hub(5);
  Site& two = network.add_site(2, {1, 5}, 2);
  Site& three = network.add_site(3, {1, 5}, 3);
  network.settle();
  network.stop_hub(1);
  network.pass(20s);
  EXPECT_EQ(two.joined(), 1U);
  network.send(3, datagram_of(status(1), key(1)));
  EXPECT_EQ(network.arrived(2).size(), 1U);
  network.add_hub(1);
  network.pass(30s);
  EXPECT_EQ(two.joined(), 0U);
  EXPECT_EQ(three.joined(), 0U);
}

TEST_F(Relays, APeerPutsWhatSitesSendIntoItsOwnGroup) {
  Hub peer({.has_group = true, .most_bytes_per_s = 0, .others = false, .secret = {}}, key(1));
  Site site({}, key(1), 7);
  Outbox up, down;
  site.advance(network.now, up);
  site.found({address(1)}, network.now);
  for (int turn = 0; turn < 4; ++turn) {
    site.advance(network.now, up);
    for (const Packet& packet : up.packets) {
      peer.receive(packet.bytes, address(2), network.now, down);
    }
    for (const Packet& packet : down.packets) {
      site.receive(packet.bytes, address(1), network.now, up);
    }
    up = {}, down.packets = {};
    network.now += 500ms;
  }
  ASSERT_TRUE(site.joined());
  site.take_local(Bus::kWorld, datagram_of(status(1), key(1)), network.now);
  site.advance(network.now, up);
  for (const Packet& packet : up.packets) {
    peer.receive(packet.bytes, address(2), network.now, down);
  }
  ASSERT_EQ(down.group.size(), 1U);
  EXPECT_EQ(down.group[0].bus, Bus::kWorld);
  peer.take_local(Bus::kWorld, datagram_of(status(1), key(1)), network.now + 5s);
  Outbox back;
  peer.advance(network.now, back);
  EXPECT_TRUE(back.packets.empty()) << "an echo";
}

// ---- strangers ----

TEST_F(Relays, ARecordedPingFromAnotherAddressDoesNotEndAFlow) {
  Hub hub({}, key(1));
  Site site({}, key(1), 7);
  int joined = 0, turns = 0;
  const Seal seal(key(1).key());
  for (; turns < 100; ++turns, network.now += 100ms) {
    Outbox up, down, stolen, none;
    site.advance(network.now, up);
    if (site.wanted_hub()) site.found({address(1)}, network.now);
    for (const Packet& packet : up.packets) {
      // The stranger is faster than the site.
      if (std::holds_alternative<Ping>(*seal.read(packet.bytes))) {
        hub.receive(packet.bytes, address(66), network.now, stolen);
      }
      hub.receive(packet.bytes, address(2), network.now, down);
    }
    for (const Outbox& answers : {stolen, down}) {
      for (const Packet& packet : answers.packets) {
        site.receive(packet.bytes, address(1), network.now, none);
        if (joined > 0) EXPECT_TRUE(site.joined()) << turns;
      }
    }
    joined += site.joined() ? 1 : 0;
  }
  EXPECT_GT(joined, 90);
}

struct Strangers : ::testing::Test {
  Instant now{1000s};
  Hub hub{{}, key(1)};
  Seal seal{key(1).key()}, other{key(2).key()}, none{nullptr};

  std::vector<Packet> answers(const std::vector<std::byte>& packet, const Address& from) {
    Outbox out;
    hub.receive(packet, from, now, out);
    return out.packets;
  }
  CookieBytes cookie_for(const Address& from, SiteId site) {
    const auto packets = answers(seal.write(Ask{site, 5}), from);
    return std::get<Cookie>(*seal.read(packets.at(0).bytes)).cookie;
  }
};

TEST_F(Strangers, WithoutTheKeyGetNoAnswer) {
  for (const Seal& theirs : {other, none}) {
    EXPECT_TRUE(answers(theirs.write(Ask{1, 2}), address(2)).empty());
    EXPECT_TRUE(answers(theirs.write(Ping{1, 2, {}, 0}), address(2)).empty());
    EXPECT_TRUE(answers(theirs.write(Join{1, 2, {}, 0}), address(2)).empty());
    EXPECT_TRUE(answers(theirs.write(Question{}), address(2)).empty());
  }
  EXPECT_TRUE(answers(datagram_of(status(1), key(1)), address(2)).empty());
}

TEST_F(Strangers, GetNoLongerAnswerThanARecordingThatTheySend) {
  for (const Control& control :
       std::vector<Control>{Ask{1, 2}, Ping{1, 2, {}, 0}, Join{1, 2, {}, 0}, Leave{1, 2}}) {
    const auto packet = seal.write(control);
    for (const Packet& answer : answers(packet, address(9))) {
      EXPECT_LE(answer.bytes.size(), packet.size());
    }
  }
  const auto question = seal.write(Question{5, cookie_for(address(2), 5)});
  const auto report = answers(question, address(2));
  ASSERT_EQ(report.size(), 1U);
  EXPECT_LE(report[0].bytes.size(), question.size());
  EXPECT_GE(question.size(), seal.write(Report{5, std::string(kMaxReportLength, 'x')}).size());
}

TEST_F(Strangers, TakeNoPlaceWithACookieOfAnotherAddressOrOfLongAgo) {
  const CookieBytes cookie = cookie_for(address(2), 8);
  answers(seal.write(Join{8, 1, cookie, 0}), address(3));
  answers(seal.write(Join{9, 1, cookie, 0}), address(2));
  EXPECT_EQ(hub.sites(), 0U);
  now += CookieJar::kCookieTime;
  answers(seal.write(Join{8, 1, cookie, 0}), address(2));
  EXPECT_EQ(hub.sites(), 0U);
  answers(seal.write(Join{8, 1, cookie_for(address(2), 8), 0}), address(2));
  EXPECT_EQ(hub.sites(), 1U);
}

TEST_F(Strangers, CannotKeepAFlowOpenWithRecordings) {
  answers(seal.write(Join{8, 1, cookie_for(address(2), 8), 0}), address(2));
  const auto ping = seal.write(Ping{8, 2, {}, 0});
  EXPECT_EQ(answers(ping, address(2)).size(), 1U);
  for (int second = 0; second < 11; ++second) {
    now += 1s;
    EXPECT_TRUE(answers(ping, address(2)).empty());
  }
  Outbox out;
  hub.advance(now, out);
  EXPECT_EQ(hub.sites(), 0U);
}

TEST_F(Strangers, AddNothingToTheCountsAndNothingBehindAForgery) {
  for (const int site : {2, 3}) {
    answers(seal.write(Join{SiteId(site), 1, cookie_for(address(site), SiteId(site)), 0}),
            address(site));
  }
  const Datagram forged = datagram_of(status(1), key(2)), honest = datagram_of(status(2), key(1));
  std::vector<std::byte> packet;
  append_frame(packet, Bus::kSwarm, forged);
  append_frame(packet, Bus::kSwarm, honest);
  EXPECT_TRUE(answers(packet, address(2)).empty());
  Outbox out;
  hub.advance(now, out);
  EXPECT_TRUE(out.packets.empty());
  // The site has sent two packets by now, and neither has arrived.
  answers(seal.write(Ping{2, 2, {.packets_sent = 2}, 0}), address(2));
  EXPECT_NE(hub.report(now).find("lost 100.0 % to the hub"), std::string::npos) << hub.report(now);
}

TEST_F(Strangers, AndMembersReadInAReportHowManySitesItLeavesOut) {
  constexpr int kSites = 60;
  for (int i = 0; i < kSites; ++i) {
    const auto site = static_cast<SiteId>(i + 1);
    answers(seal.write(Join{site, 1, cookie_for(address(i), site), 0}), address(i));
  }
  const std::string report = hub.report(now);
  EXPECT_LE(report.size(), static_cast<std::size_t>(kMaxReportLength));
  const auto named = std::count(report.begin(), report.end(), ';');
  EXPECT_TRUE(report.ends_with("; and " + std::to_string(kSites - named) + " more")) << report;
}

TEST_F(Strangers, ManyJoinNoMoreThanThereArePlaces) {
  for (int i = 0; i < static_cast<int>(Hub::kMostSites) + 20; ++i) {
    const Address from = address(i % 256, static_cast<std::uint16_t>(1000 + i));
    const auto site = static_cast<SiteId>(i + 1);
    answers(seal.write(Join{site, 1, cookie_for(from, site), 0}), from);
  }
  EXPECT_EQ(hub.sites(), Hub::kMostSites);
}

}  // namespace
}  // namespace ergocast::relay
