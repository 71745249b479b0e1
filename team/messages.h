// SPDX-License-Identifier: BSD-3-Clause
// All messages between processes, as plain values. Only lcmtypes/ encodes them.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/base/contribution.h"
#include "core/base/ids.h"
#include "core/measure/finds.h"
#include "core/mission/amendments.h"
#include "core/mission/roster.h"
#include "core/motion/charge.h"
#include "core/search/contact.h"
#include "core/search/efforts.h"
#include "plan/plan.h"

namespace ergocast {

/// Limit (Messages): vehicles in a part of WORLD_STATE. Beyond it: the state has several parts.
inline constexpr int kMaxVehiclesPerState = 15;
/// Limit (Messages): roster entries in a part of MISSION. Beyond it: the mission has several parts.
inline constexpr int kMaxRosterEntriesPerMessage = 6;
/// Limit (Messages): entries of a digest. Beyond it: entries take turns.
inline constexpr int kMaxDigestEntriesPerMessage = 40;
/// Limit (Messages): bytes of plan and amendments in a part of MISSION. Beyond it: the mission has
/// several parts.
inline constexpr int kMaxPlanBytesPerMessage = 512;
/// Limit (Messages): parts of a plan. Beyond it: the scenario is refused.
inline constexpr int kMaxPlanParts = 1024;
static_assert(std::size_t{kMaxPlanParts} * kMaxPlanBytesPerMessage == kMaxPlanBytes);
/// Limit (Messages): parts of a MISSION: those of a plan, and of its amendments. Beyond it: the
/// part is refused with `range`.
inline constexpr int kMaxMissionParts = 1201;
static_assert(kMaxMissionParts >= kMaxPlanParts &&
              std::size_t{kMaxMissionParts} * kMaxRosterEntriesPerMessage >= kMaxRosterEntries);
/// Limit (Messages): parts of an AMEND: as many as the largest sighting needs. Beyond it: the part
/// is refused with `range`.
inline constexpr int kMaxAmendParts =
    ((kMaxModes + kSearchNoteNumbers) * static_cast<int>(sizeof(double)) - 1) /
        kMaxPlanBytesPerMessage +
    1;
inline constexpr int kMaxEchoesPerMessage = kMostLeasedAgents;
inline constexpr int kMaxReasonLength = 150;
/// The period of an agent's status in wall time.
inline constexpr std::chrono::nanoseconds kAgentStatusPeriod = std::chrono::milliseconds(500);

/// Why a received datagram had no effect.
enum class Refusal {
  kSize,      ///< shorter or longer than its type and counts say
  kType,      ///< an unknown type, or one that its channel does not carry
  kTag,       ///< damaged, or of a sender with another mission key
  kUnkeyed,   ///< sound, but of a sender without a mission key
  kUnsigned,  ///< without the signature of the coordinator's key
  kRun,       ///< of another run
  kRange,     ///< an impossible number: NaN, |S| > elapsed, a coverage from the future
  kLimit,     ///< a table is full
  kEncoding,  ///< a contribution in another encoding than the plan says
  kRate,      ///< its sender exceeds its rate budget
  kLate,      ///< a command of the operator that names an old tick; see team/command_window.h
};
inline constexpr int kRefusalKinds = 11;
const char* to_string(Refusal refusal);
using RefusalCounts = std::array<std::int64_t, kRefusalKinds>;

/// Ed25519, by the holder of a team's signing key; zero if the message is not signed.
using Signature = std::array<std::byte, 64>;

/// A process announces itself. An agent requests admission; the roster will name its incarnation. A
/// coordinator or a world that has just started asks the agents for what they know. header.tick is
/// then −1 if it does not know the mission.
struct Hello {
  Header header;
  AgentId requested_id = kUnassigned;  ///< kUnassigned: any; of a world: the agent it waits for
  std::string host;
  std::string version;
  /// The newest revision of MISSION of which the agent has received any part; −1: none. A HELLO
  /// with an older revision than the newest admits no agent, because it may be a recording.
  std::int64_t revision = -1;
  std::string kind{};  ///< the name of the kind that an agent brings; empty: as planned
};

enum class MissionState { kWaiting, kRunning, kEnded, kFailed };
/// Whether the mission has ended, in order or not.
constexpr bool is_over(MissionState state) {
  return state == MissionState::kEnded || state == MissionState::kFailed;
}
const char* to_string(MissionState state);

/// One numbered part of the mission. All parts of one revision together are the whole. Parts of
/// older revisions can replace missing ones if the content_hash of the result is right.
struct MissionPart {
  Header header;
  std::int64_t revision = 0;  ///< of roster and state together
  MissionState state = MissionState::kWaiting;
  std::int32_t part = 0, parts = 1;
  std::uint64_t content_hash = 0;   ///< the sum of hash_of() over all parts of the revision
  std::vector<RosterEntry> roster;  ///< this part's share, in the order of admission
  std::vector<std::byte> plan;      ///< this part's share of the compiled plan
  /// This part's share of the amendments (plan/amendment_list.h), which follow the plan.
  std::vector<std::byte> amendments;
  /// Lockstep: the world stays at the first tick under this or a later revision until the
  /// coordinator has named a tick. −1: it goes on.
  std::int64_t stand_by_revision = -1;
  std::string reason;     ///< why it ended or failed
  Signature signature{};  ///< the coordinator's, which teammates repeat
};

struct DigestEntry {
  Author author;
  std::int64_t steps = 0;        ///< of the oldest block held; 0: nothing
  std::uint64_t state_hash = 0;  ///< a hash of the steps of all blocks held
};

/// The coverage that an agent holds: one entry for each (agent, incarnation) of the roster. If the
/// roster is too large, it has the entries that the sender seems to lack and the next ones in turn.
/// An agent that holds more answers with contributions.
struct Digest {
  Header header;
  std::uint64_t settled_hash = 0;  ///< of what is held of all former members
  std::int32_t entry_count = 0;
  std::array<DigestEntry, kMaxDigestEntriesPerMessage> entries;
};

struct SentTile {
  std::int32_t number = 0;
  EffortTile content;
};
/// Limit (Messages): tiles in an EFFORT. Beyond it: a row travels in several messages.
inline constexpr int kMaxTilesPerMessage = 8;
inline constexpr int kMaxEffortParts = static_cast<int>(kMaxTiles) / kMaxTilesPerMessage;

/// Where an agent has searched: tiles of its row in core/search/efforts.h, as they are remembered
/// at the counted tick header.tick. The tiles of one tick travel in parts.
struct Effort {
  Header header;  ///< the author's, even if another agent relays its tiles
  std::int32_t part = 0, parts = 1;
  std::int32_t tile_count = 0;
  std::array<SentTile, kMaxTilesPerMessage> tiles{};

  Author author() const { return {header.sender, header.incarnation}; }
};

/// An agent that has a station (core/mission/station.h) or was recalled may also be kReturning, on
/// its way home, or kResting.
enum class AgentPhase { kJoining, kWaiting, kRunning, kFinished, kReturning, kResting };
const char* to_string(AgentPhase phase);
/// Whether it answers ticks.
inline bool answers_ticks(AgentPhase phase) {
  return phase == AgentPhase::kRunning || phase >= AgentPhase::kReturning;
}

struct AgentStatus {
  Header header;
  AgentPhase phase = AgentPhase::kJoining;
  double ergodic_metric = 0;          ///< φ² of its known coverage, once answered_tick ≥ 0
  double max_staleness_s = 0;         ///< age of the oldest teammate's contribution
  AgentId waiting_for = kUnassigned;  ///< whose block the tick waits for; kWorld: its state
  std::int64_t answered_tick = -1;    ///< last tick that got a command
  std::int64_t contributions_received = 0, contributions_lost = 0, messages_sent = 0,
               messages_received = 0;
  std::int64_t contributions_relayed = 0;  ///< blocks of others that it relayed
  std::int64_t missed_ticks = 0;           ///< world ticks that passed without a command
  RefusalCounts refused{};
  AgentId rate_offender = kUnassigned;  ///< the last agent whose messages were refused as kRate
  std::int64_t kernel_drops = 0;
  double loop_lag_s = 0;  ///< the longest delay or busy time of its process since its last status
  /// Where a distance is kept: the agent that now blocks it; kUnassigned: none, or an edge of the
  /// domain. Then the ticks of the present block, of all blocks, and of the longest.
  AgentId blocked_by = kUnassigned;
  std::int64_t blocked_now_ticks = 0, blocked_ticks = 0, longest_block_ticks = 0;
  std::string host;
};

struct TeamStatus {
  Header header;
  MissionState state = MissionState::kWaiting;
  Tick tick_count = 0;
  std::int32_t agents_alive = 0, agents_expected = 0;
  double ergodic_metric = 0;  ///< median of the agents' own φ²; 0 until one has answered a tick
  AgentId silent_agent = kUnassigned;  ///< the first that is not alive, if any
  std::int64_t missed_deadlines = 0;   ///< as the world counts them
  bool paused = false;                 ///< the newest tick is held
  std::string host;                    ///< the coordinator's
};

/// Ends a run for good. Without `now` only the coordinator obeys, and ends the mission in order;
/// with `now` every receiver obeys. A STOP with an old tick is refused.
struct Stop {
  /// header.tick: the newest that the operator knows; 0 if none. Without a key it names a tick that
  /// never passes, because anybody can forge it anyway.
  Header header;
  bool failed = false;  ///< whether the mission failed, or was only ended
  std::string reason;
  bool now = false;  ///< emergency: all vehicles stand still at once
  Signature signature{};
};

/// Asks for an amendment of the mission. Only the coordinator obeys, and only once: a recording
/// names the number of an amendment that was already made, or an old tick.
struct Amend {
  Header header;            ///< header.tick: the newest that the operator knows
  std::int32_t number = 0;  ///< that it will have: Amendments::named
  AmendmentKind kind = AmendmentKind::kPause;
  Tick delay_ticks = 0;  ///< how many ticks later than necessary it shall hold
  std::int32_t part = 0, parts = 1;
  std::vector<std::byte> content{};  ///< this part's share of the target, plan/amendment_list.h
  std::string by{};                  ///< the operator, as Amendment has it
  Signature signature{};
};

/// Sends an agent home for the rest of the mission, or out of it. Only the coordinator obeys, and
/// only once: a recording names an agent that was recalled already, or an old tick.
struct Recall {
  Header header;  ///< header.tick: the newest that the operator knows
  AgentId agent = 0;
  bool leaves = false;  ///< out of the mission; its number stays empty
  Signature signature{};
};

struct Vehicle {
  AgentId id = 0;
  std::int64_t answered_tick = -1;  ///< newest tick its commands have answered
  Eigen::Vector3d position_m{0, 0, 0};
  Eigen::Vector3d velocity_mps{0, 0,
                               0};  ///< applied in the step that led here; with inertia, at its end
  ObjectSet detected = 0;           ///< by its sensor at this tick
  std::int32_t reported_cell = kNoCell;  ///< by its sensor, core/search/reports.h
  std::int32_t charge_ppm = kNoCharge;   ///< of its battery, core/motion/charge.h
};

/// The world at one tick, in parts of at most kMaxVehiclesPerState vehicles.
struct WorldState {
  Header header;
  std::int64_t roster_revision = 0;   ///< known when it first sent this tick
  std::int64_t missed_deadlines = 0;  ///< real time: commands that came too late for their tick
  std::int64_t skipped_ticks = 0;     ///< real time: ticks that a delayed world skipped
  std::int64_t clamped_commands = 0;  ///< steps of a vehicle that the speed limit made slower
  Tick uncounted_ticks = 0;  ///< ticks before this one that did not count, core/mission/hold.h
  ObjectSet found = 0;       ///< the objects that count as found by this tick, as far as it knows
  std::int32_t part = 0, parts = 1;
  bool last = false;  ///< the mission is over, and the world leaves: this is its last message
  std::int32_t vehicle_count = 0;
  std::array<Vehicle, kMaxVehiclesPerState> vehicles;  ///< the first vehicle_count of them count

  /// The vehicles of this part.
  std::span<const Vehicle> vehicles_in_part() const {
    return std::span(vehicles).first(static_cast<std::size_t>(vehicle_count));
  }
  std::span<Vehicle> vehicles_in_part() {
    return std::span(vehicles).first(static_cast<std::size_t>(vehicle_count));
  }
  /// One more vehicle. @pre there is room
  Vehicle& add_vehicle() { return vehicles[static_cast<std::size_t>(vehicle_count++)]; }
};

/// An agent's velocity for a tick. A restarted world learns tick and position from it.
struct Command {
  Header header;                        ///< header.tick is the tick it answers; −1: none yet
  Eigen::Vector3d position_m{0, 0, 0};  ///< from which it was computed
  Eigen::Vector3d velocity_mps{0, 0, 0};
  Incarnation asked_by = 0;             ///< the world that asked; 0: it answers a tick
  std::int32_t charge_ppm = kNoCharge;  ///< of the vehicle, as position_m
};

/// The position of a body, and the teammates' beacons that its agent had received before the
/// measurement. An agent whose beacon k comes back as an echo knows that the position is younger
/// than k. See team/beacon_book.h.
struct Beacon {
  Header header;
  std::int64_t roster_revision = 0;  ///< known to the sender: its echoes are of these members
  Eigen::Vector3d position_m{0, 0, 0};
  Eigen::Vector3d velocity_mps{0, 0, 0};
  std::uint16_t number = 1;  ///< grows by one with each beacon; 1 follows 65535
  std::int32_t echo_count = 0;
  /// By agent: the number of its newest beacon that was received in time; 0: none.
  std::array<std::uint16_t, kMaxEchoesPerMessage> echoes{};
};

/// Limit (Messages): contacts that RECORD_ACK names, fewer with more than 22 finds. Beyond it: the
/// least likely are not listed.
inline constexpr std::int32_t kMaxContactsPerMessage = 16;
/// Room for finds of 32 bytes and contacts of 25 in a RECORD_ACK.
inline constexpr std::int32_t kFindAndContactBytes = 1124;
static_assert(kFindAndContactBytes >= 32 * kMaxObjects);

/// The logger has recorded all ticks up to and including header.tick (−1: it is ready).
struct RecordAck {
  Header header;
  bool last = false;  ///< the mission is over, and the logger leaves: this is its last message
  double detection_probability = 0;      ///< of the recorded ticks, core/measure/detection.h
  std::int32_t wrong_confirmations = 0;  ///< core/search/confirmations.h
  std::int32_t find_count = 0;
  std::array<Find, kMaxObjects>
      finds{};  ///< in the recorded ticks, in their order; t_s is not sent
  std::int32_t contact_count = 0;
  std::array<Contact, kMaxContactsPerMessage> contacts{};  ///< Confirmations::contacts()

  std::span<const Find> all_finds() const {
    return std::span(finds).first(static_cast<std::size_t>(find_count));
  }
  std::span<const Contact> all_contacts() const {
    return std::span(contacts).first(static_cast<std::size_t>(contact_count));
  }
  /// How many contacts fit in beside the finds.
  std::int32_t contact_room() const {
    return std::min(kMaxContactsPerMessage, (kFindAndContactBytes - 32 * find_count) / 25);
  }
};
/// Lockstep: how many ticks the world may be ahead of the logger's acknowledgement, unless it has
/// given that logger up.
/// Limit (Time): lead of the world over the record in lockstep [steps]. Beyond it: the world waits
/// for the logger.
inline constexpr Tick kRecordWindowTicks = 64;

using Message = std::variant<Hello, MissionPart, Contribution, AgentStatus, TeamStatus, Stop,
                             WorldState, Command, RecordAck, Digest, Amend, Beacon, Recall, Effort>;

enum class Bus { kSwarm, kWorld, kCommand };
inline constexpr int kBusCount = 3;

/// A message that a core publishes.
struct Outgoing {
  Bus bus;
  Message message;
  AgentId relayer = kUnassigned;  ///< the agent that relays another process's message, if any
};
using Outbox = std::vector<Outgoing>;

inline const Header& header_of(const Message& message) {
  return std::visit([](const auto& m) -> const Header& { return m.header; }, message);
}

}  // namespace ergocast
