// SPDX-License-Identifier: BSD-3-Clause
// When a driver that takes command repeats an order, and when the vehicle belongs to the pilot.
//
// An order is sent only in answer to a heartbeat, and repeated until the autopilot accepts or the
// driver gives up. An armed vehicle belongs to the driver only if the autopilot has accepted this
// driver's order to arm. Without that answer the driver waits for one more heartbeat, because a
// heartbeat may overtake the answer. If none has arrived by then, the vehicle belongs to the pilot.
//
// An autopilot also accepts the order to arm while it is armed. So the driver first sends the order
// to run the checks before arming, and the order to arm together with it. By MAVLink an armed
// autopilot rejects the checks. The driver overlooks only a pilot that arms between these two
// orders. Some autopilots do not know the checks, or run them while armed. There the driver
// overlooks a pilot that arms between the heartbeat and the orders.
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
  /// Whether to send this order now: at most once after each heartbeat. The caller sends
  /// kRunChecks before kArm.
  bool due(std::uint16_t command);
  /// The vehicle is armed, but it is not known yet whether this driver has armed it.
  bool waits_for_answer() const { return open_; }
  /// True once after the vehicle has passed to the pilot.
  bool take_pilots() { return std::exchange(pilots_, false); }
  /// True once after the last order was repeated as often as it may be.
  bool take_gave_up() { return std::exchange(gave_up_, false); }

  /// How often an order is sent to an autopilot that does not accept it.
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
