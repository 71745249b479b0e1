// SPDX-License-Identifier: BSD-3-Clause
// Floods on the buses of a team, which continues its mission.
#include <lcm/lcm-cpp.hpp>
#include <map>

#include "lcmtypes/codec.h"
#include "runtime/bus/socket.h"
#include "runtime/process/key_file.h"
#include "team/messages.h"
#include "tests/process/support/bus_observer.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/replayer.h"

namespace ergocast::test {
namespace {

/// Resident memory of a process [kB].
long resident_kb(pid_t pid) {
  const std::string status = text_of("/proc/" + std::to_string(pid) + "/status");
  const auto at = status.find("VmRSS:");
  return at == status.npos ? 0 : std::stol(status.substr(at + 6));
}

class Flood : public RunningMission {
 protected:
  /// Short LCM messages under 100 000 unknown channel names, on one bus.
  static void send_foreign_names(Bus bus, const std::string& stem) {
    const LcmUrl url = LcmUrl::parse(kUrl).value();
    const Socket socket(AF_INET, SOCK_DGRAM);
    const sockaddr_in to = address_of(url.group, url.base_port + static_cast<int>(bus));
    for (int i = 0; i < 100000; ++i) {
      const std::string bytes =
          std::string("LC02\0\0\0\1", 8) + stem + std::to_string(i) + std::string(20, '\0');
      sendto(socket.fd(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
             sizeof to);
      if (i % 50 == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));  // so that all are received
    }
  }
  /// A message on a channel of ours, but fifty times as long as any valid one.
  static void send_long_datagrams(Bus bus) {
    const LcmUrl url = LcmUrl::parse(kUrl).value();
    const Socket socket(AF_INET, SOCK_DGRAM);
    const sockaddr_in to = address_of(url.group, url.base_port + static_cast<int>(bus));
    const std::string bytes =
        std::string("LC02\0\0\0\1ERGOCAST_HELLO", 22) + std::string(60000, '\0');
    for (int i = 0; i < 20000; ++i) {
      sendto(socket.fd(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
             sizeof to);
    }
  }
};

TEST_F(Flood, OfDatagramsLongerThanOursCostsNoMemory) {
  Child mission = launch_endless(scenario(), {"--realtime=5", "--lcm-url", kUrl});
  const pid_t who = pids(agent(0)).front();
  const long before_kb = resident_kb(who);
  send_long_datagrams(Bus::kSwarm);
  EXPECT_LT(resident_kb(who) - before_kb, 2000);
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(Flood, NamesOfForeignChannelsCostNoMemory) {
  constexpr long kGrowth_kb = 2000;
  Child mission = launch_endless(scenario(), {"--realtime=5", "--lcm-url", kUrl});
  const pid_t who[] = {pids(agent(0)).front(), pids({"ergocast-logger"}).front()};
  const long before[] = {resident_kb(who[0]), resident_kb(who[1])};
  send_foreign_names(Bus::kSwarm, "ERGOCAST_CONTRIBUTION_X");
  send_foreign_names(Bus::kWorld, "SOMEBODY_ELSES_");
  for (const int i : {0, 1}) {
    const long grown_kb = resident_kb(who[i]) - before[i];
    RecordProperty(i == 0 ? "agent_grown_kb" : "logger_grown_kb", std::to_string(grown_kb));
    EXPECT_LT(grown_kb, kGrowth_kb) << (i == 0 ? "agent" : "logger");
  }
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["restarts"], 0);
}

/// Repeats agent 3's messages far too often, or sends new ones in its name as often.
class RateOffender {
 public:
  RateOffender(const std::string& url, bool in_its_place)
      : bus_(LcmUrl::parse(url).value().of(Bus::kSwarm)), in_its_place_(in_its_place) {
    bus_.subscribe("ERGOCAST_AGENT_STATUS_3", &RateOffender::receive, this)->setQueueCapacity(0);
  }
  void exceed_rate() {
    bus_.handleTimeout(5);
    for (int i = 0; i < 50 && !bytes_.empty(); ++i) {
      if (in_its_place_) renew();
      bus_.publish("ERGOCAST_AGENT_STATUS_3", bytes_.data(), static_cast<unsigned>(bytes_.size()));
    }
  }
  bool has_received() const { return !bytes_.empty(); }

 private:
  void receive(const lcm::ReceiveBuffer* received, const std::string& /*channel*/) {
    const auto* data = static_cast<const std::byte*>(received->data);
    if (bytes_.empty()) bytes_.assign(data, data + received->data_size);
  }
  /// The same message under the next sequence.
  void renew() {
    auto status = std::get<AgentStatus>(decode(bytes_, 0).value());
    ++status.header.sequence;
    encode(status, bytes_);
  }

  lcm::LCM bus_;
  bool in_its_place_;
  std::vector<std::byte> bytes_;
};

/// A busy machine may make an agent late.
bool is_alive(const nlohmann::json& agent) {
  return agent["state"] == "ok" || agent["state"] == "late";
}

class Babble : public Flood {
 protected:
  /// The agents' part of `ergocast status`.
  nlohmann::json agents() {
    ergocast({"status", "--json", "--lcm-url", kUrl});
    return nlohmann::json::parse(output())["agents"];
  }
};

TEST_F(Babble, AnAgentThatSendsAHundredTimesAsMuchIsLimitedAndNamedAndTheTeamGoesOn) {
  Child mission = launch_endless(scenario(), {"--realtime=1", "--lcm-url", kUrl});
  for (const auto& agent : agents()) EXPECT_EQ(agent["refused"]["rate"], 0) << agent;
  RateOffender rate_offender(kUrl, true);
  ASSERT_TRUE(
      eventually([&] { return rate_offender.exceed_rate(), rate_offender.has_received(); }));
  signal_to(agent(3), SIGSTOP);
  ASSERT_TRUE(eventually([&] {
    rate_offender.exceed_rate();
    return log_of("agent-0").find("agent 3 sends more than eight times") != std::string::npos;
  })) << log_of("agent-0");
  for (const auto& agent : agents()) {
    if (agent["id"] == 3) continue;
    EXPECT_GT(agent["refused"]["rate"], 0) << agent;
    EXPECT_EQ(agent["babbler"], 3) << agent;
    EXPECT_TRUE(is_alive(agent)) << agent;
  }
  EXPECT_TRUE(moves_on(10000));
  signal_to(agent(3), SIGCONT);
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["restarts"], 0);
}

TEST_F(Babble, WhatOthersRepeatOfAnAgentIsLimitedAndNotItsFault) {
  Child mission = launch_endless(scenario(), {"--realtime=1", "--lcm-url", kUrl});
  RateOffender rate_offender(kUrl, false);
  ASSERT_TRUE(eventually([&] {
    rate_offender.exceed_rate();
    return log_of("agent-0").find("rate=") != std::string::npos;
  })) << log_of("agent-0");
  for (const auto& agent : agents()) {
    EXPECT_TRUE(agent["babbler"].is_null()) << agent;
    EXPECT_TRUE(is_alive(agent)) << agent;
  }
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(log_of("coordinator").find("silent"), std::string::npos) << log_of("coordinator");
}

/// A team with a key, and a process without it that repeats the received messages.
class FloodOfRepeats : public Flood, public ::testing::WithParamInterface<const char*> {
 protected:
  FloodOfRepeats() {
    const MissionKey key = make_mission_key();
    EXPECT_EQ(write_key_file(key_file_, key_text(key, true)), std::nullopt);
  }
  /// Messages that agents refused as `rate`, as they report themselves.
  std::int64_t refused_by_agents() {
    ergocast({"status", "--json", "--lcm-url", kUrl, "--key-file", key_file_});
    std::int64_t refused = 0;
    const auto team = nlohmann::json::parse(output());
    for (const auto& agent : team["agents"]) {
      refused += agent["refused"]["rate"].get<std::int64_t>();
    }
    return refused;
  }
  const std::filesystem::path key_file_ = folder_ / "c.key";
};

/// Without the detection of repeats all would be accepted: neither the world nor the coordinator
/// has a limit of rate. The speed of the machine only affects the duration.
TEST_P(FloodOfRepeats, IsCutByTheKernelAndTheTeamGoesOn) {
  constexpr std::int64_t kEnough = 50000;
  constexpr std::size_t kAtOnce = 200;  // every 5 ms at the most: 40 000 a second
  Child mission =
      launch_endless(scenario(), {"--realtime=5", "--key-file", key_file_, "--lcm-url", kUrl});
  Replayer replayer(LcmUrl::parse(kUrl).value(), GetParam());
  ASSERT_TRUE(eventually([&] { return replayer.listen(), replayer.kept() >= 4; }));
  std::int64_t refused = 0;
  ASSERT_TRUE(eventually([&] {
    replayer.replay(2 * kEnough);
    return (refused = refused_by_agents()) >= kEnough;
  })) << refused
      << " refused\n"
      << log_of("agent-0");
  ASSERT_TRUE(eventually([&, from = recorded_bytes()] {
    replayer.replay(kAtOnce);
    return recorded_bytes() > from + 30000;
  })) << "stands still\n"
      << printed();
  // A new coordinator asks the agents for the mission, whose parts are repeats, too.
  const pid_t first = pids({"ergocast-coordinator"}).front();
  kill(first, SIGKILL);
  EXPECT_TRUE(eventually([&] {
    replayer.replay(kAtOnce);
    return log_of("coordinator").find("taken over") != std::string::npos;
  })) << log_of("coordinator");
  EXPECT_TRUE(moves_on()) << printed();
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["restarts"], 1) << "the test's own";
  EXPECT_EQ(summary()["messages"]["refused"]["range"], 0);
}

INSTANTIATE_TEST_SUITE_P(Of, FloodOfRepeats, ::testing::Values("MISSION", "WORLD_STATE"),
                         [](const auto& of) { return std::string(of.param); });

/// Resident memory after a while and much later. ERGOCAST_LONG_TICKS makes the mission longer.
TEST_F(Flood, MemoryIsFlatHoweverLongTheMissionIs) {
  constexpr long kGrowth_kb = 1024;
  constexpr Tick kWarmUp = 3000;
  const char* longer = std::getenv("ERGOCAST_LONG_TICKS");
  const Tick ticks = longer != nullptr ? std::stoll(longer) : 9000;
  Child mission = launch_endless(scenario("broadcast_period_ticks: 5"),
                                 {"--lcm-url", kUrl, "--event-log-limit", "128"});
  kill_next(agent(2));
  BusObserver observer(kUrl);
  const auto run_to = [&observer](Tick tick) {
    return observer.observes([&] { return observer.answered(observer.member(0)) >= tick; });
  };
  ASSERT_TRUE(run_to(kWarmUp)) << printed();
  std::map<std::string, std::pair<pid_t, long>> before;
  for (const char* program :
       {"ergocast-logger", "ergocast-sim", "ergocast-coordinator", "--id 0", "--id 2"}) {
    const auto found = pids({program, "--run-id"});
    ASSERT_EQ(found.size(), 1U) << program;
    before[program] = {found.front(), resident_kb(found.front())};
  }
  for (Tick tick = kWarmUp; tick < ticks; tick += 3000)
    ASSERT_TRUE(run_to(tick + 3000)) << printed();
  for (const auto& [program, at] : before) {
    const long grown_kb = resident_kb(at.first) - at.second;
    RecordProperty(program + "_grown_kb", std::to_string(grown_kb));
    EXPECT_LT(grown_kb, kGrowth_kb) << program;
  }
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["messages"]["refused"]["rate"], 0);
}

}  // namespace
}  // namespace ergocast::test
