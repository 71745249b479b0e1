// SPDX-License-Identifier: BSD-3-Clause
// Each process that writes a record has files of its own, and damage to one spares the others.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "logger/run_record.h"
#include "tests/logger/resumed_record.h"

namespace ergocast {
namespace {

using namespace test;
namespace fs = std::filesystem;

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

}  // namespace
}  // namespace ergocast
