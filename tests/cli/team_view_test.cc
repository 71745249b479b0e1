// SPDX-License-Identifier: BSD-3-Clause
// The state of a team as a listening process knows it: agents with trouble, and its start.
#include "cli/team/team_view.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/team/team_text.h"
#include "core/motion/charge.h"
#include "core/search/search_cells.h"
#include "tests/support/team.h"

namespace ergocast {
namespace {

using namespace test;

TeamStatus coordinator_at(Tick tick) {
  TeamStatus team;
  team.header = {kRun, kCoordinator, kCoordinatorLife, next_sequence(), tick};
  team.state = MissionState::kRunning;
  team.tick_count = 100;
  team.host = "base";
  return team;
}

/// A listener since 0 s, and a team whose messages it receives.
class TeamViewTest : public ::testing::Test {
 protected:
  explicit TeamViewTest(const Mission& mission = small_mission(4)) : view_(kRun, at(0s)) {
    announce(mission);
  }

  void hear_mission(Instant now, std::vector<RosterEntry> roster = roster_of(4),
                    std::int64_t revision = 0, MissionState state = MissionState::kRunning,
                    std::string reason = "") {
    give(view_, test::mission_part(revision, state, std::move(roster), std::move(reason)), now);
  }
  void hear_processes(Instant now, Tick tick = 0) {
    give(view_, coordinator_at(tick), now);
    give(view_, world_state(tick, {{1, 1, 0}}), now);
    give(view_, RecordAck{{kRun, kLogger, kLoggerLife, next_sequence(), tick}}, now);
  }
  AgentStatus status(AgentId id, std::int64_t sequence, Tick tick = 0) const {
    AgentStatus status = status_of(id, sequence, tick);
    status.header.tick = tick;
    return status;
  }
  /// Every process sends, with the sequence numbers of that half second.
  void hear_all(Instant now, Tick tick = 0, AgentId but = kUnassigned) {
    hear_processes(now, tick);
    for (AgentId id = 0; id < 4; ++id) {
      if (id != but) give(view_, status(id, sequence_of(now), tick), now);
    }
  }
  static std::int64_t sequence_of(Instant now) { return 1 + now.time_since_epoch() / 1ms; }

  AgentRow row(AgentId id, Instant now) const {
    for (const AgentRow& row : view_.picture(now).agents) {
      if (row.author.agent == id) return row;
    }
    ADD_FAILURE() << "no row of agent " << id;
    return {};
  }
  Condition condition(AgentId id, Instant now) const { return row(id, now).condition; }

  TeamView view_;
};

struct TeamViewRealtime : TeamViewTest {
  static Mission mission() {
    Mission mission = small_mission(4);
    mission.timing.pace = Pace::kRealtime;
    mission.timing.realtime_factor = 2;
    return mission;
  }
  TeamViewRealtime() : TeamViewTest(mission()) {}
};

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

TEST_F(TeamViewTest, AnAgentWithoutMessagesIsLateThenSilentAndStandsFirst) {
  hear_mission(at(0s));
  for (const auto time : {0s, 1s, 2s, 3s}) hear_all(at(time), 0, time > 0s ? 2 : kUnassigned);
  EXPECT_EQ(condition(2, at(900ms)), Condition::kOk);
  EXPECT_EQ(condition(2, at(1s)), Condition::kLate);
  EXPECT_EQ(condition(2, at(2999ms)), Condition::kLate);
  EXPECT_EQ(condition(2, at(3s)), Condition::kSilent);
  const TeamPicture picture = view_.picture(at(3s));
  EXPECT_EQ(picture.agents.front().author.agent, 2);
  EXPECT_EQ(picture.agents.front().silent_s, 3);
  EXPECT_EQ(picture.agents[1].author.agent, 0) << "the others in their order";
  EXPECT_EQ(picture.agents_alive, 3);
  EXPECT_TRUE(picture.trouble);
}

TEST_F(TeamViewTest, AMemberWithoutAnyMessageIsSilentSinceWeListen) {
  hear_mission(at(0s));
  hear_all(at(2s), 0, 3);
  EXPECT_EQ(condition(3, at(2900ms)), Condition::kUnheard);
  EXPECT_EQ(condition(3, at(3s)), Condition::kSilent);
  EXPECT_FALSE(row(3, at(3s)).status);
  EXPECT_EQ(row(3, at(3500ms)).silent_s, 3.5);
}

TEST_F(TeamViewTest, AReplayKeepsNoProcessAlive) {
  hear_mission(at(0s));
  give(view_, status(1, 7), at(0s));
  for (int i = 1; i < 10; ++i) give(view_, status(1, 7), at(i * 1s));
  EXPECT_EQ(row(1, at(9s)).silent_s, 9);
}

TEST_F(TeamViewTest, AnAgentThatWaitsIsNamedWithTheProcessThatItWaitsFor) {
  hear_mission(at(0s));
  AgentStatus waiting = status(1, 1, 5);
  waiting.waiting_for = 3;
  give(view_, waiting, at(0s));
  EXPECT_EQ(condition(1, at(0s)), Condition::kOk) << "in lockstep every agent waits now and then";
  waiting.header.sequence = 2;
  give(view_, waiting, at(800ms));
  EXPECT_EQ(condition(1, at(800ms)), Condition::kWaiting);
  waiting.header = {kRun, 1, incarnation_of(1), 3, 6};
  give(view_, waiting, at(900ms));
  EXPECT_EQ(condition(1, at(900ms)), Condition::kOk) << "it has moved on";
  waiting.header.sequence = 4;
  waiting.waiting_for = kWorld;
  give(view_, waiting, at(1s));
  EXPECT_EQ(condition(1, at(1s)), Condition::kWaiting)
      << "an agent itself reports it only after a while";
}

TEST_F(TeamViewTest, ASlowLoopIsLate) {
  hear_mission(at(0s));
  AgentStatus slow = status(1, 1);
  slow.loop_lag_s = 0.49;
  give(view_, slow, at(0s));
  EXPECT_EQ(condition(1, at(0s)), Condition::kOk);
  slow.header.sequence = 2;
  slow.loop_lag_s = 0.5;
  give(view_, slow, at(0s));
  EXPECT_EQ(condition(1, at(0s)), Condition::kLate);
}

TEST_F(TeamViewRealtime, AnAgentHalfASecondBehindTheWorldIsLate) {
  hear_mission(at(0s));
  // dt 0.1 s at twice the speed: ten ticks are half a second, and one is on its way.
  give(view_, world_state(51, {{1, 1, 0}}), at(0s));
  give(view_, status(0, 1, 41), at(0s));
  give(view_, status(1, 1, 40), at(0s));
  EXPECT_EQ(condition(0, at(0s)), Condition::kOk);
  EXPECT_EQ(condition(1, at(0s)), Condition::kLate);
}

TEST_F(TeamViewTest, ARestartedAgentIsOneRowThatCountsItsFormerIncarnations) {
  std::vector<RosterEntry> roster = roster_of(4);
  roster[1].active_until = 20;
  roster.push_back({{1, 71}, 20, 30});
  roster.push_back({{1, 7}, 30, -1});
  hear_mission(at(0s), roster);
  AgentStatus successor = status(1, 1, 35);
  successor.header.incarnation = 7;
  give(view_, successor, at(0s));
  const AgentRow one = row(1, at(0s));
  EXPECT_EQ(one.author.incarnation, 7u);
  EXPECT_EQ(one.restarts, 2);
  EXPECT_EQ(one.condition, Condition::kOk);
  EXPECT_EQ(view_.picture(at(0s)).agents.size(), 4u);
  EXPECT_EQ(row(0, at(0s)).restarts, 0);
}

TEST_F(TeamViewTest, AnAgentThatHasLeftForGoodIsGoneAndMissing) {
  std::vector<RosterEntry> roster = roster_of(4);
  roster[2].active_until = 20;
  hear_mission(at(0s), roster);
  hear_all(at(0s), 30, 2);
  EXPECT_EQ(condition(2, at(0s)), Condition::kGone);
  EXPECT_TRUE(view_.complete());
  const TeamPicture picture = view_.picture(at(0s));
  EXPECT_EQ(picture.agents.back().author.agent, 2);
  EXPECT_EQ(picture.agents_alive, 3);
  EXPECT_EQ(picture.agents_expected, 4);
  EXPECT_TRUE(picture.trouble);
}

TEST_F(TeamViewTest, AProcessThatFallsSilentIsTrouble) {
  for (const AgentId silent : {kCoordinator, kWorld, kLogger}) {
    announce(small_mission(1));
    TeamView view(kRun, at(0s));
    give(view, test::mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
    for (const auto time : {0s, 3s}) {
      give(view, status(0, sequence_of(at(time))), at(time));
      if (silent != kCoordinator || time == 0s) give(view, coordinator_at(0), at(time));
      if (silent != kWorld || time == 0s) give(view, world_state(0, {{1, 1, 0}}), at(time));
      if (silent != kLogger || time == 0s)
        give(view, RecordAck{{kRun, kLogger, kLoggerLife, next_sequence(), 0}}, at(time));
    }
    const TeamPicture picture = view.picture(at(3s));
    EXPECT_TRUE(picture.trouble) << silent;
    for (const ProcessRow& row : picture.processes) {
      EXPECT_EQ(row.trouble, row.silent_s == 3) << row.name;
    }
  }
}

TEST_F(TeamViewTest, BeforeTheStartAMissingWorldOrOptionalLoggerIsNoTrouble) {
  hear_mission(at(0s), roster_of(4), 0, MissionState::kWaiting);
  give(view_, coordinator_at(0), at(3s));
  for (AgentId id = 0; id < 4; ++id) give(view_, status(id, 1), at(3s));
  EXPECT_FALSE(view_.picture(at(3s)).trouble);
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
TEST(TeamViewOfAReplay, JudgesSilenceByMissionTimeAlone) {
  TeamView view(kRun, at(0s), false, true);
  announce(small_mission(1));
  give(view, test::mission_part(0, MissionState::kRunning, roster_of(1), ""), at(0s));
  give(view, coordinator_at(0), at(0s));
  AgentStatus status = status_of(0, 1, 0);
  give(view, status, at(0s));
  const double dt_s = small_mission(1).timing.dt_s;
  give(view, world_state(static_cast<Tick>(5.9 / dt_s), {{1, 1, 0}}), at(60s));
  TeamPicture picture = view.picture(at(100s));
  EXPECT_TRUE(picture.replay);
  EXPECT_FALSE(picture.trouble);
  EXPECT_EQ(picture.agents_alive, 1);
  give(view, world_state(static_cast<Tick>(6.2 / dt_s), {{1, 1, 0}}), at(100s));
  picture = view.picture(at(100s));
  EXPECT_TRUE(picture.trouble);
  EXPECT_EQ(picture.agents.at(0).condition, Condition::kSilent);
  EXPECT_EQ(picture.agents_alive, 0);
}

}  // namespace ergocast
