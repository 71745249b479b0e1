// SPDX-License-Identifier: BSD-3-Clause
// What the order of a new target sends, and what it reports of the team's messages.
#include "cli/operate/amend_order.h"

#include <gtest/gtest.h>

#include "plan/amendment_list.h"
#include "tests/support/team.h"

namespace ergocast::cli {
namespace {

using namespace test;
using State = OrderReport::State;

Zone zone_lasting(Tick ticks) {
  return {.until = ticks, .corners_m = {{100, 100}, {400, 100}, {400, 400}}};
}

class Amended : public ::testing::Test {
 protected:
  Amended() { announce(mission_); }

  /// A target of the mission whose second coefficient is that number.
  TargetChange target(double number) const {
    TargetChange change{.target = mission_.target_coefficients};
    change.target[1] = number;
    return change;
  }
  /// The coordinator announces the list.
  void announce_list() {
    MissionPart part = mission_part(++revision_, MissionState::kRunning, roster_of(2));
    part.amendments = encode_amendments(list_);
    part.content_hash = hash_of(part);
    give(team_, part, now_);
  }
  void move_to(Tick tick) { give(team_, world_state(tick, {{1, 1, 0}}), now_); }
  /// Turns the order for that time; returns the last report.
  OrderReport turn(AmendOrder& order, Instant::duration time) {
    OrderReport report;
    for (const Instant until = now_ + time; now_ < until && !report.ended(); now_ += 20ms) {
      Outbox out;
      order.send(team_, now_, out);
      for (const Amend& amend : only<Amend>(out)) sent_.push_back(amend);
      report = order.report(team_, now_);
    }
    return report;
  }

  /// The newest amendment is the one that was sent last.
  void name_as_sent() { list_.recent.back().ordered_by = sent_.back().header.incarnation; }
  /// The order of a zone that was named, closed from tick 5 on and free `notice` ticks later.
  AmendOrder zone_named(Tick notice) {
    const Zone zone = zone_lasting(60);
    announce_list();
    AmendOrder order(wish_of(zone), notice, now_);
    turn(order, 20ms);
    name_zone(list_, 0, 5, notice, zone);
    name_as_sent();
    return order;
  }
  static void expect_report(const OrderReport& report, State state, const std::string& text) {
    EXPECT_EQ(report.state, state) << report.text;
    EXPECT_NE(report.text.find(text), std::string::npos) << report.text;
  }

  Mission mission_ = small_mission(2);
  Instant now_ = at(1s);
  MonitoredRun team_{kRun, at(0s)};
  Amendments list_;
  std::int64_t revision_ = -1;
  std::vector<Amend> sent_;
};

TEST_F(Amended, IsAskedForUntilItIsNamedAndDoneWhenItHolds) {
  AmendOrder order(target(0.5), 7, now_);
  EXPECT_EQ(turn(order, 500ms).state, State::kSent);
  EXPECT_TRUE(sent_.empty()) << "the number is not known";
  announce_list();
  move_to(10);
  EXPECT_EQ(turn(order, 450ms).state, State::kSent);
  ASSERT_EQ(sent_.size(), 5U);
  EXPECT_EQ(sent_[0].number, 0);
  EXPECT_EQ(sent_[0].delay_ticks, 7);
  EXPECT_EQ(sent_[0].kind, AmendmentKind::kTarget);
  EXPECT_EQ(sent_[0].header.tick, 10);
  EXPECT_EQ(decode_target(sent_[0].content, mission_), target(0.5));
  name_target(list_, 30, target(0.5));
  name_as_sent();
  announce_list();
  EXPECT_EQ(turn(order, 1s).state, State::kAnswered);
  EXPECT_EQ(sent_.size(), 5U);
  move_to(30);
  expect_report(turn(order, 1s), State::kDone, "holds since tick 30, t = 3.0 s");
}

TEST_F(Amended, GoesInPartsThatMakeUpTheTarget) {
  mission_.basis.modes_x = mission_.basis.modes_y = 16;
  mission_.target_coefficients = Coefficients::Zero(256);
  mission_.target_coefficients[0] = 1;
  announce(mission_);
  announce_list();
  AmendOrder order(target(0.25), 0, now_);
  turn(order, 20ms);
  ASSERT_EQ(sent_.size(), 4U);
  std::vector<std::byte> content;
  for (const Amend& part : sent_) {
    EXPECT_EQ(part.parts, 4);
    content.insert(content.end(), part.content.begin(), part.content.end());
  }
  EXPECT_EQ(decode_target(content, mission_), target(0.25));
}

TEST_F(Amended, FailsIfItsNumberWasTaken) {
  announce_list();
  AmendOrder order(target(0.5), 0, now_);
  turn(order, 100ms);
  name_target(list_, 5, target(-0.5));
  announce_list();
  expect_report(turn(order, 1s), State::kFailed, "another order was first: amendment 0, target ");

  AmendOrder later(target(0.5), 0, now_);
  turn(later, 100ms);
  name_pause(list_, 20);
  announce_list();
  expect_report(turn(later, 1s), State::kFailed, "another order was first: amendment 1, a pause");
}

// As two terminals of one operator do it.
TEST_F(Amended, FailsIfAnotherOrderHasAskedForTheSame) {
  announce_list();
  AmendOrder one(wish_of_end(70), 0, now_, "anna@base"),
      other(wish_of_end(70), 0, now_, "anna@base");
  turn(other, 20ms);
  turn(one, 20ms);
  name_end(list_, 30, 70);
  list_.recent.back().by = "anna@base";
  name_as_sent();
  announce_list();
  move_to(30);
  expect_report(turn(one, 1s), State::kDone, "amendment 0, the end at t = 7.0 s, holds since");
  expect_report(turn(other, 1s), State::kFailed,
                "another order was first: amendment 0, the end at t = 7.0 s, holds since");
}

TEST_F(Amended, FailsWithTheCauseIfNoTickIsNamed) {
  announce_list();
  AmendOrder order(target(0.5), 0, now_);
  expect_report(turn(order, 20s), State::kFailed, "no coordinator answers");

  TeamStatus status;
  status.header = {kRun, kCoordinator, kCoordinatorLife, next_sequence(), 0};
  give(team_, status, now_);
  AmendOrder first(target(0.5), 0, now_);
  expect_report(turn(first, 20s), State::kFailed, "the coordinator names no tick");

  name_target(list_, 50, target(0.1));
  announce_list();
  AmendOrder second(target(0.5), 0, now_);
  expect_report(turn(second, 20s), State::kFailed,
                "another target, amendment 0, waits for tick 50, t = 5.0 s");
}

TEST_F(Amended, IsNotSentIfItCannotHold) {
  announce_list();
  move_to(10);
  AmendOrder order(target(0.5), 90, now_);
  expect_report(turn(order, 1s), State::kFailed, "the mission ends before that, at tick 100");
  list_.named = kMaxAmendments;
  announce_list();
  AmendOrder one_too_many(target(0.5), 0, now_);
  expect_report(turn(one_too_many, 1s), State::kFailed, "can be amended 1000000 times");
  EXPECT_TRUE(sent_.empty());
}

TEST_F(Amended, AnEndIsAskedForUntilItIsNamed) {
  announce_list();
  move_to(10);
  AmendOrder order(wish_of_end(70), 0, now_);
  EXPECT_EQ(turn(order, 450ms).state, State::kSent);
  ASSERT_FALSE(sent_.empty());
  EXPECT_EQ(sent_[0].kind, AmendmentKind::kEnd);
  EXPECT_EQ(decode_end(sent_[0].content, mission_), 70);
  name_end(list_, 30, 70);
  name_as_sent();
  announce_list();
  EXPECT_EQ(turn(order, 1s).state, State::kAnswered);
  move_to(30);
  expect_report(turn(order, 1s), State::kDone,
                "amendment 0, the end at t = 7.0 s, holds since tick 30");
}

TEST_F(Amended, AnEndThatIsImpossibleIsNotSent) {
  const auto refused = [&](Tick tick_count, const std::string& why) {
    announce_list();
    AmendOrder order(wish_of_end(tick_count), 0, now_);
    expect_report(turn(order, 1s), State::kFailed, why);
  };
  announce_list();
  move_to(10);
  refused(100, "the mission ends at t = 10.0 s already");
  refused(12, "t = 1.2 s has passed before all agents can know it");
  refused(200,
          "must be named 10 s of mission time before the end that holds, and that is at t = "
          "10.0 s");
  mission_.kinds = {{"a", 2, 10, 0, 0}};
  mission_.kinds[0].stations_m = {{1900, 1900, 0}};
  announce(mission_);
  MonitoredRun other{kRun, at(0s)};
  team_ = other;
  announce_list();
  move_to(10);
  refused(90, "agent 0 cannot be at its station in time for an end at t = 9.0 s");
  EXPECT_TRUE(sent_.empty());
}

TEST_F(Amended, TheNewestTargetAndTheNewestEndCanBeCancelled) {
  name_target(list_, 5, target(0.25));
  name_end(list_, 6, 80);
  name_pause(list_, 7);
  name_pause(list_, 8);
  name_target(list_, 9, target(0.5));
  name_end(list_, 10, 90);
  announce_list();
  const auto wish = [&](std::int32_t number) { return wish_to_cancel(team_, number); };
  EXPECT_EQ(wish(4)->content, encode_target(target(0.25)));
  EXPECT_EQ(wish(5)->content, encode_end(80));
  for (const auto& [number, why] :
       {std::pair(0, "a later amendment has replaced amendment 0"), std::pair(1, "a later"),
        std::pair(2, "amendment 2 is a pause: ergocast resume ends it"),
        std::pair(3, "amendment 3 ended a pause"), std::pair(6, "there is no amendment 6"),
        std::pair(-1, "there is no amendment -1")}) {
    ASSERT_FALSE(wish(number)) << number;
    EXPECT_NE(wish(number).error().find(why), std::string::npos) << wish(number).error();
  }
}

TEST_F(Amended, TheFirstTargetAndTheFirstEndAreCancelledByThePlans) {
  name_target(list_, 50, target(0.25));
  name_end(list_, 6, 80);
  announce_list();
  move_to(10);
  EXPECT_EQ(wish_to_cancel(team_, 0)->content,
            encode_target({.target = mission_.target_coefficients}));
  EXPECT_EQ(wish_to_cancel(team_, 1)->content, encode_end(100));
  AmendOrder order(*wish_to_cancel(team_, 0), 0, now_);
  EXPECT_EQ(turn(order, 1s).state, State::kSent) << "although a target waits";
  EXPECT_FALSE(sent_.empty());
}

TEST_F(Amended, AWaitingTargetThatIsReplacedFailsAndNamesItsSuccessor) {
  announce_list();
  AmendOrder order(target(0.5), 0, now_);
  turn(order, 20ms);
  name_target(list_, 50, target(0.5));
  name_as_sent();
  announce_list();
  move_to(10);
  EXPECT_EQ(turn(order, 1s).state, State::kAnswered);
  replace_target(list_, {.target = mission_.target_coefficients});
  announce_list();
  expect_report(turn(order, 1s), State::kFailed,
                "never holds: amendment 1 replaced it before tick 50, t = 5.0 s");
}

TEST_F(Amended, IsDoneIfItHeldAlthoughAnotherOneHoldsNow) {
  announce_list();
  AmendOrder order(target(0.5), 0, now_);
  turn(order, 20ms);
  name_target(list_, 20, target(0.5));
  name_as_sent();
  name_target(list_, 30, target(0.25));
  announce_list();
  move_to(40);
  expect_report(turn(order, 1s), State::kDone,
                "held from tick 20, t = 2.0 s, until tick 30, t = 3.0 s: amendment 1");
}

TEST_F(Amended, TheListNamesWhatHoldsAndWhatHeld) {
  name_target(list_, 10, target(0.5));
  name_target(list_, 20, target(0.25));
  name_end(list_, 21, 90);
  name_end(list_, 25, 95);
  name_pause(list_, 30);
  name_pause(list_, 35);
  name_target(list_, 80, target(0.125));
  replace_target(list_, target(0.0625));
  announce_list();
  move_to(40);
  const auto text = [&](std::size_t i) {
    const std::string whole = amendment_text(team_, list_.recent[i]);
    return whole.substr(whole.rfind(", h") + 2);
  };
  EXPECT_EQ(text(0), "held from tick 10, t = 1.0 s, until tick 20, t = 2.0 s: amendment 1");
  EXPECT_EQ(text(1), "holds since tick 20, t = 2.0 s");
  EXPECT_EQ(text(2), "held from tick 21, t = 2.1 s, until tick 25, t = 2.5 s: amendment 3");
  EXPECT_EQ(text(3), "holds since tick 25, t = 2.5 s");
  EXPECT_EQ(text(4), "held at tick 30, t = 3.0 s, until amendment 5");
  EXPECT_EQ(text(5), "holds since tick 30, t = 3.0 s");
  EXPECT_NE(amendment_text(team_, list_.recent[6]).find("never holds: amendment 7 replaced it"),
            std::string::npos);
  EXPECT_EQ(text(7), "holds from tick 75, t = 7.5 s");
  move_to(85);
  EXPECT_EQ(text(1), "held from tick 20, t = 2.0 s, until tick 75, t = 7.5 s: amendment 7");
}

TEST_F(Amended, TheListNamesZonesThatHaveEnded) {
  const Zone zone = zone_lasting(10);
  name_zone(list_, 0, 5, 3, zone);
  announce_list();
  const auto text = [&] {
    const std::string whole = amendment_text(team_, list_.recent[0]);
    return whole.substr(whole.find(", ", whole.find("zone")) + 2);
  };
  move_to(6);
  EXPECT_EQ(text(),
            "holds from tick 8, t = 0.8 s, closed since tick 5, t = 0.5 s, until tick 18, t = 1.8 "
            "s");
  move_to(18);
  EXPECT_EQ(text(), "was closed from tick 5, t = 0.5 s until tick 18, t = 1.8 s");
  list_.zones.clear();
  announce_list();
  EXPECT_EQ(text(), "has ended");
}

TEST_F(Amended, AZoneIsCancelled) {
  const Zone zone = zone_lasting(60);
  name_zone(list_, 0, 5, 3, zone);  // until 68
  announce_list();
  move_to(20);
  const auto wish = wish_to_cancel(team_, 0);
  ASSERT_TRUE(wish) << wish.error();
  AmendOrder order(*wish, 0, now_);
  EXPECT_EQ(turn(order, 20ms).state, State::kSent);
  ASSERT_EQ(sent_.size(), 1U);
  EXPECT_EQ(sent_[0].kind, AmendmentKind::kReopen);
  EXPECT_EQ(decode_reopening(sent_[0].content), 0);
  name_reopening(list_, 22, 0);
  name_as_sent();
  announce_list();
  EXPECT_EQ(turn(order, 20ms).state, State::kAnswered);
  EXPECT_FALSE(wish_to_cancel(team_, 0)) << "it is cancelled already";
  EXPECT_FALSE(wish_to_cancel(team_, 1)) << "no amendment undoes that";
  const auto text = [&](std::size_t i) { return amendment_text(team_, list_.recent[i]); };
  EXPECT_NE(text(0).find("until tick 22, t = 2.2 s: amendment 1 cancelled it"), std::string::npos)
      << text(0);
  move_to(22);
  const OrderReport report = turn(order, 20ms);
  EXPECT_EQ(report.state, State::kDone);
  EXPECT_EQ(report.text,
            "amendment 1, the end of the zone of amendment 0, holds since tick 22, t = 2.2 s");
  EXPECT_NE(text(0).find("was closed from tick 5, t = 0.5 s until tick 22"), std::string::npos)
      << text(0);
  // It cannot be done again, nor shortly before the end.
  EXPECT_EQ(why_impossible(team_, wish_of_reopening(0), 0),
            "another order was first: that zone ends at tick 22, t = 2.2 s");
  name_zone(list_, 22, 25, 3, zone);  // until 88
  announce_list();
  move_to(86);
  EXPECT_TRUE(why_impossible(team_, wish_of_reopening(2), 0));
}

TEST_F(Amended, AZoneDoesNotFailBecauseAnotherIsCancelled) {
  AmendOrder order = zone_named(30);
  name_zone(list_, 0, 5, 30, zone_lasting(60));
  name_reopening(list_, 10, 1);
  announce_list();
  move_to(7);
  EXPECT_EQ(turn(order, 20ms).state, State::kAnswered);
}

TEST_F(Amended, AZoneThatIsCancelledBeforeItIsFreeFails) {
  AmendOrder order = zone_named(30);
  name_reopening(list_, 10, 0);
  announce_list();
  move_to(7);
  const OrderReport report = turn(order, 20ms);
  EXPECT_EQ(report.state, State::kFailed);
  EXPECT_NE(report.text.find("is closed from tick 5, t = 0.5 s until tick 10, t = 1.0 s: amendment "
                             "1 cancelled it"),
            std::string::npos)
      << report.text;
}

TEST_F(Amended, ThereIsNoPlaceForANinthZone) {
  const Zone zone = zone_lasting(50);
  for (std::size_t i = 0; i < kMaxZones; ++i) name_zone(list_, 0, 5, 3, zone);
  announce_list();
  move_to(6);
  const auto problem = why_impossible(team_, wish_of(zone), 3);
  ASSERT_TRUE(problem);
  EXPECT_NE(problem->find("8 zones are in force"), std::string::npos) << *problem;
  move_to(58);
  EXPECT_EQ(why_impossible(team_, wish_of(zone), 3), std::nullopt);
}

TEST_F(Amended, SurvivesThatItsProcessIsStopped) {
  announce_list();
  AmendOrder order(target(0.5), 0, now_);
  turn(order, 20ms);
  now_ += 1h;
  EXPECT_EQ(turn(order, 1s).state, State::kSent) << "it has not listened since";
}

TEST_F(Amended, ALawIsAskedForWithItsOperatorAndCancelled) {
  LawChange slow = plans_law(mission_);
  slow.kinds[0].u_max_mps /= 2;
  announce_list();
  AmendOrder order(wish_of(slow), 0, now_, "anna@base");
  turn(order, 20ms);
  ASSERT_EQ(sent_.size(), 1U);
  EXPECT_EQ(sent_[0].kind, AmendmentKind::kLaw);
  EXPECT_EQ(sent_[0].by, "anna@base");
  EXPECT_EQ(decode_law(sent_[0].content, mission_), slow);
  name_law(list_, 5, slow);
  list_.recent.back().by = "anna@base";
  name_as_sent();
  announce_list();
  move_to(10);
  const OrderReport report = turn(order, 1s);
  EXPECT_EQ(report.state, State::kDone);
  EXPECT_TRUE(report.text.ends_with("holds since tick 5, t = 0.5 s, by anna@base")) << report.text;
  EXPECT_NE(report.text.find(" (u_max_mps "), std::string::npos) << report.text;
  EXPECT_EQ(wish_to_cancel(team_, 0)->content, encode_law(plans_law(mission_)));
  LawChange slower = slow;
  slower.kinds[0].u_max_mps /= 2;
  name_law(list_, 50, slower);
  announce_list();
  EXPECT_EQ(wish_to_cancel(team_, 1)->content, encode_law(slow));
  AmendOrder later(wish_of(plans_law(mission_)), 0, now_);
  const std::size_t before = sent_.size();
  EXPECT_EQ(turn(later, 1s).state, State::kSent) << "the law that waits will soon hold";
  EXPECT_GT(sent_.size(), before);
}

}  // namespace
}  // namespace ergocast::cli
