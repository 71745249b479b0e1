// SPDX-License-Identifier: BSD-3-Clause
// A team with a mission key, and an attacker that receives, repeats and forges messages.
#include <sys/stat.h>

#include <array>
#include <lcm/lcm-cpp.hpp>

#include "core/base/noise.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "runtime/process/key_file.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/stranger.h"

namespace ergocast::test {
namespace {

/// An attacker on the network without the key. It records and repeats messages, and forges others
/// in the name of their senders.
class Outsider {
 public:
  explicit Outsider(const LcmUrl& url)
      : buses_{lcm::LCM(url.of(Bus::kSwarm)), lcm::LCM(url.of(Bus::kWorld)),
               lcm::LCM(url.of(Bus::kCommand))},
        ears_{Ear{this, 0}, Ear{this, 1}, Ear{this, 2}} {
    for (std::size_t bus = 0; bus < buses_.size(); ++bus) {
      buses_[bus].subscribe(".*", &Ear::receive, &ears_[bus])->setQueueCapacity(0);
    }
  }

  /// Receives for a moment, repeats some of all messages received so far, and forges some of them.
  void turn() {
    for (lcm::LCM& bus : buses_) {
      for (int n = 0; n < 64 && bus.handleTimeout(0) > 0; ++n) {
      }
    }
    for (int n = 0; n < 16 && !heard_.empty(); ++n) {
      const Heard& one = heard_[random(1) % heard_.size()];
      send(one);
      forge(one);
    }
  }
  std::size_t heard() const { return heard_.size(); }
  std::int64_t forged() const { return forged_; }

 private:
  struct Heard {
    std::size_t bus;
    std::string channel;
    std::vector<std::byte> bytes;
  };
  struct Ear {
    Outsider* owner;
    std::size_t bus;
    void receive(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
      const auto* data = static_cast<const std::byte*>(buffer->data);
      owner->keep({bus, channel, {data, data + buffer->data_size}});
    }
  };

  /// Also records its own datagrams, so that forgeries are forged again. LCM's own self test has no
  /// header.
  void keep(Heard one) {
    constexpr std::size_t kMost = 20000;
    if (heard_.size() < kMost && one.bytes.size() >= kHeaderEnd) heard_.push_back(std::move(one));
  }
  void send(const Heard& one) {
    buses_[one.bus].publish(one.channel, one.bytes.data(), static_cast<unsigned>(one.bytes.size()));
  }
  /// The message with changed bytes after the tag and a tag that is valid without a key; and the
  /// same message on a neighbour's channel.
  void forge(Heard one) {
    const std::size_t at = random(2) % one.bytes.size();
    one.bytes[at < kTagOffset || at >= kHeaderEnd ? at : 8] ^= std::byte{1};
    send(one);
    MessageAuthenticator().close(one.bytes, false, "");
    send(one);
    one.channel.back() = static_cast<char>('0' + random(3) % 4);
    send(one);
    forged_ += 3;
  }
  std::uint32_t random(std::uint32_t who) {
    return static_cast<std::uint32_t>(random_words(7, Purpose::kFault, who, ++draws_).first);
  }

  std::array<lcm::LCM, 3> buses_;
  std::array<Ear, 3> ears_;
  std::vector<Heard> heard_;
  std::uint64_t draws_ = 0;
  std::int64_t forged_ = 0;
};

class Keyed : public ByHand {
 protected:
  Keyed() {
    const MissionKey key = make_mission_key();
    EXPECT_EQ(write_key_file(coordinator_, key_text(key, true)), std::nullopt);
    EXPECT_EQ(write_key_file(team_, key_text(key, false)), std::nullopt);
  }
  MessageAuthenticator authenticator(const std::filesystem::path& file) const {
    return MessageAuthenticator(read_key_file(file).value());
  }
  /// The id of the running mission.
  static RunId run_id() {
    const std::string world = std::to_string(pids({"ergocast-sim"}).at(0));
    const std::string command = text_of("/proc/" + world + "/cmdline");
    return std::strtoull(command.c_str() + command.find("--run-id") + 9, nullptr, 16);
  }

  const std::filesystem::path coordinator_ = folder_ / "c.key", team_ = folder_ / "t.key";
};

TEST_F(Keyed, OutsidersChangeNotOneBitOfTheMission) {
  Child mission = start("ergocast", {"run", scenario(), "--out", out(), "--duration", "200",
                                     "--key-file", coordinator_, "--lcm-url", kUrl});
  mission_log_ = log_;
  Outsider outsider(LcmUrl::parse(kUrl).value());
  // The world waits until there are enough forgeries, at any speed of the team.
  ASSERT_TRUE(eventually([] { return pids({"ergocast-sim"}).size() == 1; }));
  signal_to({"ergocast-sim"}, SIGSTOP);
  ASSERT_TRUE(eventually([&] {
    outsider.turn();
    return outsider.heard() > 1000 && outsider.forged() > 10000;
  }));
  signal_to({"ergocast-sim"}, SIGCONT);
  ASSERT_TRUE(eventually([&] {
    outsider.turn();
    return !mission.running();
  })) << printed();
  EXPECT_EQ(mission.exit_code(), 0) << printed();
  EXPECT_EQ(summary()["result"], "done");
  EXPECT_EQ(summary()["restarts"], 0);
  EXPECT_EQ(summary()["record_complete"], true);
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  const auto refused = summary()["messages"]["refused"];
  EXPECT_GT(refused["tag"], 0);
  EXPECT_GT(refused["unkeyed"], 0);
  EXPECT_EQ(refused["range"], 0) << "something that was forged has been believed";
}

TEST_F(Keyed, OnlyTheCoordinatorsKeyEndsAMission) {
  Child mission = launch_endless(scenario(), {"--key-file", coordinator_, "--lcm-url", kUrl});
  const RunId run = run_id();
  const auto stop = [run](const std::string& why) {
    constexpr Tick kNotLate = Tick{1} << 40;
    return Stop{{run, kOperator, 1, 0, kNotLate}, false, why};
  };
  Stranger outsider(kUrl), member(kUrl, authenticator(team_)),
      coordinator(kUrl, authenticator(coordinator_));
  for (int i = 0; i < 20; ++i) {
    outsider.send(Bus::kSwarm, stop("no key"));
    member.send(Bus::kSwarm, stop("an agent's key"));
    outsider.send(Bus::kSwarm, Amend{.header = {run, kOperator, 1, 0, 0}});
    member.send(Bus::kSwarm, Amend{.header = {run, kOperator, 1, 0, 0}});
  }
  EXPECT_TRUE(logs("coordinator", "a process sends without our --key-file"));
  ASSERT_TRUE(moves_on()) << printed();
  EXPECT_EQ(ergocast({"pause", "--lcm-url", kUrl, "--key-file", team_}), 2) << output();
  ASSERT_TRUE(eventually([&] {
    coordinator.send(Bus::kSwarm, stop("the operator"));
    coordinator.send(Bus::kCommand, stop("the operator"));
    return !mission.running();
  }));
  EXPECT_TRUE(logs("coordinator", "the operator"));
  const auto refused = summary()["messages"]["refused"];
  EXPECT_GE(refused["unkeyed"], 40);
  EXPECT_GE(refused["unsigned"], 40);
  EXPECT_FALSE(summary().contains("holds"));
}

TEST_F(Keyed, TheCoordinatorsKeyPausesAMissionAndLetsItGoOn) {
  Child mission = launch_endless(scenario(), {"--key-file", coordinator_, "--lcm-url", kUrl});
  const auto send = [&](const std::string& command) {
    return ergocast({command, "--lcm-url", kUrl, "--key-file", coordinator_});
  };
  ASSERT_EQ(send("pause"), 0) << output();
  EXPECT_NE(output().find("paused at tick "), output().npos) << output();
  ASSERT_EQ(send("resume"), 0) << output();
  ASSERT_TRUE(moves_on()) << printed();
  ASSERT_EQ(send("stop"), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  EXPECT_EQ(summary()["holds"].size(), 1U);
}

TEST_F(Keyed, ProcessesByHandRunWithTheirOwnFiles) {
  std::filesystem::create_directory(out());
  hand("ergocast-logger", {"--out", out(), "--key-file", team_});
  hand("ergocast-sim", {"--key-file", team_});
  Program& coordinator =
      hand("ergocast-coordinator", {scenario(), "--duration", "20", "--key-file", coordinator_});
  for (int id = 0; id < 4; ++id) hand("ergocast-agent", {"--key-file", team_});
  EXPECT_EQ(wait_for(coordinator.child), 0) << coordinator.printed();
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(out() / "summary.json"); }));
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

TEST_F(Keyed, AProcessWithoutTheKeyReportsIt) {
  Child mission = launch_endless(scenario(), {"--key-file", coordinator_, "--lcm-url", kUrl});
  EXPECT_EQ(ergocast({"status", "--lcm-url", kUrl}), 4);
  EXPECT_NE(output().find("has a mission key: give it with --key-file"), output().npos) << output();
  const std::filesystem::path other = folder_ / "o.key";
  ASSERT_EQ(write_key_file(other, key_text(make_mission_key(), false)), std::nullopt);
  EXPECT_EQ(ergocast({"status", "--lcm-url", kUrl, "--key-file", other}), 4);
  EXPECT_NE(output().find("another mission key than " + other.string()), output().npos) << output();
  EXPECT_EQ(ergocast({"status", "--lcm-url", kUrl, "--key-file", team_}), 0) << output();
  EXPECT_NE(output().find(", authenticated"), output().npos) << output();

  Program& agent = hand("ergocast-agent");
  EXPECT_TRUE(agent.prints("a team with a --key-file is on this URL"));
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(Keyed, KeysThatWouldNotDoAreRefusedAtOnce) {
  EXPECT_EQ(ergocast({"run", scenario(), "--out", out(), "--key-file", team_}), 2);
  EXPECT_NE(output().find("coordinator.key"), output().npos) << output();
  EXPECT_EQ(run("ergocast-coordinator", {scenario(), "--key-file", team_}), 2);
  EXPECT_NE(output().find("coordinator.key"), output().npos) << output();
  chmod(team_.c_str(), 0640);
  EXPECT_EQ(run("ergocast-agent", {"--key-file", team_}), 2);
  EXPECT_NE(output().find("chmod 600 " + team_.string()), output().npos) << output();
  setenv("ERGOCAST_KEY_FILE", team_.c_str(), 1);
  EXPECT_EQ(run("ergocast-agent", {}), 2);
  unsetenv("ERGOCAST_KEY_FILE");
  EXPECT_NE(output().find("chmod 600 " + team_.string()), output().npos) << output();
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(Keyed, KeygenWritesBothFilesOnceAndForItsOwnerOnly) {
  const std::string name = folder_ / "new";
  EXPECT_EQ(ergocast({"keygen", name}), 0) << output();
  const auto coordinator = read_key_file(name + ".coordinator.key").value();
  const auto team = read_key_file(name + ".key").value();
  EXPECT_TRUE(coordinator.signing.has_value());
  EXPECT_FALSE(team.signing.has_value());
  EXPECT_EQ(team.shared, coordinator.shared);
  EXPECT_EQ(ergocast({"keygen", name}), 2);
  EXPECT_EQ(read_key_file(name + ".key").value().shared, team.shared);
  // Half a pair would be useless.
  std::filesystem::remove(name + ".coordinator.key");
  EXPECT_EQ(ergocast({"keygen", name}), 2);
  EXPECT_FALSE(std::filesystem::exists(name + ".coordinator.key"));
}

}  // namespace
}  // namespace ergocast::test
