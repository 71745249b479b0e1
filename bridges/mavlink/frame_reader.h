// SPDX-License-Identifier: BSD-3-Clause
// Frames of MAVLink 1 and 2 in a stream of bytes. Whatever the bytes are, it neither throws nor
// keeps more than one frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "bridges/mavlink/frame_writer.h"
#include "bridges/mavlink/messages.h"
#include "bridges/mavlink/signing.h"

namespace ergocast::mavlink {

/// A message and its sender.
struct Received {
  Source from;
  Packet packet;
};

class FrameReader {
 public:
  /// With a key only frames with a valid signature count. A sender that is new here must not be
  /// more than kSigningSlack behind `time` or behind the newest frame.
  explicit FrameReader(std::optional<SigningKey> key = {}, std::uint64_t time = 0)
      : key_(key), newest_time_(time) {}

  /// Appends the messages that end in `bytes`.
  void read(std::span<const std::byte> bytes, std::vector<Received>& out);
  /// Forgets an incomplete frame, because the next bytes do not continue it: another datagram.
  void begin_anew() { held_.clear(); }

  struct Counts {
    std::int64_t read = 0;
    std::int64_t unknown = 0;    ///< of a type that we do not read
    std::int64_t damaged = 0;    ///< a wrong checksum or an impossible length
    std::int64_t unsigned_ = 0;  ///< without a signature, though there is a key
    std::int64_t wrong_key = 0;  ///< a wrong signature
    std::int64_t repeated = 0;   ///< a signature that is not newer than the last
  };
  const Counts& counts() const { return counts_; }

  /// Limit (MAVLink): senders with signatures on a link. Beyond it: frames of further ones are
  /// refused.
  static constexpr std::size_t kMaxSigners = 256;

 private:
  bool counts_as_signed(std::span<const std::byte> frame, const Source& from);

  std::optional<SigningKey> key_;
  std::uint64_t newest_time_;
  std::map<std::array<std::uint8_t, 3>, std::uint64_t> times_;  // by system, component and link
  std::vector<std::byte> held_;
  Counts counts_;
};

}  // namespace ergocast::mavlink
