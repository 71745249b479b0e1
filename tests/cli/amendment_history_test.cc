// SPDX-License-Identifier: BSD-3-Clause
// What browsers get of a running mission's amendments.
#include "cli/team/amendment_history.h"

#include <gtest/gtest.h>

#include "tests/support/team.h"

namespace ergocast {
namespace {

using namespace test;

Zone triangle(double side_m) {
  return {.until = 50, .corners_m = {{100, 100}, {100 + side_m, 100}, {100, 100 + side_m}}};
}

TEST(AmendmentHistory, HasZonesThatHaveLeftTheListAndCancelledOnes) {
  const Mission mission = small_mission(1);
  AmendmentHistory history;
  AmendmentHistory::Cursor cursor;
  const auto frame = [&](const Amendments& list) {
    history.note(list);
    nlohmann::ordered_json json;
    history.add_new(cursor, mission, json);
    return json;
  };
  Amendments list;
  name_zone(list, 0, 5, 3, triangle(100));  // until 58
  EXPECT_EQ(frame(list)["zones"][0]["until"], 58);
  EXPECT_TRUE(frame(list).is_null()) << "nothing is new";
  name_reopening(list, 20, 0);
  const auto cancelled = frame(list);
  EXPECT_EQ(cancelled["zones"][0]["until"], 20);
  EXPECT_EQ(cancelled["amendments"][1]["kind"], "reopen");
  EXPECT_EQ(cancelled["amendments"][1]["zone"], 0);
  name_zone(list, 30, 30, 3, triangle(200));
  ASSERT_EQ(list.zones.size(), 1U);
  const auto both = frame(list)["zones"];
  ASSERT_EQ(both.size(), 2U) << "the page shows the mission from its beginning";
  EXPECT_EQ(both[0]["until"], 20);
  EXPECT_EQ(both[1]["number"], 2);
}

TEST(AmendmentHistory, ForgetsAZoneThatANewerListLacks) {
  const Mission mission = small_mission(1);
  AmendmentHistory history;
  AmendmentHistory::Cursor cursor;
  Amendments lost, kept;
  name_zone(lost, 0, 5, 3, triangle(100));
  name_zone(kept, 0, 9, 3, triangle(200));
  name_zone(kept, 100, 100, 3, triangle(200));
  ASSERT_EQ(kept.zones.size(), 1U) << "the first has ended";
  history.note(lost);
  history.note(kept);
  nlohmann::ordered_json json;
  history.add_new(cursor, mission, json);
  ASSERT_EQ(json["zones"].size(), 1U);
  EXPECT_EQ(json["zones"][0]["number"], 1);
}

TEST(AmendmentHistory, SendsThatNoZoneIsLeft) {
  const Mission mission = small_mission(1);
  AmendmentHistory history;
  AmendmentHistory::Cursor cursor;
  nlohmann::ordered_json first, second;
  Amendments list;
  name_zone(list, 0, 5, 3, triangle(100));
  history.note(list);
  history.add_new(cursor, mission, first);
  EXPECT_EQ(first["zones"].size(), 1U);
  history.note({});  // of a coordinator that does not know it
  history.add_new(cursor, mission, second);
  EXPECT_EQ(second["zones"], nlohmann::ordered_json::array());
}

TEST(AmendmentHistory, KnowsOfACancellationThoughNoListHasTheZoneAnyMore) {
  const Mission mission = small_mission(1);
  AmendmentHistory history;
  AmendmentHistory::Cursor cursor;
  Amendments list;
  name_zone(list, 0, 5, 3, triangle(100));  // until 58
  history.note(list);
  name_reopening(list, 20, 0);
  name_zone(list, 30, 30, 3, triangle(200));
  ASSERT_EQ(list.zones.size(), 1U);
  history.note(list);  // the list in between was lost
  nlohmann::ordered_json json;
  history.add_new(cursor, mission, json);
  EXPECT_EQ(json["zones"][0]["until"], 20);
}

}  // namespace
}  // namespace ergocast
