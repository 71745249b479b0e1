// SPDX-License-Identifier: BSD-3-Clause
// Counts heartbeats instead of seconds, so a slow link gives nobody less time to answer.
#include "bridges/mavlink/orders.h"

#include <iterator>

namespace ergocast::mavlink {
namespace {

/// In how many heartbeats the state must show an order that was accepted. Else a pilot has changed
/// it again.
constexpr std::int64_t kSeenHeartbeats = 3;
constexpr std::uint8_t kAccepted = 0, kTemporarilyRejected = 1, kInProgress = 5;
constexpr const char* kResults[] = {"ACCEPTED", "TEMPORARILY_REJECTED", "DENIED",   "UNSUPPORTED",
                                    "FAILED",   "IN_PROGRESS",          "CANCELLED"};

}  // namespace

void Orders::note_heartbeat(bool armed) {
  ++heartbeats_;
  const bool was_armed = std::exchange(armed_, armed), began = armed && !was_armed;
  if (std::exchange(open_, false) && armed) pilots_ = true;
  if (!began) return;
  const bool accepted = command_ == kArm && accepted_at_heartbeat_.has_value();
  open_ = command_ == kArm && (unanswered_ || (accepted && !checked_));
  if (!accepted && !open_) pilots_ = true;
}

std::optional<std::string> Orders::take_answer(const CommandAck& ack) {
  if (ack.command == kRunChecks && command_ == kArm) return take_check(ack), std::nullopt;
  if (ack.command != command_ || requests_ == 0) return std::nullopt;
  const bool in_progress = ack.result == kInProgress;
  if (in_progress && command_ == kArm) return std::nullopt;
  unanswered_ = false;
  if (ack.result != kAccepted && !in_progress)
    return ack.result < std::size(kResults) ? kResults[ack.result] : std::to_string(ack.result);
  open_ = open_ && command_ == kArm && !checked_;
  if (!accepted_at_heartbeat_) accepted_at_heartbeat_ = heartbeats_;
  return std::nullopt;
}

/// An autopilot that rejects the checks was armed before the driver's order.
void Orders::take_check(const CommandAck& ack) {
  checked_ = true;
  if (ack.result == kTemporarilyRejected) pilots_ = true;
  if (accepted_at_heartbeat_) open_ = false;
}

bool Orders::due(std::uint16_t command) {
  if (answered_heartbeats_ == heartbeats_ || open_) return false;
  answered_heartbeats_ = heartbeats_;
  if (command != command_) {
    requests_ = 0;
    unanswered_ = false;
    accepted_at_heartbeat_.reset();
  }
  command_ = command;
  if (accepted_at_heartbeat_) {
    if (heartbeats_ - *accepted_at_heartbeat_ >= kSeenHeartbeats) pilots_ = true;
    return false;
  }
  if (requests_ > kMostRequests) return false;
  checked_ = false;
  gave_up_ = ++requests_ > kMostRequests;
  return unanswered_ = !gave_up_;
}

}  // namespace ergocast::mavlink
