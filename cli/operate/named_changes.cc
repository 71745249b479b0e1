// SPDX-License-Identifier: BSD-3-Clause
// Compares the list of amendments and the roster with those of the last call.
#include "cli/operate/named_changes.h"

#include "core/mission/amendments.h"

namespace ergocast::cli {
namespace {

const char* what(AmendmentKind kind) {
  return kind == AmendmentKind::kTarget    ? "new target"
         : kind == AmendmentKind::kEnd     ? "another end"
         : kind == AmendmentKind::kReopen  ? "cancelled zone"
         : kind == AmendmentKind::kDismiss ? "dismissed contact"
                                           : to_string(kind);
}

}  // namespace

void NamedChanges::take_amendments(const MonitoredRun& team,
                                   std::vector<NamedChange>& changes) const {
  for (const Amendment& amendment : team.amendments().recent) {
    if (amendment.number < *named_) continue;
    changes.push_back({to_string(amendment.kind), kUnassigned, what(amendment.kind),
                       "from " + team.mission_time(amendment.from), amendment.by});
  }
}

void NamedChanges::take_recalls(const MonitoredRun& team, std::vector<NamedChange>& changes) {
  for (const RosterEntry& entry : team.roster()) {
    const AgentId agent = entry.author.agent;
    if (!entry.recalled() || !recalled_.emplace(agent, entry.leaves).second || !named_) continue;
    changes.push_back(
        {entry.leaves ? "out" : "home", agent,
         "agent " + std::to_string(agent) + (entry.leaves ? " out of the mission" : " home"),
         "recalled at " + team.mission_time(team.tick())});
  }
}

std::vector<NamedChange> NamedChanges::take(const MonitoredRun& team) {
  std::vector<NamedChange> changes;
  if (!team.knows_mission()) return changes;
  take_recalls(team, changes);
  if (named_) take_amendments(team, changes);
  named_ = team.amendments().named;
  return changes;
}

}  // namespace ergocast::cli
