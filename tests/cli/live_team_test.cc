// SPDX-License-Identifier: BSD-3-Clause
// A team's frames: a browser gets each once, however late it asks.
#include "cli/team/live_team.h"

#include <gtest/gtest.h>

#include <chrono>

#include "plan/amendment_list.h"
#include "tests/support/team.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr RunId kWatchedRun = 7;
constexpr Instant kListening{100s};

class LiveTeamFrames : public ::testing::Test {
 protected:
  LiveTeamFrames() { team.begin(test::small_mission(2), {}); }

  void move(Tick tick) {
    WorldState world;
    world.header = {.run = kWatchedRun,
                    .sender = kWorld,
                    .incarnation = 5,
                    .sequence = ++sequence,
                    .tick = tick};
    world.vehicle_count = 2;
    for (const int i : {0, 1}) {
      world.vehicles[static_cast<std::size_t>(i)].id = i;
      world.vehicles[static_cast<std::size_t>(i)].position_m = {1.0 + i, 2, 0};
    }
    team.receive(world, Bus::kWorld, kWorld, kListening + 1ms * tick);
  }
  std::string frame(LiveTeam::Cursor& cursor) {
    bool more = false;
    return team.frame(cursor, more);
  }

  LiveTeam team{kWatchedRun, kListening, false};
  std::int64_t sequence = 0;
};

TEST_F(LiveTeamFrames, ComeOnceAndWithAllThatIsNew) {
  LiveTeam::Cursor quick, slow;
  EXPECT_NE(frame(quick).find("event: mission"), std::string::npos);
  EXPECT_EQ(frame(quick), "");
  for (Tick tick = 0; tick < 3; ++tick) move(tick);
  const std::string rows = frame(quick);
  EXPECT_NE(rows.find(R"("runs":[0,2])"), std::string::npos) << rows;  // the newest may grow
  EXPECT_EQ(frame(quick), "");
  for (Tick tick = 3; tick < 5; ++tick) move(tick);
  EXPECT_NE(frame(quick).find(R"("runs":[2,2])"), std::string::npos);
  const std::string all = frame(slow);
  EXPECT_NE(all.find("event: mission"), std::string::npos);
  EXPECT_NE(all.find(R"("runs":[0,4])"), std::string::npos);
}

// A browser that connects late gets the curve up to that time.
TEST_F(LiveTeamFrames, BeginWithWhatTheStatusesHaveReported) {
  test::announce(test::small_mission(2));
  LiveTeam live_team(test::kRun, kListening, false);
  for (Tick tick = 0; tick < 3; ++tick) {
    const Instant now = kListening + 100ms * tick;
    test::give(live_team, test::mission_part(1, MissionState::kRunning, test::roster_of(2)), now);
    AgentStatus status = test::status_of(0, test::next_sequence(), tick);
    status.header.tick = tick;
    status.ergodic_metric = 0.5;
    test::give(live_team, status, now);
    live_team.look(now);
  }
  LiveTeam::Cursor late;
  bool more = false;
  const std::string text = live_team.frame(late, more);
  EXPECT_NE(text.find(R"("past":{"t":[0.0,0.1,0.2],"phi":[0.5,0.5,0.5],)"), std::string::npos)
      << text;
  const auto begin = text.find("data: ") + 6;
  const auto sent = nlohmann::json::parse(text.substr(begin, text.find('\n', begin) - begin));
  EXPECT_EQ(sent["team"]["t"], nlohmann::json::parse("[0.0, 0.1, 0.2]"));
  const auto& agent = sent["team"]["agents"]["0"];
  EXPECT_EQ(agent["metric"], nlohmann::json::parse("[0.5, 0.5, 0.5]"));
  EXPECT_EQ(sent["team"]["words"][agent["state"][2].get<std::size_t>()], "ok");
  EXPECT_FALSE(agent.contains("blocked_s"));
}

// Single commands of a point are mostly noise.
TEST_F(LiveTeamFrames, HaveTheMeanOfAPointsCommandsOfTheNewestSecond) {
  test::announce(test::small_mission(2));
  LiveTeam live_team(test::kRun, kListening, false);
  test::give(live_team, test::mission_part(1, MissionState::kRunning, test::roster_of(2)),
             kListening);
  const auto answer = [&](Tick tick, const Eigen::Vector3d& velocity_mps) {
    Command command = test::command_of(0, tick, velocity_mps);
    command.header.sequence = test::next_sequence();
    live_team.receive(command, Bus::kCommand, 0, kListening);
  };
  answer(1'000'000, {7, 7, 0});  // it would be the newest one for long
  for (Tick tick = 0; tick < 30; ++tick) {
    test::give(live_team, test::world_state(tick, {{1, 1, 0}}), kListening);
    answer(tick, {tick < 20 ? 100.0 : static_cast<double>(tick % 2), 2, 0});
  }
  live_team.look(kListening);
  LiveTeam::Cursor cursor;
  bool more = false;
  const std::string text = live_team.frame(cursor, more);
  EXPECT_NE(text.find(R"("commands_mps":{"0":[0.5,2.0]})"), std::string::npos) << text;
}

// A tick is named some time before it comes.
TEST_F(LiveTeamFrames, ShowAPauseFromItsFirstTickToItsLast) {
  test::announce(test::small_mission(2));
  LiveTeam live_team(test::kRun, kListening, false);
  std::int64_t revision = 0;
  const auto incidents_at = [&](Tick tick, const std::vector<Hold>& holds) {
    const Instant now = kListening + 100ms * tick;
    MissionPart part = test::mission_part(++revision, MissionState::kRunning, test::roster_of(2));
    part.amendments = test::pauses(holds);
    test::give(live_team, part, now);
    AgentStatus status = test::status_of(0, test::next_sequence(), tick);
    status.header.tick = tick;
    test::give(live_team, status, now);
    live_team.look(now);
    return live_team.incidents_json();
  };
  EXPECT_TRUE(incidents_at(4, {{5, -1}}).empty());
  EXPECT_EQ(incidents_at(5, {{5, -1}})[0]["kind"], "paused");
  EXPECT_FALSE(incidents_at(19, {{5, 20}})[0].contains("until"));
  EXPECT_EQ(incidents_at(20, {{5, 20}})[0]["until"], 2.0);
}

// MISSION has only the newest targets. A page shows all that it ever received.
TEST_F(LiveTeamFrames, KeepAllTargetsAndSendEachOnce) {
  const Mission mission = test::small_mission(2);
  test::announce(mission);
  LiveTeam live_team(test::kRun, kListening, false);
  Amendments list;
  LiveTeam::Cursor quick;
  std::int64_t revision = 0;
  const auto frame_of = [&](LiveTeam::Cursor& cursor) {
    bool more = false;
    const std::string text = live_team.frame(cursor, more);
    const auto begin = text.find("data: ", text.find("event: frame"));
    return begin == text.npos
               ? nlohmann::json::object()
               : nlohmann::json::parse(text.substr(begin + 6, text.find('\n', begin) - begin - 6));
  };
  const auto frame_after = [&](Tick tick, double second_number) {
    TargetChange change;
    change.target = mission.target_coefficients;
    change.target[1] = second_number;
    name_target(list, tick, change);
    MissionPart part = test::mission_part(++revision, MissionState::kRunning, test::roster_of(2));
    part.amendments = encode_amendments(list);
    test::give(live_team, part, kListening);
    return frame_of(quick);
  };
  for (const double number : {0.1, 0.2, 0.3}) {
    const auto frame = frame_after(100 * revision + 5, number);
    ASSERT_EQ(frame["targets"].size(), 1) << frame;
    const auto& newest = frame["amendments"].back();
    EXPECT_EQ(frame["amendments"].size(), revision);
    EXPECT_EQ(newest["number"], revision - 1);
    EXPECT_EQ(newest["kind"], "target");
    EXPECT_EQ(newest["from"], 100 * (revision - 1) + 5);
    EXPECT_EQ(frame["targets"][newest["hash"].get<std::string>()][1], number);
    EXPECT_FALSE(frame_of(quick).contains("amendments"));
  }
  ASSERT_EQ(list.targets.size(), 2U);
  LiveTeam::Cursor late;
  const auto frame = frame_of(late);
  EXPECT_EQ(frame["targets"].size(), 3);
  EXPECT_EQ(frame["amendments"].size(), 3);
}

// An agent rests from the tick at which the world uses the roster that recalls it, however late
// MISSION comes.
TEST_F(LiveTeamFrames, HaveTheTickFromWhichARecalledAgentRests) {
  test::announce(test::small_mission(2));
  for (const bool late : {false, true}) {
    LiveTeam live_team(test::kRun, kListening, false);
    const auto know = [&](std::int64_t revision) {
      auto roster = test::roster_of(2);
      if (revision == 2) roster[1].recall_revision = 2;
      test::give(live_team, test::mission_part(revision, MissionState::kRunning, roster),
                 kListening);
    };
    const auto move = [&](Tick tick, std::int64_t revision) {
      WorldState world = test::world_state(tick, {{1, 1, 0}, {2, 2, 0}});
      world.roster_revision = revision;
      test::give(live_team, world, kListening);
    };
    know(1);
    if (!late) know(2);
    move(5, 1);
    for (const Tick tick : {6, 7}) move(tick, 2);
    if (late) know(2);
    live_team.look(kListening);
    LiveTeam::Cursor cursor;
    bool more = false;
    const std::string text = live_team.frame(cursor, more);
    EXPECT_NE(text.find(R"({"id":1,"active_from":0,"recalled_from":6})"), std::string::npos)
        << text;
    EXPECT_NE(text.find(R"({"id":0,"active_from":0})"), std::string::npos) << text;
  }
}

TEST_F(LiveTeamFrames, OfOtherRunsShowNothing) {
  LiveTeam other(kWatchedRun + 1, kListening, false);
  other.begin(test::small_mission(2), {});
  LiveTeam::Cursor cursor;
  bool more = false;
  other.frame(cursor, more);
  WorldState world;
  world.header = {.run = kWatchedRun, .sender = kWorld, .incarnation = 5, .sequence = 1, .tick = 1};
  world.vehicle_count = 1;
  other.receive(world, Bus::kWorld, kWorld, kListening);
  EXPECT_EQ(other.frame(cursor, more), "");
}

TEST_F(LiveTeamFrames, MarkAReplay) {
  for (const bool replay : {false, true}) {
    LiveTeam one(kWatchedRun, kListening, false, replay);
    one.begin(test::small_mission(2), {});
    LiveTeam::Cursor cursor;
    bool more = false;
    const std::string wanted = std::string(R"("replay":)") + (replay ? "true" : "false");
    EXPECT_NE(one.frame(cursor, more).find(wanted), std::string::npos);
  }
}

TEST_F(LiveTeamFrames, KeepTheNewestLinesAndEscapeThem) {
  for (int i = 0; i < 1000; ++i) team.log("line " + std::to_string(i));
  team.log("</script>\xff\n\nevent: end\ndata: {}");
  LiveTeam::Cursor cursor;
  const std::string text = frame(cursor);
  EXPECT_EQ(text.find("\"line 600\""), std::string::npos);
  EXPECT_NE(text.find("\"line 999\""), std::string::npos);
  EXPECT_EQ(text.find("\nevent: end"), std::string::npos);  // a line break would start a new event
}

}  // namespace
}  // namespace ergocast
