// SPDX-License-Identifier: BSD-3-Clause
// A geofence for the autopilot itself: uploaded by MAVLink's mission protocol, read back, compared.
//
//   MISSION_COUNT →   ← MISSION_REQUEST_INT   MISSION_ITEM_INT →   ← MISSION_ACK      the upload
//   MISSION_REQUEST_LIST →   ← MISSION_COUNT  MISSION_REQUEST_INT →  ← MISSION_ITEM_INT   the check
//
// The side that waits repeats its last message. What the autopilot does at the fence, and whether
// it watches the fence at all, is set by its parameters, which this driver leaves alone.
#pragma once

#include <ergocast/core/base/geometry.h>
#include <ergocast/core/base/ids.h>
#include <ergocast/core/base/indexed_rings.h>
#include <ergocast/core/base/result.h>

#include <string>
#include <vector>

#include "bridges/mavlink/messages.h"
#include "bridges/mavlink/places.h"

namespace ergocast::mavlink {

/// The domain's rectangle, `margin_m` wider on each side, as the polygon to stay in; each wall as
/// one to stay out of.
/// @return  an error if a wall has a room: autopilots know no polygon within a polygon
Result<std::vector<MissionItemInt>> fence_items(const EarthPlace& origin, const Box& domain,
                                                double margin_m, const IndexedRings& walls);

class Fence {
 public:
  /// Uploads `items`, which replace a fence that the autopilot has; at once after the next
  /// advance().
  void begin(std::vector<MissionItemInt> items);
  /// The autopilot may have lost it: uploads it again.
  void begin_anew();

  /// For messages of the autopilot to this driver.
  void receive(const MissionRequest& request, Instant now) {
    if (request.mission_type == kType) give(request.seq, now);
  }
  void receive(const MissionRequestInt& request, Instant now) {
    if (request.mission_type == kType) give(request.seq, now);
  }
  void receive(const MissionAck& ack, Instant now);
  void receive(const MissionCount& count, Instant now);
  void receive(const MissionItemInt& item, Instant now);

  /// Appends what is to be sent at `now`; the receiver's address is the caller's part.
  void advance(Instant now, std::vector<Packet>& out);

  /// Why the vehicle must stand; empty without a fence, and once it was read back as it was sent.
  std::string why_not() const;
  /// Whether an upload has failed, and none has succeeded since.
  bool failed() const { return !problem_.empty(); }

  static constexpr std::uint8_t kType = 1;  ///< MAV_MISSION_TYPE_FENCE

 private:
  enum class Phase { kNone, kBegins, kUploads, kChecks, kHolds, kFailed };
  void give(std::size_t seq, Instant now);
  void send(const Packet& packet, Instant now);
  void fail(std::string problem, Instant now);

  std::vector<MissionItemInt> items_;
  Phase phase_ = Phase::kNone;
  std::size_t given_ = 0, read_ = 0;  // items that were asked for, and that were read back
  Packet last_;                       // sent, and repeated until an answer comes
  std::vector<Packet> out_;
  int tries_ = 0;
  Instant next_{};       // to repeat it, or to begin again after a failure
  std::string problem_;  // of the last upload
};

}  // namespace ergocast::mavlink
