// SPDX-License-Identifier: BSD-3-Clause
// `ergocast status` during a mission: its output and its end; it only listens.
#include <set>

#include "lcmtypes/codec.h"
#include "runtime/process/program_options.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/stranger.h"

namespace ergocast::test {
namespace {

class Status : public ByHand {
 protected:
  /// A mission in real time that the test ends.
  Child start_mission() { return launch_endless(scenario(), {"--realtime=5", "--lcm-url", kUrl}); }
  void end(Child& mission) {
    mission.send(SIGINT);
    EXPECT_EQ(wait_for(mission), 0) << printed();
  }

  int status(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"status", "--lcm-url", kUrl};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return ergocast(arguments);
  }
  /// Repeats the query until `wanted` holds for the answer; null if it never does.
  nlohmann::json status_where(const std::function<bool(const nlohmann::json&)>& wanted) {
    nlohmann::json answer;
    const bool came = eventually([&] {
      status({"--json"});
      answer = nlohmann::json::parse(output(), nullptr, false);
      return answer.is_object() && wanted(answer);
    });
    EXPECT_TRUE(came) << output();
    return came ? answer : nlohmann::json();
  }
  static nlohmann::json agent_in(const nlohmann::json& answer, int id) {
    for (const auto& row : answer["agents"]) {
      if (row["id"] == id) return row;
    }
    return {};
  }
  /// Every datagram on a bus, by channel.
  struct Ear {
    explicit Ear(const std::string& url) : lcm(url) { lcm.subscribe(".*", &Ear::receive, this); }
    void receive(const lcm::ReceiveBuffer*, const std::string& channel) {
      channels.insert(channel);
    }
    void listen() {
      while (lcm.handleTimeout(0) > 0) {
      }
    }
    lcm::LCM lcm;
    std::set<std::string> channels;
  };
};

TEST_F(Status, OfATeamThatIsWellShowsAllAndEndsWithZero) {
  Child mission = start_mission();
  ASSERT_TRUE(eventually([this] { return status() == 0; })) << output();
  for (const char* part : {"quadrimodal_corners, run ", ", running, tick ", " of 100000000 (",
                           "4 of 4 agents alive, phi^2 ", "coordinator  alive",
                           "world        alive", "logger       alive", "refused\n"}) {
    EXPECT_NE(output().find(part), std::string::npos) << part << " in\n" << output();
  }
  EXPECT_EQ(output().find('\x1b'), std::string::npos) << "no terminal, no colour";
  const auto answer = status_where([](const auto& json) { return json["trouble"] == false; });
  ASSERT_EQ(answer["agents"].size(), 4u);
  for (int id = 0; id < 4; ++id) {
    const auto row = agent_in(answer, id);
    EXPECT_EQ(row["state"], "ok");
    EXPECT_EQ(row["host"], host_name());
    EXPECT_EQ(row["restarts"], 0);
    EXPECT_GT(row["tick"], 0);
    EXPECT_GT(row["ergodic_metric"], 0);
    EXPECT_GE(row["loop_lag_s"], 0);
  }
  EXPECT_EQ(answer["processes"]["coordinator"]["host"], host_name());
  end(mission);
}

TEST_F(Status, ShowsASilentAgentFirst) {
  Child mission = start_mission();
  signal_to(agent(2), SIGSTOP);
  const auto answer = status_where([](const auto& json) {
    return json["agents"][0]["state"] == "silent" && json["agents_alive"] == 3;
  });
  EXPECT_EQ(answer["agents"][0]["id"], 2);
  EXPECT_EQ(answer["trouble"], true);
  EXPECT_EQ(status(), 1);
  EXPECT_NE(output().find(" 2  silent "), std::string::npos) << output();
  signal_to(agent(2), SIGCONT);
  status_where([](const auto& json) { return agent_in(json, 2)["state"] == "ok"; });
  end(mission);
}

TEST_F(Status, OfAKilledAgentShowsItsSuccessor) {
  Child mission = start_mission();
  const auto before =
      status_where([](const auto& json) { return agent_in(json, 1)["state"] == "ok"; });
  kill_next(agent(1));
  const auto after = status_where([&](const auto& json) {
    const auto row = agent_in(json, 1);
    return row["state"] == "ok" && row["incarnation"] != agent_in(before, 1)["incarnation"];
  });
  EXPECT_EQ(agent_in(after, 1)["restarts"], 1);
  EXPECT_EQ(agent_in(after, 0)["restarts"], 0);
  end(mission);
}

TEST_F(Status, CountsWhatAgentsRefuse) {
  Child mission = start_mission();
  Stranger stranger(kUrl);
  std::vector<std::byte> damaged;
  Contribution contribution;
  contribution.header.sender = 3;
  encode(contribution, damaged);
  damaged.back() ^= std::byte{1};
  const auto answer = status_where([&](const auto& json) {
    stranger.send(Bus::kSwarm, "ERGOCAST_CONTRIBUTION_3", damaged);
    return agent_in(json, 0)["refused"]["tag"] > 2;
  });
  EXPECT_EQ(agent_in(answer, 0)["refused"]["size"], 0);
  ASSERT_TRUE(eventually([this] { return status() == 0; })) << "a count alone is no trouble\n"
                                                            << output();
  EXPECT_NE(output().find("  tag "), std::string::npos) << output();
  end(mission);
}

TEST_F(Status, WithoutATeamNamesWhatToCheckAndHasPublishedNothing) {
  const LcmUrl url = LcmUrl::parse(kUrl).value();
  Ear swarm(url.of(Bus::kSwarm)), world(url.of(Bus::kWorld)), command(url.of(Bus::kCommand));
  EXPECT_EQ(status(), 4);
  EXPECT_NE(output().find("no message of any run arrived on "), std::string::npos) << output();
  EXPECT_NE(output().find("ergocast doctor --lcm-url"), std::string::npos) << output();
  for (Ear* ear : {&swarm, &world, &command}) {
    ear->listen();
    ear->channels.erase("LCM_SELF_TEST");  // the library's own
    EXPECT_TRUE(ear->channels.empty()) << ::testing::PrintToString(ear->channels);
  }
}

TEST_F(Status, OfSeveralRunsOnOneUrlAsksWhich) {
  Stranger stranger(kUrl);
  Program& undecided = hand("ergocast", {"status"});
  Program& decided = hand("ergocast", {"status", "--run-id", "00000000000000b2"});
  ASSERT_TRUE(eventually([&] {
    for (const RunId run : {0xa1, 0xb2}) {
      TeamStatus team;
      team.header = {run, kCoordinator, run, 0, 7};
      stranger.send(Bus::kSwarm, team);
    }
    const bool decided_runs = decided.child.running();
    return !undecided.child.running() && !decided_runs;
  }));
  EXPECT_EQ(wait_for(undecided.child), 2) << undecided.printed();
  EXPECT_TRUE(undecided.prints("--run-id 00000000000000a1")) << undecided.printed();
  EXPECT_TRUE(undecided.prints("--run-id 00000000000000b2")) << undecided.printed();
  wait_for(decided.child);
  EXPECT_TRUE(decided.prints("run 00000000000000b2")) << decided.printed();
}

TEST_F(Status, WatchGoesOnUntilTheMissionsEndAndReportsHowItEnded) {
  Program& watch = hand("ergocast", {"status", "--watch"});
  Program& lines = hand("ergocast", {"status", "--watch", "--json"});
  ASSERT_TRUE(watch.prints("no message yet on ")) << watch.printed();
  Child mission = launch(scenario(), {"--realtime=5", "--duration", "20", "--lcm-url", kUrl});
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(wait_for(watch.child), 0) << watch.printed();
  EXPECT_TRUE(watch.prints("the mission has ended: mission complete")) << watch.printed();
  EXPECT_EQ(wait_for(lines.child), 0) << lines.printed();
  std::istringstream text(lines.printed());
  std::string line, last;
  int count = 0;
  for (; std::getline(text, line); ++count) last = line;
  EXPECT_GE(count, 2);
  EXPECT_EQ(nlohmann::json::parse(last)["state"], "ended");
}

TEST_F(Status, WatchEndsWithCtrlC) {
  Program& watch = hand("ergocast", {"status", "--watch"});
  ASSERT_TRUE(watch.prints("no message yet on ")) << watch.printed();
  watch.child.send(SIGINT);
  EXPECT_EQ(wait_for(watch.child), 0);
}

}  // namespace
}  // namespace ergocast::test
