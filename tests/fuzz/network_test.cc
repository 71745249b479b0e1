// SPDX-License-Identifier: BSD-3-Clause
// An adversary sends damaged datagrams to the buses of a team in real time: no process crashes, no
// datagram is accepted, and the mission runs to its end.
//
// A short run checks no time. A long run prints the missed deadlines with and without attack:
// ERGOCAST_FUZZ_DATAGRAMS=1000000 ERGOCAST_FUZZ_PER_S=5000 bin/fuzz_network_tests
#include <cstdlib>
#include <lcm/lcm-cpp.hpp>

#include "runtime/process/key_file.h"
#include "tests/fuzz/support/adversary.h"
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

using fuzz::Adversary;

long setting(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atol(text);
}

/// Ids of all processes of the mission.
std::vector<pid_t> crew() {
  std::vector<pid_t> all;
  for (const char* program :
       {"ergocast-agent", "ergocast-sim", "ergocast-logger", "ergocast-coordinator"}) {
    const auto some = pids({program});
    all.insert(all.end(), some.begin(), some.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// Resident memory of a process [kB].
long resident_kb(pid_t pid) {
  const std::string status = text_of("/proc/" + std::to_string(pid) + "/status");
  const auto at = status.find("VmRSS:");
  return at == status.npos ? 0 : std::atol(status.c_str() + at + 6);
}
long largest_kb(const std::vector<pid_t>& pids) {
  long most = 0;
  for (const pid_t pid : pids) most = std::max(most, resident_kb(pid));
  return most;
}

/// The numbers of messages and forged messages that the logger has accepted.
std::pair<int, int> accepted(const std::filesystem::path& folder, const Adversary& adversary) {
  int all = 0, forged = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".lcm") continue;
    lcm::LogFile log(file.path(), "r");
    while (const lcm::LogEvent* event = log.good() ? log.readNextEvent() : nullptr) {
      const auto* data = static_cast<const std::uint8_t*>(event->data);
      ++all;
      if (adversary.forged(event->channel, {data, static_cast<std::size_t>(event->datalen)}))
        ++forged;
    }
  }
  return {all, forged};
}

class HostileNetwork : public RunningMission {
 protected:
  /// Missed deadlines in a part of the mission.
  struct Stretch {
    Tick ticks = 0;
    std::int64_t missed = 0;
    double share() const {
      return static_cast<double>(missed) / (4.0 * static_cast<double>(std::max<Tick>(1, ticks)));
    }
  };

  /// Listens for that time and sends that number of damaged datagrams.
  static Stretch spend(Adversary& adversary, std::chrono::duration<double> time, long strikes) {
    const Tick tick = adversary.tick();
    const std::int64_t missed = adversary.missed_deadlines();
    const auto begin = std::chrono::steady_clock::now();
    for (long done = 0; done < strikes || std::chrono::steady_clock::now() < begin + time;) {
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
      const long due =
          std::min(strikes, static_cast<long>(static_cast<double>(strikes) * (spent / time)));
      for (; done < due; ++done) adversary.strike();
      adversary.listen();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return {adversary.tick() - tick, adversary.missed_deadlines() - missed};
  }

  void fly_among_adversaries(const std::vector<std::string>& more,
                             const MessageAuthenticator& authenticator) {
    const long strikes = setting("ERGOCAST_FUZZ_DATAGRAMS", 20000);
    const std::chrono::duration<double> time(
        static_cast<double>(strikes) / static_cast<double>(setting("ERGOCAST_FUZZ_PER_S", 4000)));
    std::vector<std::string> arguments{"--realtime", "--lcm-url", kUrl};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Child mission = launch_endless(scenario(), arguments);
    Adversary adversary(LcmUrl::parse(kUrl).value(), authenticator, 1);
    const std::vector<pid_t> before = crew();
    ASSERT_EQ(before.size(), 7U);
    const long memory_kb = largest_kb(before);
    ASSERT_TRUE(eventually([&] { return adversary.listen(), adversary.heard() > 100; }));
    const Stretch quiet = spend(adversary, std::max(time / 4, std::chrono::duration<double>(3)), 0);
    const Stretch stormy = spend(adversary, time, strikes);
    ASSERT_TRUE(moves_on()) << printed();
    EXPECT_EQ(crew(), before) << printed();
    std::printf(
        "%ld datagrams in %.0f s; of the deadlines were missed: quiet %.4f, stormy %.4f; "
        "largest process %ld kB, then %ld kB\n",
        strikes, time.count(), quiet.share(), stormy.share(), memory_kb, largest_kb(before));
    mission.send(SIGINT);
    EXPECT_EQ(wait_for(mission), 0) << printed();
    check(adversary, strikes);
  }

  void check(const Adversary& adversary, long strikes) {
    EXPECT_EQ(adversary.sent(), strikes);
    const auto [all, forged] = accepted(out(), adversary);
    EXPECT_GT(all, 1000);
    EXPECT_EQ(forged, 0);
    EXPECT_EQ(summary()["restarts"], 0);
    const auto refused = summary()["messages"]["refused"];
    std::printf("%d messages accepted, %d of them forged; refused: %s\n", all, forged,
                refused.dump().c_str());
    EXPECT_GT(refused["tag"], strikes / 10);
    EXPECT_EQ(refused["range"], 0) << "something that was forged has been believed";
  }
};

TEST_F(HostileNetwork, WhatFailsTheHashIsRefused) { fly_among_adversaries({}, {}); }

TEST_F(HostileNetwork, WithAKeyAlsoWhatHasTheRightHashIs) {
  const std::filesystem::path file = folder_ / "c.key";
  const MissionKey key = make_mission_key();
  ASSERT_EQ(write_key_file(file, key_text(key, true)), std::nullopt);
  fly_among_adversaries({"--key-file", file}, MessageAuthenticator(key));
  EXPECT_GT(summary()["messages"]["refused"]["unkeyed"], 0);
}

}  // namespace
}  // namespace ergocast::test
