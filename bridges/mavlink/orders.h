// SPDX-License-Identifier: BSD-3-Clause
// When a driver that takes command repeats an order, and when the vehicle is the pilot's.
//
// An order is sent only in answer to a heartbeat, and repeated until the autopilot accepts or the
// driver gives up. A vehicle that is armed is the driver's only if the autopilot has accepted this
// driver's order to arm. Without that answer the driver waits for one more heartbeat, because an
// answer may be overtaken, and then the vehicle is the pilot's.
//
// An autopilot also accepts the order to arm while it is armed. So each order to arm follows an
// order to run the checks before arming, which MAVLink has an armed autopilot reject. Only a pilot
// that arms between these two orders, which are sent together, is overlooked. Where the autopilot
// does not know the checks, or runs them while it is armed, that holds for a pilot that arms
// between the heartbeat and the order.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "bridges/mavlink/messages.h"

namespace ergocast::mavlink {

inline constexpr std::uint16_t kTakeOff = 22, kSetMode = 176, kArm = 400, kRunChecks = 401;

class Orders {
 public:
  /// To be called for each heartbeat of the autopilot.
  void note_heartbeat(bool armed);
  /// An answer to this driver. @return  the autopilot's refusal of the present order, as a word
  std::optional<std::string> take_answer(const CommandAck& ack);
  /// Whether this order is to be sent now, kArm after kRunChecks. At most once after each
  /// heartbeat.
  bool due(std::uint16_t command);
  /// The vehicle is armed, and whether this driver has armed it is not known yet.
  bool waits_for_answer() const { return open_; }
  /// True once after the vehicle has become the pilot's.
  bool take_pilots() { return std::exchange(pilots_, false); }
  /// True once after the last order was repeated as often as it may be.
  bool take_gave_up() { return std::exchange(gave_up_, false); }

  /// How often it asks an autopilot that refuses.
  static constexpr int kMostRequests = 5;

 private:
  void take_check(const CommandAck& ack);

  std::int64_t heartbeats_ = 0, answered_heartbeats_ = 0;
  bool armed_ = false;
  std::uint16_t command_ = 0;  // the present order
  int requests_ = 0;
  bool unanswered_ = false;                            // the newest request
  bool checked_ = false;                               // the answer to kRunChecks has arrived
  std::optional<std::int64_t> accepted_at_heartbeat_;  // the present order
  bool open_ = false, pilots_ = false, gave_up_ = false;
};

}  // namespace ergocast::mavlink
