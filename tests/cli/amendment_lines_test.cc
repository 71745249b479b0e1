// SPDX-License-Identifier: BSD-3-Clause
// What the closing lines name of targets, ends, laws and zones, and when a record's mission ends.
#include "cli/record/amendment_lines.h"

#include <gtest/gtest.h>

#include "cli/record/run_directory.h"
#include "logger/amendments_file.h"
#include "logger/run_record.h"
#include "tests/support/team.h"
#include "tests/support/temp_folder.h"

namespace ergocast::cli {
namespace {

using namespace test;

class AmendmentLines : public ::testing::Test {
 protected:
  TargetChange target(double number) const {
    TargetChange change{.target = mission_.target_coefficients};
    change.target[1] = number;
    return change;
  }
  /// Agents 0 to 3 stand; the first two of them are in the zone.
  RunData run() const {
    RunData run;
    run.amendments.note(list_);
    for (AgentId agent = 0; agent < 4; ++agent)
      for (Tick tick = 0; tick < 60; ++tick)
        run.tracks[agent].push_back(
            {tick, 0.1 * static_cast<double>(tick), {agent < 2 ? 150.0 + agent : 500.0, 140, 0}});
    return run;
  }
  static Zone zone(double far_m) {
    return {.until = 20, .corners_m = {{100, 100}, {far_m, 100}, {far_m, far_m}}};
  }

  Mission mission_ = small_mission(4);
  Amendments list_;
};

TEST_F(AmendmentLines, NameTargetsEndsAndLaws) {
  name_pause(list_, 5);
  name_pause(list_, 15);
  name_target(list_, 30, target(0.5));
  replace_target(list_, target(0.25));
  name_end(list_, 40, 200);
  LawChange law = plans_law(mission_);
  law.kinds[0].u_max_mps /= 2;
  name_law(list_, 50, law);
  EXPECT_EQ(amendment_lines(run(), mission_),
            (std::vector<std::string>{
                "target    amendment 2 from t = 2.0 s on, replaced before by amendment 3",
                "target    amendment 3 from t = 2.0 s on",
                "end       amendment 4 at t = 20.0 s, from t = 3.0 s on",
                "law       amendment 5 from t = 4.0 s on: " + law_text(law, mission_)}));
}

TEST_F(AmendmentLines, NameWhoWasInAZone) {
  name_zone(list_, 0, 10, 20, zone(400));
  name_zone(list_, 0, 11, 20, zone(150.5));
  name_zone(list_, 0, 12, 20, zone(120));
  name_zone(list_, 0, 50, 20, zone(400));
  EXPECT_EQ(amendment_lines(run(), mission_),
            (std::vector<std::string>{"zone      amendment 0 closed from t = 1.0 s until t = 5.0 "
                                      "s; at t = 3.0 s agents 0, 1 were inside",
                                      "zone      amendment 1 closed from t = 1.1 s until t = 5.1 "
                                      "s; at t = 3.1 s agent 0 was inside",
                                      "zone      amendment 2 closed from t = 1.2 s until t = 5.2 "
                                      "s; at t = 3.2 s nobody was inside",
                                      "zone      amendment 3 closed from t = 5.0 s until t = 9.0 "
                                      "s; at t = 7.0 s the mission had ended"}));
}

TEST_F(AmendmentLines, NameWhatCancelledAZone) {
  name_zone(list_, 0, 10, 20, zone(400));
  name_zone(list_, 0, 11, 20, zone(150.5));
  name_reopening(list_, 40, 1);
  name_reopening(list_, 20, 0);
  EXPECT_EQ(amendment_lines(run(), mission_),
            (std::vector<std::string>{
                "zone      amendment 0 closed from t = 1.0 s until t = 2.0 s, when amendment 3 "
                "cancelled it before it was free",
                "zone      amendment 1 closed from t = 1.1 s until t = 4.0 s, when amendment 2 "
                "cancelled it; at t = 3.1 s agent 0 was inside"}));
}

TEST_F(AmendmentLines, ARecordEndsByTheNewestEndAndItsPauses) {
  const TempFolder folder;
  EXPECT_DOUBLE_EQ(recorded_end_s(folder.path(), mission_), 10);
  name_end(list_, 3, 200);
  name_pause(list_, 5);
  name_pause(list_, 15);
  ReceivedAmendments received;
  received.note(list_);
  ASSERT_FALSE(write_file(folder.path() / kAmendmentsFile, amendments_text(received, 0.1)));
  EXPECT_DOUBLE_EQ(recorded_end_s(folder.path(), mission_), 21);
}

}  // namespace
}  // namespace ergocast::cli
