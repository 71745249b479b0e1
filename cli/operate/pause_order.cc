// SPDX-License-Identifier: BSD-3-Clause
// Asks for the mission until its holds are known. Then repeats AMEND until MISSION names the tick
// of the change.
#include "cli/operate/pause_order.h"

#include <chrono>
#include <utility>

#include "runtime/bus/random_identity.h"

namespace ergocast::cli {
namespace {

using State = OrderReport::State;

}  // namespace

bool BrakingWatch::is_stuck(const MonitoredRun::Standing& vehicles) {
  constexpr double kSlower = 0.999;  // a vehicle that brakes is soon slower by more
  if (vehicles.leaves_zone) return false;
  ++idle_;
  if (vehicles.speed_mps < kSlower * least_mps_) {
    least_mps_ = vehicles.speed_mps;
    idle_ = 0;
  }
  return idle_ >= patience_;
}

PauseOrder::PauseOrder(bool pauses, Instant now, std::string by)
    : pauses_(pauses),
      by_(std::move(by)),
      header_{0, kOperator, random_identity(), 0, 0},
      since_(now) {}

/// Whether MISSION names the tick of the change.
bool PauseOrder::is_named(const MonitoredRun& team) const {
  return is_open(team.holds()) == pauses_;
}

void PauseOrder::send(const MonitoredRun& team, Instant now, Outbox& out) {
  if (team.over()) return;
  if (team.is_running() && !number_) {
    number_ = team.amendments().named;
    obsolete_ = is_named(team);
    since_ = now;
    next_ = now;
  }
  was_named_ = was_named_ || (number_ && is_named(team));
  if (was_named_ || now < next_) return;
  next_ = now + kRepeatPeriod;
  if (!number_) {
    out.push_back(mission_question(team, header_));
    return;
  }
  ++header_.sequence;
  header_.run = team.run();
  header_.tick = team.tick();
  out.push_back(
      {Bus::kSwarm, Amend{.header = header_,
                          .number = *number_,
                          .kind = pauses_ ? AmendmentKind::kPause : AmendmentKind::kResume,
                          .by = by_}});
}

OrderReport PauseOrder::report(const MonitoredRun& team, Instant now) const {
  if (!number_) return waiting_for_mission(team, now - since_);
  // A mission that goes on may end before the next look at it.
  const bool goes_on =
      is_named(team) && (team.holds().empty() || team.tick() >= team.holds().back().until);
  if (!pauses_ && was_named_ && goes_on) return resumed(team);
  if (team.over()) return {State::kFailed, "the mission has ended: " + team.reason()};
  if (!is_named(team) && was_named_)
    return {State::kDone, pauses_ ? "the mission was resumed" : "the mission was paused again"};
  if (!is_named(team)) return unnamed(team, now);
  return pauses_ ? paused(team) : resumed(team);
}

OrderReport PauseOrder::unnamed(const MonitoredRun& team, Instant now) const {
  if (now - since_ < kAnswerPatience) return {State::kSent, "the coordinator has not answered yet"};
  return {State::kFailed, why_not(team)};
}

/// In real time the named tick is two seconds ahead, and vehicles move until then.
OrderReport PauseOrder::paused(const MonitoredRun& team) const {
  const Tick named = team.holds().back().from;
  const std::string when = team.mission_time(named);
  if (team.tick() < named) {
    return {State::kAnswered, "the coordinator pauses the mission at " + when +
                                  in_seconds(team.seconds_until(named))};
  }
  const bool all_stand = team.standing().moving.empty();
  return {all_stand ? State::kDone : State::kObeyed,
          (obsolete_ ? "the mission is paused already, at " : "paused at ") + when + ": " +
              standing_text(team)};
}

OrderReport PauseOrder::resumed(const MonitoredRun& team) const {
  if (team.holds().empty()) return {State::kDone, "the mission is not paused"};
  const Tick named = team.holds().back().until;
  const std::string when = team.mission_time(named);
  if (team.tick() < named)
    return {State::kAnswered, "the coordinator resumes the mission at " + when +
                                  in_seconds(team.seconds_until(named))};
  return {State::kDone, obsolete_ ? "the mission is not paused" : "the mission goes on at " + when};
}

std::string PauseOrder::why_not(const MonitoredRun& team) const {
  if (team.coordinator_seen() && team.holds().size() == kMaxHolds && pauses_)
    return "a mission can be paused " + std::to_string(kMaxHolds) +
           " times, and this one has been: end it with ergocast stop";
  return why_no_tick(team);
}

}  // namespace ergocast::cli
