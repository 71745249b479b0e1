// SPDX-License-Identifier: BSD-3-Clause
// Which requests from a page become orders: from which operator, how often, how late.
#include "tests/cli/desk.h"

namespace ergocast::cli {
namespace {

TEST_F(Desk, OnlyTheOperatorsRequestsBecomeOrders) {
  ask(ControlAct::kPause);
  EXPECT_EQ(refusal(), "no operator has control: take it");
  ask(ControlAct::kTake);
  EXPECT_EQ(operator_name()["name"], "anna");
  ask(ControlAct::kPause, 2);
  EXPECT_EQ(refusal(), "anna has control now");
  EXPECT_EQ(sent<Amend>(), 0);
  ask(ControlAct::kPause);
  ASSERT_EQ(sent<Amend>(), 1);
  const auto is_amend = [](const Outgoing& one) {
    return std::holds_alternative<Amend>(one.message);
  };
  const auto found = std::ranges::find_if(sent_, is_amend);
  EXPECT_EQ(std::get<Amend>(found->message).by, "anna");
  EXPECT_EQ(lines_.back(), "control: anna asks for: pause, at tick 100, t = 10.0 s");
}

TEST_F(Desk, TheTokenSufficesToStopTheTeamAtOnceAtAnyTick) {
  now_ += 1min;
  move(5000, 1);
  now_ += 1min;
  move(9000, 1);
  ask(ControlAct::kStopNow, 2, 0);
  EXPECT_EQ(sent<Stop>(), 2);  // on two buses
  EXPECT_TRUE(std::get<Stop>(sent_.front().message).now);
}

TEST_F(Desk, ANumberCountsOnce) {
  ask(ControlAct::kTake);
  const ControlRequest take = last_;
  ask(ControlAct::kTake, 2);
  desk_.receive(take, team_, now_);  // recorded, and sent again
  EXPECT_EQ(operator_name()["name"], "bert");
  EXPECT_EQ(lines_.back(), "control: bert takes control from anna at tick 100, t = 10.0 s");
}

// A page repeats what it has seen no answer to.
TEST_F(Desk, ARepeatedRequestIsObeyedOnceAndHasOneAnswer) {
  ask(ControlAct::kPause);
  desk_.receive(last_, team_, now_);
  EXPECT_EQ(state()["refused"].size(), 1U);
  ask(ControlAct::kTake);
  desk_.receive(last_, team_, now_);
  for (const ControlAct act : {ControlAct::kPause, ControlAct::kZone}) {
    ask(act);
    for (int i = 0; i < 3; ++i) desk_.receive(last_, team_, now_);
  }
  EXPECT_EQ(drawn_.size(), 1U);
  EXPECT_EQ(state()["acts"].size(), 2U);
  ask(ControlAct::kRelease);
  desk_.receive(last_, team_, now_);
  EXPECT_EQ(state()["refused"].size(), 1U) << state();
}

TEST_F(Desk, NoAnswerHidesAnother) {
  ask(ControlAct::kTake);
  ask(ControlAct::kPause);
  ask(ControlAct::kPause);
  EXPECT_EQ(refusal(), "it is being carried out already");
  const std::int64_t number = last_.number;
  ask(ControlAct::kResume, 2);
  EXPECT_EQ(refusal(), "anna has control now");
  EXPECT_EQ(state()["refused"][0]["number"], number);
  for (int i = 0; i < 20; ++i) ask(ControlAct::kResume, 2);
  EXPECT_EQ(state()["refused"].size(), 8U);
}

TEST_F(Desk, WhatCameWhileThisProcessSleptIsRefusedButForAStop) {
  ask(ControlAct::kTake);
  const auto late = [this](ControlAct act) {
    last_.act = act;
    last_.number = ++numbers_;
    desk_.receive_late(last_, team_, now_);
    advance();
  };
  late(ControlAct::kHere);
  EXPECT_EQ(refusal(), "");
  late(ControlAct::kPause);
  EXPECT_EQ(refusal(), "the process that gives the orders has slept: give the order again");
  desk_.receive(last_, team_, now_);  // a second copy
  EXPECT_EQ(state()["acts"].size(), 0U);
  EXPECT_EQ(state()["refused"].size(), 1U);
  late(ControlAct::kStopNow);
  EXPECT_EQ(sent<Stop>(), 2);
}

TEST_F(Desk, ARequestThatNamesAnOldTickIsRefused) {
  ask(ControlAct::kTake);
  for (int i = 0; i < 4; ++i) {
    now_ += 5s;
    move(200 + 100 * i, 1);
    ask(ControlAct::kHere);
  }
  ask(ControlAct::kPause, 1, 100);
  EXPECT_EQ(refusal(),
            "the page has shown nothing new for several seconds: look at the team again");
  ask(ControlAct::kPause);
  EXPECT_EQ(sent<Amend>(), 1);
}

TEST_F(Desk, AnOperatorWhoseBrowserIsSilentLosesControl) {
  ask(ControlAct::kTake);
  now_ += ControlDesk::kSilence;
  advance();
  EXPECT_FALSE(operator_name().is_null());
  ask(ControlAct::kHere);
  now_ += ControlDesk::kSilence + 1ms;
  advance();
  EXPECT_TRUE(operator_name().is_null());
  EXPECT_EQ(lines_.back(),
            "control: anna loses control at tick 100, t = 10.0 s: the browser has "
            "been silent for 10 s");
  EXPECT_EQ(sent<Stop>() + sent<Amend>(), 0);  // the mission goes on
}

TEST_F(Desk, ManyPressesAreOneOrder) {
  ask(ControlAct::kTake);
  for (int i = 0; i < 1000; ++i) ask(ControlAct::kPause);
  EXPECT_EQ(state()["acts"].size(), 1U);
  EXPECT_EQ(refusal(), "too many requests in a second");
  now_ += 1s;
  ask(ControlAct::kHere);
  EXPECT_EQ(lines_.back().substr(0, 9), "control: ");
  EXPECT_NE(lines_.back().find("requests were refused: too many in a second"), std::string::npos);
  EXPECT_LT(lines_.size(), 6U);
}

TEST_F(Desk, AStopAtOnceHasNoLimitOfRate) {
  for (int i = 0; i < 1000; ++i) ask(ControlAct::kTake, 2);
  ask(ControlAct::kStopNow);
  EXPECT_EQ(sent<Stop>(), 2);
}

TEST_F(Desk, AStopAtOnceNeedsNoNumberAndIsSaidOnce) {
  ask(ControlAct::kTake);
  numbers_ = 0;
  ask(ControlAct::kStopNow);
  EXPECT_EQ(sent<Stop>(), 2);
  numbers_ = 0;
  ask(ControlAct::kPause);
  EXPECT_NE(refusal().find("a later request"), std::string::npos);
}

// A browser sends over several connections.
TEST_F(Desk, ASignOfTheBrowserMayOvertakeAnOrder) {
  ask(ControlAct::kTake);
  numbers_ += 1;
  ask(ControlAct::kHere);
  numbers_ -= 2;
  ask(ControlAct::kPause);
  EXPECT_EQ(sent<Amend>(), 1) << refusal();
  numbers_ -= 1;
  ask(ControlAct::kHere);
  EXPECT_EQ(refusal(), "");
}

TEST_F(Desk, ARepeatedStopAtOnceIsObeyedOnceEvenIfItHasFailed) {
  ask(ControlAct::kStopNow);
  now_ += 1min;  // no process has reported its end
  advance();
  EXPECT_EQ(state()["acts"][0]["over"], true);
  EXPECT_EQ(state()["acts"][0]["state"], "failed");
  desk_.receive(last_, team_, now_);
  EXPECT_EQ(state()["acts"].size(), 1U);
  ask(ControlAct::kStopNow);  // another press
  EXPECT_EQ(state()["acts"].size(), 2U);
}

TEST_F(Desk, ATickThatTheTeamHasNotReachedIsRefused) {
  ask(ControlAct::kTake, 1, 1'000'000'000);
  EXPECT_EQ(refusal(), "the page names a tick that the team has not reached: reload it");
  EXPECT_TRUE(operator_name().is_null());
  ask(ControlAct::kTake, 1, 110);  // the page's process may be ahead of us
  EXPECT_EQ(operator_name()["name"], "anna");
}

TEST_F(Desk, ASignOfABrowserWithoutControlIsNoRefusedOrder) {
  ask(ControlAct::kHere, 2);
  EXPECT_EQ(refusal(), "");
  EXPECT_TRUE(lines_.empty());
}

}  // namespace
}  // namespace ergocast::cli
