// SPDX-License-Identifier: BSD-3-Clause
// The run record: its rows and numbers, its acknowledgements, and the effect of a gap or an end.
#include "logger/recorder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/noise.h"
#include "tests/logger/record.h"

namespace ergocast {
namespace {

using namespace test;

// ---- trajectory.csv ----

TEST(Trajectory, RowNHoldsThePlaceOfTickNAndTheCommandAppliedThere) {
  Record record(small_mission(1));
  record.deliver(state_of(0, {100, 500, 0}, {0, 0, 0}));
  EXPECT_TRUE(record.trajectory_rows().empty()) << "the command of tick 0 is not known yet";
  record.deliver(state_of(1, {101, 502, 0}, {10, 20, 0}));
  record.deliver(state_of(2, {104, 506, 0}, {30, 40, 0}));
  EXPECT_EQ(record.trajectory.str(),
            "tick,t_s,agent,x_m,y_m,vx_mps,vy_mps\n"
            "0,0,0,100,500,10,20\n"
            "1,0.10000000000000001,0,101,502,30,40\n");
}

TEST(Trajectory, EveryNumberReadsBackBitForBit) {
  Mission mission = small_mission(1);
  mission.timing.tick_count = 300;
  Record record(mission);
  std::vector<Eigen::Vector3d> places, commands;
  for (Tick tick = 0; tick <= 200; ++tick) {
    const auto step = static_cast<std::uint64_t>(tick);
    const double scale = std::pow(10, -static_cast<double>(tick % 20));
    places.push_back(on_ground(2000 * uniform_pair(1, Purpose::kStart, 0, step) * scale));
    commands.push_back(on_ground(normal_pair(1, Purpose::kStart, 1, step) * scale));
    record.deliver(state_of(tick, places.back(), commands.back()));
  }
  const auto rows = record.trajectory_rows();
  ASSERT_EQ(rows.size(), 200u);
  for (std::size_t n = 0; n < rows.size(); ++n) {
    EXPECT_EQ(number(rows[n], 1), static_cast<double>(n) * 0.1);
    EXPECT_EQ(number(rows[n], 3), places[n].x());
    EXPECT_EQ(number(rows[n], 4), places[n].y());
    EXPECT_EQ(number(rows[n], 5), commands[n + 1].x());
    EXPECT_EQ(number(rows[n], 6), commands[n + 1].y());
  }
}

TEST(Trajectory, RowsComeInOrderWhateverTheOrderOfArrival) {
  Record in_order(small_mission(1)), shuffled(small_mission(1));
  for (Tick tick = 0; tick <= 5; ++tick) in_order.deliver(state_of(tick));
  for (const Tick tick : {3, 1, 1, 5, 0, 4, 3, 2, 0}) shuffled.deliver(state_of(tick));
  ASSERT_EQ(in_order.trajectory_rows().size(), 5u);
  EXPECT_EQ(shuffled.trajectory.str(), in_order.trajectory.str());
  EXPECT_EQ(shuffled.metrics.str(), in_order.metrics.str());
}

TEST(Trajectory, WaitsForEveryPartOfAState) {
  const Mission mission = small_mission(2);
  Record record(mission);
  const auto part_of = [&](Tick tick, int part) {
    WorldState state = world_state(tick, {mission.starts_m[static_cast<std::size_t>(part)]});
    state.vehicles[0].id = part;
    state.part = part;
    state.parts = 2;
    return state;
  };
  record.deliver(part_of(0, 0));
  record.deliver(part_of(1, 0));
  record.deliver(part_of(1, 1));
  EXPECT_TRUE(record.trajectory_rows().empty());
  record.deliver(part_of(0, 1));
  const auto rows = record.trajectory_rows();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(columns(rows[0])[2], "0");
  EXPECT_EQ(columns(rows[1])[2], "1");
}

TEST(Trajectory, EndsWithTheLastTicksRow) {
  Mission mission = small_mission(1);
  mission.timing.tick_count = 3;
  Record record(mission);
  for (Tick tick = 0; tick <= 3; ++tick) record.deliver(state_of(tick));
  record.deliver(state_of(4));
  EXPECT_EQ(record.trajectory_rows().size(), 3u);
  EXPECT_EQ(record.recorder.facts().ticks, 3);
  EXPECT_EQ(record.recorder.facts().gaps, 0);
}

TEST(Trajectory, MissesNoRowForStatesBeyondThePlan) {
  Mission mission = small_mission(1);
  mission.timing.tick_count = 3;
  mission.timing.pace = Pace::kRealtime;
  Record record(mission);
  record.deliver(state_of(0));
  for (Tick tick = 4; tick < 100; ++tick) record.deliver(state_of(tick));
  for (Tick tick = 1; tick <= 3; ++tick) record.deliver(state_of(tick));
  EXPECT_EQ(record.trajectory_rows().size(), 3u);
  EXPECT_EQ(record.recorder.facts().gaps, 0);
}

TEST(Trajectory, DoesNotHoardStatesFromAnImpossibleFuture) {
  Record record(small_mission(1));
  record.deliver(state_of(1025, {1, 1, 0}, {0, 0, 0}));
  record.deliver(state_of(Tick{1} << 48, {1, 1, 0}, {0, 0, 0}));
  record.deliver(state_of(0));
  record.deliver(state_of(1));
  EXPECT_EQ(record.trajectory_rows().size(), 1u);
}

// ---- acknowledgements ----

TEST(Acknowledgement, FirstReportsThatTheRecordIsReady) {
  std::ostringstream trajectory, metrics;
  announce(small_mission(1));
  Recorder recorder(kRun, kLoggerLife, trajectory, metrics);
  EXPECT_TRUE(advance(recorder, at(0s)).empty()) << "not before it knows the mission";
  give(recorder, mission_part(0, MissionState::kWaiting, {}), at(0s));
  EXPECT_EQ(acks(advance(recorder, at(0s))), (std::vector<Tick>{-1}));
}

TEST(Acknowledgement, ComesEverySixteenRowsAndEveryTenthOfASecond) {
  Record record(small_mission(1));
  EXPECT_EQ(acks(record.deliver(state_of(0))), (std::vector<Tick>{-1}));
  std::vector<Tick> all;
  for (Tick tick = 1; tick <= 50; ++tick) {
    for (const Tick ack : acks(record.deliver(state_of(tick)))) all.push_back(ack);
  }
  EXPECT_EQ(all, (std::vector<Tick>{15, 31, 47}));
  EXPECT_TRUE(acks(advance(record.recorder, at(99ms))).empty());
  EXPECT_EQ(record.recorder.next_wakeup(), at(100ms));
  EXPECT_EQ(acks(advance(record.recorder, at(100ms))), (std::vector<Tick>{49}));
  EXPECT_EQ(acks(advance(record.recorder, at(200ms))), (std::vector<Tick>{49})) << "repeated";
}

TEST(Acknowledgement, NeverNamesATickThatIsNotWritten) {
  Record record(small_mission(1));
  record.deliver(state_of(0));
  record.deliver(state_of(1));
  for (Tick tick = 3; tick < 40; ++tick) {
    for (const Tick ack : acks(record.deliver(state_of(tick), at(tick * 1s)))) EXPECT_LE(ack, 0);
  }
  record.deliver(state_of(2), at(50s));
  EXPECT_EQ(acks(advance(record.recorder, at(51s))), (std::vector<Tick>{38}));
}

// ---- gaps ----

TEST(Gap, InLockstepTheRecordWaitsForTheMissingStateBecauseItIsRepeated) {
  Record record(small_mission(1));
  for (Tick tick = 0; tick <= 60; ++tick) {
    if (tick != 3) record.deliver(state_of(tick));
  }
  advance(record.recorder, at(30s));
  EXPECT_EQ(record.recorder.next_row(), 2);
  record.deliver(state_of(3), at(30s));
  EXPECT_EQ(record.recorder.next_row(), 60);
  EXPECT_EQ(record.recorder.facts().gaps, 0);
}

TEST(Gap, InLockstepARecorderThatWasCutOffAndGivenUpComesBackAndCountsTheRowsItLacks) {
  Mission mission = small_mission(1);
  mission.timing.tick_count = 10000;
  Record record(mission);
  const auto patience = seconds(mission.timing.lockstep_timeout_s / 2);
  for (Tick tick = 0; tick <= 10; ++tick) record.deliver(state_of(tick));
  // Meanwhile the world has continued, further than it would with a logger.
  record.deliver(state_of(500), at(1s));
  EXPECT_EQ(record.recorder.next_row(), 10) << "it may still be waiting for us";
  const Instant back = at(seconds(1)) + patience;
  const Outbox sent = record.deliver(state_of(501), back);
  ASSERT_EQ(acks(sent).size(), 1U);
  EXPECT_NE(header_of(sent.front().message).incarnation, kLoggerLife)
      << "as a logger that it takes back";
  record.deliver(state_of(502), back + seconds(1));
  record.deliver(state_of(503), back + seconds(2));
  EXPECT_EQ(number(record.trajectory_rows().back(), 0), 502);
  EXPECT_EQ(record.recorder.facts().gaps, 490);
}

TEST(Gap, InLockstepWhatStandsBehindAGapIsWrittenAtTheEnd) {
  Record record(small_mission(1));
  for (const Tick tick : {0, 1, 2, 20, 21, 22}) record.deliver(state_of(tick));
  record.recorder.stop("told to");
  EXPECT_EQ(number(record.trajectory_rows().back(), 0), 21);
  EXPECT_EQ(record.recorder.facts().gaps, 18);
}

TEST(Gap, InRealTimeTheRecordGoesOnAndCountsTheRowsItLacks) {
  Record record(realtime_mission());
  for (Tick tick = 0; tick <= 60; ++tick) {
    if (tick != 10 && tick != 11 && tick != 40) record.deliver(state_of(tick));
  }
  // A row needs its own state and the next one: 9, 10, 11 and 39, 40 are missing.
  std::vector<Tick> ticks;
  for (const std::string& row : record.trajectory_rows()) ticks.push_back(std::stoll(row));
  std::vector<Tick> expected;
  for (Tick tick = 0; tick < 60; ++tick) {
    if (tick < 9 || (tick > 11 && tick < 39) || tick > 40) expected.push_back(tick);
  }
  EXPECT_EQ(ticks, expected);
  EXPECT_EQ(record.recorder.facts().gaps, 5);
  EXPECT_EQ(record.recorder.facts().ticks, static_cast<Tick>(expected.size()));
}

TEST(Gap, ShortlyBeforeTheEndCostsNoOtherRow) {
  for (const bool by_stop : {false, true}) {
    Record record(realtime_mission());
    for (Tick tick = 0; tick <= 100; ++tick) {
      if (tick != 95) record.deliver(state_of(tick));
    }
    if (by_stop) {
      record.recorder.stop("SIGTERM");
    } else {
      record.deliver(mission_part(1, MissionState::kEnded, roster_of(1), "mission complete"));
      advance(record.recorder, at(1s));
    }
    EXPECT_TRUE(record.recorder.finished());
    EXPECT_EQ(record.trajectory_rows().size(), 98u);
    EXPECT_EQ(columns(record.trajectory_rows().back())[0], "99");
    EXPECT_EQ(record.recorder.facts().gaps, 2);
  }
}

// ---- metrics.csv ----

TEST(Metrics, ArePhiSquaredOfTheTruePlacesEverySecondAndAtTheLastTick) {
  Mission mission = small_mission(1);
  mission.timing.tick_count = 25;
  Record record(mission);
  Coefficients sums = Coefficients::Zero(20);
  const Coefficients weights = sobolev_weights(mission.basis, mission.domain);
  std::vector<double> expected;
  std::optional<double> acknowledged;
  for (Tick tick = 0; tick <= 25; ++tick) {
    acknowledged = found(record.deliver(state_of(tick)));
    const Eigen::Vector3d x_m(100 + static_cast<double>(tick), 500, 0);
    sums += 0.1 * basis_values(x_m, mission.domain, mission.basis);
    if (tick == 0 || tick == 10 || tick == 20 || tick == 24) {
      const Coefficients coverage = sums / (0.1 * static_cast<double>(tick + 1));
      expected.push_back(ergodic_metric(coverage, mission.target_coefficients, weights));
    }
  }
  EXPECT_EQ(record.metrics.str().substr(0, record.metrics.str().find('\n')),
            "tick,t_s,ergodic_metric,detection_probability,metric_spread,max_staleness_s,"
            "contributions_received,contributions_lost,blocked_share");
  const auto rows = record.metrics_rows();
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(columns(rows[1])[0], "10");
  EXPECT_EQ(columns(rows[3])[0], "24");
  EXPECT_EQ(number(rows[1], 1), 1.0);
  EXPECT_GT(number(rows[3], 3), 0);
  EXPECT_EQ(acknowledged, number(rows[3], 3)) << "the last acknowledgement says what was found";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // The order of summation differs: 25 samples of 20 modes.
    EXPECT_NEAR(number(rows[i], 2), expected[i], 1e-13 * expected[i]);
  }
  const RunFacts& facts = record.recorder.facts();
  EXPECT_EQ(facts.ergodic_metric_first, number(rows.front(), 2));
  EXPECT_EQ(facts.ergodic_metric_last, number(rows.back(), 2));
  EXPECT_EQ(facts.ergodic_metric.size(), 4u);
}

TEST(Metrics, CountWhatTheNewestStatusOfEachAgentReports) {
  Record record(small_mission(3));
  const auto report = [](AgentId id, std::int64_t sequence, double metric, double staleness,
                         std::int64_t received, std::int64_t lost) {
    AgentStatus status = status_of(id, sequence, 0);
    status.ergodic_metric = metric;
    status.max_staleness_s = staleness;
    status.contributions_received = received;
    status.contributions_lost = lost;
    status.blocked_ticks = id == 0 ? 1 : 0;
    return status;
  };
  record.deliver(report(0, 7, 0.5, 1.5, 100, 3));
  record.deliver(report(0, 6, 99, 99, 1, 1));  // older
  record.deliver(report(1, 1, 0.25, 2.5, 200, 4));
  record.deliver(report(2, 1, 0.75, 0.5, 300, 5));
  AgentStatus newcomer = status_of(1, 2);  // φ² without any coverage has no meaning
  newcomer.ergodic_metric = 7;
  newcomer.max_staleness_s = 2.5;
  newcomer.contributions_received = 200;
  newcomer.contributions_lost = 4;
  record.deliver(newcomer);
  AgentStatus foreign = report(2, 9, 1e9, 1e9, 1000, 1000);
  foreign.header.run = kRun + 1;
  record.deliver(foreign);
  record.deliver(state_of(0));
  record.deliver(state_of(1));
  const auto rows = record.metrics_rows();
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(number(rows[0], 4), 0.25) << "max − min of φ² as the agents see it";
  EXPECT_EQ(number(rows[0], 5), 2.5) << "the worst-informed agent's";
  EXPECT_EQ(columns(rows[0])[6], "600");
  EXPECT_EQ(columns(rows[0])[7], "12");
  EXPECT_EQ(number(rows[0], 8), 0.5) << "one of two ticks";
}

TEST(Metrics, AnAgentThatHasLeftCountsInTheTotalsButNotInTheSpread) {
  Record record(small_mission(2));
  AgentStatus gone = status_of(1, 1);
  gone.ergodic_metric = 50;
  gone.max_staleness_s = 50;
  gone.contributions_received = 7;
  AgentStatus here = status_of(0, 1);
  here.ergodic_metric = 1;
  here.contributions_received = 10;
  record.deliver(gone);
  record.deliver(here);
  std::vector<RosterEntry> roster = roster_of(2);
  roster[1].active_until = 0;
  record.deliver(mission_part(1, MissionState::kRunning, roster));
  record.deliver(state_of(0));
  record.deliver(state_of(1));
  const auto rows = record.metrics_rows();
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(number(rows[0], 4), 0);
  EXPECT_EQ(number(rows[0], 5), 0);
  EXPECT_EQ(columns(rows[0])[6], "17");
}

TEST(Metrics, ShowWhatTheWorldMissedAndSkipped) {
  Record record(realtime_mission());
  WorldState state = state_of(0);
  state.missed_deadlines = 4;
  state.skipped_ticks = 2;
  record.deliver(state);
  EXPECT_EQ(record.recorder.facts().missed_deadlines, 4);
  EXPECT_EQ(record.recorder.facts().skipped_ticks, 2);
}

TEST(Metrics, TicksOfAPauseThatIsTakenBackCountAfterAll) {
  // The coordinator that named a second pause stopped, and no agent had received the pause.
  Record record(small_mission(1));
  const auto run_ticks = [&](Tick from, Tick to, const auto& uncounted_at) {
    for (Tick tick = from; tick < to; ++tick) {
      WorldState state = state_of(tick);
      state.uncounted_ticks = uncounted_at(tick);
      record.deliver(state);
    }
  };
  run_ticks(0, 9,
            [](Tick tick) { return std::max<Tick>(0, tick - 3) - std::max<Tick>(0, tick - 5); });
  EXPECT_EQ(record.recorder.facts().held_ticks, 2);
  run_ticks(9, 15, [](Tick tick) { return tick - 7; });
  EXPECT_EQ(record.recorder.facts().held_ticks, 7);
  run_ticks(15, 20, [](Tick) { return 2; });
  EXPECT_EQ(record.recorder.facts().ticks, 19);
  EXPECT_EQ(record.recorder.facts().held_ticks, 2) << "those of the pause before it";
}

// ---- the end ----

TEST(RecordEnd, ComesASecondAfterTheLastTickSoThatLastStatusesCount) {
  Mission mission = small_mission(1);
  mission.timing.tick_count = 2;
  Record record(mission);
  for (Tick tick = 0; tick <= 2; ++tick) record.deliver(state_of(tick), at(5s));
  EXPECT_FALSE(record.recorder.finished());
  record.deliver(status_of(0, 9), at(5500ms));
  EXPECT_EQ(acks(advance(record.recorder, at(6s))), (std::vector<Tick>{1}));
  EXPECT_TRUE(record.recorder.finished());
  EXPECT_STREQ(record.recorder.result(), "done");
  EXPECT_EQ(record.recorder.statuses().at(author_of(0)).header.sequence, 9);
  EXPECT_EQ(record.recorder.next_wakeup(), Instant::max());
}

TEST(RecordEnd, ReportsThatAMissionFailedAndWhyAndKeepsWhatIsThere) {
  Record record(small_mission(1));
  for (Tick tick = 0; tick <= 7; ++tick) record.deliver(state_of(tick));
  record.deliver(mission_part(1, MissionState::kFailed, roster_of(1), "agent 0 is late"), at(5s));
  record.deliver(state_of(8), at(5500ms));
  advance(record.recorder, at(6400ms));
  EXPECT_FALSE(record.recorder.finished()) << "a missing state may still come";
  advance(record.recorder, at(6500ms));
  EXPECT_TRUE(record.recorder.finished());
  EXPECT_STREQ(record.recorder.result(), "failed");
  EXPECT_EQ(record.recorder.reason(), "agent 0 is late");
  EXPECT_EQ(record.trajectory_rows().size(), 8u);
}

TEST(RecordEnd, AStopAtOnceEndsItWithTheStopsReason) {
  for (const bool failed : {false, true}) {
    Record record(small_mission(1));
    record.deliver(Stop{{kRun + 1, kOperator, 1, 1, 0}, true, "another run's", true}, at(0s));
    record.deliver(Stop{{kRun, kOperator, 1, 1, 0}, true, "the coordinator's to obey"}, at(0s));
    record.deliver(Stop{{kRun, kOperator, 1, 1, 0}, failed, "enough", true}, at(5s));
    record.deliver(mission_part(1, MissionState::kEnded, roster_of(1), "later"), at(5s));
    advance(record.recorder, at(6s));
    EXPECT_TRUE(record.recorder.finished());
    EXPECT_STREQ(record.recorder.result(), failed ? "failed" : "stopped");
    EXPECT_EQ(record.recorder.reason(), "enough");
    EXPECT_TRUE(record.recorder.facts().halted);
  }
}

TEST(RecordEnd, ComesByItselfOnceThePlansLastTickIsLongPastAndNoMessagesArrive) {
  Record record(realtime_mission());  // 10 s
  for (const Tick tick : {0, 1, 40}) record.deliver(state_of(tick), at(4s));
  advance(record.recorder, at(40s));  // 6 s after tick 40, and 30 s more
  EXPECT_FALSE(record.recorder.finished());
  record.deliver(mission_part(0, MissionState::kRunning, roster_of(1)), at(40s));
  advance(record.recorder, at(76s));
  EXPECT_FALSE(record.recorder.finished()) << "the coordinator has sent a message";
  advance(record.recorder, at(76s + 1ms));
  EXPECT_TRUE(record.recorder.finished());
  EXPECT_STREQ(record.recorder.result(), "stopped");
  EXPECT_EQ(
      record.recorder.reason(),
      "nothing arrives from the world or the coordinator, and the mission must be over by now");
  EXPECT_EQ(record.trajectory_rows().size(), 1u);
}

TEST(RecordEnd, ItsOwnProcessMayEndIt) {
  Record record(small_mission(1));
  for (Tick tick = 0; tick <= 3; ++tick) record.deliver(state_of(tick));
  record.recorder.stop("SIGTERM");
  EXPECT_TRUE(record.recorder.finished());
  EXPECT_STREQ(record.recorder.result(), "stopped");
  EXPECT_EQ(record.recorder.reason(), "SIGTERM");
  EXPECT_EQ(record.trajectory_rows().size(), 3u);
}

TEST(RecordedStatuses, AreTheNewestWithTheWorstLagOfAll) {
  Record record(small_mission(1));
  AgentStatus status = status_of(0, 1);
  for (const double lag_s : {0.1, 0.7, 0.2}) {
    status.loop_lag_s = lag_s;
    record.deliver(status);
    ++status.header.sequence;
  }
  EXPECT_EQ(record.recorder.statuses().at(author_of(0)).loop_lag_s, 0.7);
  EXPECT_EQ(record.recorder.statuses().at(author_of(0)).header.sequence, 3);
}

TEST(RecordEnd, APlanItCannotReadEndsItAtOnce) {
  std::ostringstream trajectory, metrics;
  Recorder recorder(kRun, kLoggerLife, trajectory, metrics);
  announced_plan = kNoPlan;
  give(recorder, mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
  EXPECT_TRUE(recorder.finished());
  EXPECT_STREQ(recorder.result(), "failed");
  EXPECT_EQ(recorder.reason(), why_no_plan());
}

}  // namespace
}  // namespace ergocast
