// SPDX-License-Identifier: BSD-3-Clause
// A recorded mission is replayed by `ergocast replay`, or on one URL as by LCM's player: displays
// show all of it, and no other process takes part.
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <map>
#include <memory>
#include <set>

#include "lcmtypes/codec.h"
#include "runtime/bus/lcm_url.h"
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

using Replay = ByHand;

TEST_F(Replay, ShowsTheWholeTeamAndItsEnd) {
  // In real time, so that the log has the same duration on any machine.
  ASSERT_EQ(ergocast({"run", scenario_file("quadrimodal_corners"), "--realtime", "--duration", "8",
                      "--out", out()}),
            0)
      << output();
  Program& watch = hand("ergocast", {"status", "--watch"});
  ASSERT_TRUE(watch.prints("no message yet on ")) << watch.printed();
  Child player = begin({"/usr/bin/lcm-logplayer", std::string("--lcm-url=") + kUrl,
                        (out() / "events-000.lcm").string()});
  EXPECT_EQ(wait_for(watch.child), 0) << watch.printed();
  const std::string printed = watch.printed();
  for (const char* process : {"coordinator  alive", "world        alive", "logger       alive"}) {
    EXPECT_NE(printed.find(process), std::string::npos) << printed;
  }
  // An ended mission is not running, although its messages are recent.
  const std::string end = printed.substr(printed.rfind("quadrimodal_corners, run "));
  EXPECT_NE(end.find("the mission has ended"), std::string::npos) << end;
  EXPECT_EQ(end.find("alive"), std::string::npos) << end;
  EXPECT_NE(end.find("world        ended"), std::string::npos) << end;
  wait_for(player);
}

/// Every channel on the three buses of a URL.
class Channels {
 public:
  explicit Channels(const LcmUrl& url) {
    for (const Bus bus : {Bus::kSwarm, Bus::kWorld, Bus::kCommand}) {
      buses_.push_back(std::make_unique<lcm::LCM>(url.of(bus)));
      buses_.back()->subscribe(".*", &Channels::receive, this);
    }
  }
  const std::set<std::string>& take() {
    for (auto& bus : buses_) {
      while (bus->handleTimeout(0) > 0) {
      }
    }
    return names_;
  }

 private:
  void receive(const lcm::ReceiveBuffer*, const std::string& channel) { names_.insert(channel); }
  std::vector<std::unique_ptr<lcm::LCM>> buses_;
  std::set<std::string> names_;
};

TEST_F(Replay, OfTheCommandIsShownAsAReplayThatCannotBeJoinedOrStopped) {
  ASSERT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--duration", "600",
                      "--event-log", "--out", out()}),
            0)
      << output();
  Program& agent = hand("ergocast-agent");
  ASSERT_TRUE(agent.prints("joining on "));
  Channels channels(LcmUrl::parse(kUrl).value());
  Program& replay = hand("ergocast", {"replay", out(), "--from", "100", "--rate", "2"});
  ASSERT_TRUE(replay.prints("replay of quadrimodal_corners from "));
  nlohmann::json status;
  ASSERT_TRUE(eventually([&] {
    ergocast({"status", "--json", "--lcm-url", kUrl});
    status = nlohmann::json::parse(output(), nullptr, false);
    return status.is_object() && status["tick"] > 1010 && status["agents_alive"] == 4;
  })) << output();
  EXPECT_EQ(status["replay"], true);
  EXPECT_EQ(status["trouble"], false) << status;
  EXPECT_EQ(status["scenario"], "quadrimodal_corners");
  EXPECT_EQ(ergocast({"status", "--lcm-url", kUrl}), 0) << output();
  EXPECT_TRUE(output().starts_with("replay of quadrimodal_corners, run ")) << output();
  for (const char* option : {"--now", "--lcm-url"}) {
    std::vector<std::string> words{"stop", "--lcm-url", kUrl};
    if (option == std::string("--now")) words.emplace_back(option);
    EXPECT_EQ(ergocast(words), 4);
    EXPECT_NE(output().find("are a replay of run "), std::string::npos) << output();
    EXPECT_NE(output().find("no team is there to obey"), std::string::npos) << output();
  }
  EXPECT_EQ(ergocast({"pause", "--lcm-url", kUrl}), 4);
  EXPECT_NE(output().find("are a replay of run "), std::string::npos) << output();
  EXPECT_EQ(ergocast({"replay", out(), "--lcm-url", kUrl}), 2);
  EXPECT_NE(output().find("a team or another replay sends here"), std::string::npos) << output();
  EXPECT_GE(channels.take().size(), 15U);
  for (const std::string& name : channels.take()) {
    EXPECT_TRUE(name.starts_with("REPLAYED_") || name == "LCM_SELF_TEST") << name;
  }
  replay.child.send(SIGINT);
  EXPECT_EQ(wait_for(replay.child), 0) << replay.printed();
  EXPECT_EQ(agent.printed().find("run "), std::string::npos) << agent.printed();
}

TEST_F(Replay, RefusesWhatIsNoRecordWithAPlaceAndARemedy) {
  const auto expect = [&](std::vector<std::string> words, const std::string& part) {
    words.insert(words.begin(), {"replay", out().string()});
    EXPECT_EQ(ergocast(words), 2) << output();
    EXPECT_NE(output().find(part), std::string::npos) << output();
  };
  expect({}, "plan.binpb: missing or not readable: is this a run directory?");
  ASSERT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--duration", "5", "--out",
                      out()}),
            0);
  expect({}, "has no event log (events-000.lcm …); `ergocast run` writes one");
  std::filesystem::remove_all(out());
  ASSERT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--duration", "5",
                      "--event-log", "--out", out()}),
            0);
  expect({"--from", "6"}, "--from: the record ends at 5 s; give an earlier time");
  expect({"--lcm-url", "udpm://239.255.76.67:24700?ttl=1"}, "a replay stays on this host");
  // A byte of the first message.
  std::fstream file(out() / "events-000.lcm", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(120);
  file.put('!');
  file.close();
  expect({"--rate", "1000"}, "events-000.lcm, byte 0: not a message of this run (tag)");
}

/// The positions of each tick in a log, and its channels.
struct Logged {
  std::set<std::string> channels;
  std::map<Tick, std::vector<Eigen::Vector3d>> positions_m;

  explicit Logged(const std::filesystem::path& file) {
    lcm::LogFile log(file, "r");
    EXPECT_TRUE(log.good());
    while (const lcm::LogEvent* event = log.readNextEvent()) {
      channels.insert(event->channel);
      const auto decoded = decode(
          {static_cast<const std::byte*>(event->data), static_cast<std::size_t>(event->datalen)},
          0);
      EXPECT_TRUE(decoded) << event->channel;
      const auto* world = decoded ? std::get_if<WorldState>(&*decoded) : nullptr;
      if (world == nullptr) continue;
      auto& places = positions_m[world->header.tick];
      places.clear();
      for (int i = 0; i < world->vehicle_count; ++i)
        places.push_back(world->vehicles[static_cast<std::size_t>(i)].position_m);
    }
  }
};

TEST_F(Replay, ASimulationsEventLogHasTheMessagesOfARun) {
  for (const char* command : {"run", "simulate"}) {
    std::vector<std::string> words{command,      scenario_file("quadrimodal_corners"),
                                   "--duration", "20",
                                   "--out",      folder_ / command};
    if (command == std::string("simulate")) words.emplace_back("--event-log");
    ASSERT_EQ(ergocast(words), 0) << output();
  }
  Logged flown(folder_ / "run" / "events-000.lcm");
  const Logged simulated(folder_ / "simulate" / "events-000.lcm");
  flown.channels.erase("ERGOCAST_HELLO_NEW");
  EXPECT_EQ(simulated.channels, flown.channels);
  EXPECT_EQ(simulated.positions_m.size(), 201U);
  EXPECT_EQ(simulated.positions_m, flown.positions_m);
  EXPECT_EQ(ergocast({"verify", folder_ / "simulate"}), 0) << output();
}

}  // namespace
}  // namespace ergocast::test
