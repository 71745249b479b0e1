// SPDX-License-Identifier: BSD-3-Clause
// A logger that was killed and continues. Nothing is written twice or changed, and only rows that
// no process can repeat are missing.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/base/noise.h"
#include "logger/run_record.h"
#include "modes/provide.h"
#include "tests/logger/record.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;
namespace fs = std::filesystem;

constexpr Incarnation kNextWorldLife = kWorldLife + 1;

/// Three agents that jump between positions, which use all digits of a double. Two come near each
/// other at tick 7.
WorldState team_at(Tick tick) {
  WorldState state = world_state(tick, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  for (AgentId id = 0; id < 3; ++id) {
    Vehicle& vehicle = state.vehicles[static_cast<std::size_t>(id)];
    const auto step = static_cast<std::uint64_t>(tick);
    vehicle.position_m =
        on_ground(2000 * uniform_pair(1, Purpose::kStart, static_cast<std::uint32_t>(id), step));
    vehicle.velocity_mps =
        on_ground(normal_pair(2, Purpose::kStart, static_cast<std::uint32_t>(id), step));
  }
  if (tick == 7) {
    const Eigen::Vector3d& x_m = state.vehicles[0].position_m;
    state.vehicles[1].position_m = x_m + 1e-3 * (on_ground({1000, 1000}) - x_m);
  }
  return state;
}

WorldState of_world(Incarnation incarnation, WorldState state) {
  state.header.incarnation = incarnation;
  return state;
}

/// The first columns, which do not depend on the arrival of statuses.
std::vector<std::string> observed(const std::vector<std::string>& metrics_rows) {
  std::vector<std::string> rows;
  for (const std::string& row : metrics_rows) {
    const auto fields = columns(row);
    rows.push_back(fields[0] + ',' + fields[1] + ',' + fields[2] + ',' + fields[3]);
  }
  return rows;
}

std::vector<std::string> joined(std::vector<std::string> first,
                                const std::vector<std::string>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

class Resume : public testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) const {
    std::ofstream(dir / file, std::ios::binary) << text;
  }
  std::string read(const std::string& file) const {
    std::ifstream in(dir / file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// The data that a resumed recorder finds after a killed one with these files.
  RunData past(const std::string& trajectory, const std::string& metrics) const {
    write("trajectory.csv", trajectory);
    write("metrics.csv", metrics);
    return read_run(dir, small_mission(1)).value();
  }
  /// The data after rows 0 … 9 of a single agent on its line.
  RunData ten_rows() const {
    Record former(small_mission(1));
    for (Tick tick = 0; tick <= 10; ++tick) former.deliver(state_of(tick));
    return past(former.trajectory.str(), former.metrics.str());
  }

  const test::TempFolder own;
  const fs::path& dir = own.path();
};

// ---- the same record as without a kill ----

TEST_F(Resume, WhereverTheFilesAreCutTheRecordIsThatOfARecorderThatWasNotStopped) {
  Mission mission = small_mission(3);
  mission.separation.distance_m = 1;
  mission.speed_limit_mps = 20;
  Record lived(mission), killed(mission);
  for (Tick tick = 0; tick <= 100; ++tick) lived.deliver(team_at(tick));
  for (Tick tick = 0; tick <= 60; ++tick) killed.deliver(team_at(tick));
  ASSERT_EQ(lived.trajectory_rows().size(), 300u);
  EXPECT_LT(lived.recorder.facts().nearest_m, 2) << "at tick 7";
  const std::string trajectory = killed.trajectory.str(), metrics = killed.metrics.str();
  for (std::size_t cut = 0; cut < trajectory.size(); cut += 71) {
    // One table may be longer than the other.
    const std::string rows = trajectory.substr(0, cut);
    const std::string values = metrics.substr(0, cut * 13 % metrics.size());
    Record resumed(mission, past(rows, values));
    for (Tick tick = 0; tick <= 100; ++tick) resumed.deliver(team_at(tick));
    ASSERT_EQ(joined(rows_of(rows), resumed.trajectory_rows()), lived.trajectory_rows()) << cut;
    ASSERT_EQ(observed(joined(rows_of(values), resumed.metrics_rows())),
              observed(lived.metrics_rows()))
        << cut;
    const RunFacts &facts = resumed.recorder.facts(), &all = lived.recorder.facts();
    EXPECT_EQ(facts.ticks, 100);
    EXPECT_EQ(facts.gaps, 0);
    EXPECT_EQ(facts.t_s, all.t_s);
    EXPECT_EQ(facts.ergodic_metric, all.ergodic_metric);
    EXPECT_EQ(facts.ergodic_metric_first, all.ergodic_metric_first);
    EXPECT_EQ(facts.ergodic_metric_last, all.ergodic_metric_last);
    EXPECT_EQ(facts.nearest_m, all.nearest_m);
  }
}

/// Three reports of an object confirm it, two of them recorded by the former process.
TEST_F(Resume, ReportsOfTheFormerProcessCount) {
  Mission mission = small_mission(1);
  mission.objects.count = 1;
  mission.sensor.false_alarms_per_s = 0.01;
  const auto seen_at = [](Tick tick) {
    WorldState state = state_of(tick);
    const bool sees = tick == 3 || tick == 5 || tick == 12;
    state.vehicles[0].detected = sees ? 1 : 0;
    state.vehicles[0].reported_cell = sees ? 7 : kNoCell;
    return state;
  };
  Record whole(mission), first(mission);
  for (Tick tick = 0; tick < 20; ++tick) {
    whole.deliver(seen_at(tick));
    if (tick < 10) first.deliver(seen_at(tick));
  }
  EXPECT_TRUE(whole.trajectory_rows()[3].ends_with(",1,7")) << whole.trajectory_rows()[3];
  EXPECT_TRUE(whole.trajectory_rows()[4].ends_with(",0,-1")) << whole.trajectory_rows()[4];
  Record second(mission, past(first.trajectory.str(), first.metrics.str()));
  for (Tick tick = 9; tick < 20; ++tick) second.deliver(seen_at(tick));
  const std::vector<Find>& finds = whole.recorder.facts().finds.list();
  const std::vector<Find>& resumed = second.recorder.facts().finds.list();
  ASSERT_EQ(finds.size(), 1u);
  EXPECT_EQ(finds[0].tick, 12);
  ASSERT_EQ(resumed.size(), 1u);
  EXPECT_EQ(resumed[0].tick, 12);
  EXPECT_EQ(second.recorder.facts().wrong_confirmations, 0);
}

/// Object 5 does not exist.
TEST_F(Resume, FindsOfTheFormerProcessCount) {
  Mission mission = small_mission(1);
  mission.objects.count = 4;
  const auto found_at = [](Tick tick, ObjectSet detected) {
    WorldState state = state_of(tick);
    state.vehicles[0].detected = detected;
    return state;
  };
  Record whole(mission), first(mission);
  for (Tick tick = 0; tick < 20; ++tick) {
    const ObjectSet detected = tick == 3 ? 0b100100 : tick == 12 ? 0b000111 : 0;
    whole.deliver(found_at(tick, detected));
    if (tick < 10) first.deliver(found_at(tick, detected));
  }
  const std::vector<Find>& finds = whole.recorder.facts().finds.list();
  ASSERT_EQ(finds.size(), 3u);
  EXPECT_EQ(finds[0].object, 2);
  EXPECT_EQ(finds[0].tick, 3);
  EXPECT_EQ(finds[0].x_m, state_of(3).vehicles[0].position_m);
  EXPECT_NEAR(finds[0].t_s, 0.3, 1e-12);
  EXPECT_EQ(finds[2].object, 1);
  EXPECT_EQ(finds[2].tick, 12);
  EXPECT_TRUE(whole.trajectory_rows()[3].ends_with(",4")) << whole.trajectory_rows()[3];

  Record second(mission, past(first.trajectory.str(), first.metrics.str()));
  for (Tick tick = 9; tick < 20; ++tick) second.deliver(found_at(tick, tick == 12 ? 0b111 : 0));
  const std::vector<Find>& again = second.recorder.facts().finds.list();
  ASSERT_EQ(again.size(), 3u);
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(again[i].object, finds[i].object);
    EXPECT_EQ(again[i].tick, finds[i].tick);
  }
}

TEST_F(Resume, ACompleteRecordIsDone) {
  Record former(small_mission(1));
  for (Tick tick = 0; tick <= 100; ++tick) former.deliver(state_of(tick));
  Record resumed(small_mission(1), past(former.trajectory.str(), former.metrics.str()));
  EXPECT_EQ(acks(advance(resumed.recorder, at(0s))), (std::vector<Tick>{99}));
  advance(resumed.recorder, at(1s));
  EXPECT_TRUE(resumed.recorder.finished());
  EXPECT_STREQ(resumed.recorder.result(), "done");
  EXPECT_EQ(resumed.recorder.facts().ticks, 100);
  EXPECT_TRUE(resumed.trajectory_rows().empty());
}

TEST_F(Resume, WithoutARecordOneIsBegun) {
  Record resumed(small_mission(1), RunData{});
  for (Tick tick = 0; tick <= 20; ++tick) resumed.deliver(state_of(tick));
  EXPECT_EQ(resumed.trajectory_rows().size(), 20u);
  EXPECT_EQ(resumed.recorder.facts().gaps, 0);
}

TEST_F(Resume, GapsOfTheFormerProcessStayCounted) {
  Record former(realtime_mission());
  for (Tick tick = 0; tick <= 40; ++tick) {
    if (tick != 10) former.deliver(state_of(tick));
  }
  Record resumed(realtime_mission(), past(former.trajectory.str(), former.metrics.str()));
  for (Tick tick = 40; tick <= 60; ++tick) resumed.deliver(state_of(tick));
  EXPECT_EQ(resumed.recorder.facts().gaps, 2);
  EXPECT_EQ(resumed.recorder.facts().ticks, 58);
}

TEST_F(Resume, CountsOfMessagesDoNotFallBack) {
  Record former(small_mission(1));
  AgentStatus status = status_of(0, 1, 0);
  status.contributions_received = 700;
  status.contributions_lost = 7;
  former.deliver(status);
  for (Tick tick = 0; tick <= 5; ++tick) former.deliver(state_of(tick));
  Record resumed(small_mission(1), past(former.trajectory.str(), former.metrics.str()));
  for (Tick tick = 5; tick <= 15; ++tick) resumed.deliver(state_of(tick));
  ASSERT_EQ(resumed.metrics_rows().size(), 1u);
  EXPECT_EQ(columns(resumed.metrics_rows()[0])[6], "700");
  EXPECT_EQ(columns(resumed.metrics_rows()[0])[7], "7");
}

TEST_F(Resume, WhatIsAcknowledgedIsInTheFile) {
  auto record = RunRecord::create(dir).value();
  const Mission mission = small_mission(1);
  announce(mission);
  Recorder recorder(kRun, kLoggerLife, record->trajectory(), record->metrics());
  give(recorder, mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
  int seen = 0;
  for (Tick tick = 0; tick <= 60; ++tick) {
    give(recorder, state_of(tick), at(0s));
    for (const Tick ack : acks(advance(recorder, at(0s)))) {
      EXPECT_EQ(rows_of(read("trajectory.csv")).size(), static_cast<std::size_t>(ack + 1));
      EXPECT_EQ(rows_of(read("metrics.csv")).size(), static_cast<std::size_t>(ack + 10) / 10);
      ++seen;
    }
  }
  EXPECT_EQ(seen, 4);
}

// ---- gaps in lockstep ----

TEST_F(Resume, AStateThatIsRepeatedInTimeIsNoGap) {
  Record resumed(small_mission(1), ten_rows());
  EXPECT_EQ(acks(resumed.deliver(state_of(30), at(10s))), (std::vector<Tick>{9}));
  for (Tick tick = 10; tick < 30; ++tick)
    resumed.deliver(state_of(tick), at(10s + (tick - 9) * 200ms));
  EXPECT_EQ(resumed.recorder.next_row(), 30);
  EXPECT_EQ(resumed.recorder.facts().gaps, 0);
}

TEST_F(Resume, WhatIsNotRepeatedWithinHalfASecondIsAGap) {
  Record resumed(small_mission(1), ten_rows());
  for (const Tick tick : {30, 31, 33, 34}) resumed.deliver(state_of(tick), at(10s));
  advance(resumed.recorder, at(10499ms));
  EXPECT_EQ(resumed.recorder.next_row(), 10);
  advance(resumed.recorder, at(10500ms));
  EXPECT_EQ(resumed.recorder.next_row(), 31);
  EXPECT_EQ(resumed.recorder.facts().gaps, 20);
  advance(resumed.recorder, at(30s));
  EXPECT_EQ(resumed.recorder.next_row(), 31) << "32 came after the first that was received";
  resumed.deliver(state_of(32), at(30s));
  EXPECT_EQ(resumed.recorder.next_row(), 34);
  EXPECT_EQ(resumed.recorder.facts().gaps, 20);
}

TEST_F(Resume, AGapEndsAtTheFirstStateReceivedEvenIfTheNextIsMissing) {
  Record resumed(small_mission(1), ten_rows());
  for (const Tick tick : {30, 32}) resumed.deliver(state_of(tick), at(10s));
  advance(resumed.recorder, at(30s));
  EXPECT_EQ(resumed.recorder.next_row(), 30);
  resumed.deliver(state_of(31), at(30s));
  EXPECT_EQ(resumed.recorder.next_row(), 32);
}

TEST_F(Resume, AGapEndsWithTheFirstPairThatIsRepeated) {
  Record resumed(small_mission(1), ten_rows());
  for (const Tick tick : {30, 20, 21, 18}) resumed.deliver(state_of(tick), at(10s));
  advance(resumed.recorder, at(11s));
  EXPECT_EQ(resumed.recorder.next_row(), 21);
  EXPECT_EQ(resumed.recorder.facts().gaps, 10);
}

TEST_F(Resume, NothingIsGivenUpWhileNoNewerStateIsHeld) {
  Record resumed(small_mission(1), ten_rows());
  advance(resumed.recorder, at(1h));
  resumed.deliver(state_of(10), at(2h));
  advance(resumed.recorder, at(3h));
  EXPECT_EQ(resumed.recorder.next_row(), 10);
  EXPECT_EQ(resumed.recorder.facts().gaps, 0);
}

TEST_F(Resume, ALastTickThatWasCutOffCannotBecomeAGap) {
  const Mission mission = small_mission(3);
  Record former(mission);
  for (Tick tick = 0; tick <= 10; ++tick) former.deliver(team_at(tick));
  const std::string rows = former.trajectory.str();
  const std::string cut = rows.substr(0, rows.rfind('\n', rows.size() - 2) + 5);  // 9's third row
  Record resumed(mission, past(cut, former.metrics.str()));
  for (const Tick tick : {20, 21}) resumed.deliver(team_at(tick), at(10s));
  advance(resumed.recorder, at(11s));
  EXPECT_EQ(resumed.recorder.next_row(), 21);
  EXPECT_EQ(resumed.recorder.facts().gaps, 10) << "10 … 19: of 9 there are rows";
  EXPECT_EQ(resumed.recorder.facts().ticks, 11);
}

TEST_F(Resume, TheWorldMayHaveGoneFarAheadButNotBeyondTheMission) {
  Mission mission = small_mission(1);
  mission.timing.tick_count = 9000;
  Record resumed(mission, ten_rows());
  for (const Tick tick : {9001, 8000, 8001}) resumed.deliver(state_of(tick), at(10s));
  advance(resumed.recorder, at(11s));
  EXPECT_EQ(resumed.recorder.next_row(), 8001);
  EXPECT_EQ(resumed.recorder.facts().gaps, 7990);
}

TEST_F(Resume, ARecordThatEndsWritesWhatStandsBehindTheGap) {
  Record resumed(small_mission(1), ten_rows());
  for (const Tick tick : {30, 31, 32}) resumed.deliver(state_of(tick), at(10s));
  resumed.recorder.stop("SIGTERM");
  EXPECT_EQ(resumed.recorder.next_row(), 32);
  EXPECT_EQ(resumed.recorder.facts().gaps, 20);
}

TEST_F(Resume, ANewWorldMayLeaveAGapBeforeItsFirstState) {
  Record record(small_mission(1));
  for (Tick tick = 0; tick <= 10; ++tick) record.deliver(state_of(tick));
  for (const Tick tick : {14, 15, 17}) {
    record.deliver(of_world(kNextWorldLife, state_of(tick)), at(10s));
  }
  advance(record.recorder, at(10499ms));
  EXPECT_EQ(record.recorder.next_row(), 10);
  advance(record.recorder, at(14s));
  EXPECT_EQ(record.recorder.next_row(), 15) << "16 is repeated by the world that sent 17";
  EXPECT_EQ(record.recorder.facts().gaps, 4);
}

TEST_F(Resume, ANewWorldThatRepeatsWhatIsRecordedChangesNothing) {
  for (Mission mission : {small_mission(1), realtime_mission()}) {
    Record record(mission);
    for (Tick tick = 0; tick <= 10; ++tick) record.deliver(state_of(tick));
    // The new world does not know which velocities led there.
    record.deliver(of_world(kNextWorldLife, state_of(8, {108, 500, 0}, {0, 0, 0})), at(1s));
    record.deliver(of_world(kNextWorldLife, state_of(10, {110, 500, 0}, {0, 0, 0})), at(1s));
    for (Tick tick = 11; tick <= 20; ++tick) {
      record.deliver(of_world(kNextWorldLife, state_of(tick)), at(1s));
    }
    const auto rows = record.trajectory_rows();
    ASSERT_EQ(rows.size(), 20u);
    for (const std::string& row : rows) EXPECT_EQ(number(row, 5), 10) << row;
    EXPECT_EQ(record.recorder.facts().gaps, 0);
  }
}

TEST_F(Resume, AStateThatIsHeldIsNotReplacedByANewWorldsRepeat) {
  Record record(small_mission(1));
  for (const Tick tick : {0, 1, 3, 4}) record.deliver(state_of(tick));
  record.deliver(of_world(kNextWorldLife, state_of(4, {104, 500, 0}, {0, 0, 0})), at(1s));
  advance(record.recorder, at(2s));
  const auto rows = record.trajectory_rows();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(columns(rows[1])[0], "3");
  EXPECT_EQ(number(rows[1], 5), 10);
}

TEST_F(Resume, PartsOfTwoWorldsMakeNoState) {
  Record record(small_mission(2));
  const auto part_of = [](Incarnation world, Tick tick, int part) {
    WorldState state = of_world(world, world_state(tick, {{100, 500, 0}}));
    state.vehicles[0].id = part;
    state.part = part;
    state.parts = 2;
    return state;
  };
  for (const int part : {0, 1}) record.deliver(part_of(kWorldLife, 0, part));
  record.deliver(part_of(kWorldLife, 1, 0));
  record.deliver(part_of(kNextWorldLife, 1, 1));
  EXPECT_TRUE(record.trajectory_rows().empty());
  record.deliver(part_of(kNextWorldLife, 1, 0));
  EXPECT_EQ(record.trajectory_rows().size(), 2u);
}

// ---- segments ----

TEST_F(Resume, EachProcessHasFilesOfItsOwn) {
  EXPECT_EQ(segment_count(dir), 0);
  for (int segment = 0; segment < 3; ++segment) {
    const auto record = RunRecord::go_on(dir).value();
    EXPECT_EQ(record->segment(), segment);
    record->trajectory() << "rows of " << segment << '\n';
    EXPECT_EQ(record->flush(), std::nullopt);
    EXPECT_EQ(segment_count(dir), segment + 1);
  }
  EXPECT_EQ(read("trajectory.csv"), "rows of 0\n");
  EXPECT_EQ(read("trajectory-001.csv"), "rows of 1\n");
  EXPECT_EQ(read("trajectory-002.csv"), "rows of 2\n");
  EXPECT_TRUE(fs::exists(dir / "metrics-002.csv"));
}

TEST_F(Resume, WithoutBeingAskedToARecordIsNotGoneOnWith) {
  write("trajectory.csv", "old");
  const auto refused = RunRecord::create(dir);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().find("--resume"), std::string::npos);
  EXPECT_EQ(read("trajectory.csv"), "old");
}

TEST_F(Resume, AKillBetweenTheTwoFilesOfASegmentCostsNothing) {
  write("trajectory.csv", "");
  const auto record = RunRecord::go_on(dir).value();
  EXPECT_EQ(record->segment(), 0);
  EXPECT_EQ(segment_count(dir), 1);
}

TEST_F(Resume, ATableThatLacksItsOtherIsASegmentThatIsNotOverwritten) {
  write("trajectory.csv", "precious");
  const auto record = RunRecord::go_on(dir).value();
  EXPECT_EQ(record->segment(), 1);
  EXPECT_EQ(read("trajectory.csv"), "precious");
  EXPECT_EQ(segment_count(dir), 2);
  const auto table = read_run(dir, small_mission(1));
  ASSERT_FALSE(table);
  EXPECT_NE(table.error().find("metrics.csv: cannot be opened"), std::string::npos)
      << table.error();
}

TEST_F(Resume, OfEachDamagedFileTheRowsBeforeTheDamageCount) {
  const std::string header = std::string(kTrajectoryHeader) + '\n',
                    values = std::string(kMetricsHeader) + '\n';
  write("trajectory.csv",
        header + "0,0,0,1,1,0,0\n1,0.1,0,2,2,0,0\n2,0.2,5,garbage\n3,0.3,0,9,9,0,0\n");
  write("metrics.csv", "another header\n");
  write("trajectory-001.csv", header + "7,0.7,0,3,3,0,0\n");
  write("metrics-001.csv", values + "7,0.7,0.5,0.25,0,0,0,0,0\n");
  write("trajectory-002.csv", header + "9,0.9,0,4,4,0,0\n");
  RunData run;
  const auto damage = read_up_to_damage(dir, run);
  ASSERT_TRUE(damage);
  EXPECT_NE(damage->find("trajectory.csv:4: "), std::string::npos) << *damage;
  ASSERT_EQ(run.tracks.size(), 1u) << "an agent without a readable row has no track";
  std::vector<Tick> ticks;
  for (const TrackPoint& row : run.tracks.at(0)) ticks.push_back(row.tick);
  EXPECT_EQ(ticks, (std::vector<Tick>{0, 1, 7, 9}));
  ASSERT_EQ(run.metrics.size(), 1u);
  EXPECT_EQ(run.metrics.front().tick, 7);
}

TEST_F(Resume, ADiscardedSegmentLeavesNoTrace) {
  write("trajectory.csv", "rows\n");
  write("metrics.csv", "");
  RunRecord::go_on(dir).value()->discard();
  EXPECT_EQ(segment_count(dir), 1);
  EXPECT_FALSE(fs::exists(dir / "trajectory-001.csv"));
  EXPECT_FALSE(fs::exists(dir / "metrics-001.csv"));
  EXPECT_EQ(read("trajectory.csv"), "rows\n");
}

// No table of the record has this metric.
TEST_F(Resume, KnowsTheMetricInCosinesWithoutARowMore) {
  Mission mission = small_mission(1);
  mission.cosine_target = mission.target_coefficients;
  mission.basis.free_domain = true;
  mission.basis.table_hash = table_of(mission).value()->hash;
  Record lived(mission);
  EXPECT_TRUE(std::isnan(lived.recorder.facts().cosine_metric_last)) << "no agent has moved yet";
  for (Tick tick = 0; tick <= 100; ++tick) lived.deliver(state_of(tick));
  const double metric = lived.recorder.facts().cosine_metric_last;
  EXPECT_GT(metric, 0);
  Record resumed(mission, past(lived.trajectory.str(), lived.metrics.str()));
  EXPECT_EQ(resumed.recorder.facts().cosine_metric_last, metric);
}

}  // namespace
}  // namespace ergocast
