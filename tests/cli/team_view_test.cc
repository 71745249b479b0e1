// SPDX-License-Identifier: BSD-3-Clause
// A team as a listening process knows it: its members, places, finds and metric, and its end.
#include "cli/team/team_view.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/team/team_text.h"
#include "core/motion/charge.h"
#include "core/search/search_cells.h"
#include "tests/cli/watched_team.h"

namespace ergocast {
namespace {

using namespace test;

struct TeamViewWithFalseAlarms : TeamViewTest {
  static Mission mission() {
    Mission mission = small_mission(4);
    mission.sensor.radius_m = 300;
    mission.sensor.false_alarms_per_s = 0.1;
    return mission;
  }
  TeamViewWithFalseAlarms() : TeamViewTest(mission()) {}
};

struct TeamViewWithBatteries : TeamViewTest {
  static Mission mission() {
    Mission mission = small_mission(4);
    AgentKind kind;
    kind.name = "robots";
    kind.count = 4;
    kind.u_max_mps = 1;
    kind.stations_m = {{100, 100, 0}, {200, 100, 0}, {300, 100, 0}, {400, 100, 0}};
    kind.battery.capacity_wh = 5;
    kind.battery.power_w = kind.battery.charge_w = 100;
    mission.kinds = {kind};
    return mission;
  }
  TeamViewWithBatteries() : TeamViewTest(mission()) {}
};

TEST_F(TeamViewWithBatteries, KnowsWhichAgentIsChargedAtItsStation) {
  hear_mission(at(0s));
  hear_all(at(100ms), 40);
  Tick tick = 40;
  const auto charges = [&](AgentPhase phase, double x_m, std::int32_t charge_ppm) {
    ++tick;
    AgentStatus told = status(0, 1000 + tick, tick);
    told.phase = phase;
    give(view_, told, at(200ms));
    WorldState state = world_state(tick, {{x_m, 100, 0}});
    state.vehicles[0].charge_ppm = charge_ppm;
    give(view_, state, at(200ms));
    return row(0, at(200ms)).charges;
  };
  EXPECT_TRUE(charges(AgentPhase::kReturning, 100.1, 400'000));
  EXPECT_EQ(condition_text(row(0, at(200ms))), "charging");
  EXPECT_FALSE(charges(AgentPhase::kReturning, 180, 400'000)) << "on its way";
  EXPECT_EQ(condition_text(row(0, at(200ms))), "goes home");
  EXPECT_FALSE(charges(AgentPhase::kReturning, 100.1, kFull_ppm)) << "full";
  EXPECT_FALSE(charges(AgentPhase::kReturning, 100.1, kNoCharge)) << "not known";
  EXPECT_FALSE(charges(AgentPhase::kRunning, 100.1, 400'000)) << "it passes by";
  EXPECT_FALSE(charges(AgentPhase::kResting, 100.1, 400'000)) << "it rests";
}

TEST_F(TeamViewWithFalseAlarms, HasTheContactsOfTheNewestRecordAck) {
  hear_mission(at(0s));
  const SearchCells cells(mission());
  const auto cell = static_cast<std::int32_t>(cells.cells.cell_of({900, 300, 0}));
  RecordAck ack{{kRun, kLogger, kLoggerLife, next_sequence(), 7}};
  ack.contact_count = 2;
  ack.contacts[0] = {
      .cell = cell, .reports = 2, .newest = 5, .probability = 0.875, .confirmed = true};
  ack.contacts[1].cell = kMaxSearchCells - 1;  // beyond this domain's cells
  give(view_, ack, at(1s));
  const TeamPicture picture = view_.picture(at(1s));
  ASSERT_EQ(picture.contacts.size(), 1U);
  const Contact& contact = picture.contacts[0];
  EXPECT_LE((contact.x_m - Eigen::Vector2d(900, 300)).cwiseAbs().maxCoeff(),
            cells.cells.size_m.x() / 2);
  EXPECT_EQ(contact.t_s, 5 * mission().timing.dt_s);
  const auto told = nlohmann::json::parse(team_json(picture))["contacts"];
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0]["x_m"], contact.x_m.x());
  EXPECT_EQ(told[0]["probability"], 0.875);
  EXPECT_EQ(told[0]["reports"], 2);
  EXPECT_EQ(told[0]["t_s"], contact.t_s);
  EXPECT_EQ(told[0]["confirmed"], true);
  EXPECT_NE(team_table(picture, false).find("contact  " + to_text(contact)), std::string::npos);
  EXPECT_FALSE(picture.more_contacts);
  ack.header.sequence = next_sequence();
  ack.contact_count = kMaxContactsPerMessage;  // the logger may know more
  for (std::int32_t i = 0; i < ack.contact_count; ++i)
    ack.contacts[static_cast<std::size_t>(i)] = {.cell = i, .probability = 0.5};
  give(view_, ack, at(1s));
  const TeamPicture full = view_.picture(at(1s));
  EXPECT_EQ(nlohmann::json::parse(team_json(full))["more_contacts"], true);
  EXPECT_NE(team_table(full, false).find("and 8 or more less likely ones"), std::string::npos);
  ack.header.sequence = next_sequence();
  ack.contact_count = 0;  // dismissed
  give(view_, ack, at(2s));
  EXPECT_TRUE(view_.picture(at(2s)).contacts.empty());
}

TEST_F(TeamViewTest, NamesWhoseCoverageIsForgottenAndCallsThatTrouble) {
  auto roster = roster_of(4);
  roster[2].forgotten = true;
  hear_mission(at(0s), roster);
  hear_all(at(100ms));
  EXPECT_EQ(view_.picture(at(100ms)).forgotten, std::vector<AgentId>{2});
  EXPECT_TRUE(view_.picture(at(100ms)).trouble);
  roster[2].forgotten = false;
  hear_mission(at(200ms), roster, 1);
  EXPECT_TRUE(view_.picture(at(200ms)).forgotten.empty());
  EXPECT_FALSE(view_.picture(at(200ms)).trouble);
  // An incarnation that has a successor is not reported as missing.
  RosterEntry former{{2, 7}, 0, 1};
  former.forgotten = true;
  roster.insert(roster.begin() + 2, former);
  hear_mission(at(300ms), roster, 2);
  EXPECT_EQ(view_.picture(at(300ms)).forgotten, std::vector<AgentId>{2});
  EXPECT_FALSE(view_.picture(at(300ms)).trouble);
}

TEST_F(TeamViewTest, OfATeamThatIsWellHasNoTrouble) {
  hear_mission(at(0s));
  hear_all(at(100ms), 40);
  const TeamPicture picture = view_.picture(at(200ms));
  EXPECT_FALSE(picture.trouble);
  EXPECT_EQ(picture.scenario, "small");
  EXPECT_EQ(picture.state, MissionState::kRunning);
  EXPECT_EQ(picture.tick, 40);
  EXPECT_EQ(picture.tick_count, 100);
  EXPECT_EQ(picture.dt_s, 0.1);
  EXPECT_EQ(picture.agents_alive, 4);
  EXPECT_EQ(picture.agents_expected, 4);
  ASSERT_EQ(picture.processes.size(), 3u);
  for (const ProcessRow& process : picture.processes) EXPECT_TRUE(process.heard) << process.name;
  EXPECT_EQ(picture.processes[0].host, "base");
  EXPECT_TRUE(view_.complete());
  EXPECT_FALSE(view_.over());
}

TEST_F(TeamViewTest, KnowsTheNewestPlaceOfEachVehicle) {
  hear_mission(at(0s));
  hear_all(at(100ms), 40);
  EXPECT_EQ(row(0, at(100ms)).position_m, (std::vector<double>{1, 1}));
  EXPECT_TRUE(row(1, at(100ms)).position_m.empty());
  give(view_, world_state(42, {{7, 1, 0}, {2, 8, 0}}), at(200ms));
  give(view_, world_state(41, {{6, 1, 0}}), at(200ms));  // it was overtaken
  EXPECT_EQ(row(0, at(200ms)).position_m, (std::vector<double>{7, 1}));
  EXPECT_EQ(row(1, at(200ms)).position_m, (std::vector<double>{2, 8}));
  EXPECT_EQ(row(0, at(200ms)).moves, false);
  WorldState moving = world_state(43, {{7, 1, 0}});
  moving.vehicles[0].velocity_mps = {3, -1, 0};
  give(view_, moving, at(300ms));
  EXPECT_EQ(row(0, at(300ms)).velocity_mps, (std::vector<double>{3, -1}));
  EXPECT_EQ(row(0, at(300ms)).moves, true);
}

TEST_F(TeamViewTest, KnowsWhatTheLoggerSaysHasBeenFound) {
  hear_mission(at(0s));
  EXPECT_FALSE(view_.picture(at(0s)).detection_probability);
  RecordAck ack{{kRun, kLogger, kLoggerLife, next_sequence(), 7}};
  ack.detection_probability = 0.25;
  give(view_, ack, at(0s));
  EXPECT_EQ(view_.picture(at(0s)).detection_probability, 0.25);
  // A logger that resumes may report fewer finds for a moment.
  ack.header.sequence = next_sequence();
  ack.find_count = 1;
  ack.finds[0] = {.object = 2, .agent = 1, .tick = 6};
  give(view_, ack, at(0s));
  ack.header.sequence = next_sequence();
  ack.find_count = 0;
  give(view_, ack, at(0s));
  const std::vector<Find> finds = view_.picture(at(0s)).finds;
  ASSERT_EQ(finds.size(), 1u);
  EXPECT_EQ(finds[0].object, 2);
  EXPECT_GT(finds[0].t_s, 0);
}

TEST_F(TeamViewTest, IsCompleteOnceTheMissionAndEveryMemberAreKnown) {
  EXPECT_FALSE(view_.complete());
  hear_all(at(0s), 0, 2);
  EXPECT_FALSE(view_.complete()) << "without the mission it is unknown which agents are missing";
  EXPECT_EQ(view_.picture(at(0s)).state, MissionState::kRunning) << "its coordinator reports it";
  hear_mission(at(0s));
  EXPECT_FALSE(view_.complete());
  EXPECT_EQ(condition(2, at(1s)), Condition::kUnheard);
  give(view_, status(2, 1), at(0s));
  EXPECT_TRUE(view_.complete());
}

TEST_F(TeamViewTest, WithoutACoordinatorTheAgentsThemselvesAreTheTeam) {
  for (AgentId id = 0; id < 3; ++id) give(view_, status(id, 1, 60), at(0s));
  AgentStatus successor = status(1, 1, 61);
  successor.header.incarnation = 7;
  give(view_, successor, at(1s));
  const TeamPicture picture = view_.picture(at(1s));
  EXPECT_EQ(picture.state, std::nullopt);
  EXPECT_EQ(picture.agents.size(), 3u);
  EXPECT_EQ(row(1, at(1s)).author.incarnation, 7u) << "the latest sender";
  EXPECT_EQ(picture.tick, 61);
  EXPECT_TRUE(view_.picture(at(3s)).trouble) << "no coordinator";
}

TEST_F(TeamViewTest, TheMetricIsTheMedianOfAgentsThatKnowOne) {
  hear_mission(at(0s));
  EXPECT_EQ(view_.picture(at(0s)).ergodic_metric, std::nullopt);
  for (AgentId id = 0; id < 4; ++id) {
    AgentStatus one = status(id, 1, id == 0 ? -1 : 5);
    one.header.tick = 5;
    one.ergodic_metric = id;
    give(view_, one, at(0s));
  }
  EXPECT_EQ(view_.picture(at(0s)).ergodic_metric, 2);
}

TEST_F(TeamViewTest, IsOverWhenTheCoordinatorOrAllAgentsReportIt) {
  hear_mission(at(0s));
  for (AgentId id = 0; id < 4; ++id) {
    EXPECT_FALSE(view_.over());
    AgentStatus last = status(id, 1, 100);
    last.phase = AgentPhase::kFinished;
    give(view_, last, at(0s));
    EXPECT_EQ(condition(id, at(9s)), Condition::kFinished) << "whatever the time";
  }
  EXPECT_TRUE(view_.over());

  announce(small_mission(1));
  TeamView other(kRun, at(0s));
  give(other, test::mission_part(0, MissionState::kFailed, roster_of(1), "no agents"), at(0s));
  EXPECT_TRUE(other.over());
  EXPECT_EQ(other.picture(at(0s)).reason, "no agents");
  EXPECT_TRUE(other.picture(at(0s)).trouble);
}

TEST_F(TeamViewTest, IsOverWhenAllAreDoneButOneThatWasStruckFromTheRoster) {
  auto roster = roster_of(4);
  roster[1].active_until = 20;
  give(view_, test::mission_part(0, MissionState::kRunning, roster), at(0s));
  for (const AgentId id : {0, 2, 3}) {
    EXPECT_FALSE(view_.over());
    AgentStatus last = status(id, 1, 100);
    last.phase = AgentPhase::kFinished;
    give(view_, last, at(0s));
  }
  EXPECT_TRUE(view_.over());
}

TEST_F(TeamViewTest, APlanOfAnotherVersionIsTroubleWithItsReason) {
  TeamView view(kRun, at(0s));
  announced_plan = kNoPlan;
  give(view, test::mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
  EXPECT_EQ(view.picture(at(0s)).reason, why_no_plan());
  EXPECT_TRUE(view.picture(at(0s)).trouble);
}

TEST_F(TeamViewTest, InventedAgentsCostNoMemory) {
  for (Incarnation incarnation = 1; incarnation < 10000; ++incarnation) {
    AgentStatus invented = status(static_cast<AgentId>(incarnation % kMaxAgents), 1);
    invented.header.incarnation = incarnation;
    give(view_, invented, at(0s));
  }
  EXPECT_LE(view_.picture(at(0s)).agents.size(), std::size_t{kMaxAgents});
}

}  // namespace
}  // namespace ergocast
