// SPDX-License-Identifier: BSD-3-Clause
// What must hold in every mission, whatever happens to its messages and processes.
//
// Safety holds always. Liveness holds within a bounded time after everything has been healed. This
// code does not trust the code that it checks: it computes every bound again from the equations.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "agent/anti_entropy.h"
#include "coordinator/coordinator.h"
#include "core/measure/objects.h"
#include "core/mission/mission.h"
#include "lab/faults.h"
#include "lab/shadow/shadow.h"
#include "lab/shadow/table_view.h"
#include "lab/shadow/wire_modes.h"
#include "lcmtypes/codec.h"
#include "logger/recorder.h"
#include "team/mission_follower.h"
#include "team/state_assembler.h"

namespace ergocast::lab {

enum class Invariant : std::uint8_t {
  // Safety.
  kPositionsInTheDomain,
  kInputsBounded,
  kDistanceKept,
  kWallsKept,
  kZonesNotEntered,
  kZonesLeft,
  kHomeInTime,
  kRecalledComeHome,
  kChargesAreTrue,
  kEmptyOnlyAtHome,
  kSumsBounded,
  kRelaysAnswerDigests,
  kDigestsSayWhatIsHeld,
  kWholeMessagesAccepted,
  kDamagedMessagesRefused,
  kHeldNeverShrinks,
  kDetectionsInReach,
  kLooksAreTrue,
  kNoStepCountsTwice,
  kNothingCountsWhilePaused,
  kWhatIsNotPausedCounts,
  kNobodyMovesWhilePaused,
  kNobodyMovesAfterTheEnd,
  kAverageOfWhatIsHeld,
  kSamplesAreTrue,
  kForecastOfWhatIsKnown,
  kZerothIsOne,
  kHonestMessagesAccepted,
  kNoEarlyEnd,
  kClosedNumbersStayEmpty,
  kNoWakeupInThePast,
  kHeardLoggerIsKept,
  // Liveness.
  kEverybodyIsBack,
  kLiveAgentsAreKnown,
  kLiveAgentsCount,
  kEverybodyLearnsEveryRow,
  kViewsAgree,
  kRelaysStop,
  kEverybodyEnds,
  kMissionDoesNotFail,
  kLastTickReached,
  kRecordIsWhole,
  kFindsAreRecorded,
  kEndsOnceFound,
  kGoalReached,
  kCount,
};
/// All invariants by number, with their names in reports.
inline constexpr std::array<std::pair<Invariant, std::string_view>,
                            static_cast<std::size_t>(Invariant::kCount)>
    kInvariants{{
        {Invariant::kPositionsInTheDomain, "positions are in the domain"},
        {Invariant::kInputsBounded, "|u| <= u_max"},
        {Invariant::kDistanceKept, "bodies keep their distance"},
        {Invariant::kWallsKept, "bodies keep out of walls"},
        {Invariant::kZonesNotEntered, "no body enters a zone"},
        {Invariant::kZonesLeft, "nobody is in a zone from its tick on"},
        {Invariant::kHomeInTime, "agents are home in time"},
        {Invariant::kRecalledComeHome, "recalled agents come home"},
        {Invariant::kChargesAreTrue, "a battery is used away from its station alone"},
        {Invariant::kEmptyOnlyAtHome, "no vehicle runs empty away from its station"},
        {Invariant::kSumsBounded, "S_00 = time covered, |S_mn| <= S_00, or 3 S_00 after a change"},
        {Invariant::kRelaysAnswerDigests, "a relay answers a digest"},
        {Invariant::kDigestsSayWhatIsHeld, "a digest lists what is held"},
        {Invariant::kWholeMessagesAccepted, "no whole message is refused"},
        {Invariant::kDamagedMessagesRefused, "no damaged message is accepted"},
        {Invariant::kHeldNeverShrinks, "what is held never shrinks"},
        {Invariant::kDetectionsInReach, "sensors detect only objects within their radius"},
        {Invariant::kLooksAreTrue,
         "looks and reports are as their author sent them, and count once"},
        {Invariant::kNoStepCountsTwice, "no step counts twice"},
        {Invariant::kNothingCountsWhilePaused, "nothing counts while paused or at rest"},
        {Invariant::kWhatIsNotPausedCounts, "every tick counts unless paused or at rest"},
        {Invariant::kNobodyMovesWhilePaused, "no vehicle moves while the mission is paused"},
        {Invariant::kNobodyMovesAfterTheEnd, "no vehicle moves after the end"},
        {Invariant::kAverageOfWhatIsHeld, "c_k = sum S / sum elapsed of what is held"},
        {Invariant::kSamplesAreTrue,
         "each sample is f at its place against the target of its tick"},
        {Invariant::kForecastOfWhatIsKnown, "forecast of what is known"},
        {Invariant::kZerothIsOne, "c_00 = 1"},
        {Invariant::kHonestMessagesAccepted, "no honest message is refused"},
        {Invariant::kNoEarlyEnd, "no agent ends before the mission"},
        {Invariant::kClosedNumbersStayEmpty,
         "the number of an agent that was sent out stays empty"},
        {Invariant::kNoWakeupInThePast, "no process asks to be woken in the past"},
        {Invariant::kHeardLoggerIsKept, "a logger whose messages arrive is not given up"},
        {Invariant::kEverybodyIsBack, "every process is back in the mission"},
        {Invariant::kLiveAgentsAreKnown, "a running agent counts as running"},
        {Invariant::kLiveAgentsCount, "a running agent is not forgotten"},
        {Invariant::kEverybodyLearnsEveryRow, "every agent learns every row"},
        {Invariant::kViewsAgree, "all agree on c_k within their staleness"},
        {Invariant::kRelaysStop, "relays stop once all know all"},
        {Invariant::kEverybodyEnds, "every process ends"},
        {Invariant::kMissionDoesNotFail, "the mission does not fail"},
        {Invariant::kLastTickReached, "the mission reaches its last tick"},
        {Invariant::kRecordIsWhole, "the record has every tick"},
        {Invariant::kFindsAreRecorded, "the record has the finds of the simulated world"},
        {Invariant::kEndsOnceFound, "the mission ends once enough objects are found"},
        {Invariant::kGoalReached, "the goal is reached"},
    }};
constexpr std::string_view name_of(Invariant invariant) {
  return kInvariants[static_cast<std::size_t>(invariant)].second;
}
constexpr bool all_are_named() {
  for (std::size_t i = 0; i < kInvariants.size(); ++i) {
    if (kInvariants[i].first != static_cast<Invariant>(i) || kInvariants[i].second.empty())
      return false;
  }
  return true;
}
static_assert(all_are_named(), "every invariant has a name, at its place");

struct Violation {
  Invariant invariant;
  std::string who;
  double t_s = 0;  ///< virtual, since the start of the mission
  std::string numbers;
};
/// Formatted as `<invariant>: <who> at t = <t_s> s: <numbers>`.
std::string to_string(const Violation& violation);

/// The time until a row is known one hop further. Two digests must name it, a round of digests
/// apart, the first up to a round after an admission; the answer waits up to 0.25 s. An agent that
/// learns a row late passes it on late, which takes as long again.
/// @param entries  number of entries of the roster
constexpr double hop_s(std::size_t entries) {
  return 2 * (2 * AntiEntropy::round_s(entries) + 0.25);
}

/// Virtual time after healing by which every running agent is back in the mission and knows what
/// the others know.
double recovery_bound_s(const Mission& mission, const Faults& faults);

class Invariants {
 public:
  explicit Invariants(const Mission& mission);

  /// A new (agent, incarnation) has started.
  void started(const Author& author);

  // ---- safety ----

  /// A process has sent a message. Checked are: positions are in the domain, in no wall, and as far
  /// from each wall as the mission requires; bodies are as far apart as required, in each tick; |u|
  /// ≤ the u_max that holds, or |v| ≤ the speed limit where a distance is kept or on the way home;
  /// in lockstep agents with a station are there from the reserve before the end on, or where
  /// others may be in the way, at the last tick, unless a zone may have delayed them, as near as
  /// vehicles that stand for good let them; |S| ≤ S_00 = steps · dt, or with a half-life the time
  /// that is remembered, which is halved at its ticks; while the mission is paused no body moves
  /// once it has braked, and after the end none moves; a digest matches what its sender holds; each
  /// entry of a received digest gets at most one answer.
  /// @param speaker  the agent, or null
  void sent(double t_s, const Outgoing& outgoing, const TableView* speaker);
  /// An agent that has finished has sent a command: it may only stop its vehicle.
  void commanded_after(double t_s, const Command& command);
  /// An agent has received a digest.
  void digest_received(const Author& listener, const Digest& digest);
  /// Bytes were decoded: whole messages are accepted, damaged ones refused.
  void decoded(double t_s, const Decoded& result, bool damaged);
  /// A message has reached an agent, whose knowledge is now `listener`; its c_k is not read. Call
  /// it for each MISSION, because one of them admits the agent and names its first tick.
  void received(const TableView& listener, const Message& message);
  /// An agent has begun the tick `holder.answered`, and may not have answered it yet. It has more
  /// steps than before if the tick counts, and no more if not, if it was recalled, or if the
  /// battery of its vehicle is charged at its station. In lockstep a recalled point is at home
  /// after the time that the longest way takes, if no zone is closed. Call it for each tick, before
  /// the agent receives anything else.
  void began(double t_s, const TableView& holder);
  /// An agent has answered a tick. What it holds never shrinks; no author's steps exceed the ticks
  /// so far that count; c_k is Σ S / Σ elapsed of what it holds; c_00 = 1. Where its law looks
  /// ahead, ĉ_k follows by the equation of core/law/forecast.h from what has reached it
  /// (lab/shadow.h).
  /// @param x_m  where it was at that tick; nothing: its sample is not checked
  void answered(double t_s, const TableView& holder,
                const std::optional<Eigen::Vector3d>& x_m = std::nullopt);
  /// An agent's core has refused `counts` messages, none of them damaged.
  void refused(double t_s, const Author& who, const RefusalCounts& counts);
  /// An agent has ended by itself.
  void finished(double t_s, const Author& who, const std::string& reason, bool mission_over);
  /// A process wants to be woken at a time that has passed: it would run at full load.
  void wakeup(double t_s, const std::string& who, bool in_the_past);
  /// The world continues at `tick` without the logger.
  /// @param acknowledged  the newest tick whose acknowledgement has reached it
  void gave_up_logger(double t_s, std::optional<Tick> acknowledged, Tick tick);

  // ---- liveness ----

  /// Call it from recovery_bound_s() after healing on. Every running agent holds each row that any
  /// agent holds, and the newest version if its author has left. |c − c_true|_∞ ≤ 2 δ / (T − δ),
  /// where δ sums what active authors may not have sent or delivered yet. Between two calls no
  /// agent repeats anything.
  ///
  /// With a radio range an agent learns another's rows, also through others, only if each on the
  /// way has received from the next for long enough. Then it holds what the other held that long
  /// ago. δ is what it lacks, and repeats may go on.
  void recovered(double t_s, const std::vector<TableView>& living);
  /// From now on it demands that nobody is in a zone from its tick on, if bodies keep no distance.
  void expect_zones_to_be_left() { zones_are_left_ = !(mission_.separation.distance_m > 0); }
  /// Call it together with recovered(): checks what the coordinator knows of every running process.
  void coordinated(double t_s, const Coordinator& coordinator, Instant now,
                   const std::vector<TableView>& living);
  /// All processes have ended, or the time is over.
  /// @param excused  ticks whose states may have been kept from the logger
  void ended(double t_s, const std::string& still_running, const std::string& failure,
             const RunFacts& facts, Tick excused);

  const std::optional<Violation>& violation() const { return violation_; }
  /// Only measures how far these views are from c_true, for largest_view_error().
  void compare_views(const std::vector<TableView>& living);
  /// max_a √(Σ λ (c_a − c_true)²) of the last recovered() or compare_views().
  double largest_view_error() const { return largest_view_error_; }
  Tick last_tick() const { return last_tick_; }
  /// Every author so far.
  const std::vector<Author>& authors() const { return authors_; }

 private:
  struct Best {
    std::int64_t steps = 0;
    BlockSums sums;
    double elapsed_s = 0;
    Tick halvings = 0;  ///< of these two
  };
  /// What an author has sent of its memory.
  struct Sent {
    std::int64_t steps = 0;
    Tick tick = 0;
    double elapsed_s = 0;
  };
  void violate(double t_s, Invariant invariant, const std::string& who, std::string numbers);
  void note_ends();
  void check(double t_s, const WorldState& world);
  void check(double t_s, const Command& command, const TableView& speaker);
  void check_paused(double t_s, const Command& command);
  void check_paused(double t_s, const WorldState& world);
  void note_end_of(const Amendments& list);
  void check_ended(double t_s, const WorldState& world);
  void check_ended(double t_s, const Command& command, const TableView& speaker);
  void check(double t_s, const Contribution& block, AgentId relayer, const TableView* speaker);
  void check_memory(double t_s, const Contribution& block);
  void check(double t_s, const Digest& digest, const TableView& speaker);
  void check_steps(double t_s, const TableView& holder);
  void check_average(double t_s, const TableView& holder);
  void check_sample(double t_s, const TableView& holder, const Eigen::Vector3d& x_m);
  void check_forecast(double t_s, const TableView& holder);
  std::map<Author, std::vector<Best>> best_of(const std::vector<TableView>& living) const;
  double quality_of(const Author& author) const;
  double remembered_s(const Best& block) const;
  Tick most_halvings(const std::map<Author, std::vector<Best>>& rows) const;
  Coefficients average_of(const std::map<Author, std::vector<Best>>& rows) const;
  void check_rows(double t_s, const TableView& holder,
                  const std::map<Author, std::vector<Best>>& best);
  void check_view(double t_s, const TableView& holder,
                  const std::map<Author, std::vector<Best>>& best, const Coefficients& c_true);
  void check_quiet(double t_s);
  void note_positions(double t_s, const WorldState& world);
  void check_wall(double t_s, const Vehicle& vehicle);
  void check_zones(double t_s, const WorldState& world);
  void check_zone(double t_s, const WorldState& world, const Zone& zone);
  void note_zone(const Zone& zone);
  void forget_bound(std::int32_t zone);
  bool may_leave_a_zone(AgentId id, const Eigen::Vector3d& x_m, Tick tick) const;
  bool any_zone_closed_at(Tick tick) const;
  bool zone_may_delay(AgentId id, Tick home_from) const;
  void check_detections(double t_s, const WorldState& world);
  void check_finds(double t_s, const Finds& finds, Tick excused);
  void check_end_by_finding(double t_s, Tick excused);
  void note_looks(const Effort& own);
  void check_looks(double t_s, const TableView& holder);
  std::string remembered(const TableView& holder) const;
  bool all_states_count(Tick excused) const;
  void check_home(double t_s, const WorldState& world);
  bool counts_for_home(AgentId id) const;
  void check_batteries(double t_s, const WorldState& world);
  void note_charge(const Vehicle& vehicle, Tick tick);
  std::optional<bool> charged(AgentId id, Tick tick) const;
  void check_charge(double t_s, const Vehicle& vehicle, const Battery& battery, Tick tick,
                    double apart_m);
  double nearest_to_station_m(const Vehicle& vehicle) const;
  void check_recalled_home(double t_s, const TableView& holder);
  bool recalled_in_truth(const TableView& holder) const;
  void check_closed_numbers(double t_s);
  void check_distances(double t_s, const WorldState& world);
  void check_counted(double t_s, const TableView& holder, const std::vector<TableView>& living);
  void check_neighbours(double t_s, const std::vector<TableView>& living);
  std::set<Author> within(int hops, const Author& self, double heard_for_s, double t_s,
                          const std::vector<TableView>& living) const;
  void check_learned(double t_s, const TableView& holder, const Author& other,
                     const std::map<Author, std::int64_t>& held_then, int hops);

  Mission mission_;
  Coefficients weights_;
  int block_count_;
  WireModes wire_modes_;
  std::optional<Violation> violation_;
  std::vector<Author> authors_;
  std::map<AgentId, int> incarnation_count_;
  MissionFollower truth_;  // follows all messages about the mission
  /// Where a vehicle has been since a zone was closed.
  struct BesideZone {
    Tick first_seen = 0;
    bool bound = false;  // it was surely outside
  };
  std::vector<EndChange> ends_;    // of the newest mission
  std::vector<Hold> holds_;        // the same
  std::int64_t end_revision_ = 0;  // by which they were named
  /// Where vehicles are after the end, and the world that reported it.
  std::map<AgentId, Eigen::Vector3d> final_places_m_;
  Incarnation final_world_ = 0;
  std::map<std::int32_t, Zone> zones_;                   // all so far
  std::map<std::int32_t, std::int64_t> zone_revisions_;  // by which each zone was named
  std::map<std::pair<std::int32_t, AgentId>, BesideZone> beside_zones_;
  Incarnation zone_world_ = 0;  // the world of beside_zones_
  bool zones_are_left_ = false;
  bool shifted_ = false;                                   // a target has been named
  std::map<Author, std::map<Author, std::int64_t>> held_;  // holder, author: steps
  std::map<Author, std::int64_t> own_steps_;               // after the tick begun last
  std::map<std::pair<Author, int>, Sent> sent_;            // of each block, with a half-life
  std::map<Author, Shadow>
      shadows_;  // of each incarnation of an agent, from its first admission on
  std::map<Author, std::int64_t> relays_allowed_;
  std::map<Author, Tick> commanded_;   // the newest tick that a command has answered
  std::map<AgentId, Tick> home_from_;  // where agents have stations
  std::map<AgentId, std::pair<Tick, std::int32_t>> charges_;  // the newest, of a battery
  /// Whether a battery is charged, at the newest ticks; nothing: states of two worlds differ.
  std::map<AgentId, std::map<Tick, std::optional<bool>>> charged_;
  std::map<Author, Tick> rested_;                // counted ticks since an agent was recalled
  std::map<AgentId, Eigen::Vector3d> places_m_;  // in lockstep, of the newest state
  StateAssembler state_;                         // where a distance is kept
  Objects objects_;
  /// For each object by tick and agent.
  std::map<int, std::set<std::pair<Tick, AgentId>>> detections_;
  std::map<AgentId, std::set<Tick>> reports_;  // ticks at which a sensor reports something
  std::set<Incarnation> worlds_;               // that have sent a state
  /// The counts that each author has sent, by tile and newest look.
  std::map<Author, std::map<std::pair<std::int32_t, Tick>, std::array<std::uint16_t, kTileCells>>>
      looks_sent_;
  std::map<AgentId, Eigen::Vector3d>
      positions_m_;  // only with a radio range, like the next members
  std::map<std::pair<AgentId, AgentId>, double> last_apart_t_s_;  // smaller id first
  struct Memory {
    double t_s;
    std::map<Author, std::map<Author, std::int64_t>> held;  // as held_
  };
  std::vector<Memory> memories_;  // of each call of recovered()
  std::int64_t relayed_ = 0;      // since the last recovered()
  bool recovered_ = false;
  Tick last_tick_ = -1;
  double largest_view_error_ = 0;
};

}  // namespace ergocast::lab
