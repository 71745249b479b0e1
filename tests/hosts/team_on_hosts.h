// SPDX-License-Identifier: BSD-3-Clause
// Programs on several hosts, each with its own network stack, started as people would start them.
#pragma once

#include <optional>

#include "tests/process/support/bus_observer.h"
#include "tests/process/support/mission.h"
#include "tests/support/lan.h"

namespace ergocast::test {

/// Three hosts on one network. Skipped where there is no root to make them.
class OnHosts : public ByHand {
 protected:
  OnHosts() { url_ = "udpm://239.255.76.67:24700?ttl=1"; }

  void SetUp() override {
    try {
      lan_.emplace(3);
    } catch (const std::runtime_error& error) {
      if (!is_root()) GTEST_SKIP() << "needs root: " << error.what();
      FAIL() << error.what();
    }
  }
  void TearDown() override {
    ByHand::TearDown();
    if (!lan_) return;
    EXPECT_TRUE(eventually([this] { return lan_->processes().empty(); }))
        << "left behind: " << ::testing::PrintToString(lan_->processes());
  }

  Program& on(int host, const std::string& program, std::vector<std::string> arguments = {}) {
    const auto there = lan_->visit(host);
    return hand(program, std::move(arguments));
  }
  BusObserver witness_on(int host) const {
    const auto there = lan_->visit(host);
    return BusObserver(url_);
  }

  std::optional<Lan> lan_;
};

/// The default scenario's four agents: the coordinator on host 0, world and logger on host 1,
/// agents 0, 1 and 2 on the hosts of these numbers, agent 3 also on host 2.
class TeamOnHosts : public OnHosts {
 protected:
  /// The default scenario, lasting that long, with more fields in its `time`.
  std::filesystem::path mission(const std::string& duration_s, const std::string& time = "",
                                const std::string& agents = "") {
    return scenario("duration_s: " + duration_s + ' ' + time, agents);
  }

  void start_all_but_agents(const std::filesystem::path& scenario, int coordinators_host = 0) {
    std::filesystem::create_directory(out());
    logger_ = &on(1, "ergocast-logger", {"--out", out()});
    world_ = &on(1, "ergocast-sim");
    coordinator_ = &on(coordinators_host, "ergocast-coordinator", {scenario});
  }
  Program& agent_on(int host, AgentId id) {
    return on(host, "ergocast-agent", {"--id", std::to_string(id)});
  }
  void start_agents() {
    for (const AgentId id : {0, 1, 2, 3}) agents_.push_back(&agent_on(std::min(id, 2), id));
  }
  void start(const std::filesystem::path& scenario) {
    start_all_but_agents(scenario);
    start_agents();
  }

  /// Sends the coordinator a signal to end the mission.
  void end_mission() { coordinator_->child.send(SIGINT); }

  /// The mission continues until it is stopped, and the record equals the simulation's.
  void expect_all_to_go_on_and_end_when_told() {
    EXPECT_TRUE(moves_on()) << coordinator_->printed();
    end_mission();
    expect_all_to_end();
    EXPECT_EQ(summary()["result"], "stopped") << summary()["reason"];
    EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  }

  /// All processes end by themselves, in order.
  void expect_all_to_end() {
    for (Program* program : {coordinator_, world_, logger_}) {
      EXPECT_EQ(wait_for(program->child), 0) << program->printed();
    }
    for (Program* agent : agents_) EXPECT_EQ(wait_for(agent->child), 0) << agent->printed();
  }
  void expect_complete_record() {
    EXPECT_EQ(summary()["result"], "done") << summary()["reason"];
    EXPECT_EQ(summary()["ticks"], summary()["tick_count"]);
    EXPECT_EQ(summary()["gaps"], 0);
  }
  /// The record is the simulation's, byte for byte.
  void expect_simulated(const std::filesystem::path& scenario) {
    const auto simulated = folder_ / "simulated";
    ASSERT_EQ(ergocast({"simulate", scenario, "--out", simulated}), 0) << output();
    EXPECT_TRUE(text_of(out() / "trajectory.csv") == text_of(simulated / "trajectory.csv"));
  }

  Program *coordinator_ = nullptr, *world_ = nullptr, *logger_ = nullptr;
  std::vector<Program*> agents_;
};

inline constexpr const char* kRealtime = "pace: REALTIME realtime_factor: 5";

}  // namespace ergocast::test
