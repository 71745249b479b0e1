// SPDX-License-Identifier: BSD-3-Clause
// The bugs that the laboratory must detect. This file is linked in front of the real program as
// ergocast-with-bugs and intercepts calls from one library into another (--wrap: the names in
// WRAPPED lines are the linker's, and CMake reads them here). ERGOCAST_BUG selects the bug; without
// it, every call passes through.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include "agent/agent.h"
#include "coordinator/coordinator.h"
#include "core/base/geometry.h"
#include "core/basis/basis.h"
#include "core/law/control.h"
#include "core/law/coverage_table.h"
#include "core/law/forecast.h"
#include "core/mission/hold.h"
#include "core/motion/separation.h"
#include "core/motion/vehicle.h"
#include "core/motion/way_home.h"
#include "lcmtypes/codec.h"
#include "sim/world.h"

// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
/// `real_x` is the program's own function, and `bug_x` stands in its place.
#define WRAPPED(result, x, symbol, ...)               \
  result real_##x(__VA_ARGS__) asm("__real_" symbol); \
  result bug_##x(__VA_ARGS__) asm("__wrap_" symbol);
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

namespace ergocast {
namespace {

bool bug(std::string_view name) {
  static const char* const chosen = std::getenv("ERGOCAST_BUG");
  return chosen != nullptr && name == chosen;
}

/// Some ticks after the mission's start, when all agents know each other.
constexpr Tick kUnderWay = 100;

}  // namespace

// clang-format off
WRAPPED(Eigen::Vector3d, command, "_ZN8ergocast10Controller7commandEilRKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEERKNS_7BasisAtE", Controller*, AgentId, Tick, const Eigen::Vector3d&, const BasisAt&)
WRAPPED(double, ergodic_metric, "_ZN8ergocast14ergodic_metricERKN5Eigen6MatrixIdLin1ELi1ELi0ELin1ELi1EEES4_S4_", const Coefficients&, const Coefficients&, const Coefficients&)
WRAPPED(Eigen::Vector3d, reflect, "_ZN8ergocast7reflectERKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEERKNS_3BoxE", const Eigen::Vector3d&, const Box&)
WRAPPED(void, make_table, "_ZN8ergocast13CoverageTableC1ERKNS_5BasisEdl", CoverageTable*, const Basis&, double, Tick)
WRAPPED(void, add_sample, "_ZN8ergocast13CoverageTable10add_sampleERKNS_6AuthorERKNS_7BasisAtEPKd", CoverageTable*, const Author&, const BasisAt&, const double*)
WRAPPED(void, set_quality, "_ZN8ergocast13CoverageTable11set_qualityERKNS_6AuthorEd", CoverageTable*, const Author&, double)
WRAPPED(Merge, merge, "_ZN8ergocast13CoverageTable5mergeERKNS_12ContributionEl", CoverageTable*, const Contribution&, std::int64_t)
WRAPPED(Contribution, block, "_ZNK8ergocast13CoverageTable5blockERKNS_6AuthorEi", const CoverageTable*, const Author&, int)
WRAPPED(void, average, "_ZNK8ergocast13CoverageTable7averageERN5Eigen6MatrixIdLin1ELi1ELi0ELin1ELi1EEE", const CoverageTable*, Coefficients&)
WRAPPED(void, make_forecast, "_ZN8ergocast8ForecastC1ERKNS_7MissionERKNS_6AuthorE", Forecast*, const Mission&, const Author&)
WRAPPED(void, look_ahead, "_ZN8ergocast8Forecast10look_aheadERKNS_13CoverageTableERKSt6vectorINS_11RosterEntryESaIS5_EElRN5Eigen6MatrixIdLin1ELi1ELi0ELin1ELi1EEE", Forecast*, const CoverageTable&, const std::vector<RosterEntry>&, Tick, Coefficients&)
WRAPPED(void, receive_at_agent, "_ZN8ergocast5Agent7receiveERKSt7variantIJNS_5HelloENS_11MissionPartENS_12ContributionENS_11AgentStatusENS_10TeamStatusENS_4StopENS_10WorldStateENS_7CommandENS_9RecordAckENS_6DigestENS_5PauseENS_6BeaconENS_6RecallEEENS_3BusEiNSt6chrono10time_pointINS_11PacingClockENSJ_8durationIlSt5ratioILl1ELl1000000000EEEEEE", Agent*, const Message&, Bus, AgentId, Instant)
WRAPPED(void, advance, "_ZN8ergocast5Agent7advanceENSt6chrono10time_pointINS_11PacingClockENS1_8durationIlSt5ratioILl1ELl1000000000EEEEEERSt6vectorINS_8OutgoingESaISA_EE", Agent*, Instant, Outbox&)
WRAPPED(Instant, next_wakeup, "_ZNK8ergocast5Agent11next_wakeupEv", const Agent*)
WRAPPED(void, coordinate, "_ZN8ergocast11Coordinator7advanceENSt6chrono10time_pointINS_11PacingClockENS1_8durationIlSt5ratioILl1ELl1000000000EEEEEERSt6vectorINS_8OutgoingESaISA_EE", Coordinator*, Instant, Outbox&)
WRAPPED(void, turn_world, "_ZN8ergocast5World7advanceENSt6chrono10time_pointINS_11PacingClockENS1_8durationIlSt5ratioILl1ELl1000000000EEEEEERSt6vectorINS_8OutgoingESaISA_EE", World*, Instant, Outbox&)
WRAPPED(Instant, next_turn_of_world, "_ZNK8ergocast5World11next_wakeupEv", const World*)
WRAPPED(void, receive_at_coordinator, "_ZN8ergocast11Coordinator7receiveERKSt7variantIJNS_5HelloENS_11MissionPartENS_12ContributionENS_11AgentStatusENS_10TeamStatusENS_4StopENS_10WorldStateENS_7CommandENS_9RecordAckENS_6DigestENS_5PauseENS_6BeaconENS_6RecallEEENS_3BusEiNSt6chrono10time_pointINS_11PacingClockENSJ_8durationIlSt5ratioILl1ELl1000000000EEEEEE", Coordinator*, const Message&, Bus, AgentId, Instant)
WRAPPED(void, receive_at_world, "_ZN8ergocast5World7receiveERKSt7variantIJNS_5HelloENS_11MissionPartENS_12ContributionENS_11AgentStatusENS_10TeamStatusENS_4StopENS_10WorldStateENS_7CommandENS_9RecordAckENS_6DigestENS_5PauseENS_6BeaconENS_6RecallEEENS_3BusEiNSt6chrono10time_pointINS_11PacingClockENSJ_8durationIlSt5ratioILl1ELl1000000000EEEEEE", World*, const Message&, Bus, AgentId, Instant)
WRAPPED(bool, is_held, "_ZN8ergocast7is_heldESt4spanIKNS_4HoldELm18446744073709551615EEl", std::span<const Hold>, Tick)
WRAPPED(Tick, counted_ticks, "_ZN8ergocast13counted_ticksESt4spanIKNS_4HoldELm18446744073709551615EEl", std::span<const Hold>, Tick)
WRAPPED(Tick, tick_after, "_ZN8ergocast10tick_afterESt4spanIKNS_4HoldELm18446744073709551615EEl", std::span<const Hold>, Tick)
using Decoded = std::variant<Message, Refusal>;
WRAPPED(Decoded, decode, "_ZN8ergocast6decodeESt4spanIKSt4byteLm18446744073709551615EEmRKNS_20MessageAuthenticatorESt17basic_string_viewIcSt11char_traitsIcEEPNS_15KnownSignaturesE", std::span<const std::byte>, RunId, const MessageAuthenticator&, std::string_view, KnownSignatures*)
WRAPPED(void, make_filter, "_ZN8ergocast16SeparationFilterC1ERKNS_7MissionEl", SeparationFilter*, const Mission&, Tick)
WRAPPED(bool, goes_home, "_ZN8ergocast7WayHome5begunElRKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEE", WayHome*, Tick, const Eigen::Vector3d&)
WRAPPED(Eigen::Vector3d, go_home, "_ZN8ergocast7WayHome12velocity_mpsERKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEES5_", WayHome*, const Eigen::Vector3d&, const Eigen::Vector3d&)
WRAPPED(bool, filters_again, "_ZN8ergocast13filters_againERKNS_7MissionE", const Mission&)
WRAPPED(SafeVelocity, safe, "_ZN8ergocast16SeparationFilter4safeERKNS_5MoverERKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEESt4spanIKNS_9NeighbourELm18446744073709551615EE", SeparationFilter*, const Mover&, const Eigen::Vector3d&, std::span<const Neighbour>)
WRAPPED(void, make_book, "_ZN8ergocast10BeaconBookC1ERKNS_7MissionERKNS_6AuthorEl", BeaconBook*, const Mission&, const Author&, std::int64_t)
WRAPPED(void, receive_beacon, "_ZN8ergocast10BeaconBook7receiveERKNS_6BeaconEbRKNS_6MomentE", BeaconBook*, const Beacon&, bool, const Moment&)
WRAPPED(std::span<const Neighbour>, bodies, "_ZN8ergocast10BeaconBook6bodiesERKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEERKNS_6MomentE", BeaconBook*, const Eigen::Vector3d&, const Moment&)
// clang-format on

// ---- control and world ----

Eigen::Vector3d bug_command(Controller* self, AgentId agent, Tick tick, const Eigen::Vector3d& x_m,
                            const BasisAt& at) {
  const Eigen::Vector3d v_mps = real_command(self, agent, tick, x_m, at);
  return bug("the input is not cut") ? 20 * v_mps : v_mps;
}

double bug_ergodic_metric(const Coefficients& coverage, const Coefficients& target,
                          const Coefficients& weights) {
  return bug("phi^2 is no number") ? std::nan("") : real_ergodic_metric(coverage, target, weights);
}

Eigen::Vector3d bug_reflect(const Eigen::Vector3d& x_m, const Box& domain) {
  const Eigen::Vector3d back_m = real_reflect(x_m, domain);
  if (!bug("the edges push outwards")) return back_m;
  return back_m + (back_m - domain.center_m());
}

namespace {

/// A filter's settings and its earlier neighbours.
struct Filtered {
  Mission mission;
  std::map<AgentId, std::map<Tick, std::vector<Neighbour>>> sent;  // of each body
};
std::map<const SeparationFilter*, Filtered> filtered;

/// An age at which a body may have moved a small distance.
constexpr Tick kOld = 8;

/// The neighbours that a body got kOld ticks ago.
std::vector<Neighbour> old_news(SeparationFilter* self, const Mover& mover,
                                std::span<const Neighbour> others) {
  auto& sent = filtered.at(self).sent[mover.id];
  sent[mover.tick] = {others.begin(), others.end()};
  while (sent.begin()->first < mover.tick - kOld) sent.erase(sent.begin());
  return sent.begin()->second;
}

/// A number for a pair of bodies that stays constant for a second.
Tick draw_of(const Mover& mover, const Neighbour& other) {
  return mover.tick / 10 * 7 + mover.id * 5 + other.id * 3;
}

/// The filter's data on a body of another kind.
Neighbour misjudged_kind(const Mission& mission, const Mover& mover, const Neighbour& other) {
  const Motion motion = motion_of(mission, other.id);
  Neighbour sent = other;
  if (bug("a neighbour needs no way to brake") && motion.has_inertia()) sent.velocity_mps.setZero();
  if (bug("a neighbour's loiter circle is a point")) {
    const Eigen::Vector3d center_m = anchor_m(motion, other.position_m, other.velocity_mps);
    sent.position_m += loiter_radius_m(motion) * (center_m - mover.position_m).normalized();
  }
  if (bug("a neighbour is taken for another vehicle")) {
    const auto team = static_cast<AgentId>(mission.starts_m.size());
    do sent.id = (sent.id + 1) % team;
    while (sent.id == mover.id);
  }
  return sent;
}

/// The changed neighbours that the filter gets.
std::vector<Neighbour> misjudged(SeparationFilter* self, const Mover& mover,
                                 std::span<const Neighbour> others) {
  const Filtered& made = filtered.at(self);
  std::vector<Neighbour> sent(others.begin(), others.end());
  if (bug("only two bodies count")) sent.resize(std::min<std::size_t>(2, sent.size()));
  if (bug("a body takes the whole gap")) {
    for (Neighbour& other : sent) other.max_speed_mps *= 1e-9;
  }
  if (bug("old places count as new")) sent = old_news(self, mover, others);
  if (bug("places count as half as old")) {
    sent = old_news(self, mover, others);
    for (Neighbour& other : sent) other.age_ticks = kOld / 2;
  }
  if (bug("a body needs no way to brake")) {
    for (Neighbour& other : sent) other.velocity_mps.setZero();
  }
  if (bug("uncertainty narrows no direction")) sent = old_news(self, mover, others);
  if (bug("a body without messages does not exist")) {
    std::erase_if(sent, [&](const Neighbour& other) { return draw_of(mover, other) % 3 == 0; });
  }
  for (Neighbour& other : sent) {
    if (other.id != mover.id) other = misjudged_kind(made.mission, mover, other);
    const Eigen::Vector3d y_m = other.position_m - mover.position_m;
    if (bug("uncertainty narrows no direction") && y_m.norm() > 0) {
      const double near_m = other.max_speed_mps * made.mission.timing.dt_s * kOld;
      other.position_m -= y_m * std::min(1.0, near_m / y_m.norm());
    }
    if (bug("nobody knows of position errors")) {
      const double angle = static_cast<double>(draw_of(mover, other));
      other.position_m += made.mission.separation.position_error_m *
                          Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    }
  }
  return sent;
}

}  // namespace

void bug_make_filter(SeparationFilter* self, const Mission& mission, Tick hold_ticks) {
  Mission changed = mission;
  filtered[self] = {mission, {}};
  if (bug("no command is held")) hold_ticks = 0;
  if (bug("a body looks everywhere at once")) changed.vehicle = {};
  if (bug("a loiter circle is a point"))
    changed.separation.distance_m -= 2 * loiter_radius_m(motion_of(mission, 0));
  if (bug("walls are air")) changed.walls.clear();
  if (bug("walls keep half of their clearance")) changed.wall_clearance_m /= 2;
  if (bug("a loiter circle may reach into walls"))
    changed.wall_clearance_m -= loiter_radius_m(motion_of(mission, 0));
  if (bug("nobody knows of position errors")) changed.separation.position_error_m = 0;
  if (bug("edges count afterwards")) {
    changed.domain.origin_m.head<2>().array() -= 1000;
    changed.domain.size_m.head<2>().array() += 2000;
  }
  real_make_filter(self, changed, hold_ticks);
}

SafeVelocity bug_safe(SeparationFilter* self, const Mover& mover, const Eigen::Vector3d& wanted_mps,
                      std::span<const Neighbour> others) {
  if (bug("bodies are no bodies")) return {wanted_mps};
  if (bug("nobody brakes before walls")) {
    Mover standing = mover;
    standing.velocity_mps.setZero();
    return real_safe(self, standing, wanted_mps, misjudged(self, mover, others));
  }
  return real_safe(self, mover, wanted_mps, misjudged(self, mover, others));
}

namespace {

/// The messages that a book's owner has received.
struct Overheard {
  std::map<AgentId, Tick> heard;  // tick of the newest beacon
  std::map<AgentId, bool> known;  // ever
  std::vector<Neighbour> sent;
};
std::map<const BeaconBook*, Overheard> overheard;

}  // namespace

void bug_make_book(BeaconBook* self, const Mission& mission, const Author& author,
                   std::int64_t revision) {
  overheard[self] = {};  // clears the book of another mission
  real_make_book(self, mission, author, revision);
}

void bug_receive_beacon(BeaconBook* self, const Beacon& beacon, bool fresh, const Moment& now) {
  if (fresh) overheard[self].heard[beacon.header.sender] = now.tick;
  real_receive_beacon(self, beacon, fresh, now);
}

std::span<const Neighbour> bug_bodies(BeaconBook* self, const Eigen::Vector3d& x_m,
                                      const Moment& now) {
  const auto bodies = real_bodies(self, x_m, now);
  Overheard& memory = overheard[self];
  memory.sent.assign(bodies.begin(), bodies.end());
  for (Neighbour& body : memory.sent) {
    memory.known[body.id] = memory.known[body.id] || body.known;
    if (bug("places of beacons are always new")) body.age_ticks = 0;
    if (bug("a beacon's age counts from its arrival"))
      body.age_ticks = std::min(body.age_ticks, now.tick - memory.heard[body.id]);
    if (bug("nobody keeps to the lease")) body.known = memory.known[body.id];
  }
  return memory.sent;
}

bool bug_filters_again(const Mission& mission) {
  return real_filters_again(mission) && !bug("held commands know no walls");
}

// ---- pauses ----

namespace {

/// Whether the current agent misinterprets pauses.
bool one_agent_acts = false;
class Acting {
 public:
  explicit Acting(const Agent& agent) { one_agent_acts = agent.id() == 2; }
  ~Acting() { one_agent_acts = false; }
};

/// The delay after which it continues, relative to the others.
constexpr Tick kLate = 3;

/// The pauses as the current agent interprets them.
std::vector<Hold> misread(std::span<const Hold> holds) {
  std::vector<Hold> taken(holds.begin(), holds.end());
  if (!one_agent_acts) return taken;
  if (bug("one agent ignores pauses")) taken.clear();
  if (bug("one agent misses the second pause") && taken.size() > 1) taken.erase(taken.begin() + 1);
  for (Hold& hold : taken) {
    if (bug("one agent goes on later") && !hold.open()) hold.until += kLate;
  }
  return taken;
}

}  // namespace

bool bug_is_held(std::span<const Hold> holds, Tick tick) {
  return real_is_held(misread(holds), tick);
}

Tick bug_counted_ticks(std::span<const Hold> holds, Tick tick) {
  return real_counted_ticks(misread(holds), tick);
}

Tick bug_tick_after(std::span<const Hold> holds, Tick count) {
  return bug("the end does not move") ? count : real_tick_after(holds, count);
}

Eigen::Vector3d bug_go_home(WayHome* self, const Eigen::Vector3d& x_m,
                            const Eigen::Vector3d& v_mps) {
  if (bug("a recalled agent stays where it is")) return {0, 0, 0};
  return real_go_home(self, x_m, v_mps);
}

/// A second and a half late.
bool bug_goes_home(WayHome* self, Tick counted, const Eigen::Vector3d& x_m) {
  return real_goes_home(self, bug("an agent goes home late") ? counted - 15 : counted, x_m);
}

// ---- coverage ----

void bug_set_quality(CoverageTable* self, const Author& author, double quality) {
  real_set_quality(self, author, bug("a quality does not count") ? 1 : quality);
}

void bug_add_sample(CoverageTable* self, const Author& author, const BasisAt& at,
                    const double* footprint) {
  if (bug("a backup is put back")) {
    static std::map<CoverageTable*, CoverageTable> backup;
    const auto steps = self->steps_held(author).value_or(0);
    if (steps == kUnderWay) backup.insert_or_assign(self, *self);
    if (steps == 2 * kUnderWay) *self = backup.at(self);
  }
  real_add_sample(self, author, at, footprint);
  if (bug("a sample counts twice")) real_add_sample(self, author, at, footprint);
}

namespace {

/// The agent that receives a message now, and whether a teammate repeats it.
const Agent* listener;
bool is_relayed;

/// The content of a table, for a forecast that misreads it.
struct Sent {
  Basis basis;
  double dt_s;
  Tick joined;
  struct Blocks {
    Contribution before, held;
  };
  std::map<std::pair<Author, int>, Blocks> blocks;
};
std::map<const CoverageTable*, Sent> sent_to;

/// Whether another incarnation of this agent has sent a block after `tick`.
bool is_replaced(const CoverageTable& table, const Author& author, Tick tick) {
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Author& other = table.author(row);
    if (other.agent == author.agent && other != author && table.view(row, 0).tick > tick)
      return true;
  }
  return false;
}

void note(const CoverageTable* table, const Contribution& theirs, Merge merged) {
  Sent::Blocks& blocks = sent_to.at(table).blocks[{theirs.author(), theirs.block}];
  if (merged == Merge::kNewer) blocks = {blocks.held, theirs};
  const bool is_old = merged == Merge::kStale && theirs.steps < blocks.held.steps;
  if (is_old && bug("a late block becomes the one before")) blocks.before = theirs;
  if (is_old && is_relayed && bug("a relayed block becomes the one before")) blocks.before = theirs;
}

}  // namespace

void bug_make_table(CoverageTable* self, const Basis& basis, double dt_s, Tick joined) {
  real_make_table(self, basis, dt_s, joined);
  sent_to[self] = {basis, dt_s, joined, {}};
}

namespace {

/// The same roster, in which no agent was sent home. Those that were sent out still are.
std::vector<RosterEntry> without_recalls(std::vector<RosterEntry> roster) {
  for (RosterEntry& entry : roster) {
    if (!entry.leaves) entry.recall_revision = -1;
  }
  return roster;
}

}  // namespace

void bug_receive_at_agent(Agent* self, const Message& message, Bus bus, AgentId transmitter,
                          Instant now) {
  listener = self;
  is_relayed = transmitter != header_of(message).sender;
  const Acting acting(*self);
  if (bug("digests are ignored") && std::holds_alternative<Digest>(message)) return;
  if (const auto* state = std::get_if<WorldState>(&message);
      state != nullptr && bug("a late state is taken for the newest")) {
    WorldState taken = *state;
    if (taken.header.tick < self->tick()) taken.header.tick = self->tick() + 1;
    return real_receive_at_agent(self, taken, bus, transmitter, now);
  }
  if (const auto* part = std::get_if<MissionPart>(&message);
      part != nullptr && bug("recalls are ignored")) {
    MissionPart taken = *part;
    taken.roster = without_recalls(part->roster);
    return real_receive_at_agent(self, taken, bus, transmitter, now);
  }
  real_receive_at_agent(self, message, bus, transmitter, now);
}

Merge bug_merge(CoverageTable* self, const Contribution& theirs, std::int64_t max_steps) {
  if (bug("an honest block is refused") && theirs.steps > kUnderWay) return Merge::kRefusedRange;
  if (bug("one agent's rows are dropped") && theirs.author().agent == 0) return Merge::kStale;
  if (bug("a replaced incarnation is ignored") &&
      is_replaced(*self, theirs.author(), theirs.header.tick))
    return Merge::kStale;
  Contribution changed = theirs;
  // Still within the rounding that a receiver allows.
  if (bug("a receiver rounds") && theirs.block == 0) changed.sums.edit()[0] *= 1 + 5e-10;
  if (bug("a receiver mixes up modes")) {
    for (std::size_t k = 1; k < changed.sums.size(); ++k) changed.sums.edit()[k] *= -1;
  }
  if (bug("a block's age counts from its arrival")) {
    changed.header.tick = std::max(changed.header.tick, listener->tick());
  }
  const Merge merged = real_merge(self, changed, max_steps);
  note(self, theirs, merged);
  return merged;
}

Contribution bug_block(const CoverageTable* self, const Author& author, int block) {
  Contribution out = real_block(self, author, block);
  if (bug("a sum runs away")) out.sums.edit()[5] += 2 * out.elapsed_s;
  return out;
}

void bug_average(const CoverageTable* self, Coefficients& coverage) {
  if (bug("a replaced incarnation counts twice")) {
    CoverageTable other = *self;
    for (std::size_t row = 0; row < other.row_count(); ++row) {
      if (is_replaced(other, other.author(row), other.view(row, 0).tick))
        real_set_quality(&other, other.author(row), 2 * other.quality(row));
    }
    return real_average(&other, coverage);
  }
  real_average(self, coverage);
  if (bug("the average is off")) coverage[2] += 1e-6;
}

// ---- forecasts ----

namespace {

/// Longer than any mission of the test.
constexpr Tick kForEver = 10000;

bool the_dead_are_foreseen() { return bug("the dead are foreseen for ever"); }
bool foresees_itself() { return bug("an agent foresees itself"); }

/// The table as it would be with other messages.
CoverageTable mistaken(const CoverageTable& table, Tick tick) {
  const Sent& sent = sent_to.at(&table);
  CoverageTable other(sent.basis, sent.dt_s, sent.joined);
  const auto merge = [&](Contribution block) {
    if (the_dead_are_foreseen()) block.next_broadcast_tick += kForEver;
    real_merge(&other, block, kForEver);
  };
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const Author& author = table.author(row);
    other.add_row(author);
    for (int b = 0; b < table.block_count(); ++b) {
      const auto heard = sent.blocks.find({author, b});
      Contribution own = real_block(&table, author, b);
      own.header.tick = tick;
      if (heard == sent.blocks.end()) {
        merge(own);
      } else {
        merge(heard->second.before);
        merge(heard->second.held);
      }
    }
    if (!table.counts(row)) other.forget(author);
  }
  return other;
}

}  // namespace

void bug_make_forecast(Forecast* self, const Mission& mission, const Author& author) {
  Mission changed = mission;
  if (the_dead_are_foreseen()) changed.timing.broadcast_period_ticks = kForEver;
  if (bug("a footprint is not foreseen")) {
    for (AgentKind& kind : changed.kinds) kind.footprint_sigma_m = 0;
  }
  if (bug("the resting are foreseen")) {
    for (AgentKind& kind : changed.kinds) kind.stations_m.clear();
  }
  real_make_forecast(self, changed, foresees_itself() ? Author{} : author);
}

void bug_look_ahead(Forecast* self, const CoverageTable& table,
                    const std::vector<RosterEntry>& roster, Tick tick, Coefficients& coverage) {
  const bool mistakes_it = the_dead_are_foreseen() || foresees_itself() ||
                           bug("a late block becomes the one before") ||
                           bug("a relayed block becomes the one before");
  if (bug("the recalled are foreseen"))
    return real_look_ahead(self, table, without_recalls(roster), tick, coverage);
  if (!mistakes_it) return real_look_ahead(self, table, roster, tick, coverage);
  real_look_ahead(self, mistaken(table, tick), roster, tick, coverage);
}

// ---- agents ----

namespace {

/// Repeats a teammate's block in its own name.
void relay(const Agent& self, Outbox& out) {
  const CoverageTable& table = *self.coverage();
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (table.author(row) == self.author() || table.min_steps(row) == 0) continue;
    Contribution block = real_block(&table, table.author(row), 0);
    block.header.run = self.run();
    out.push_back({Bus::kSwarm, block, self.author().agent});
    return;
  }
}

bool speaks_digest(const Outgoing& outgoing) {
  return std::holds_alternative<Digest>(outgoing.message);
}

}  // namespace

/// While its mission is paused.
void ignore_pause(const Agent& self, Outbox& out) {
  if (bug("a sample counts while all stand")) {
    const Mission& mission = *self.follower().mission();
    real_add_sample(const_cast<CoverageTable*>(self.coverage()), self.author(),
                    BasisAt(mission.starts_m[0], mission.domain, mission.basis), nullptr);
  }
  for (Outgoing& one : out) {
    auto* command = std::get_if<Command>(&one.message);
    if (command != nullptr && bug("an agent creeps on")) command->velocity_mps.x() = 1e-3;
  }
}

void bug_advance(Agent* self, Instant now, Outbox& out) {
  if (bug("an agent crashes") && self->tick() == kUnderWay) std::abort();
  if (bug("an agent gives up") && self->tick() == kUnderWay) self->leave("no more");
  {
    const Acting acting(*self);
    real_advance(self, now, out);
  }
  const bool is_one_of_them = self->author().agent == 2;
  if (self->held()) ignore_pause(*self, out);
  if (bug("a newcomer is mute") && is_one_of_them) {
    std::erase_if(out,
                  [](const Outgoing& one) { return std::holds_alternative<Hello>(one.message); });
  }
  if (self->coverage() == nullptr || self->tick() < kUnderWay) return;
  if (bug("a digest exaggerates")) {
    for (Outgoing& one : out) {
      if (speaks_digest(one)) ++std::get<Digest>(one.message).entries[0].steps;
    }
  }
  if (bug("an agent repeats unasked")) relay(*self, out);
  // Answers the messages since its last one, although no block was missing.
  if (bug("an agent repeats what all have") && std::any_of(out.begin(), out.end(), speaks_digest)) {
    relay(*self, out);
  }
}

Instant bug_next_wakeup(const Agent* self) {
  const bool now = bug("an agent never sleeps") && self->tick() > kUnderWay && !self->finished();
  return now ? Instant{} : real_next_wakeup(self);
}

// ---- coordinator and world ----

namespace {

void give_away_closed_numbers(std::vector<RosterEntry>& roster) {
  for (std::size_t i = 0, count = roster.size(); i < count; ++i) {
    if (!roster[i].leaves || std::ssize(roster) == kMaxRosterEntriesPerMessage) continue;
    roster.push_back({{roster[i].author.agent, 1}, roster[i].active_from});
  }
}

}  // namespace

void bug_coordinate(Coordinator* self, Instant now, Outbox& out) {
  const bool due = self->state() == MissionState::kRunning && self->tick() > kUnderWay;
  if (due && bug("the coordinator panics")) self->end(true, "no reason", now);
  if (due && bug("the coordinator ends too early")) self->end(false, "enough", now);
  real_coordinate(self, now, out);
  if (!bug("a closed number is given away")) return;
  for (Outgoing& one : out) {
    auto* part = std::get_if<MissionPart>(&one.message);
    if (part != nullptr) give_away_closed_numbers(part->roster);
  }
}

void bug_receive_at_coordinator(Coordinator* self, const Message& message, Bus bus,
                                AgentId transmitter, Instant now) {
  const auto* status = std::get_if<AgentStatus>(&message);
  if (bug("the coordinator ignores an agent") && status != nullptr && status->header.sender == 2)
    return;
  real_receive_at_coordinator(self, message, bus, transmitter, now);
}

void bug_receive_at_world(World* self, const Message& message, Bus bus, AgentId transmitter,
                          Instant now) {
  if (bug("the world ignores the logger") && std::holds_alternative<RecordAck>(message)) return;
  if (const auto* state = std::get_if<WorldState>(&message);
      state != nullptr && bug("a restarted world takes bodies to stand")) {
    WorldState taken = *state;
    for (Vehicle& vehicle : taken.vehicles) vehicle.velocity_mps.setZero();
    return real_receive_at_world(self, taken, bus, transmitter, now);
  }
  real_receive_at_world(self, message, bus, transmitter, now);
}

namespace {

bool hangs(const World& world) {
  const auto& mission = world.follower().mission();
  return bug("the world hangs") && mission && world.tick() == mission->timing.tick_count - 1;
}

}  // namespace

void bug_turn_world(World* self, Instant now, Outbox& out) {
  if (!hangs(*self)) real_turn_world(self, now, out);
  if (bug("the world creeps on")) {
    for (Outgoing& one : out) {
      auto* state = std::get_if<WorldState>(&one.message);
      if (state != nullptr && is_held(self->follower().holds(), state->header.tick))
        state->vehicles[0].velocity_mps.x() = 1e-3;
    }
  }
  if (bug("the world keeps a tick to itself") && self->tick() == kUnderWay) {
    std::erase_if(
        out, [](const Outgoing& one) { return std::holds_alternative<WorldState>(one.message); });
  }
}

Instant bug_next_turn_of_world(const World* self) {
  return hangs(*self) ? Instant::max() : real_next_turn_of_world(self);
}

// ---- codec ----

Decoded bug_decode(std::span<const std::byte> bytes, RunId run,
                   const MessageAuthenticator& authenticator, std::string_view channel,
                   KnownSignatures* known) {
  Decoded result = real_decode(bytes, run, authenticator, channel, known);
  const bool refused = std::holds_alternative<Refusal>(result);
  if (bug("whole messages are refused") && !refused) return Refusal::kTag;
  if (bug("damage passes") && refused) return Digest{};
  return result;
}

}  // namespace ergocast
