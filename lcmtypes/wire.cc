// SPDX-License-Identifier: BSD-3-Clause
// One pair of functions for each type copies the fields in both directions and refuses
// implausible numbers.
#include "lcmtypes/wire.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "core/require.h"

namespace ergocast {
namespace {

header_t to_wire(const Header& h) {
  header_t w{};
  w.run_id = static_cast<std::int64_t>(h.run);
  w.sender = h.sender;
  w.incarnation = static_cast<std::int64_t>(h.incarnation);
  w.sequence = h.sequence;
  w.tick = h.tick;
  return w;
}
Header from_wire(const header_t& w) {
  return {static_cast<RunId>(w.run_id), w.sender, static_cast<Incarnation>(w.incarnation),
          w.sequence, w.tick};
}

/// More messages, ticks or events of any kind than a run can have; sums of a few cannot overflow.
constexpr std::int64_t kMostEver = std::int64_t{1} << 48;

bool plausible_count(std::int64_t count) { return count >= 0 && count <= kMostEver; }
/// A tick, or −1: none.
bool plausible_tick(Tick tick) { return tick == -1 || plausible_count(tick); }
/// The same of revisions.
bool plausible_revision(std::int64_t revision) { return revision == -1 || plausible_count(revision); }

bool plausible_quantity(double value) { return std::isfinite(value) && value >= 0; }
bool plausible_sender(std::int32_t id) { return id >= kOperator && id < kMaxAgents; }

/// The first character that means something to a terminal: C0, DEL, or C1 in UTF-8.
/// What others say of themselves ends up in logs and on terminals.
std::string_view find_control(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (c < 0x20 || c == 0x7F) return text.substr(i, 1);
    const bool has_next = c == 0xC2 && i + 1 < text.size();
    if (has_next && (text[i + 1] & 0xE0) == 0x80) return text.substr(i, 2);
  }
  return {};
}
bool plausible_text(const std::string& text) { return find_control(text).empty(); }

/// At most `limit` characters, none of which means something to a terminal, up to a NUL: so that
/// what we send is what we accept.
std::string bounded(const std::string& text, int limit) {
  auto size = static_cast<std::size_t>(limit);
  // Not in the middle of a UTF-8 character.
  while (text.size() > size && size > 0 && (text[size] & 0xC0) == 0x80) --size;
  std::string cut = text.substr(0, size);
  cut.resize(std::min(cut.find('\0'), cut.size()));
  for (auto control = find_control(cut); !control.empty(); control = find_control(cut)) {
    cut.replace(static_cast<std::size_t>(control.data() - cut.data()), control.size(), " ");
  }
  return cut;
}

void copy3(const Eigen::Vector3d& from, double* to) { std::copy_n(from.data(), 3, to); }
Eigen::Vector3d vector3(const double* from) { return {from[0], from[1], from[2]}; }

}  // namespace

hello_t to_wire(const Hello& m) {
  hello_t w;
  w.header = to_wire(m.header);
  w.requested_id = m.requested_id;
  w.known_revision = m.revision;
  w.host = bounded(m.host, kMaxHostLength);
  w.version = bounded(m.version, kMaxVersionLength);
  return w;
}
bool from_wire(const hello_t& w, Hello& m) {
  if (w.requested_id < kUnassigned || w.requested_id >= kMaxAgents ||
      !plausible_revision(w.known_revision) || !plausible_text(w.host) || !plausible_text(w.version)) {
    return false;
  }
  m = {from_wire(w.header), w.requested_id, w.host, w.version, w.known_revision};
  return true;
}

mission_t to_wire(const MissionPart& m) {
  ERGOCAST_REQUIRE(m.roster.size() <= kMaxRosterEntriesPerMessage &&
                   m.plan.size() <= kMaxPlanBytesPerMessage);
  mission_t w;
  w.header = to_wire(m.header);
  std::memcpy(w.mission_signature, m.signature.data(), m.signature.size());
  w.revision = m.revision;
  w.state = static_cast<std::int8_t>(m.state);
  w.part = m.part;
  w.parts = m.parts;
  w.roster_count = static_cast<std::int32_t>(m.roster.size());
  w.plan_size = static_cast<std::int32_t>(m.plan.size());
  for (const RosterEntry& entry : m.roster) {
    roster_entry_t e;
    e.id = entry.author.agent;
    e.nonce = static_cast<std::int64_t>(entry.author.incarnation);
    e.active_from = entry.active_from;
    e.active_until = entry.active_until;
    e.forgotten = entry.forgotten ? 1 : 0;
    e.since_tick = entry.since_tick;
    e.since_revision = entry.since_revision;
    w.roster.push_back(e);
  }
  w.plan.resize(m.plan.size());
  if (!m.plan.empty()) std::memcpy(w.plan.data(), m.plan.data(), m.plan.size());
  w.reason = bounded(m.reason, kMaxReasonLength);
  return w;
}
bool from_wire(const mission_t& w, MissionPart& m) {
  if (w.state < 0 || w.state > static_cast<int>(MissionState::kFailed) || !plausible_count(w.revision) ||
      w.parts < 1 || w.parts > kMaxPlanParts || w.part < 0 || w.part >= w.parts ||
      !plausible_text(w.reason)) {
    return false;
  }
  m.header = from_wire(w.header);
  m.revision = w.revision;
  m.state = static_cast<MissionState>(w.state);
  m.part = w.part;
  m.parts = w.parts;
  for (const roster_entry_t& e : w.roster) {
    if (e.id < 0 || e.id >= kMaxAgents || !plausible_count(e.active_from) ||
        !plausible_tick(e.active_until) || !plausible_count(e.since_tick) ||
        !plausible_count(e.since_revision)) {
      return false;
    }
    m.roster.push_back({{e.id, static_cast<Incarnation>(e.nonce)}, e.active_from, e.active_until,
                        e.forgotten != 0, e.since_tick, e.since_revision});
  }
  m.plan.resize(w.plan.size());
  if (!w.plan.empty()) std::memcpy(m.plan.data(), w.plan.data(), w.plan.size());
  m.reason = w.reason;
  std::memcpy(m.signature.data(), w.mission_signature, m.signature.size());
  return true;
}

contribution_t to_wire(const Contribution& m) {
  contribution_t w;
  w.header = to_wire(m.header);
  w.steps = m.steps;
  w.next_broadcast_tick = m.next_broadcast_tick;
  w.elapsed_s = m.elapsed_s;
  w.block = m.block;
  w.mode_count = m.mode_count;
  std::copy(m.sums.begin(), m.sums.end(), w.sums);
  return w;
}
/// Whether the sums can be true is for CoverageTable::merge, which knows the mission.
bool from_wire(const contribution_t& w, Contribution& m) {
  if (w.header.sender < 0 || w.header.sender >= kMaxAgents || !std::isfinite(w.elapsed_s) ||
      !plausible_count(w.steps) || !plausible_count(w.next_broadcast_tick)) {
    return false;
  }
  m.header = from_wire(w.header);
  m.steps = w.steps;
  m.next_broadcast_tick = w.next_broadcast_tick;
  m.elapsed_s = w.elapsed_s;
  m.block = w.block;
  m.mode_count = w.mode_count;
  std::copy_n(w.sums, kBlockSize, m.sums.begin());
  return true;
}

agent_status_t to_wire(const AgentStatus& m) {
  agent_status_t w;
  w.header = to_wire(m.header);
  w.phase = static_cast<std::int8_t>(m.phase);
  w.ergodic_metric = m.ergodic_metric;
  w.max_staleness_s = m.max_staleness_s;
  w.waiting_for = m.waiting_for;
  w.answered_tick = m.answered_tick;
  w.contributions_received = m.contributions_received;
  // Whoever jumps ahead in its numbering makes others count what never was.
  w.contributions_lost = std::min(m.contributions_lost, kMostEver);
  w.messages_sent = m.messages_sent;
  w.messages_received = m.messages_received;
  w.contributions_relayed = m.contributions_relayed;
  w.missed_ticks = m.missed_ticks;
  std::copy(m.refused.begin(), m.refused.end(), w.refused);
  w.babbler = m.babbler;
  w.kernel_drops = m.kernel_drops;
  w.loop_lag_s = m.loop_lag_s;
  w.status_host = bounded(m.host, kMaxHostLength);
  return w;
}
bool from_wire(const agent_status_t& w, AgentStatus& m) {
  if (w.phase < 0 || w.phase > static_cast<int>(AgentPhase::kFinished) ||
      w.header.sender < kUnassigned || w.header.sender >= kMaxAgents ||
      !plausible_sender(w.waiting_for) || w.babbler < kUnassigned || w.babbler >= kMaxAgents || !plausible_quantity(w.ergodic_metric) ||
      !plausible_quantity(w.max_staleness_s) || !plausible_quantity(w.loop_lag_s) ||
      !plausible_tick(w.answered_tick) || !plausible_text(w.status_host) ||
      !std::all_of(std::begin(w.refused), std::end(w.refused), plausible_count)) {
    return false;
  }
  for (const std::int64_t count : {w.contributions_received, w.contributions_lost, w.messages_sent,
                                   w.messages_received, w.contributions_relayed, w.missed_ticks,
                                   w.kernel_drops}) {
    if (!plausible_count(count)) return false;
  }
  m.header = from_wire(w.header);
  m.phase = static_cast<AgentPhase>(w.phase);
  m.ergodic_metric = w.ergodic_metric;
  m.max_staleness_s = w.max_staleness_s;
  m.waiting_for = w.waiting_for;
  m.answered_tick = w.answered_tick;
  m.contributions_received = w.contributions_received;
  m.contributions_lost = w.contributions_lost;
  m.messages_sent = w.messages_sent;
  m.messages_received = w.messages_received;
  m.contributions_relayed = w.contributions_relayed;
  m.missed_ticks = w.missed_ticks;
  std::copy_n(w.refused, kRefusalKinds, m.refused.begin());
  m.babbler = w.babbler;
  m.kernel_drops = w.kernel_drops;
  m.loop_lag_s = w.loop_lag_s;
  m.host = w.status_host;
  return true;
}

team_status_t to_wire(const TeamStatus& m) {
  team_status_t w;
  w.header = to_wire(m.header);
  w.mission_state = static_cast<std::int8_t>(m.state);
  w.tick_count = m.tick_count;
  w.agents_alive = m.agents_alive;
  w.agents_expected = m.agents_expected;
  w.median_ergodic_metric = m.ergodic_metric;
  w.silent_agent = m.silent_agent;
  w.team_missed_deadlines = m.missed_deadlines;
  w.team_host = bounded(m.host, kMaxHostLength);
  return w;
}
bool from_wire(const team_status_t& w, TeamStatus& m) {
  if (w.mission_state < 0 || w.mission_state > static_cast<int>(MissionState::kFailed) ||
      !plausible_count(w.tick_count) || w.agents_alive < 0 || w.agents_expected < 0 ||
      !plausible_quantity(w.median_ergodic_metric) || !plausible_sender(w.silent_agent) ||
      !plausible_count(w.team_missed_deadlines) || !plausible_text(w.team_host)) {
    return false;
  }
  m = {from_wire(w.header), static_cast<MissionState>(w.mission_state),
       w.tick_count,        w.agents_alive,
       w.agents_expected,   w.median_ergodic_metric,
       w.silent_agent,  w.team_missed_deadlines, w.team_host};
  return true;
}

stop_t to_wire(const Stop& m) {
  stop_t w;
  w.header = to_wire(m.header);
  std::memcpy(w.stop_signature, m.signature.data(), m.signature.size());
  w.stop_failed = m.failed ? 1 : 0;
  w.stop_now = m.now ? 1 : 0;
  w.stop_reason = bounded(m.reason, kMaxReasonLength);
  return w;
}
bool from_wire(const stop_t& w, Stop& m) {
  if (!plausible_text(w.stop_reason)) return false;
  m = {from_wire(w.header), w.stop_failed != 0, w.stop_reason, w.stop_now != 0, {}};
  std::memcpy(m.signature.data(), w.stop_signature, m.signature.size());
  return true;
}

world_state_t to_wire(const WorldState& m) {
  ERGOCAST_REQUIRE(m.vehicle_count >= 0 && m.vehicle_count <= kMaxVehiclesPerState);
  world_state_t w;
  w.header = to_wire(m.header);
  w.roster_revision = m.roster_revision;
  w.missed_deadlines = m.missed_deadlines;
  w.skipped_ticks = m.skipped_ticks;
  w.clamped_commands = m.clamped_commands;
  w.state_part = m.part;
  w.state_parts = m.parts;
  w.vehicle_count = m.vehicle_count;
  w.vehicles.resize(static_cast<std::size_t>(m.vehicle_count));
  for (std::size_t i = 0; i < w.vehicles.size(); ++i) {
    w.vehicles[i].vehicle_id = m.vehicles[i].id;
    w.vehicles[i].vehicle_answered_tick = m.vehicles[i].answered_tick;
    copy3(m.vehicles[i].position_m, w.vehicles[i].position_m);
    copy3(m.vehicles[i].velocity_mps, w.vehicles[i].velocity_mps);
  }
  return w;
}
bool from_wire(const world_state_t& w, WorldState& m) {
  m.header = from_wire(w.header);
  m.roster_revision = w.roster_revision;
  m.missed_deadlines = w.missed_deadlines;
  m.skipped_ticks = w.skipped_ticks;
  m.clamped_commands = w.clamped_commands;
  m.part = w.state_part;
  m.parts = w.state_parts;
  m.vehicle_count = w.vehicle_count;
  if (m.header.tick < 0 || !plausible_count(m.roster_revision) || m.part < 0 ||
      m.part >= m.parts || m.parts > kMaxAgents || !plausible_count(m.missed_deadlines) ||
      !plausible_count(m.skipped_ticks) || !plausible_count(m.clamped_commands)) {
    return false;
  }
  for (std::size_t i = 0; i < w.vehicles.size(); ++i) {
    const vehicle_t& v = w.vehicles[i];
    m.vehicles[i] = {v.vehicle_id, v.vehicle_answered_tick, vector3(v.position_m),
                     vector3(v.velocity_mps)};
    if (v.vehicle_id < 0 || v.vehicle_id >= kMaxAgents || !plausible_tick(v.vehicle_answered_tick) ||
        !m.vehicles[i].position_m.allFinite() || !m.vehicles[i].velocity_mps.allFinite()) {
      return false;
    }
  }
  return true;
}

command_t to_wire(const Command& m) {
  command_t w;
  w.header = to_wire(m.header);
  copy3(m.position_m, w.command_position_m);
  copy3(m.velocity_mps, w.command_velocity_mps);
  w.command_asked_by = static_cast<std::int64_t>(m.asked_by);
  return w;
}
bool from_wire(const command_t& w, Command& m) {
  m = {from_wire(w.header), vector3(w.command_position_m), vector3(w.command_velocity_mps),
       static_cast<Incarnation>(w.command_asked_by)};
  return m.header.sender >= 0 && m.header.sender < kMaxAgents && m.position_m.allFinite() && m.velocity_mps.allFinite();
}

digest_t to_wire(const Digest& m) {
  ERGOCAST_REQUIRE(m.entry_count >= 0 && m.entry_count <= kMaxDigestEntriesPerMessage);
  digest_t w;
  w.header = to_wire(m.header);
  w.entry_count = m.entry_count;
  w.entries.resize(static_cast<std::size_t>(m.entry_count));
  for (std::size_t i = 0; i < w.entries.size(); ++i) {
    w.entries[i].digest_id = m.entries[i].author.agent;
    w.entries[i].digest_incarnation = static_cast<std::int64_t>(m.entries[i].author.incarnation);
    w.entries[i].digest_steps = m.entries[i].steps;
    w.entries[i].digest_mark = static_cast<std::int64_t>(m.entries[i].mark);
  }
  return w;
}
bool from_wire(const digest_t& w, Digest& m) {
  if (w.header.sender < 0 || w.header.sender >= kMaxAgents) return false;
  m.header = from_wire(w.header);
  m.entry_count = w.entry_count;
  for (std::size_t i = 0; i < w.entries.size(); ++i) {
    const digest_entry_t& e = w.entries[i];
    if (e.digest_id < 0 || e.digest_id >= kMaxAgents || !plausible_count(e.digest_steps)) {
      return false;
    }
    m.entries[i] = {{e.digest_id, static_cast<Incarnation>(e.digest_incarnation)}, e.digest_steps,
                    static_cast<std::uint64_t>(e.digest_mark)};
  }
  return true;
}

record_ack_t to_wire(const RecordAck& m) {
  record_ack_t w;
  w.ack_header = to_wire(m.header);
  return w;
}
bool from_wire(const record_ack_t& w, RecordAck& m) {
  m.header = from_wire(w.ack_header);
  return true;
}

bool plausible(const Header& h) {
  return plausible_sender(h.sender) && plausible_count(h.sequence) && plausible_tick(h.tick);
}

}  // namespace ergocast
