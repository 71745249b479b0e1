// SPDX-License-Identifier: BSD-3-Clause
// Repeats STOP, and judges by the team's last messages whether the team has ended.
#include "cli/operate/stop_order.h"

#include <chrono>
#include <utility>

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;
using State = OrderReport::State;

/// How long the team may take to exit.
constexpr auto kLongest = 15s;
/// Without a roster an emergency stop is repeated at least this long. An unknown process may miss
/// the first ones.
constexpr auto kLeastInsistence = 1s;

}  // namespace

StopOrder::StopOrder(RunId run, bool at_once, std::string reason, bool keyed, Instant now)
    : request_(run, false, std::move(reason)), at_once_(at_once), keyed_(keyed), since_(now) {}

void StopOrder::send(const MonitoredRun& team, Instant now, Outbox& out) {
  const bool obeyed = !at_once_ && team.over();
  if (!obeyed) request_.repeat(now, at_once_, team.tick(), keyed_, out);
}

std::vector<std::string> StopOrder::awaited(const MonitoredRun& team, Instant now) const {
  return at_once_ ? team.still_moving(now) : team.still_there(now);
}

OrderReport StopOrder::report(const MonitoredRun& team, Instant now) const {
  const auto waited = now - since_;
  if (team.unheard()) return {State::kSent, "no message of the team arrives"};
  const bool obeyed = at_once_ ? team.knows_roster() || waited >= kLeastInsistence : team.over();
  const bool world_due = at_once_ && !team.world_seen() && team.tick() > 0;
  if (world_due && waited < kListeningTime) return unfinished(team, obeyed, now);
  const auto left = awaited(team, now);
  if (obeyed && left.empty()) return concluded(team, now);
  if (waited >= kLongest) {
    return {State::kFailed, "still running: " + listed(left) +
                                (at_once_ ? ": end them on their hosts"
                                          : ": ergocast stop --now stops them at once")};
  }
  if (!obeyed && !at_once_) {
    if (const auto problem = why_not_in_order(team, now)) return {State::kFailed, *problem};
  }
  return unfinished(team, obeyed, now);
}

std::optional<std::string> StopOrder::why_not_in_order(const MonitoredRun& team,
                                                       Instant now) const {
  if (!team.coordinator_seen() && now - since_ >= kListeningTime) {
    return "no coordinator answers, and only a coordinator ends a mission in order: "
           "ergocast stop --now stops the team at once";
  }
  if (now - since_ >= kAnswerPatience) {
    return "the coordinator does not end the mission: ergocast stop --now stops the team at once";
  }
  return std::nullopt;
}

/// The result so far.
OrderReport StopOrder::unfinished(const MonitoredRun& team, bool obeyed, Instant now) const {
  const std::string so_far = !at_once_ ? (team.over() ? "the coordinator has ended the mission"
                                                      : "the coordinator has not answered yet")
                             : !team.world_seen()  ? "no world or driver answers yet"
                             : team.stands_still() ? "all vehicles stand still"
                                                   : standing_text(team);
  const auto left = awaited(team, now);
  return {obeyed ? State::kObeyed : State::kSent,
          so_far + (left.empty() ? "" : "; waiting for ") + listed(left)};
}

OrderReport StopOrder::concluded(const MonitoredRun& team, Instant now) const {
  const std::string when = team.mission_time(team.tick());
  // A mission that never started has moved no vehicle.
  if (at_once_ && !team.world_seen() && team.tick() > 0) {
    return {State::kFailed,
            "no messages arrive any more, and none came from a world or driver: it is unknown "
            "whether the vehicles stand still: look at them"};
  }
  if (at_once_ && !team.stands_still()) {
    return {State::kFailed, "the world is silent, and in its last state, of " + when +
                                ", vehicles still move: look at them"};
  }
  const auto lost = team.lost(now);
  return {State::kDone, (at_once_ ? "stopped at " : "the mission has ended at ") + when + ": " +
                            (at_once_ ? "all stand still" : team.reason()) +
                            (lost.empty() ? "" : "; " + listed(lost) + " did not confirm it")};
}

}  // namespace ergocast::cli
