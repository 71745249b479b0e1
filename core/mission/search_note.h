// SPDX-License-Identifier: BSD-3-Clause
// What an operator learns about hidden objects during a mission: sightings, and contacts that are
// none.
//
// A sighting: an object may be near a place. It comes with a new target, which is 1 − q of the
// target before and q of a Gaussian around the place. A team that searches then forgets what it
// has looked at and reported within 2 σ of the place before: the object may have come there since.
//
// A dismissal: a contact is no object. What sensors have reported in the place's cell and in its
// neighbours before counts no more. Looks there still count.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast {

struct SearchNote {
  std::int32_t number = 0;  ///< of the amendment; of a sighting, that of its target
  Tick from = 0;            ///< the world's tick from which it holds
  Eigen::Vector2d x_m{0, 0};
  double sigma_m = 0;  ///< of a sighting: standard deviation along x and along y; else 0
  double share = 0;    ///< q of a sighting, below 1; else 0

  bool is_sighting() const { return share > 0; }
  bool operator==(const SearchNote&) const = default;
};

/// Numbers of a note, without number and tick: place, σ and q.
inline constexpr int kSearchNoteNumbers = 4;
/// Within how many σ of its place a sighting makes a team forget.
inline constexpr double kForgottenSigmas = 2;
/// Limit (Team): sightings and dismissed contacts of a mission together. Beyond it: `ergocast amend
/// --sighting` and `--dismiss` end with code 4.
inline constexpr std::size_t kMaxSearchNotes = 64;

/// Whether an operator can have learnt this: the place is in a plane. A sighting has 0 < q < 1 and
/// σ ≤ 1e7 m, and the team searches. Contacts exist, because sensors have false alarms.
bool is_search_note(const SearchNote& note, const Mission& mission);

/// Whether a mission can have these: at most kMaxSearchNotes, and each is_search_note().
bool are_search_notes(std::span<const SearchNote> notes, const Mission& mission);

/// A number that identifies place, σ and q.
std::uint64_t search_note_hash(const SearchNote& note);

/// For people: "sighting at (412.0, 77.5) m, sigma 50 m, share 0.5", or "contact at (412.0, 77.5) m
/// dismissed".
std::string to_text(const SearchNote& note);

}  // namespace ergocast
