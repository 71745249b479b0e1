// SPDX-License-Identifier: BSD-3-Clause
// Which requests from a page become orders, and what is reported of them, for a team of two.
#include "cli/operate/control_desk.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/team.h"

namespace ergocast::cli {
namespace {

using namespace test;
using nlohmann::json;

class Desk : public ::testing::Test {
 protected:
  Desk() {
    Mission mission = small_mission(2);
    mission.timing.tick_count = 10'000;
    announce(mission);
    give(team_, mission_part(0, MissionState::kRunning, roster_of(2)), now_);
    move(100, 1);
  }
  /// The world's state: both vehicles at that speed.
  void move(Tick tick, double speed_mps) {
    WorldState state = world_state(tick, {{1, 1, 0}, {2, 2, 0}});
    for (Vehicle& vehicle : state.vehicles_in_part()) vehicle.velocity_mps = {speed_mps, 0, 0};
    give(team_, state, now_);
    advance();
  }
  void pause_from(Tick tick, const std::string& by = {}) {
    Amendments list = only_pauses({{tick, -1}});
    list.recent.back().by = by;
    name(list);
  }
  /// MISSION with this list.
  void name(const Amendments& list) {
    MissionPart part = mission_part(++revision_, MissionState::kRunning, roster_of(2));
    part.amendments = encode_amendments(list);
    part.content_hash = hash_of(part);
    give(team_, part, now_);
  }
  void ask(ControlAct act, std::uint32_t operator_id = 1, std::optional<Tick> tick = {}) {
    ControlRequest request;
    request.operator_id = operator_id;
    request.name = operator_id == 1 ? "anna" : "bert";
    request.number = ++numbers_;
    request.tick = tick.value_or(team_.tick());
    request.act = act;
    if (act == ControlAct::kTarget) {
      request.target.emplace();
      request.target->peaks = {{300, 400, 50, {}}};
      request.target->uniform = 0.5;
    }
    if (act == ControlAct::kZone) request.zone = {{{0, 0}, {4, 0}, {4, 4}}, 600, {}};
    ask(request);
  }
  void ask(const ControlRequest& request) {
    last_ = request;
    desk_.receive(request, team_, now_);
    advance();
  }
  /// Anna cancels a zone.
  void cancel(std::int32_t amendment) {
    ask({.operator_id = 1,
         .name = "anna",
         .number = ++numbers_,
         .tick = team_.tick(),
         .act = ControlAct::kReopen,
         .amendment = amendment});
  }
  /// Anna sends another state of a drawn zone.
  void send_instead_of(std::int64_t number) {
    ControlRequest changed = last_;
    changed.number = ++numbers_;
    changed.instead_of = number;
    ask(changed);
  }
  void advance() {
    sent_.clear();
    desk_.advance(team_, now_, sent_);
    for (std::string& line : desk_.take_lines()) lines_.push_back(std::move(line));
  }
  json state() const { return json::parse(desk_.state().dump()); }
  json operator_name() const { return state()["operator"]; }
  std::string refusal() const {
    const json refused = state()["refused"];
    return refused.empty() ? "" : refused.back()["text"].get<std::string>();
  }
  template <class M>
  int sent() const {
    return static_cast<int>(std::count_if(sent_.begin(), sent_.end(), [](const Outgoing& one) {
      return std::holds_alternative<M>(one.message);
    }));
  }

  /// An order whose report the test sets.
  struct Drawn final : Order {
    explicit Drawn(const OrderReport& reported) : now(reported) {}
    void send(const MonitoredRun&, Instant, Outbox&) override {}
    OrderReport report(const MonitoredRun&, Instant) const override { return now; }
    const OrderReport& now;
  };

  OrderReport drawn_report_;
  std::vector<std::string> drawn_;  // the texts of drawn targets and zones
  std::string drawn_by_;            // the operator of the last one
  Instant now_ = at(1s);
  MonitoredRun team_{kRun, at(0s)};
  ControlDesk desk_{
      "here", true, [this](const ControlRequest& request, const std::string& by) {
        drawn_.push_back(request.zone ? request.zone->text() : request.target->text());
        drawn_by_ = by;
        return std::make_unique<Drawn>(drawn_report_);
      }};
  Outbox sent_;
  std::vector<std::string> lines_;
  ControlRequest last_;
  std::int64_t numbers_ = 0, revision_ = 0;
};

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
