// SPDX-License-Identifier: BSD-3-Clause
// Zones: polygons that a running mission keeps free for a while. In a box a zone is a prism.
//
// A zone is an amendment with three ticks of the world. From `closed` on no body enters it, and a
// body that is inside leaves it. From `from` on nobody is inside any more. At `until` it ends.
// Zones are no walls: they may overlap each other and walls, and a place is closed if any of them
// contains it. core/motion/zones.h has what they ask of bodies. An operator may cancel a zone: it
// then ends earlier.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/ids.h"
#include "core/base/rings.h"

namespace ergocast {

struct Zone {
  std::int32_t number = 0;  ///< of the amendment
  Tick closed = 0, from = 0, until = 0;
  Ring corners_m;
  double low_m = 0, high_m = 0;  ///< the heights in a box; 0 in a plane
  Tick cancelled = -1;           ///< it ends at this tick instead of `until`; −1: as planned

  /// The tick at which it ends.
  Tick end() const { return cancelled < 0 ? until : std::min(cancelled, until); }
  bool closed_at(Tick tick) const { return closed <= tick && tick < end(); }
  bool operator==(const Zone&) const = default;
};

/// Limit (Team): zones of a mission at a time. Beyond it: `ergocast amend` ends with code 4, until
/// one of them has ended.
inline constexpr std::size_t kMaxZones = 8;
/// Limit (Team): corners of a zone. Beyond it: it is refused.
inline constexpr std::size_t kMaxZoneCorners = 64;
/// The longest that a zone can last [ticks].
inline constexpr Tick kMaxZoneTicks = Tick{1} << 40;

/// Whether this is a zone of a mission in `domain`: from 3 to kMaxZoneCorners corners near the
/// domain, edges that touch only at corners, an area, heights in a box, and ticks in their order;
/// a zone is not cancelled before it is closed.
bool is_zone(const Zone& zone, const Box& domain);

/// Whether the numbers of zones ascend, they are zones in `domain`, and at most kMaxZones.
bool are_zones(std::span<const Zone> zones, const Box& domain);

/// Those that have not ended at a tick.
std::vector<Zone> not_ended(std::span<const Zone> zones, Tick tick);

/// A number that identifies a zone's place and how long it was to last.
std::uint64_t zone_hash(const Zone& zone);

}  // namespace ergocast
