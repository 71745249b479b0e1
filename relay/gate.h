// SPDX-License-Identifier: BSD-3-Clause
// Checks each datagram before a relay queues it, and finds what it may replace.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/ids.h"
#include "lcmtypes/message_authenticator.h"
#include "team/messages.h"

namespace ergocast::relay {

/// In what order a full link carries datagrams: the first at once, the others by turns.
enum class Urgency {
  kOrder,     ///< STOP, RECALL, and AMEND of one part, as pauses are
  kMotion,    ///< what all agents need at once: beacons, states, HELLO
  kCommand,   ///< COMMAND, which only the site of the world needs
  kCoverage,  ///< CONTRIBUTION, EFFORT
  kMission,   ///< MISSION, and AMEND of several parts: up to a megabyte at once
  kReport,    ///< statuses and digests
  kOther,     ///< other messages of LCM, which only a relay with --insecure carries
};
inline constexpr std::size_t kUrgencies = 7;

/// Only the newer one of two messages with the same place is needed. Parts have separate places.
struct Place {
  RunId run = 0;
  Bus bus = Bus::kSwarm;
  std::size_t type = 0;
  AgentId transmitter = kUnassigned;  ///< with bus and type: the channel
  Author author;
  std::int64_t part = 0, revision = 0;
  auto operator<=>(const Place&) const = default;
};

/// The same for every copy of a message on one bus, whichever way it took.
using Identity = std::array<std::uint64_t, 2>;

struct Admitted {
  Urgency urgency = Urgency::kOther;
  std::optional<Place> place;   ///< nothing: it replaces nothing
  std::int64_t newness = 0;     ///< greater is newer, at one place
  std::optional<Tick> whole{};  ///< a part that is of use only with the others of this tick
  bool stops = false;           ///< a STOP
  bool commanded = false;       ///< of a world, driver or logger, which receive COMMAND
  Identity identity{};
};

class Gate {
 public:
  /// @param authenticator  without a key only together with `others`
  /// @param others  other messages of LCM are admitted as well, fragments of messages included,
  ///                which nobody can verify
  Gate(const MessageAuthenticator& authenticator, bool others)
      : authenticator_(authenticator), others_(others) {}

  /// Nothing if it is refused and counted. Never throws, whatever the bytes are.
  std::optional<Admitted> admit(Bus bus, std::span<const std::byte> datagram) noexcept;

  const RefusalCounts& refused() const { return refused_; }

 private:
  std::optional<Admitted> refuse(Refusal why) {
    ++refused_[static_cast<std::size_t>(why)];
    return std::nullopt;
  }

  MessageAuthenticator authenticator_;
  bool others_;
  KnownSignatures signatures_;
  RefusalCounts refused_{};
};

}  // namespace ergocast::relay
