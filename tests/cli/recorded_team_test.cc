// SPDX-License-Identifier: BSD-3-Clause
// A recorded event log shows when an agent was silent, and when only the logger was absent.
#include "cli/team/recorded_team.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "tests/support/team.h"
#include "tests/support/temp_folder.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

std::string big_endian(std::uint64_t value, int bytes) {
  std::string text;
  while (bytes-- > 0) text += static_cast<char>(value >> (8 * bytes) & 255);
  return text;
}

class RecordedTeam : public ::testing::Test {
 protected:
  RecordedTeam() { test::announce(mission_); }

  void log(const Message& message) {
    std::vector<std::byte> bytes;
    const std::string& channel = channel_of(message);
    encode(message, bytes, authenticator_, channel);
    events_ += big_endian(0xEDA1DA01, 4) + big_endian(++count_, 8) +
               big_endian(static_cast<std::uint64_t>(now_.count()), 8) +
               big_endian(channel.size(), 4) + big_endian(bytes.size(), 4) + channel;
    for (const std::byte byte : bytes) events_ += static_cast<char>(byte);
  }
  /// Adds half seconds of a team in which the agents of `ids` run.
  void record_ticks(std::chrono::microseconds duration, const std::vector<AgentId>& ids) {
    for (const auto end = now_ + duration; now_ < end; now_ += 500ms) {
      tick_ += 5;
      log(test::mission_part(1, MissionState::kRunning, test::roster_of(2)));
      TeamStatus team;
      team.header = {test::kRun, kCoordinator, test::kCoordinatorLife, test::next_sequence(),
                     tick_};
      team.state = MissionState::kRunning;
      log(team);
      log(test::world_state(tick_, {{100, 500, 0}, {200, 500, 0}}));
      for (const AgentId id : ids) {
        AgentStatus status = test::status_of(id, test::next_sequence(), tick_);
        status.header.tick = tick_;
        status.ergodic_metric = 0.25 + id;
        status.max_staleness_s = 1.5;
        status.blocked_now_ticks = blocked_ticks_;
        if (blocked_ticks_ > 0 && id == 1) status.blocked_by = 0;
        status.phase =
            now_ < begin_ + std::chrono::seconds(2) ? AgentPhase::kRunning : AgentPhase::kReturning;
        log(status);
      }
    }
  }
  Json read() {
    std::ofstream(folder_.path() / "events-000.lcm", std::ios::binary) << events_;
    return recorded_team(folder_.path(), mission_);
  }
  static std::vector<std::string> incidents(const Json& team) {
    std::vector<std::string> texts;
    for (const Json& one : team["incidents"]) texts.push_back(one["text"]);
    return texts;
  }

  test::TempFolder folder_;
  Mission mission_ = test::small_mission(2);
  MessageAuthenticator authenticator_;
  const std::chrono::microseconds begin_ = 1000h;
  std::chrono::microseconds now_ = begin_;
  std::uint64_t count_ = 0;
  Tick tick_ = 0;
  Tick blocked_ticks_ = 0;
  std::string events_;
};

TEST_F(RecordedTeam, ReportsWhenAnAgentWasSilentAndWhatEachKnew) {
  record_ticks(5s, {0, 1});
  record_ticks(5s, {0});
  record_ticks(5s, {0, 1});
  const Json team = read();
  EXPECT_EQ(incidents(team), (std::vector<std::string>{"1 silent", "1 back"}));
  const Json& one = team["agents"]["1"];
  ASSERT_EQ(one["state"].size(), team["t"].size());
  const auto state_at = [&](double t_s) {
    std::size_t i = 0;
    while (i + 1 < team["t"].size() && team["t"][i + 1] <= t_s) ++i;
    return team["words"][one["state"][i].get<std::size_t>()].get<std::string>();
  };
  EXPECT_EQ(state_at(4), "ok");
  EXPECT_EQ(state_at(9.5), "silent");
  EXPECT_EQ(state_at(14.5), "ok");
  EXPECT_EQ(one["metric"].back(), 1.25);
  EXPECT_EQ(team["agents"]["0"]["age_s"].back(), 1.5);
  const Json& phase = team["agents"]["0"]["phase"];
  ASSERT_EQ(phase.size(), team["t"].size());
  const auto first =
      std::ranges::find_if(phase, [](const Json& value) { return !value.is_null(); });
  EXPECT_EQ(team["phases"][first->get<std::size_t>()], "running");
  EXPECT_EQ(team["phases"][phase.back().get<std::size_t>()], "returning");
}

TEST_F(RecordedTeam, ReportsWhichAgentIsBlockedByWhich) {
  record_ticks(2s, {0, 1});
  EXPECT_FALSE(read()["agents"]["1"].contains("blocked_s")) << "no agent was blocked";
  blocked_ticks_ = 15;
  record_ticks(2s, {0, 1});
  const Json team = read();
  for (const char* id : {"0", "1"}) {
    const Json& lists = team["agents"][id];
    ASSERT_EQ(lists["blocked_s"].size(), team["t"].size()) << id;
    ASSERT_EQ(lists["blocked_by"].size(), team["t"].size()) << id;
    EXPECT_DOUBLE_EQ(lists["blocked_s"].back().get<double>(), 15 * mission_.timing.dt_s) << id;
  }
  EXPECT_EQ(team["agents"]["1"]["blocked_by"].back(), 0);
  EXPECT_EQ(team["agents"]["0"]["blocked_by"].back(), nullptr) << "an edge";
}

TEST_F(RecordedTeam, APauseOfTheLoggerIsNoSilence) {
  record_ticks(5s, {0, 1});
  now_ += 1h;
  record_ticks(5s, {0, 1});
  EXPECT_EQ(incidents(read()), std::vector<std::string>());
}

TEST_F(RecordedTeam, NeedsNoKey) {
  MissionKey key;
  key.shared.fill(std::byte{7});
  authenticator_ = MessageAuthenticator(key);
  record_ticks(3s, {0, 1});
  EXPECT_EQ(read()["agents"].size(), 2U);
}

TEST_F(RecordedTeam, EndsWhereItsLogIsDamaged) {
  EXPECT_TRUE(read().is_null());
  record_ticks(3s, {0, 1});
  const double whole = read()["t"].back();
  const std::string events = events_;
  events_ = events.substr(0, events.size() / 2 + 10);
  const double half = read()["t"].back();
  EXPECT_LT(half, whole);
  events_ += events;  // out of step from there on
  EXPECT_EQ(read()["t"].back(), half);
}

TEST_F(RecordedTeam, OfALongMissionKeepsABoundedNumberOfLooks) {
  mission_.timing.tick_count = 1'000'000;
  test::announce(mission_);
  record_ticks(6h, {0, 1});
  const Json team = read();
  EXPECT_LE(team["t"].size(), 10'000U);
  EXPECT_GT(team["t"].size(), 4'000U);
  EXPECT_NEAR(team["t"].back().get<double>(), 6 * 3600, 20);
}

}  // namespace
}  // namespace ergocast::cli
