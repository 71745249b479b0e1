// SPDX-License-Identifier: BSD-3-Clause
// Has a line for each kind of amendment.
#include "report/export/changes.h"

#include <cstdio>

#include "core/mission/law_change.h"

namespace ergocast {
namespace {

/// "1600.8 s"
std::string seconds_of(Tick tick, double dt_s) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g s", static_cast<double>(tick) * dt_s);
  return text;
}

/// "zone, closed from 8 s on, free from 15 s until 18 s".
std::string zone_text(const Zone& zone, double dt_s) {
  const auto at = [dt_s](Tick tick) { return seconds_of(tick, dt_s); };
  const std::string closed = "zone, closed from " + at(zone.closed);
  if (zone.cancelled >= 0) return closed + " until " + at(zone.end()) + ", when it was cancelled";
  return closed + " on, free from " + at(zone.from) + " until " + at(zone.until);
}

}  // namespace

std::string change_text(const ReceivedAmendment& one, const Mission& mission) {
  const double dt_s = mission.timing.dt_s;
  if (one.note) return to_text(*one.note);
  switch (one.amendment.kind) {
    case AmendmentKind::kPause:
      return "the mission is paused";
    case AmendmentKind::kResume:
      return "the mission goes on";
    case AmendmentKind::kTarget:
      return "target " + to_hex(one.amendment.hash);
    case AmendmentKind::kEnd:
      return "the end at " + seconds_of(static_cast<Tick>(one.amendment.hash), dt_s) +
             " of mission time";
    case AmendmentKind::kZone:
      return one.zone ? zone_text(*one.zone, dt_s) : "zone " + to_hex(one.amendment.hash);
    case AmendmentKind::kLaw:
      return "law " + (one.law ? law_text(*one.law, mission) : to_hex(one.amendment.hash));
    case AmendmentKind::kDismiss:
      return "a contact is dismissed";
    case AmendmentKind::kReopen:
      return "the zone of amendment " + std::to_string(one.amendment.hash) + " is cancelled";
  }
  return to_string(one.amendment.kind);
}

std::vector<ExportedChange> changes_of(const ExportRecord& record) {
  std::vector<ExportedChange> changes;
  for (const ReceivedAmendment& one : record.run.amendments.all()) {
    if (one.is_void) continue;
    const double t_s = static_cast<double>(one.amendment.from) * record.mission.timing.dt_s;
    changes.push_back({one.amendment, t_s, change_text(one, record.mission)});
  }
  return changes;
}

}  // namespace ergocast
