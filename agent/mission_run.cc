// SPDX-License-Identifier: BSD-3-Clause
// What an agent does at a tick of the world: it samples, broadcasts, answers and helps its
// teammates.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>
#include <utility>

#include "agent/agent.h"
#include "core/station.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr auto kDigestPeriod = 1s;
constexpr double kDigestMissionPeriod_s = 1.0;
/// An agent that gets no new tick broadcasts what it has, this often.
constexpr auto kStallPeriod = 1s;

/// Writes into `block` what it has gained since the broadcast `before`. A block that is sent again
/// within a tick keeps its gains.
void note_gains(const Contribution& before, Contribution& block) {
  if (before.steps == block.steps) {
    block.gains = before.gains;
    block.gained_steps = before.gained_steps;
    return;
  }
  block.gained_steps = block.steps - before.steps;
  const std::span<double> gains = block.gains.set_all(block.sums.size());
  const double *now = block.sums.data(), *then = before.sums.data();
  for (std::size_t k = 0; k < gains.size(); ++k) gains[k] = now[k] - then[k];
}

}  // namespace

void Agent::advance_mission(InMission& mission_run, Instant now, Outbox& out) {
  if (may_begin(mission_run) && !begin_tick(mission_run, now, out)) return;
  const Step& step = mission_run.step;
  if (step.repeat_wanted) repeat(mission_run, out);
  if (step.answered < step.tick && may_answer(mission_run)) answer(mission_run, out);
  if (stalled(mission_run, now)) {
    mission_run.stall_announced = now;
    broadcast(mission_run, true, out);
  }
  if (!me_.cut_off(step.tick, now)) return;
  finish(true,
         "nothing arrives from the world or the coordinator, and the mission must be over by now: "
         "check this host's network");
}

/// Gives the forecast the positions of vehicles in range. In real time a vehicle stands still once
/// its last answer is older than the world holds a command. In lockstep the world waits for
/// answers.
void Agent::note_places(InMission& mission_run, const WorldState& world) {
  const Timing& timing = mission().timing;
  mission_run.state_parts.see(world);
  // Nothing is covered at a held tick, and no vehicle moves on before the mission continues.
  if (me_.is_held(world.header.tick)) return;
  const Tick tick = world.header.tick;
  const auto hold =
      static_cast<Tick>(std::max(1.0, std::ceil(timing.command_hold_s / timing.dt_s)));
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    if (!radio_.receives(me_.id(), vehicle.id)) continue;
    if (timing.pace == Pace::kRealtime && vehicle.answered_tick < tick - hold) continue;
    mission_run.forecast->see(vehicle.id, me_.counted(tick), vehicle.position_m);
  }
}

/// Lockstep: an agent needs the revision that the world names, which decides whether the tick
/// counts and which agents take part. A restarted world may have continued before all agents knew
/// it.
bool Agent::may_begin(const InMission& mission_run) const {
  if (!mission_run.pending) return false;
  return mission().timing.pace == Pace::kRealtime ||
         follower().revision() >= mission_run.pending->roster_revision;
}

/// False if the mission is over for us; `mission_run` is then no longer valid.
bool Agent::begin_tick(InMission& mission_run, Instant now, Outbox& out) {
  const Mission& mission = me_.mission();
  const WorldView view = *mission_run.pending;
  Step& step = mission_run.step;
  mission_run.pending.reset();
  step.repeat_wanted = false;
  if (me_.is_over(view.tick)) {
    step.tick = view.tick;
    finish(false, "mission complete");
    return false;
  }
  if (const auto why = evicted(view.tick)) {
    finish(true, *why);
    return false;
  }
  if (step.tick >= 0) status_.missed_ticks += view.tick - step.tick - 1;
  step.tick = view.tick;
  step.counted = me_.counted(view.tick);
  step.held = me_.is_held(view.tick);
  step.begun = now;
  step.roster_revision = view.roster_revision;
  step.body_m = view.position_m;
  step.body_mps = view.velocity_mps;
  step.x_m = mission.domain.nearest(view.position_m);
  step.basis_at.emplace(step.x_m, mission.domain, mission.basis);
  if (mission_run.beacons) publish_place(mission_run, view, out);
  // A restarted world may be a tick behind the roster. Our predecessor has covered that tick.
  if (step.tick < mission_run.active_from || step.held) return true;
  if (!rests(mission, me_.id(), step.counted))
    mission_run.table.add_sample(me_.author(), *step.basis_at,
                                 mission_run.sensors.of(mission_run.kind).footprint());
  broadcast(mission_run, false, out);
  return true;
}

void Agent::publish_place(InMission& mission_run, const WorldView& view, Outbox& out) {
  mission_run.beacons->measured(view.answered_tick, view.roster_revision, view.position_m,
                                view.velocity_mps);
  const auto beacon = mission_run.beacons->next(follower().revision(),
                                                {mission_run.step.tick, mission_run.step.begun});
  if (beacon) me_.publish(Bus::kSwarm, *beacon, mission_run.step.tick, out);
}

/// Whether ticks have stopped in real time, so that the agent broadcasts what it has. In lockstep
/// no broadcast may come before the one that was announced. In a pause there is nothing new to
/// send, and an agent that joined during it has no coverage at all.
bool Agent::stalled(const InMission& mission_run, Instant now) const {
  return mission().timing.pace == Pace::kRealtime && !mission_run.step.held &&
         mission_run.step.tick >= mission_run.active_from &&
         now - std::max(mission_run.step.begun, mission_run.stall_announced) >= kStallPeriod;
}

/// Broadcasts the blocks that are due, or all. An agent that learns late of a pause has counted too
/// many ticks. The tick that it announced is then too late, so it broadcasts at once.
void Agent::broadcast(InMission& mission_run, bool all, Outbox& out) {
  const Tick tick = mission_run.step.counted;
  for (int b = 0; b < mission_run.table.block_count(); ++b) {
    Contribution& published = mission_run.published[static_cast<std::size_t>(b)];
    const bool counted_less = tick < published.header.tick;
    if (!all && !counted_less && tick < published.next_broadcast_tick) continue;
    Contribution block = mission_run.table.block(me_.author(), b);
    if (block.encoding == ContributionEncoding::kFixed16) note_gains(published, block);
    block.header.tick = tick;  // repeats keep it: forecasts count a block's age from it
    block.next_broadcast_tick = next_broadcast(mission(), me_.id(), tick, b);
    me_.publish(Bus::kSwarm, block, tick, out);
    published = std::move(block);
  }
}

void Agent::repeat(InMission& mission_run, Outbox& out) {
  Step& step = mission_run.step;
  step.repeat_wanted = false;
  // Repeats the blocks as they were broadcast: newer sums would make a tick depend on losses.
  for (const Contribution& block : mission_run.published) {
    if (block.steps > 0) me_.publish(Bus::kSwarm, block, block.header.tick, out);
  }
  if (step.answered == step.tick)
    me_.publish(Bus::kCommand, mission_run.last_command, step.tick, out);
}

bool Agent::may_answer(InMission& mission_run) const {
  Step& step = mission_run.step;
  step.waiting_for = kUnassigned;
  // An agent answers only once it knows the position of every body.
  if (mission_run.separation && !mission_run.beacons && !mission_run.bodies.complete(step.tick)) {
    step.waiting_for = kWorld;
    return false;
  }
  if (mission().timing.pace == Pace::kRealtime) return true;
  // A command must not depend on the order in which the parts of the state arrive.
  const bool dead_reckons = mission_run.forecast && mission().dead_reckoning &&
                            step.tick >= mission_run.active_from && !step.held;
  if (dead_reckons && !mission_run.state_parts.complete(step.tick)) {
    step.waiting_for = kWorld;
    return false;
  }
  if (step.held) return true;  // no agent broadcasts in a pause
  for (const RosterEntry& entry : follower().roster()) {
    if (entry.author == me_.author() || !entry.active_at(step.tick)) continue;
    if (!radio_.receives(me_.id(), entry.author.agent)) continue;
    // An agent that rests since its admission never broadcasts.
    if (rests(mission(), entry.author.agent, me_.counted(entry.active_from))) continue;
    if (!mission_run.table.holds_due(entry.author, step.counted)) {
      step.waiting_for = entry.author.agent;
      return false;
    }
  }
  return true;
}

void Agent::answer(InMission& mission_run, Outbox& out) {
  Step& step = mission_run.step;
  mission_run.command_before = mission_run.last_command;
  mission_run.last_command.header.tick = step.tick;
  mission_run.last_command.position_m = step.x_m;
  forget_silent(mission_run);
  mission_run.last_command.velocity_mps = kept_apart(mission_run, wanted(mission_run));
  step.answered = step.tick;
  if (mission_run.beacons) mission_run.beacons->commands({step.tick, step.begun});
  me_.publish(Bus::kCommand, mission_run.last_command, step.tick, out);
}

/// Forgets by the roster that the tick may have waited for, never by an older one. The admission of
/// a forgotten agent may have been lost with its coordinator. This also runs in a pause, because
/// forgetting goes by the world's ticks, and the agent then reports the c_k that counts.
void Agent::forget_silent(InMission& mission_run) const {
  const Step& step = mission_run.step;
  mission_run.table.remember_all();
  for (const RosterEntry& entry : follower().roster()) {
    // Our own coverage always counts: we run, even if the coordinator receives nothing from us.
    if (entry.author == me_.author()) continue;
    if (entry.forgotten_at(step.tick, step.roster_revision)) mission_run.table.forget(entry.author);
  }
}

/// The velocity of the law, or of the way home. It is zero in a pause, so that the vehicle brakes,
/// then stands or loiters.
Eigen::Vector3d Agent::wanted(InMission& mission_run) {
  const Step& step = mission_run.step;
  if (step.held) return {0, 0, 0};
  const CoverageTable& table = mission_run.table;
  if (mission_run.forecast) {
    mission_run.forecast->look_ahead(table, counted_roster(), step.counted, mission_run.foreseen);
  } else {
    table.average(mission_run.foreseen);
  }
  mission_run.controller.set_coverage(mission_run.foreseen);
  if (mission_run.way_home && mission_run.way_home->begun(step.counted, step.x_m))
    return mission_run.way_home->velocity_mps(step.body_m, step.body_mps);
  return mission_run.controller.command(me_.id(), step.counted, step.x_m, *step.basis_at);
}

/// The last step of a command: makes the wanted velocity safe, and counts blocked ticks.
Eigen::Vector3d Agent::kept_apart(InMission& mission_run, const Eigen::Vector3d& wanted_mps) {
  if (!mission_run.separation) return wanted_mps;
  const bool goes_home = mission_run.way_home && mission_run.way_home->begun();
  const Eigen::Vector3d aim_mps =
      mission_run.follower && !goes_home
          ? mission_run.follower->aim(mission_run.step.tick, mission_run.step.body_m, wanted_mps)
          : wanted_mps;
  const SafeVelocity safe = safe_velocity(mission_run, aim_mps);
  if (mission_run.follower) mission_run.follower->note(safe.wall);
  status_.blocked_by = safe.blocked ? safe.by : kUnassigned;
  status_.blocked_now_ticks = safe.blocked ? status_.blocked_now_ticks + 1 : 0;
  status_.blocked_ticks += safe.blocked ? 1 : 0;
  status_.longest_block_ticks = std::max(status_.longest_block_ticks, status_.blocked_now_ticks);
  return safe.velocity_mps;
}

SafeVelocity Agent::safe_velocity(InMission& mission_run, const Eigen::Vector3d& aim_mps) {
  const Step& step = mission_run.step;
  // A newer roster may have a body that we do not know of.
  if (mission_run.beacons && follower().revision() < step.roster_revision)
    return {.blocked = true, .blind = true};
  const auto others = mission_run.beacons
                          ? mission_run.beacons->bodies(step.body_m, {step.tick, step.begun})
                          : mission_run.bodies.neighbours(mission());
  const double limit_mps = motion_of(mission(), me_.id()).speed_limit_mps;
  const Mover self{me_.id(), step.tick, step.body_m, limit_mps, step.body_mps};
  return mission_run.separation->safe(self, aim_mps, others);
}

void Agent::answer_digests(InMission& mission_run, Instant now, Outbox& out) {
  const Tick tick = mission_run.step.counted;
  if (mission_run.asking_world) report_position(mission_run, out);
  for (const Contribution& block :
       mission_run.anti_entropy.answers_due(mission_run.table, now, tick)) {
    me_.relay(Bus::kSwarm, block, out);
  }
  if (!mission_run.next_digest.due(now, tick)) return;
  mission_run.next_digest =
      Deadline::in(kDigestPeriod, now, kDigestMissionPeriod_s, mission().timing.dt_s, tick);
  const Digest digest = mission_run.anti_entropy.digest(mission_run.table, counted_roster(), tick);
  me_.publish(Bus::kSwarm, digest, std::max<Tick>(mission_run.step.tick, 0), out);
}

void Agent::report_position(InMission& mission_run, Outbox& out) {
  // Only agents still know where the vehicles of departed agents stand.
  for (const WorldState& state : mission_run.bodies.states()) out.push_back({Bus::kCommand, state});
  for (Command command : {mission_run.command_before, mission_run.last_command}) {
    command.asked_by = *mission_run.asking_world;
    me_.publish(Bus::kCommand, command, command.header.tick, out);
  }
  mission_run.asking_world.reset();
}

}  // namespace ergocast
