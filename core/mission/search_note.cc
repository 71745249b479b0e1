// SPDX-License-Identifier: BSD-3-Clause
// Checks sightings and dismissals that come from the network, and words them.
#include "core/mission/search_note.h"

#include <algorithm>
#include <bit>
#include <cstdio>

namespace ergocast {

bool is_search_note(const SearchNote& note, const Mission& mission) {
  constexpr double kMostSigma_m = 1e7;
  const Box& domain = mission.domain;
  if (!domain.planar() || !note.x_m.allFinite() || !domain.contains(on_ground(note.x_m)))
    return false;
  if (note.is_sighting())
    return mission.law.kind == LawKind::kSearch && note.sigma_m > 0 &&
           note.sigma_m <= kMostSigma_m && note.share < 1;
  return note.sigma_m == 0 && note.share == 0 && mission.sensor.has_false_alarms();
}

bool are_search_notes(std::span<const SearchNote> notes, const Mission& mission) {
  return notes.size() <= kMaxSearchNotes &&
         std::ranges::all_of(
             notes, [&mission](const SearchNote& note) { return is_search_note(note, mission); });
}

std::uint64_t search_note_hash(const SearchNote& note) {
  std::uint64_t hash = 1;
  for (const double value : {note.x_m.x(), note.x_m.y(), note.sigma_m, note.share}) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9e3779b97f4a7c15;
    hash ^= hash >> 29;
  }
  return hash;
}

std::string to_text(const SearchNote& note) {
  char text[120];
  if (note.is_sighting()) {
    std::snprintf(text, sizeof text, "sighting at (%.1f, %.1f) m, sigma %g m, share %g",
                  note.x_m.x(), note.x_m.y(), note.sigma_m, note.share);
  } else {
    std::snprintf(text, sizeof text, "contact at (%.1f, %.1f) m dismissed", note.x_m.x(),
                  note.x_m.y());
  }
  return text;
}

}  // namespace ergocast
