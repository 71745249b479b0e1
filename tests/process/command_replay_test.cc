// SPDX-License-Identifier: BSD-3-Clause
// An attacker without the key recorded a signed command that no process obeyed, and sends it again
// later. Without a key such a command is obeyed.
#include <lcm/lcm-cpp.hpp>

#include "runtime/process/key_file.h"
#include "team/command_window.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/stranger.h"

namespace ergocast::test {
namespace {

/// Records the operator's commands on a URL, byte by byte.
class Tape {
 public:
  explicit Tape(const std::string& url) {
    const LcmUrl buses = LcmUrl::parse(url).value();
    for (const Bus bus : {Bus::kSwarm, Bus::kCommand}) {
      ears_.push_back({bus, std::make_unique<lcm::LCM>(buses.of(bus)), &recorded_});
      Ear& ear = ears_.back();
      ear.lcm->subscribe("ERGOCAST_(AMEND|STOP)", &Ear::receive, &ear)->setQueueCapacity(0);
    }
  }
  /// Reads the arrived messages; returns the number of all recorded ones.
  std::size_t size() {
    for (Ear& ear : ears_) {
      while (ear.lcm->handleTimeout(0) > 0) {
      }
    }
    return recorded_.size();
  }
  /// Sends all recorded messages.
  void play(const std::string& url) const {
    const LcmUrl buses = LcmUrl::parse(url).value();
    for (const Bus bus : {Bus::kSwarm, Bus::kCommand}) {
      lcm::LCM out(buses.of(bus));
      for (const auto& one : recorded_) {
        if (one.bus == bus)
          out.publish(one.channel, one.bytes.data(), static_cast<unsigned>(one.bytes.size()));
      }
    }
  }

 private:
  struct Recorded {
    Bus bus;
    std::string channel;
    std::vector<std::uint8_t> bytes;
  };
  struct Ear {
    Bus bus;
    std::unique_ptr<lcm::LCM> lcm;
    std::vector<Recorded>* recorded;
    void receive(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
      const auto* data = static_cast<const std::uint8_t*>(buffer->data);
      recorded->push_back({bus, channel, {data, data + buffer->data_size}});
    }
  };
  std::deque<Ear> ears_;
  std::vector<Recorded> recorded_;
};

class CommandReplay : public ByHand {
 protected:
  static constexpr RunId kRun = 0xab;

  CommandReplay() {
    const MissionKey key = make_mission_key();
    EXPECT_EQ(write_key_file(coordinator_key_, key_text(key, true)), std::nullopt);
    EXPECT_EQ(write_key_file(team_key_, key_text(key, false)), std::nullopt);
  }

  /// A team that runs until the test ends it.
  void start_mission() {
    std::filesystem::create_directory(out());
    member("ergocast-logger", {"--out", out()}, team_key_);
    world_ = &member("ergocast-sim", {}, team_key_);
    coordinator_ =
        &member("ergocast-coordinator",
                {scenario(std::string("duration_s: ") + kEndless), "--run-id", to_hex(kRun)},
                coordinator_key_);
    for (const char* id : {"0", "1", "2", "3"}) member("ergocast-agent", {"--id", id}, team_key_);
    ASSERT_TRUE(recorded(30000)) << coordinator_->printed();
  }
  Program& member(const std::string& program, std::vector<std::string> arguments,
                  const std::filesystem::path& key) {
    if (keyed_) arguments.insert(arguments.end(), {"--key-file", key});
    return hand(program, std::move(arguments));
  }
  /// Runs the operator's command as a person would.
  int send_command(const std::string& command, std::vector<std::string> more = {},
                   const char* url = kUrl) {
    more.insert(more.begin(), {command, "--lcm-url", url});
    if (keyed_) more.insert(more.end(), {"--key-file", coordinator_key_});
    return ergocast(more);
  }
  void stop_coordinator() const {
    signal_to({"ergocast-coordinator"}, SIGKILL);
    ASSERT_TRUE(eventually([] { return pids({"ergocast-coordinator"}).empty(); }));
  }
  /// Another coordinator takes the mission over some ticks later.
  void resume_coordinator() {
    ASSERT_TRUE(moves_on());
    coordinator_ = &hand("ergocast-coordinator", {"--resume", "--key-file", coordinator_key_});
    ASSERT_TRUE(coordinator_->prints("taken over")) << coordinator_->printed();
  }
  /// Sends the recording until `program` logs that it ignores it, or does something else.
  void play_until_ignored(const Tape& tape, const Program& program) const {
    EXPECT_TRUE(eventually(
        [&] {
          tape.play(kUrl);
          return ignores(program) ||
                 program.printed().find("mission is paused") != std::string::npos;
        },
        program.child.pid()))
        << program.printed();
    EXPECT_TRUE(ignores(program)) << program.printed();
  }
  static bool ignores(const Program& program) {
    return program.printed().find("late=") != std::string::npos;
  }
  /// Waits until the world refuses a command that names the mission's first tick, and longer for
  /// processes that started later. The world leaves a stop in order to the coordinator, which does
  /// not receive it.
  void pass_the_first_tick() const {
    MessageAuthenticator key;
    if (keyed_) key = MessageAuthenticator(read_key_file(coordinator_key_).value());
    Stranger operator_(kUrl, key);
    ASSERT_TRUE(eventually([&] {
      operator_.send(Bus::kCommand, Stop{{kRun, kOperator, 1, 0, 0}, false, "of the first tick"});
      return ignores(*world_);
    })) << world_->printed();
    std::this_thread::sleep_for(CommandWindow::kLength);
  }
  /// Checks that the team still obeys its operator.
  void expect_obedience() {
    ASSERT_TRUE(moves_on()) << coordinator_->printed();
    EXPECT_EQ(send_command("pause"), 0) << output();
    EXPECT_EQ(send_command("resume"), 0) << output();
    EXPECT_EQ(send_command("stop"), 0) << output();
    EXPECT_EQ(wait_for(coordinator_->child), 0) << coordinator_->printed();
    ASSERT_TRUE(eventually([&] { return std::filesystem::exists(out() / "summary.json"); }));
    EXPECT_EQ(summary()["holds"].size(), 1U) << coordinator_->printed();
    EXPECT_TRUE(summary()["reason"].get<std::string>().starts_with("stopped by `ergocast stop`"));
  }

  static constexpr const char* kElsewhere = "udpm://239.255.76.67:24800?ttl=0";

  bool keyed_ = true;
  const std::filesystem::path coordinator_key_ = folder_ / "c.key", team_key_ = folder_ / "t.key";
  Program* world_ = nullptr;
  Program* coordinator_ = nullptr;
};

TEST_F(CommandReplay, APauseThatNoCoordinatorObeyedDoesNotPauseLater) {
  start_mission();
  Tape tape(kUrl);
  hold_next("ERGOCAST_AMEND", 0);  // the operator's command, once it knows the mission
  Program& pause = hand("ergocast", {"pause", "--key-file", coordinator_key_});
  hold_none();
  ASSERT_TRUE(eventually([&] { return stopped({pause.child.pid()}); })) << pause.printed();
  stop_coordinator();
  pause.child.send(SIGCONT);
  EXPECT_EQ(wait_for(pause.child), 4) << pause.printed();
  ASSERT_GT(tape.size(), 0U);
  resume_coordinator();
  play_until_ignored(tape, *coordinator_);
  EXPECT_EQ(coordinator_->printed().find("mission is paused"), std::string::npos)
      << coordinator_->printed();
  expect_obedience();
}

TEST_F(CommandReplay, AStopThatNoCoordinatorObeyedDoesNotEndTheMissionLater) {
  start_mission();
  Tape tape(kUrl);
  stop_coordinator();
  EXPECT_EQ(send_command("stop"), 4) << output();
  EXPECT_NE(output().find("no coordinator answers"), output().npos) << output();
  ASSERT_GT(tape.size(), 0U);
  resume_coordinator();
  play_until_ignored(tape, *coordinator_);
  expect_obedience();
}

TEST_F(CommandReplay, AStopAtOnceThatTheTeamDidNotReceiveDoesNotStopItLater) {
  start_mission();
  Tape tape(kElsewhere);
  EXPECT_EQ(send_command("stop", {"--now", "--run-id", to_hex(kRun)}, kElsewhere), 4) << output();
  ASSERT_GT(tape.size(), 0U);
  pass_the_first_tick();
  play_until_ignored(tape, *coordinator_);
  EXPECT_TRUE(world_->child.running()) << world_->printed();
  ASSERT_TRUE(moves_on()) << coordinator_->printed();
  EXPECT_EQ(send_command("stop", {"--now", "--run-id", to_hex(kRun)}), 0) << output();
  EXPECT_EQ(wait_for(world_->child), 0) << world_->printed();
  EXPECT_TRUE(world_->prints("stopped at once by `ergocast stop --now`")) << world_->printed();
}

// The operator's host can send and receives nothing: another URL, whose commands arrive at the
// team.
TEST_F(CommandReplay, WithoutAKeyAHostThatReceivesNothingStopsTheTeam) {
  keyed_ = false;
  start_mission();
  Tape tape(kElsewhere);
  EXPECT_EQ(send_command("stop", {"--now", "--run-id", to_hex(kRun)}, kElsewhere), 4) << output();
  ASSERT_GT(tape.size(), 0U);
  pass_the_first_tick();
  EXPECT_TRUE(eventually([&] {
    tape.play(kUrl);
    return !world_->child.running() || ignores(*coordinator_);
  })) << world_->printed();
  EXPECT_FALSE(ignores(*coordinator_)) << coordinator_->printed();
  EXPECT_TRUE(world_->prints("stopped at once by `ergocast stop --now`")) << world_->printed();
}

}  // namespace
}  // namespace ergocast::test
