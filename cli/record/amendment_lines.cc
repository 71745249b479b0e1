// SPDX-License-Identifier: BSD-3-Clause
// Looks up where each agent was at the tick of a zone.
#include "cli/record/amendment_lines.h"

#include <algorithm>
#include <cstdio>

#include "core/mission/hold.h"
#include "core/mission/law_change.h"
#include "core/motion/zones.h"

namespace ergocast::cli {
namespace {

class Lines {
 public:
  Lines(const RunData& run, const Mission& mission) : run_(run), mission_(mission) {
    for (const auto& [agent, track] : run.tracks) last_ = std::max(last_, track.back().tick);
  }

  std::string target(const Amendment& amendment) const {
    return "target    amendment " + std::to_string(amendment.number) + " from " +
           time_of(amendment.from) + " on" + replaced(amendment);
  }
  std::string note(const Amendment& amendment, const SearchNote& note) const {
    return std::string(note.is_sighting() ? "sighting" : "contact ") + "  amendment " +
           std::to_string(amendment.number) + " from " + time_of(amendment.from) +
           " on: " + to_text(note) + replaced(amendment);
  }
  std::string end(const Amendment& amendment) const {
    return "end       amendment " + std::to_string(amendment.number) + " at " +
           text_of(static_cast<Tick>(amendment.hash)) + ", from " + time_of(amendment.from) +
           " on" + replaced(amendment);
  }
  std::string law(const Amendment& amendment, const LawChange& law) const {
    return "law       amendment " + std::to_string(amendment.number) + " from " +
           time_of(amendment.from) + " on: " + law_text(law, mission_) + replaced(amendment);
  }
  std::string zone(const Zone& zone) const {
    std::string text = "zone      amendment " + std::to_string(zone.number) + " closed from " +
                       time_of(zone.closed) + " until " + time_of(zone.end()) + cancelled(zone);
    if (zone.end() <= zone.from) return text + " before it was free";
    text += "; at " + time_of(zone.from);
    if (zone.from > last_) return text + " the mission had ended";
    const std::vector<AgentId> inside = inside_at(zone);
    if (inside.empty()) return text + " nobody was inside";
    text += inside.size() == 1 ? " agent " : " agents ";
    for (const AgentId agent : inside)
      text += (agent == inside.front() ? "" : ", ") + std::to_string(agent);
    return text + (inside.size() == 1 ? " was inside" : " were inside");
  }

 private:
  std::string text_of(Tick counted) const {
    char text[32];
    std::snprintf(text, sizeof text, "t = %.1f s",
                  static_cast<double>(counted) * mission_.timing.dt_s);
    return text;
  }
  /// The mission time of a tick of the world.
  std::string time_of(Tick tick) const { return text_of(counted_ticks(run_.holds(), tick)); }

  /// ", replaced by amendment 4 before", or nothing.
  std::string replaced(const Amendment& amendment) const {
    if (amendment.kind == AmendmentKind::kDismiss) return "";
    const auto& all = run_.amendments.all();
    const auto next = std::ranges::find_if(all, [&](const ReceivedAmendment& one) {
      return !one.is_void && one.amendment.number > amendment.number &&
             one.amendment.kind == amendment.kind;
    });
    const bool before = next != all.end() && next->amendment.from <= amendment.from;
    return before ? ", replaced before by amendment " + std::to_string(next->amendment.number) : "";
  }

  /// ", when amendment 4 cancelled it", or nothing.
  std::string cancelled(const Zone& zone) const {
    if (zone.cancelled < 0) return "";
    const auto& all = run_.amendments.all();
    const auto by = std::ranges::find_if(all, [&zone](const ReceivedAmendment& one) {
      return !one.is_void && one.amendment.kind == AmendmentKind::kReopen &&
             one.amendment.hash == static_cast<std::uint64_t>(zone.number);
    });
    return by == all.end()
               ? ", when it was cancelled,"
               : ", when amendment " + std::to_string(by->amendment.number) + " cancelled it";
  }

  std::vector<AgentId> inside_at(const Zone& zone) const {
    std::vector<AgentId> inside;
    for (const auto& [agent, track] : run_.tracks) {
      const auto point = std::ranges::lower_bound(track, zone.from, {}, &TrackPoint::tick);
      if (point != track.end() && point->tick == zone.from && is_inside(zone, point->x_m))
        inside.push_back(agent);
    }
    return inside;
  }

  const RunData& run_;
  const Mission& mission_;
  Tick last_ = -1;
};

}  // namespace

std::vector<std::string> amendment_lines(const RunData& run, const Mission& mission) {
  const Lines lines(run, mission);
  std::vector<std::string> all;
  for (const ReceivedAmendment& one : run.amendments.all()) {
    if (one.is_void) continue;
    if (one.note)
      all.push_back(lines.note(one.amendment, *one.note));
    else if (one.amendment.kind == AmendmentKind::kTarget)
      all.push_back(lines.target(one.amendment));
    if (one.amendment.kind == AmendmentKind::kEnd) all.push_back(lines.end(one.amendment));
    if (one.law) all.push_back(lines.law(one.amendment, *one.law));
    if (one.zone) all.push_back(lines.zone(*one.zone));
  }
  return all;
}

}  // namespace ergocast::cli
