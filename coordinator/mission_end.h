// SPDX-License-Identifier: BSD-3-Clause
// The end of the mission. It is repeated until all other processes have reported that they leave,
// and at most for a second.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "coordinator/members.h"
#include "core/base/ids.h"
#include "team/mission_follower.h"

namespace ergocast {

/// How long the end is repeated.
inline constexpr std::chrono::seconds kEndLinger{1};

class MissionEnd {
 public:
  bool begun() const { return since_.has_value(); }
  /// Why the mission has ended or failed.
  const std::string& reason() const { return reason_; }
  /// The end begins. Only the first call has an effect; false for others.
  bool begin(std::string reason, Instant now);
  /// Continues after a takeover: if the mission is over, its end begins again.
  /// @pre not begun()
  void take_over(const MissionFollower& known, Instant now);

  /// Whether a world or logger has just reported that it leaves, in its newest message.
  void note_world(bool leaves) { world_left_ = leaves; }
  void note_logger(bool leaves) { logger_left_ = leaves; }
  /// Whether world, logger and agents have reported that they leave. Each of them leaves once it
  /// has received the end.
  bool all_have_left(const Members& members, const SignsOfLife& signs) const;
  /// Whether it has been repeated for long enough. @pre begun()
  bool over(Instant now) const { return now - *since_ >= kEndLinger; }

  /// The coordinator sends nothing more.
  void finish() { finished_ = true; }
  /// The same; the mission is not its own to end.
  void leave() { finished_ = left_ = true; }
  bool finished() const { return finished_; }
  bool left() const { return left_; }

 private:
  std::optional<Instant> since_;
  std::string reason_;
  bool finished_ = false, left_ = false;
  bool world_left_ = false, logger_left_ = false;
};

}  // namespace ergocast
