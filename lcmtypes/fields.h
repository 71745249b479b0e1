// SPDX-License-Identifier: BSD-3-Clause
// The fields of every message in the order of its .lcm file: the only definition of the wire
// format. Writing, reading, message sizes and plausibility checks all use it.
//
// Fields<M>::list(io, m) visits each field of `m` once, with its kind of number. Writer and Reader
// (lcmtypes/wire.h) are the two visitors.
#pragma once

#include <ergocast/agent_status_t.hpp>
#include <ergocast/amend_t.hpp>
#include <ergocast/averages_t.hpp>
#include <ergocast/beacon_t.hpp>
#include <ergocast/command_t.hpp>
#include <ergocast/contribution_t.hpp>
#include <ergocast/digest_t.hpp>
#include <ergocast/effort_t.hpp>
#include <ergocast/hello_t.hpp>
#include <ergocast/low_averages_t.hpp>
#include <ergocast/low_sums_t.hpp>
#include <ergocast/mission_t.hpp>
#include <ergocast/recall_t.hpp>
#include <ergocast/record_ack_t.hpp>
#include <ergocast/stop_t.hpp>
#include <ergocast/team_status_t.hpp>
#include <ergocast/world_state_t.hpp>
#include <limits>

#include "plan/mission_limits.h"
#include "team/messages.h"

namespace ergocast {

/// `Generated` is lcm-gen's type: its fingerprint is on the wire, and its name is that of the
/// channel. With kPerAgent each agent has a channel of its own. kSender is the only process that
/// may send it, if there is one.
template <class M>
struct Fields;

template <>
struct Fields<Hello> {
  using Generated = hello_t;
  static void list(auto& io, auto& m) {
    io.within(m.requested_id, kUnassigned, kMaxAgents - 1);
    io.count_or_none(m.revision);
    io.text(m.host, kMaxHostLength);
    io.text(m.version, kMaxVersionLength);
    io.text(m.kind, kMaxKindNameLength);
  }
};

template <>
struct Fields<MissionPart> {
  using Generated = mission_t;
  static constexpr AgentId kSender = kCoordinator;
  static void list(auto& io, auto& m) {
    io.bytes(m.signature);
    io.count(m.revision);
    io.enumerator(m.state, MissionState::kFailed);
    io.within(m.part, 0, kMaxMissionParts - 1);
    io.within(m.parts, 1, kMaxMissionParts);
    io.holds(m.part < m.parts);
    io.number(m.content_hash);
    io.length(m.roster, kMaxRosterEntriesPerMessage);
    io.length(m.plan, kMaxPlanBytesPerMessage);
    for (auto& entry : m.roster) {
      io.within(entry.author.agent, 0, kMaxAgents - 1);
      io.number(entry.author.incarnation);
      io.count(entry.active_from);
      io.count_or_none(entry.active_until);
      io.flag(entry.forgotten);
      io.count(entry.since_tick);
      io.count(entry.since_revision);
      io.small(entry.kind, kMaxKinds - 1);
      io.count_or_none(entry.recall_revision);
      io.flag(entry.leaves);
      io.holds(entry.recalled() || !entry.leaves);
    }
    io.bytes(m.plan);
    io.count_or_none(m.stand_by_revision);
    io.length(m.amendments, kMaxPlanBytesPerMessage);
    io.holds(m.plan.size() + m.amendments.size() <= std::size_t{kMaxPlanBytesPerMessage});
    io.bytes(m.amendments);
    io.text(m.reason, kMaxReasonLength);
  }
};

/// CoverageTable::merge() checks whether the sums are plausible, because it knows the mission.
template <>
struct Fields<Contribution> {
  using Generated = contribution_t;
  static constexpr bool kPerAgent = true;
  static void list(auto& io, auto& m, std::size_t count = kBlockSize) {
    io.holds(m.header.sender >= 0);
    io.count(m.steps);
    io.count(m.next_broadcast_tick);
    io.quantity(m.elapsed_s);
    io.number(m.block);
    io.number(m.mode_count);
    io.sums(m.sums, count);
  }
};

/// One of kLowModes.
struct LowSums;

template <>
struct Fields<LowSums> {
  using Generated = low_sums_t;
  static void list(auto& io, auto& m) { Fields<Contribution>::list(io, m, kLowModes); }
};

/// A contribution whose numbers are sent in 16 bits.
struct Averages;

template <>
struct Fields<Averages> {
  using Generated = averages_t;
  static void list(auto& io, auto& m, std::size_t count = kMostBlockSize) {
    io.holds(m.header.sender >= 0);
    io.count(m.steps);
    io.count(m.next_broadcast_tick);
    io.quantity(m.elapsed_s);
    io.count(m.gained_steps);
    io.small(m.range, kShiftedRange);
    io.holds(m.range == 1 || m.range == kShiftedRange);
    io.number(m.block);
    io.number(m.mode_count);
    io.averages(m.sums, m.elapsed_s, m.range, count);
    const double step_s = m.steps > 0 ? m.elapsed_s / static_cast<double>(m.steps) : 0;
    io.averages(m.gains, static_cast<double>(m.gained_steps) * step_s, m.range, count);
  }
};

/// One of kLowModes.
struct LowAverages;

template <>
struct Fields<LowAverages> {
  using Generated = low_averages_t;
  static void list(auto& io, auto& m) { Fields<Averages>::list(io, m, kLowModes); }
};

template <>
struct Fields<AgentStatus> {
  using Generated = agent_status_t;
  static constexpr bool kPerAgent = true;
  static void list(auto& io, auto& m) {
    io.holds(m.header.sender >= kUnassigned);
    io.enumerator(m.phase, AgentPhase::kResting);
    io.quantity(m.ergodic_metric);
    io.quantity(m.max_staleness_s);
    io.within(m.waiting_for, kOperator, kMaxAgents - 1);
    io.count_or_none(m.answered_tick);
    io.count(m.contributions_received);
    io.capped_count(m.contributions_lost);
    io.count(m.messages_sent);
    io.count(m.messages_received);
    io.count(m.contributions_relayed);
    io.count(m.missed_ticks);
    io.counts(m.refused);
    io.within(m.rate_offender, kUnassigned, kMaxAgents - 1);
    io.count(m.kernel_drops);
    io.quantity(m.loop_lag_s);
    io.within(m.blocked_by, kUnassigned, kMaxAgents - 1);
    io.count(m.blocked_now_ticks);
    io.count(m.blocked_ticks);
    io.count(m.longest_block_ticks);
    io.text(m.host, kMaxHostLength);
  }
};

template <>
struct Fields<TeamStatus> {
  using Generated = team_status_t;
  static constexpr AgentId kSender = kCoordinator;
  static void list(auto& io, auto& m) {
    io.enumerator(m.state, MissionState::kFailed);
    io.count(m.tick_count);
    io.within(m.agents_alive, 0, kAnyNumber);
    io.within(m.agents_expected, 0, kAnyNumber);
    io.quantity(m.ergodic_metric);
    io.within(m.silent_agent, kOperator, kMaxAgents - 1);
    io.count(m.missed_deadlines);
    io.flag(m.paused);
    io.text(m.host, kMaxHostLength);
  }

 private:
  static constexpr std::int32_t kAnyNumber = std::numeric_limits<std::int32_t>::max();
};

template <>
struct Fields<Stop> {
  using Generated = stop_t;
  static void list(auto& io, auto& m) {
    io.bytes(m.signature);
    io.flag(m.failed);
    io.flag(m.now);
    io.text(m.reason, kMaxReasonLength);
  }
};

template <>
struct Fields<Amend> {
  using Generated = amend_t;
  static void list(auto& io, auto& m) {
    io.bytes(m.signature);
    io.within(m.number, 0, kMaxAmendments);
    io.enumerator(m.kind, AmendmentKind::kDismiss);
    io.count(m.delay_ticks);
    io.within(m.part, 0, kMaxAmendParts - 1);
    io.within(m.parts, 1, kMaxAmendParts);
    io.holds(m.part < m.parts);
    io.length(m.content, kMaxPlanBytesPerMessage);
    io.bytes(m.content);
    io.text(m.by, static_cast<int>(kMaxOperatorNameLength));
    io.holds(is_operator_name(m.by));
  }
};

template <>
struct Fields<Recall> {
  using Generated = recall_t;
  static void list(auto& io, auto& m) {
    io.bytes(m.signature);
    io.within(m.agent, 0, kMaxAgents - 1);
    io.flag(m.leaves);
  }
};

template <>
struct Fields<WorldState> {
  using Generated = world_state_t;
  static constexpr AgentId kSender = kWorld;
  static void list(auto& io, auto& m) {
    io.holds(m.header.tick >= 0);
    io.count(m.roster_revision);
    io.count(m.missed_deadlines);
    io.count(m.skipped_ticks);
    io.count(m.clamped_commands);
    io.count(m.uncounted_ticks);
    io.holds(m.uncounted_ticks <= m.header.tick);
    io.number(m.found);
    io.within(m.part, 0, kMaxAgents - 1);
    io.within(m.parts, 1, kMaxAgents);
    io.holds(m.part < m.parts);
    io.flag(m.last);
    for (auto& vehicle : io.length(m.vehicles, m.vehicle_count)) {
      io.within(vehicle.id, 0, kMaxAgents - 1);
      io.count_or_none(vehicle.answered_tick);
      io.vector(vehicle.position_m);
      io.vector(vehicle.velocity_mps);
      io.number(vehicle.detected);
      io.within(vehicle.reported_cell, kNoCell, kMaxSearchCells - 1);
      io.within(vehicle.charge_ppm, kNoCharge, kWhole_ppm);
    }
  }
};

template <>
struct Fields<Command> {
  using Generated = command_t;
  static constexpr bool kPerAgent = true;
  static void list(auto& io, auto& m) {
    io.holds(m.header.sender >= 0);
    io.vector(m.position_m);
    io.vector(m.velocity_mps);
    io.number(m.asked_by);
    io.within(m.charge_ppm, kNoCharge, kWhole_ppm);
  }
};

template <>
struct Fields<RecordAck> {
  using Generated = record_ack_t;
  static constexpr AgentId kSender = kLogger;
  static void list(auto& io, auto& m) {
    io.flag(m.last);
    io.quantity(m.detection_probability);
    io.holds(m.detection_probability <= 1);
    io.within(m.wrong_confirmations, 0, std::numeric_limits<std::int32_t>::max());
    for (auto& find : io.length(m.finds, m.find_count)) {
      io.within(find.object, 0, kMaxObjects - 1);
      io.within(find.agent, 0, kMaxAgents - 1);
      io.count(find.tick);
      io.finite(find.x_m.x());
      io.finite(find.x_m.y());
    }
    for (auto& contact : io.length(m.contacts, m.contact_count)) {
      io.within(contact.cell, 0, kMaxSearchCells - 1);
      io.within(contact.reports, 0, std::numeric_limits<std::int32_t>::max());
      io.count(contact.newest);
      io.quantity(contact.probability);
      io.holds(contact.probability <= 1);
      io.flag(contact.confirmed);
    }
  }
};

template <>
struct Fields<Digest> {
  using Generated = digest_t;
  static constexpr bool kPerAgent = true;
  static void list(auto& io, auto& m) {
    io.holds(m.header.sender >= 0);
    io.number(m.settled_hash);
    for (auto& entry : io.length(m.entries, m.entry_count)) {
      io.within(entry.author.agent, 0, kMaxAgents - 1);
      io.number(entry.author.incarnation);
      io.count(entry.steps);
      io.number(entry.state_hash);
    }
  }
};

template <>
struct Fields<Beacon> {
  using Generated = beacon_t;
  static constexpr bool kPerAgent = true;
  static void list(auto& io, auto& m) {
    io.holds(m.header.sender >= 0 && m.header.tick >= 0);
    io.count(m.roster_revision);
    io.vector(m.position_m);
    io.vector(m.velocity_mps);
    io.number(m.number);
    io.holds(m.number != 0);
    for (auto& echo : io.length(m.echoes, m.echo_count)) io.number(echo);
  }
};

/// Efforts::merge() checks whether the counts are possible, because it knows the mission.
template <>
struct Fields<Effort> {
  using Generated = effort_t;
  static constexpr bool kPerAgent = true;
  static void list(auto& io, auto& m) {
    io.holds(m.header.sender >= 0 && m.header.tick >= 0);
    io.within(m.part, 0, kMaxEffortParts - 1);
    io.within(m.parts, 1, kMaxEffortParts);
    io.holds(m.part < m.parts);
    for (auto& tile : io.length(m.tiles, m.tile_count)) {
      io.within(tile.number, 0, static_cast<std::int32_t>(kMaxTiles) - 1);
      io.count(tile.content.newest_look);
      io.each_number(tile.content.looks);
    }
  }
};

/// The beginning of every message, after its fingerprint.
template <>
struct Fields<Header> {
  static void list(auto& io, auto& h) {
    io.number(h.run);
    io.within(h.sender, kOperator, kMaxAgents - 1);
    io.number(h.incarnation);
    io.count(h.sequence);
    io.count_or_none(h.tick);
    io.room_for_tag();
  }
};

}  // namespace ergocast
