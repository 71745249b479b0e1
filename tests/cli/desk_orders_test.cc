// SPDX-License-Identifier: BSD-3-Clause
// What becomes of the orders of a page, and of those that were given elsewhere.
#include "tests/cli/desk.h"

namespace ergocast::cli {
namespace {

TEST_F(Desk, APauseIsDoneOnceAllVehiclesStandAndNamesThoseThatMove) {
  ask(ControlAct::kTake);
  ask(ControlAct::kPause);
  pause_from(110, "anna");
  advance();
  EXPECT_EQ(state()["acts"][0]["state"], "answered");
  move(110, 1);
  EXPECT_EQ(state()["acts"][0]["state"], "obeyed");
  EXPECT_EQ(state()["acts"][0]["text"],
            "paused at tick 110, t = 11.0 s: 0 of 2 stand; agent 0 and agent 1 still move");
  move(111, 0);
  EXPECT_EQ(state()["acts"][0]["state"], "done");
  EXPECT_EQ(lines_.back(),
            "control: pause of anna, asked for at tick 100, t = 10.0 s: paused at "
            "tick 110, t = 11.0 s: 2 of 2 stand");
}

TEST_F(Desk, ASecondDrawnTargetWaitsUntilTheFirstOneHolds) {
  ask(ControlAct::kTake);
  ask(ControlAct::kTarget);
  ASSERT_EQ(drawn_.size(), 1U);
  EXPECT_EQ(drawn_by_, "anna");
  EXPECT_EQ(drawn_[0],
            "target {\n  gaussians { mean_x_m: 300 mean_y_m: 400 sigma_m: 50 weight: 1 }\n"
            "  uniform_weight: 1\n}\n");
  drawn_report_ = {OrderReport::State::kAnswered, "amendment 0, target 5f, holds from tick 120"};
  ask(ControlAct::kTarget);
  EXPECT_EQ(refusal(), "the last new target does not hold yet: send this one then");
  EXPECT_EQ(drawn_.size(), 1U);
  EXPECT_EQ(state()["acts"][0]["text"], drawn_report_.text);
  drawn_report_ = {OrderReport::State::kDone, "amendment 0, target 5f, holds since tick 120"};
  advance();
  EXPECT_EQ(lines_.back(),
            "control: new target of anna, asked for at tick 100, t = 10.0 s: amendment 0, target "
            "5f, holds since tick 120");
  ask(ControlAct::kTarget);
  EXPECT_EQ(drawn_.size(), 2U);
}

TEST_F(Desk, ADrawnZoneWaitsUntilTheLastOneHasANumber) {
  ask(ControlAct::kTake);
  ask(ControlAct::kZone);
  ASSERT_EQ(drawn_.size(), 1U);
  EXPECT_EQ(drawn_[0],
            "vertices { x_m: 0 y_m: 0 }\nvertices { x_m: 4 y_m: 0 }\nvertices { x_m: 4 y_m: 4 }\n");
  EXPECT_EQ(lines_.back(), "control: anna asks for: new zone, at tick 100, t = 10.0 s");
  ask(ControlAct::kZone);
  EXPECT_EQ(refusal(), "the last amendment has no answer yet: send this one then");
  ask(ControlAct::kTarget);
  EXPECT_EQ(refusal(), "the last amendment has no answer yet: send this one then");
  EXPECT_EQ(drawn_.size(), 1U);
  drawn_report_ = {OrderReport::State::kAnswered, "amendment 0, zone 5f, holds from tick 120"};
  advance();
  now_ += 1s;
  for (std::size_t i = 1; i < kMaxZones; ++i) ask(ControlAct::kZone);
  EXPECT_EQ(drawn_.size(), kMaxZones);
  ask(ControlAct::kZone);
  EXPECT_EQ(refusal(), "agents still leave 8 zones: send this one then");
  ask(ControlAct::kTarget);
  EXPECT_EQ(drawn_.size(), kMaxZones + 1);
}

TEST_F(Desk, AZoneIsCancelledOnce) {
  Amendments list;
  name_zone(list, 90, 90, 5, {.until = 600, .corners_m = {{0, 0}, {4, 0}, {4, 4}}});
  name(list);
  ask(ControlAct::kTake);
  cancel(0);
  EXPECT_EQ(lines_.back(), "control: anna asks for: cancel zone 0, at tick 100, t = 10.0 s");
  const std::vector<Amend> orders = only<Amend>(sent_);
  ASSERT_EQ(orders.size(), 1U);
  EXPECT_EQ(orders[0].number, 1);
  EXPECT_EQ(orders[0].kind, AmendmentKind::kReopen);
  EXPECT_EQ(orders[0].by, "anna");
  EXPECT_EQ(decode_reopening(orders[0].content), 0);
  desk_.receive(last_, team_, now_);      // a second copy
  EXPECT_EQ(state()["acts"].size(), 2U);  // the zone is from elsewhere
  ask(ControlAct::kZone);
  EXPECT_EQ(refusal(), "the last amendment has no answer yet: send this one then");

  name_reopening(list, 110, 0);
  list.recent.back().by = "anna";
  list.recent.back().ordered_by = orders[0].header.incarnation;
  name(list);
  advance();
  ASSERT_EQ(state()["acts"].size(), 2U) << state();
  EXPECT_EQ(state()["acts"][1]["state"], "answered");
  move(110, 1);
  EXPECT_EQ(state()["acts"][1]["state"], "done");
  EXPECT_EQ(state()["acts"][1]["text"],
            "amendment 1, the end of the zone of amendment 0, holds since tick 110, t = 11.0 s, by "
            "anna");
}

TEST_F(Desk, ACancellationIsRefusedWithTheWordsOfTheCommand) {
  Amendments list;
  name_zone(list, 90, 90, 5, {.until = 20, .corners_m = {{0, 0}, {4, 0}, {4, 4}}});
  name_zone(list, 90, 90, 5, {.until = 600, .corners_m = {{0, 0}, {4, 0}, {4, 4}}});
  name_reopening(list, 105, 1);
  name_end(list, 95, 5000);
  name(list);
  move(115, 1);
  ask(ControlAct::kTake);
  for (const std::int32_t zone : {0, 1}) {
    cancel(zone);
    EXPECT_EQ(refusal(), "amendment " + std::to_string(zone) +
                             " is a zone that has ended, or is cancelled already: ergocast amend "
                             "--list shows when");
  }
  cancel(3);
  EXPECT_EQ(refusal(), "amendment 3 is no zone: use ergocast amend --cancel");
  cancel(4);
  EXPECT_EQ(refusal(), "there is no amendment 4: ergocast amend --list shows them");
  EXPECT_EQ(lines_.back(),
            "control: anna asks for: cancel zone 4: refused: there is no amendment 4: ergocast "
            "amend --list shows them");
  EXPECT_EQ(sent<Amend>(), 0);
}

// The page does not know whether the first one has arrived.
TEST_F(Desk, OneStateOfADrawingIsObeyed) {
  ask(ControlAct::kTake);
  ask(ControlAct::kZone);
  const std::int64_t first = last_.number;
  drawn_report_ = {OrderReport::State::kDone, "amendment 0, zone 5f, holds since tick 120"};
  advance();
  send_instead_of(first);
  EXPECT_EQ(refusal(),
            "an earlier drawing has arrived: see what becomes of it, then send this "
            "one if it is still wanted");
  EXPECT_EQ(drawn_.size(), 1U);
  send_instead_of(0);
  EXPECT_EQ(drawn_.size(), 2U);
  // One that was lost, or has failed, does not count.
  send_instead_of(numbers_ + 1);
  EXPECT_EQ(drawn_.size(), 3U);
  drawn_report_ = {OrderReport::State::kFailed, "it covers a station"};
  const std::int64_t failed = numbers_ + 1;
  send_instead_of(0);
  send_instead_of(failed);
  EXPECT_EQ(drawn_.size(), 5U) << refusal();
}

TEST_F(Desk, ShowsWhatWasOrderedElsewhere) {
  ask(ControlAct::kTake);
  pause_from(110);
  advance();
  ASSERT_EQ(state()["acts"].size(), 1U);
  EXPECT_EQ(state()["acts"][0]["what"], "pause");
  EXPECT_EQ(state()["acts"][0]["text"], "from tick 110, t = 11.0 s");
  EXPECT_EQ(lines_.back(),
            "control: pause by another operator, on another page or by a command: from tick 110, "
            "t = 11.0 s");
  advance();
  EXPECT_EQ(state()["acts"].size(), 1U);
}

TEST_F(Desk, ItsOwnOrderIsNoOrderFromElsewhere) {
  ask(ControlAct::kTake);
  ask(ControlAct::kPause);
  pause_from(110, "anna");
  move(110, 0);
  ASSERT_EQ(state()["acts"].size(), 1U);
  EXPECT_EQ(state()["acts"][0]["name"], "anna");
}

TEST_F(Desk, TheSameOrderOfAnotherOperatorIsFromElsewhere) {
  ask(ControlAct::kTake);
  ask(ControlAct::kPause);
  pause_from(110, "bert@base");
  move(110, 0);
  ASSERT_EQ(state()["acts"].size(), 2U);
  EXPECT_EQ(state()["acts"][0]["name"], "anna");
  EXPECT_EQ(state()["acts"][1]["name"], "bert@base, on another page or by a command");
}

TEST_F(Desk, TheLastStateHasWhatTheOrdersHaveAchieved) {
  ask(ControlAct::kStopNow);
  desk_.end(team_, now_);
  EXPECT_EQ(desk_.state().begin().key(), "over");
  EXPECT_EQ(state()["acts"][0]["state"], "failed");
  EXPECT_EQ(state()["acts"][0]["text"],
            "the world is silent, and in its last state, of tick 100, t = 10.0 s, vehicles still "
            "move: look at them");
  EXPECT_TRUE(desk_.is_settled());
}

TEST_F(Desk, AResumptionEndsAPauseThatStillWaits) {
  ask(ControlAct::kTake);
  ask(ControlAct::kPause);
  pause_from(110, "anna");
  move(110, 1);
  ask(ControlAct::kResume);
  const auto found = std::find_if(lines_.begin(), lines_.end(), [](const std::string& line) {
    return line.find("pause of anna, asked for at") != line.npos;
  });
  ASSERT_NE(found, lines_.end());
  EXPECT_NE(found->find("still move; then anna asks for: resume"), std::string::npos) << *found;
  EXPECT_EQ(std::get<Amend>(sent_.back().message).number, 1);
}

}  // namespace
}  // namespace ergocast::cli
