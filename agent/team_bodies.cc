// SPDX-License-Identifier: BSD-3-Clause
// Takes positions from beacons if the mission uses beacons, otherwise from the world's states.
#include "agent/team_bodies.h"

#include "core/motion/filter_rules.h"

namespace ergocast {

TeamBodies::TeamBodies(const Mission& mission, const Author& self, std::int64_t revision) {
  if (uses_beacons(mission)) beacons_.emplace(mission, self, revision);
}

void TeamBodies::note_roster(const std::vector<RosterEntry>& roster) {
  if (beacons_) beacons_->note_roster(roster);
}

void TeamBodies::on(const Beacon& beacon, bool fresh, const Moment& now) {
  if (beacons_) beacons_->receive(beacon, fresh, now);
}

void TeamBodies::begin(const OwnState& own, const AgentStep& step, Participant& me, Outbox& out) {
  if (!beacons_) return;
  beacons_->measured(own.answered_tick, own.roster_revision, own.position_m, own.velocity_mps);
  const auto beacon = beacons_->next(me.follower().revision(), step.moment());
  if (beacon) me.publish(Bus::kSwarm, *beacon, step.tick, out);
}

void TeamBodies::answered(const AgentStep& step) {
  if (beacons_) beacons_->commands(step.moment());
}

std::optional<std::span<const Neighbour>> TeamBodies::neighbours(const AgentStep& step,
                                                                 const Participant& me) {
  if (!beacons_) return states_.neighbours(me.mission());
  if (me.follower().revision() < step.roster_revision) return std::nullopt;
  return beacons_->bodies(step.body_m, step.moment());
}

}  // namespace ergocast
