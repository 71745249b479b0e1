// SPDX-License-Identifier: BSD-3-Clause
// Messages as frames of MAVLink 2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "bridges/mavlink/messages.h"
#include "bridges/mavlink/signing.h"

namespace ergocast::mavlink {

/// The sender of a frame.
struct Source {
  std::uint8_t system = 0, component = 0;
  bool operator==(const Source&) const = default;
};

class FrameWriter {
 public:
  /// Signs if there is a key. @param time  of the first frame, in the unit of signing.h
  explicit FrameWriter(std::optional<SigningKey> key = {}, std::uint64_t time = 0)
      : key_(key), time_(time) {}

  std::vector<std::byte> frame_of(const Packet& packet, const Source& from);

  /// The time by the clock. The frames' times grow even where it stands or goes back.
  void note_time(std::uint64_t time) { time_ = time > time_ ? time : time_; }

 private:
  std::optional<SigningKey> key_;
  std::uint64_t time_ = 0;
  std::uint8_t sequence_ = 0;
};

}  // namespace ergocast::mavlink
