// SPDX-License-Identifier: BSD-3-Clause
// The list of a mission's amendments as bytes, which MISSION carries beside the plan.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/mission/amendments.h"
#include "core/mission/mission.h"

namespace ergocast {

/// The bytes of a list; none for an empty list.
std::vector<std::byte> encode_amendments(const Amendments& list);

/// The list of these bytes, bit for bit. Nothing if they are no list, or one that no coordinator
/// names for `mission` (are_amendments()). Lists come from the network.
std::optional<Amendments> decode_amendments(std::span<const std::byte> bytes,
                                            const Mission& mission) noexcept;

/// An end as AMEND carries it: the mission's number of ticks.
std::vector<std::byte> encode_end(Tick tick_count);
/// The number of ticks of these bytes; nothing if no mission can have it (is_tick_count()).
std::optional<Tick> decode_end(std::span<const std::byte> bytes, const Mission& mission) noexcept;

/// What cancels a zone, as AMEND carries it: the number of the zone's amendment.
std::vector<std::byte> encode_reopening(std::int32_t number);
/// The number of these bytes; nothing if they are none.
std::optional<std::int32_t> decode_reopening(std::span<const std::byte> bytes) noexcept;

/// How many bytes a target of `mission` has in AMEND.
std::size_t target_bytes(const Mission& mission);
/// A target as AMEND carries it: μ, then μ in the basis (2), where the mission has one.
std::vector<std::byte> encode_target(const TargetChange& change);
/// The target of these bytes, without number and tick; nothing if it is none of `mission`.
std::optional<TargetChange> decode_target(std::span<const std::byte> bytes,
                                          const Mission& mission) noexcept;

/// A sighting or dismissal as AMEND carries it: place, σ and share. A sighting follows its target.
std::vector<std::byte> encode_search_note(const SearchNote& note);
/// The note of these bytes, without number and tick; nothing if `mission` cannot have it
/// (is_search_note()).
std::optional<SearchNote> decode_search_note(std::span<const std::byte> bytes,
                                             const Mission& mission) noexcept;

/// A law as AMEND carries it: the numbers of each kind.
std::vector<std::byte> encode_law(const LawChange& change);
/// The law of these bytes, without number and tick; nothing if `mission` cannot have it (is_law()).
std::optional<LawChange> decode_law(std::span<const std::byte> bytes,
                                    const Mission& mission) noexcept;

/// A zone as AMEND carries it: how long it lasts, its heights and its corners.
std::vector<std::byte> encode_zone(const Zone& zone);
/// The zone of these bytes, from 0 to as long as it lasts, without number; nothing if it is none in
/// `domain`.
std::optional<Zone> decode_zone(std::span<const std::byte> bytes, const Box& domain) noexcept;

}  // namespace ergocast
