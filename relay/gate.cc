// SPDX-License-Identifier: BSD-3-Clause
// Decodes each message as its receivers will, so that nothing is carried that they would refuse.
#include "relay/gate.h"

#include <xxhash.h>

#include <algorithm>
#include <string_view>

#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "relay/packets.h"
#include "runtime/bus/lcm_datagram.h"

namespace ergocast::relay {
namespace {

template <class... Ms>
bool is_one_of(const Message& message) {
  return (std::holds_alternative<Ms>(message) || ...);
}

Urgency urgency_of(const Message& message) {
  const auto* amend = std::get_if<Amend>(&message);
  if (is_one_of<MissionPart>(message) || (amend != nullptr && amend->parts > 1)) {
    return Urgency::kMission;
  }
  if (is_one_of<Stop, Amend, Recall>(message)) return Urgency::kOrder;
  if (is_one_of<Command>(message)) return Urgency::kCommand;
  if (is_one_of<Contribution, Effort>(message)) return Urgency::kCoverage;
  if (is_one_of<AgentStatus, TeamStatus, Digest>(message)) return Urgency::kReport;
  return Urgency::kMotion;
}

/// A number for the tiles of a message. Tiles of two messages that differ stay separate.
std::int64_t tiles_of(const Effort& effort) {
  std::uint64_t tiles = 0;
  for (std::int32_t i = 0; i < effort.tile_count; ++i) {
    const auto number = effort.tiles[static_cast<std::size_t>(i)].number;
    tiles = tiles * 1000003 + static_cast<std::uint64_t>(number) + 1;
  }
  return static_cast<std::int64_t>(tiles);
}

struct PartOf {
  std::int64_t part = 0, revision = 0;
};
PartOf part_of(const Hello& m) { return {m.requested_id, m.revision}; }
PartOf part_of(const MissionPart& m) { return {m.part, m.revision}; }
PartOf part_of(const Contribution& m) { return {m.block, 0}; }
PartOf part_of(const Stop& m) { return {m.now, 0}; }
PartOf part_of(const Amend& m) { return {m.part, m.number}; }
PartOf part_of(const Recall& m) { return {m.agent, 0}; }
PartOf part_of(const WorldState& m) { return {m.part, 0}; }
PartOf part_of(const Effort& m) { return {m.part, tiles_of(m)}; }
template <class M>
PartOf part_of(const M&) {
  return {};
}

/// A new world needs an agent's last two commands as the answer to one question.
bool is_answer(const Message& message) {
  const auto* command = std::get_if<Command>(&message);
  return command != nullptr && command->asked_by != 0;
}

/// A receiver needs all parts of a state. Parts of all other messages are of use one by one.
std::optional<Tick> whole_of(const Message& message) {
  const auto* state = std::get_if<WorldState>(&message);
  return state != nullptr && state->parts > 1 ? std::optional(state->header.tick) : std::nullopt;
}

/// More steps replace fewer, from any relayer. All other messages are ordered by their sequence.
std::int64_t newness_of(const Message& message) {
  const auto* contribution = std::get_if<Contribution>(&message);
  return contribution != nullptr ? contribution->steps : header_of(message).sequence;
}

/// LCM numbers the datagrams of each sender, so a copy that another program sends again differs
/// there. The identity of a message leaves that number out. Fragments of one message differ behind
/// it.
Identity identity_of(Bus bus, std::span<const std::byte> datagram, bool is_message) {
  const auto bytes = datagram.subspan(is_message ? kLcmHeaderBytes : 0);
  const XXH128_hash_t hash =
      XXH3_128bits_withSeed(bytes.data(), bytes.size(), static_cast<std::uint64_t>(bus));
  return {hash.low64, hash.high64};
}

}  // namespace

std::optional<Admitted> Gate::admit(Bus bus, std::span<const std::byte> datagram) noexcept {
  try {
    if (!is_lcm(datagram) || datagram.size() > kMaxGroupBytes) return refuse(Refusal::kSize);
    const auto parsed = parse_datagram(datagram);
    Admitted admitted{.place = {}, .identity = identity_of(bus, datagram, parsed.has_value())};
    const bool is_ours = parsed && is_channel_of(kEveryType, parsed->channel);
    if (!is_ours) {
      if (!others_) return refuse(Refusal::kType);
      return admitted;
    }
    const auto decoded = decode(parsed->message, 0, authenticator_, parsed->channel, &signatures_);
    if (!decoded) return refuse(decoded.error());
    const auto transmitter = transmitter_of(*decoded, parsed->channel);
    if (!transmitter) return refuse(Refusal::kType);
    const Header& header = header_of(*decoded);
    const PartOf part = std::visit([](const auto& m) { return part_of(m); }, *decoded);
    admitted.urgency = urgency_of(*decoded);
    admitted.stops = is_one_of<Stop>(*decoded);
    admitted.commanded = is_one_of<WorldState, RecordAck>(*decoded);
    if (is_answer(*decoded)) return admitted;
    admitted.newness = newness_of(*decoded);
    admitted.whole = whole_of(*decoded);
    admitted.place = Place{.run = header.run,
                           .bus = bus,
                           .type = decoded->index(),
                           .transmitter = *transmitter,
                           .author = {header.sender, header.incarnation},
                           .part = part.part,
                           .revision = part.revision};
    return admitted;
  } catch (...) {  // out of memory
    return refuse(Refusal::kLimit);
  }
}

}  // namespace ergocast::relay
