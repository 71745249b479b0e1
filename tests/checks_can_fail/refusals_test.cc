// SPDX-License-Identifier: BSD-3-Clause
// Each reason for a refusal: a test process sends such a message to a running team. The agents
// count it by name; `ergocast status` and their logs show it.
#include <lcm/lcm-cpp.hpp>
#include <map>

#include "runtime/process/key_file.h"
#include "scenario/scenario.h"
#include "team/mission_follower.h"
#include "tests/process/support/bus_observer.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/stranger.h"

namespace ergocast::test {
namespace {

class RefusalsCanBeSeen : public RunningMission {
 protected:
  RefusalsCanBeSeen() {
    const MissionKey key = make_mission_key();
    write(coordinator_, key, true);
    write(team_, key, false);
    write(other_, make_mission_key(), false);
  }
  static void write(const std::filesystem::path& file, const MissionKey& key,
                    bool for_coordinator) {
    EXPECT_EQ(write_key_file(file, key_text(key, for_coordinator)), std::nullopt);
  }
  static MessageAuthenticator authenticator(const std::filesystem::path& file) {
    return MessageAuthenticator(read_key_file(file).value());
  }

  /// Receives the mission's parts, which also contain its run.
  void learn_mission() {
    const auto ear =
        Transport::open(LcmUrl::parse(kUrl).value(), 0, authenticator(team_),
                        {kTypes<MissionPart>, 0, 0},
                        {.on_message =
                             [this](const Message& message, Bus, AgentId) {
                               if (const auto* part = std::get_if<MissionPart>(&message))
                                 follower_.receive(*part);
                             }})
            .value();
    ASSERT_TRUE(eventually([&] {
      ear->deliver_until(now() + std::chrono::milliseconds(5), -1);
      return follower_.revision() >= 0;
    }));
  }
  RunId run() const { return follower_.parts().front().header.run; }
  Header from(AgentId sender, RunId run) const { return {run, sender, 4711, 0, 0}; }
  Hello hello(RunId run) const { return {from(kUnassigned, run), kUnassigned, "stranger", "9.9"}; }

  WorldState world_of(AgentId sender) const {
    WorldState state;
    state.header = from(sender, run());
    return state;
  }

  void say_raw(std::size_t bytes) {
    Stranger(kUrl).send(Bus::kSwarm, "ERGOCAST_HELLO", std::vector<std::byte>(bytes));
  }
  void send(const MessageAuthenticator& authenticator, const Message& message,
            Bus bus = Bus::kSwarm) {
    Stranger(kUrl, authenticator).send(bus, message);
  }

  void exceed_rate() {
    AgentStatus status;
    status.header = from(3, run());
    status.host = "stranger";
    // Not all at once: messages beyond the agents' socket buffers are lost, not refused.
    for (int turn = 0; turn < 200; ++turn) {
      for (int i = 0; i < 20; ++i) rate_offender_->send(Bus::kSwarm, status);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  /// More former incarnations of one agent than a table has rows for, and a message of each. The
  /// coordinator's key is enough to send that.
  void crowd() {
    constexpr int kIncarnations = kMaxIncarnationsPerAgent + 1;
    constexpr AgentId kMany = 99;
    Stranger usurper(kUrl, authenticator(coordinator_));
    int life = 0;
    for (MissionPart part : follower_.parts()) {
      part.revision += 1000;
      part.signature = {};  // it was valid for the unchanged part
      for (; life < kIncarnations && part.roster.size() < kMaxRosterEntriesPerMessage; ++life) {
        part.roster.push_back({{kMany, static_cast<Incarnation>(1000 + life)}, 0, 1});
      }
      usurper.send(Bus::kSwarm, part);
    }
    ASSERT_EQ(life, kIncarnations) << "the plan has too few parts";
    for (int i = 0; i < kIncarnations; ++i) {
      Contribution block;
      block.header = from(kMany, run());
      block.header.incarnation = static_cast<Incarnation>(1000 + i);
      block.steps = block.next_broadcast_tick = 1;
      block.elapsed_s = block.sums.edit()[0] = follower_.mission()->timing.dt_s;
      block.mode_count = follower_.mission()->basis.mode_count();
      usurper.send(Bus::kSwarm, block);
    }
  }

  /// The number of agent 0's refusals of this kind, as `ergocast status` shows it.
  std::int64_t refused(const std::string& reason) {
    ergocast({"status", "--json", "--lcm-url", kUrl, "--key-file", team_});
    const auto report = nlohmann::json::parse(output(), nullptr, false);
    for (const auto& agent : report.is_object() ? report["agents"] : nlohmann::json::array()) {
      if (agent["id"] == 0) return agent["refused"].value(reason, std::int64_t{0});
    }
    return 0;
  }

  const std::filesystem::path coordinator_ = folder_ / "c.key", team_ = folder_ / "t.key",
                              other_ = folder_ / "o.key";
  MissionFollower follower_;
  std::unique_ptr<Stranger> rate_offender_;
};

TEST_F(RefusalsCanBeSeen, ForEachOfTheirReasons) {
  Child mission =
      launch_endless(scenario(), {"--realtime=2", "--key-file", coordinator_, "--lcm-url", kUrl});
  learn_mission();
  rate_offender_ = std::make_unique<Stranger>(kUrl, authenticator(team_));
  const std::map<Refusal, std::function<void()>> plants = {
      // Longer than any message; the kernel drops much shorter or longer datagrams.
      {Refusal::kSize, [this] { say_raw(1230); }},
      {Refusal::kType, [this] { say_raw(200); }},
      {Refusal::kTag, [this] { send(authenticator(other_), hello(run())); }},
      {Refusal::kUnkeyed, [this] { send({}, hello(run())); }},
      {Refusal::kUnsigned,
       [this] {
         send(authenticator(team_), Stop{from(kOperator, run()), false, "no key"});
       }},
      {Refusal::kRun, [this] { send(authenticator(team_), hello(run() + 1)); }},
      // An agent that sends the positions of all vehicles.
      {Refusal::kRange, [this] { send(authenticator(team_), world_of(3), Bus::kWorld); }},
      {Refusal::kEncoding,
       [this] {
         const Author teammate = follower_.roster().back().author;
         Contribution block;
         block.header = from(teammate.agent, run());
         block.header.incarnation = teammate.incarnation;
         block.encoding = ContributionEncoding::kFixed16;
         send(authenticator(team_), block);
       }},
      {Refusal::kRate, [this] { exceed_rate(); }},
      // Before the mission's first tick.
      {Refusal::kLate,
       [this] {
         Stop old{from(kOperator, run()), false, "a recording"};
         old.header.tick = -1;
         send(authenticator(coordinator_), old);
       }},
      {Refusal::kLimit, [this] { crowd(); }},
  };
  // In the order of the program's own list; the last one changes the roster, and so comes last.
  std::vector<Refusal> order;
  for (int i = 0; i < kRefusalKinds; ++i) order.push_back(static_cast<Refusal>(i));
  std::ranges::stable_partition(order, [](Refusal one) { return one != Refusal::kLimit; });
  for (const Refusal reason : order) {
    const std::string name = to_string(reason);
    const auto plant = plants.find(reason);
    if (plant == plants.end()) {
      ADD_FAILURE() << "no test covers what is refused as: " << name;
      continue;
    }
    EXPECT_EQ(refused(name), 0) << name;
    EXPECT_TRUE(eventually([&] {
      plant->second();
      return refused(name) > 0;
    })) << name
        << ":\n"
        << output();
  }
  // A warning lists all kinds since the start, at most every 10 s. It does not list the refusals of
  // an agent's tables, which only its status has.
  for (const Refusal reason : order) {
    if (reason == Refusal::kLimit) continue;
    const std::string name = to_string(reason);
    const bool by_table = reason == Refusal::kEncoding;  // which has its own sentence
    const std::string printed = by_table ? "another contribution_encoding" : " " + name + "=";
    EXPECT_TRUE(logs("agent-0", printed)) << name << ":\n" << log_of("agent-0");
  }
  mission.send(SIGTERM);
  wait_for(mission);
}

}  // namespace
}  // namespace ergocast::test
