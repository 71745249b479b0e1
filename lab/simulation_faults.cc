// SPDX-License-Identifier: BSD-3-Clause
// Crashes and cuts off simulated processes by the schedule, but never destroys all
// copies of one fact.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/portable_math.h"
#include "core/motion/zones.h"
#include "lab/random_stream.h"
#include "lab/simulation.h"
#include "plan/mission_limits.h"

namespace ergocast::lab {
namespace {

/// A random stream beside those of lab/faults.cc.
constexpr std::uint32_t kClocks = 16;

}  // namespace

double Simulation::progress_s() const {
  const double virtual_s = in_seconds(now_);
  const Timing& timing = mission_.timing;
  if (timing.pace == Pace::kRealtime) return virtual_s;
  return std::max(virtual_s,
                  static_cast<double>(last_tick_) * timing.dt_s / timing.realtime_factor);
}

void Simulation::skew_clocks() {
  const Faults& faults = options_.faults;
  if (faults.clock_rate_error <= 0 && faults.clock_offset_max_s <= 0) return;
  RandomStream random(mission_.seed, kClocks);
  for (Node& node : nodes_) {
    const double rate = 1 + faults.clock_rate_error * (2 * random.uniform() - 1);
    node.clock = SkewedClock(rate, seconds(faults.clock_offset_max_s * random.uniform()));
    ++counts_.skewed_clocks;
  }
}

void Simulation::do_faults() {
  if (!faults_.healed()) {
    operator_.end_pause(now_);
    faults_.end_due(now_, [this](const FaultEvent& event) { cut(event, true); });
    const double progress_s = this->progress_s();
    while (const FaultEvent* event = faults_.take_begin(now_, progress_s)) begin(*event);
    if (faults_.healing_due(now_, progress_s) || mission_over()) heal();
  }
  bool away = false;
  for (NodeId node = 0; node < node_count(); ++node) {
    if (!up(node) && at(node).restart <= now_) start(node);
    away |= !up(node);
  }
  if (away || faults_.hinders()) hindered_ = now_;
}

void Simulation::begin(const FaultEvent& event) {
  using enum FaultEvent::Kind;
  switch (event.kind) {
    case kSplit:
    case kOneWayCut:
      ++(event.kind == kSplit ? counts_.splits : counts_.one_way_cuts);
      cut(event, false);
      faults_.end_at(now_ + seconds(event.lasts_s), event);
      return;
    case kAgentCrash:
      counts_.agent_crashes += crash(static_cast<NodeId>(event.who), event.lasts_s);
      return;
    case kCoordinatorCrash:
      counts_.coordinator_crashes += crash(coordinator_node(), event.lasts_s);
      return;
    case kWorldCrash:
      counts_.world_crashes += crash(world_node(), event.lasts_s);
      return;
    case kPause:
      ++counts_.pauses;
      operator_.want_pause(now_, event.lasts_s);
      return;
    case kTarget:
      ++counts_.targets;
      want_target(event.who);
      return;
    case kEnd:
      ++counts_.ends;
      operator_.want_end(drawn_end(event.who));
      return;
    case kZone:
      want_zone(event.who);
      return;
    case kLaw:
      ++counts_.laws;
      operator_.want_law(drawn_law(event.who), drawn_delay(event.who));
      return;
    case kCancel:
      want_cancel(event.who);
      return;
    case kSiteCut:
      ++counts_.splits;
      cut(event, false);
      faults_.end_at(now_ + seconds(event.lasts_s), event);
      return;
    case kRecall:
    case kDeparture:
      ++counts_.recalls;
      operator_.want_recall(static_cast<AgentId>(event.who), event.kind == kDeparture);
      return;
  }
}

void Simulation::cut(const FaultEvent& event, bool join) {
  if (event.kind == FaultEvent::Kind::kSiteCut)
    return join ? network_.join_site() : network_.cut_site(static_cast<int>(event.who));
  const auto first = [&](NodeId node) { return (event.who >> (node % 64) & 1) != 0; };
  for (NodeId from = 0; from < node_count(); ++from) {
    for (NodeId to = 0; to < node_count(); ++to) {
      const bool deaf = event.kind == FaultEvent::Kind::kSplit ? first(from) != first(to)
                                                               : first(from) && !first(to);
      if (!deaf) continue;
      join ? network_.join(from, to) : network_.cut(from, to);
    }
  }
}

/// How long a target or law waits longer than necessary: as often as not not at all, so that some
/// can be undone before they hold.
Tick Simulation::drawn_delay(std::uint64_t word) const {
  constexpr double kMost_s = 6;
  RandomStream random(word, 1);
  if (random.coin()) return 0;
  return static_cast<Tick>(kMost_s * random.uniform() / mission_.timing.dt_s);
}

/// A target that no agent reaches: all is at one place, or, where modes are not cosines, between
/// the plan's target and the uniform one.
TargetChange Simulation::drawn_target(std::uint64_t word) const {
  RandomStream random(word, 0);
  TargetChange change;
  if (mission_.basis.free_domain) {
    const double share = random.uniform();
    change.target = share * mission_.target_coefficients;
    change.cosine = share * mission_.cosine_target;
    change.target[0] = change.cosine[0] = 1;
    return change;
  }
  Eigen::Vector3d x_m = mission_.domain.origin_m;
  for (int axis = 0; axis < 3; ++axis) x_m[axis] += random.uniform() * mission_.domain.size_m[axis];
  change.target = basis_values(x_m, mission_.domain, mission_.basis);
  return change;
}

/// A target. A team that searches gets it, as often as not, with a sighting, or a contact is
/// dismissed in its place.
void Simulation::want_target(std::uint64_t word) {
  RandomStream random(word, 2);
  std::optional<SearchNote> note;
  if (mission_.law.kind == LawKind::kSearch && random.coin()) {
    const Box& domain = mission_.domain;
    note.emplace();
    for (int axis = 0; axis < 2; ++axis)
      note->x_m[axis] = domain.origin_m[axis] + random.uniform() * domain.size_m[axis];
    if (mission_.sensor.has_false_alarms() && random.coin()) return operator_.want_dismissal(*note);
    note->sigma_m = (0.02 + 0.2 * random.uniform()) * domain.shortest_side_m();
    note->share = 0.1 + 0.8 * random.uniform();
  }
  operator_.want_target(drawn_target(word), drawn_delay(word), note);
}

/// An end between four fifths and six fifths of the plan's time.
Tick Simulation::drawn_end(std::uint64_t word) const {
  const auto planned = static_cast<double>(mission_.timing.tick_count);
  const double share = 0.8 + 0.4 * RandomStream(word, 0).uniform();
  return std::max<Tick>(1, std::llround(share * planned));
}

/// Slower agents, each kind by itself, with more or less noise than the plan has.
LawChange Simulation::drawn_law(std::uint64_t word) const {
  RandomStream random(word, 0);
  LawChange change = plans_law(mission_);
  for (LawNumbers& numbers : change.kinds) {
    const double noise = 1.5 * random.uniform();
    numbers.u_max_mps *= 0.3 + 0.7 * random.uniform();
    numbers.noise_intensity *= noise;
    if (mission_.law.perturbation == Perturbation::kAdaptive) numbers.noise_ceiling *= noise;
  }
  return is_law(change, mission_) ? change : plans_law(mission_);
}

/// Whether there is a coordinator that an operator may ask.
bool Simulation::takes_orders() const {
  const NodeId node = coordinator_node();
  return up(node) && !finished(node) && coordinator().state() == MissionState::kRunning;
}

/// Undoes the newest target, end or law, or any zone, as `ergocast amend --cancel` does, if there
/// is one.
void Simulation::want_cancel(std::uint64_t word) {
  if (!takes_orders()) return;
  const auto& [named, recent, holds, targets, ends, zones, laws, notes] =
      coordinator().amendments();
  const auto before = [](const auto& changes, auto plans) {
    return changes.size() > 1 ? changes[changes.size() - 2] : plans;
  };
  constexpr int kKinds = 4;
  const std::uint64_t kind = word % kKinds, which = word / kKinds;
  const auto count = counts_.cancels++;
  if (kind == 0 && !targets.empty())
    return operator_.want_target(before(
        targets,
        TargetChange{.target = mission_.target_coefficients, .cosine = mission_.cosine_target}));
  if (kind == 1 && !ends.empty())
    return operator_.want_end(
        before(ends, EndChange{.tick_count = mission_.timing.tick_count}).tick_count);
  if (kind == 2 && !laws.empty()) return operator_.want_law(before(laws, plans_law(mission_)));
  if (kind == 3 && !zones.empty())
    return operator_.want_no_zone(zones[which % zones.size()].number);
  counts_.cancels = count;
}

/// Asks for a polygon somewhere in the domain, if one of some is possible: of three to seven
/// corners around a place, so that it may have dents.
void Simulation::want_zone(std::uint64_t word) {
  constexpr int kAttempts = 4;
  RandomStream random(word, 0);
  if (!takes_orders()) return;
  const auto& others = coordinator().amendments().zones;
  const Box& domain = mission_.domain;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const Eigen::Vector2d center_m =
        domain.origin_m.head<2>() +
        domain.size_m.head<2>().cwiseProduct(Eigen::Vector2d(random.uniform(), random.uniform()));
    const int corners = 3 + static_cast<int>(5 * random.uniform());
    const double size_m = (0.05 + 0.3 * random.uniform()) * domain.shortest_side_m();
    const double turn = 2 * std::numbers::pi * random.uniform();
    Zone zone;
    for (int i = 0; i < corners; ++i) {
      const double angle = turn + 2 * std::numbers::pi * i / corners;
      const double far_m = size_m * (0.4 + 0.6 * random.uniform());
      zone.corners_m.push_back(center_m +
                               far_m * Eigen::Vector2d(portable::cos(angle), portable::sin(angle)));
    }
    if (!domain.planar()) {
      zone.low_m = domain.origin_m.z() + domain.size_m.z() * (0.7 * random.uniform() - 0.1);
      zone.high_m = zone.low_m + domain.size_m.z() * (0.1 + 0.5 * random.uniform());
    }
    zone.until = 1 + static_cast<Tick>(20 * random.uniform() / mission_.timing.dt_s);
    if (!is_zone(zone, domain) || zone_problem(mission_, zone, others)) continue;
    ++counts_.zones;
    return operator_.want_zone(zone, least_notice_ticks(mission_, zone, others), now_);
  }
}

void Simulation::send_to_coordinator() {
  const NodeId node = coordinator_node();
  if (operator_.idle()) return;
  if (!up(node) || finished(node) || coordinator().looking() || mission_over()) return;
  const auto pause = operator_.message(now_, run_, coordinator());
  const Delivery by_operator{Bus::kSwarm, kOperator, {}, nullptr};
  if (pause) deliver(node, *pause, by_operator);
  for (const Amend& part : operator_.targets(now_, run_, coordinator()))
    deliver(node, part, by_operator);
  for (const Amend& part : operator_.ends(now_, run_, coordinator()))
    deliver(node, part, by_operator);
  for (const Amend& part : operator_.zones(now_, run_, coordinator()))
    deliver(node, part, by_operator);
  if (const auto cancel = operator_.cancelled_zone(now_, run_, coordinator()))
    deliver(node, *cancel, by_operator);
  if (const auto dismissal = operator_.dismissal(now_, run_, coordinator()))
    deliver(node, *dismissal, by_operator);
  for (const Amend& part : operator_.laws(now_, run_, coordinator()))
    deliver(node, part, by_operator);
  // The operator repeats it; only the first one has an effect.
  const std::vector<Recall> recalls = operator_.recalls(run_, coordinator());
  for (const Recall& recall : recalls) {
    deliver(node, recall, by_operator);
    deliver(node, recall, by_operator);
  }
  if (!recalls.empty()) operator_.forget_refused(coordinator());
}

/// An evicted agent has ended, and sends nothing any more.
bool Simulation::anybody_else_knows_the_mission(NodeId but) const {
  for (NodeId node = 0; node < agent_count_; ++node) {
    if (node == but || !up(node) || finished(node)) continue;
    if (agent(node).follower().mission()) return true;
  }
  return false;
}

/// Only the world and, by its last commands, the agent know a vehicle's position. Only the
/// coordinator and the agents that follow it know the mission. A process that alone knows something
/// does not crash.
bool Simulation::may_crash(NodeId node) const {
  if (!up(node) || at(node).starts >= kMaxIncarnationsPerAgent - 2) return false;
  if (mission_over()) return false;
  const bool world_knows = up(world_node()) && world().begun_at();
  if (node < agent_count_) {
    const bool coordinator_knows = up(coordinator_node()) && coordinator().mission() != nullptr;
    if (!coordinator_knows && !anybody_else_knows_the_mission(node)) return false;
    return world_knows || last_tick_ < 0;
  }
  if (node == coordinator_node()) return anybody_else_knows_the_mission(kMaxNodes);
  return world_knows && std::all_of(nodes_.begin(), nodes_.begin() + agent_count_,
                                    [](const Node& agent) { return agent.up && agent.answered; });
}

bool Simulation::crash(NodeId node, double lasts_s) {
  if (!may_crash(node)) return false;
  at(node).up = false;
  at(node).restart = now_ + seconds(lasts_s);
  return true;
}

/// Acts like an init system: restarts a coordinator that found no mission to take over.
void Simulation::supervise_coordinator() {
  Node& node = at(coordinator_node());
  if (faults_.healed() || !node.up || !coordinator().finished() || mission_over()) return;
  if (coordinator().mission() != nullptr) return;
  ++counts_.coordinator_crashes;
  node.up = false;
  node.restart = now_;
}

void Simulation::heal() {
  faults_.heal();
  operator_.want_no_pause();
  network_.heal(now_);
  for (Node& node : nodes_) {
    if (!node.up) node.restart = now_;
  }
  if (observer_ != nullptr) observer_->healed();
}

}  // namespace ergocast::lab
