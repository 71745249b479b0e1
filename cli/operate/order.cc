// SPDX-License-Identifier: BSD-3-Clause
// Reports that several orders share.
#include "cli/operate/order.h"

#include <cstdio>

#include "core/mission/amendments.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {
namespace {

/// How long to wait for the whole mission. A large mission arrives part by part.
constexpr std::chrono::seconds kMissionPatience{20};
/// Vehicles that a sentence names.
constexpr std::size_t kMostNames = 10;

}  // namespace

OrderReport Order::report_at_end(const MonitoredRun& team, Instant now) const {
  OrderReport last = report(team, now);
  if (last.ended()) return last;
  return {OrderReport::State::kFailed, last.text + "; then the mission ended"};
}

OrderReport waiting_for_mission(const MonitoredRun& team, Instant::duration waited) {
  using State = OrderReport::State;
  if (team.over()) return {State::kFailed, "the mission is over: " + team.reason()};
  if (team.plan_problem())
    return {State::kFailed, "the mission cannot be read: " + *team.plan_problem()};
  if (waited < kMissionPatience) return {State::kSent, "waiting for the mission"};
  return {State::kFailed,
          team.knows_mission()
              ? "the mission has not begun: it waits for its quorum, and no vehicle moves"
              : "the mission was not received: is its coordinator running?"};
}

std::string own_operator_name() { return operator_name_of(user_name() + '@' + host_name()); }

Outgoing mission_question(const MonitoredRun& team, Header& header) {
  header.run = team.run();
  ++header.sequence;
  Hello question;
  question.header = header;
  question.header.tick = -1;
  return {Bus::kSwarm, question};
}

std::string why_no_tick(const MonitoredRun& team) {
  if (!team.coordinator_seen())
    return "no coordinator answers, and only a coordinator names the tick: start one with "
           "ergocast-coordinator --resume, or end the mission with ergocast stop --now";
  return "the coordinator names no tick: it may have another key, or receive no world";
}

std::string in_seconds(double seconds) {
  if (!(seconds > 0)) return {};
  char text[32];
  std::snprintf(text, sizeof text, ", in %.1f s of wall time", seconds);
  return text;
}

std::string standing_text(const MonitoredRun& team) {
  MonitoredRun::Standing vehicles = team.standing();
  std::string text =
      std::to_string(vehicles.standing) + " of " + std::to_string(vehicles.all) + " stand";
  if (vehicles.circling > 0)
    text += ", " + std::to_string(vehicles.circling) +
            (vehicles.circling == 1 ? " circles" : " circle");
  if (vehicles.moving.size() > kMostNames) {
    const std::size_t others = vehicles.moving.size() - kMostNames;
    vehicles.moving.resize(kMostNames);
    vehicles.moving.push_back(std::to_string(others) + " others");
  }
  if (!vehicles.moving.empty())
    text += "; " + listed(vehicles.moving) +
            (vehicles.moving.size() == 1 ? " still moves" : " still move");
  return text;
}

}  // namespace ergocast::cli
