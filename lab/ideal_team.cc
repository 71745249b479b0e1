// SPDX-License-Identifier: BSD-3-Clause
// Steps all agents on one shared coverage, with the additions in the order of a coverage table.
#include "lab/ideal_team.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/base/geometry.h"
#include "core/base/vectorized.h"
#include "core/mission/station.h"
#include "core/motion/filter_rules.h"
#include "core/motion/push.h"
#include "core/motion/vehicle.h"
#include "lab/site_exchange.h"

namespace ergocast::lab {
namespace {

/// The mission with its modes in the order of the basis also in blocks, as they are here.
Mission in_basis_order(Mission mission) {
  mission.timing.high_mode_period_factor = 1;
  return mission;
}

}  // namespace

IdealTeam::IdealTeam(Mission mission, Edges edges, const LawMaker& laws)
    : mission_(std::move(mission)),
      edges_(edges),
      table_(mission_.basis, mission_.timing.dt_s),
      look_ahead_(mission_),
      coverage_(Coefficients::Zero(mission_.basis.mode_count())),
      earlier_(static_cast<std::size_t>(mission_.basis.mode_count())),
      shift_(in_basis_order(mission_)),
      sensors_(mission_),
      metric_(mission_) {
  table_.set_half_life(HalfLife(mission_));
  std::map<int, Law*> law_of_kind;
  for (const Eigen::Vector3d& start_m : mission_.starts_m) {
    const Author author{static_cast<AgentId>(agents_.size()), 1};
    const int kind = planned_kind(mission_, author.agent);
    table_.add_row(author);
    table_.set_quality(author, sensors_.of(kind).quality);
    const Motion motion = motion_of(mission_, author.agent);
    Law*& law = law_of_kind[kind];
    if (law == nullptr || !needs_.serves_all) {
      laws_.push_back(laws(mission_, kind));
      law = laws_.back().get();
      if (laws_.size() == 1) needs_ = law->needs();
      if (law->needs() != needs_) throw std::logic_error("the laws of a mission differ in needs()");
    }
    team_.push_back(author.agent);
    agents_.push_back({author,
                       kind,
                       law,
                       motion,
                       filters_commands(mission_, author.agent),
                       start_m,
                       first_velocity(motion, start_m),
                       {0, 0, 0},
                       {0, 0, 0},
                       std::nullopt,
                       earlier_,
                       earlier_,
                       earlier_});
    if (follows_walls(mission_)) agents_.back().follower.emplace(mission_, author.agent);
  }
  foresees_ = needs_.coverage && look_ahead_.any();
  if (needs_.search) {
    efforts_.emplace(mission_);
    objects_ = Objects(mission_);
    reports_ = Reports(mission_);
  }
  for (const Agent& agent : agents_) {
    if (efforts_) efforts_->add_row(agent.author);
  }
  if (needs_.places) places_.reserve(agents_.size());
  if (any_filtered(mission_)) separation_.emplace(mission_, 0);
  bodies_.resize(separation_ ? agents_.size() : 0);
  const TeamSites& sites = mission_.sites;
  if (sites.any()) divide({sites.count, sites.row_period_ticks, 0});
}

IdealTeam::IdealTeam(IdealTeam&&) noexcept = default;
IdealTeam::~IdealTeam() = default;

bool IdealTeam::stands_for(const Mission& mission, const LawNeeds& needs) {
  const Timing& timing = mission.timing;
  const bool all_is_sent = longest_period_ticks(timing) == 1;
  const bool all_is_known = !needs.coverage || (looks_ahead(mission) && mission.dead_reckoning);
  const bool is_exact = timing.contribution_encoding == ContributionEncoding::kDouble;
  if (mission.sites.any()) return true;  // no other team has sites
  return is_exact && timing.pace == Pace::kLockstep && mission.radio_range_m == 0 &&
         (all_is_sent || all_is_known) && !needs.search && !any_station(mission) &&
         mission.objects.end_when_found == 0;
}

void IdealTeam::divide(const SiteRules& rules) {
  if (rules.sites < 1 || static_cast<std::size_t>(rules.sites) > agents_.size() || !foresees_ ||
      needs_.places || needs_.search || !mission_.dead_reckoning || HalfLife(mission_).any())
    throw std::logic_error("the laboratory cannot divide this team into sites");
  sites_ = std::make_unique<SiteExchange>(mission_, rules);
}

/// The rows of all agents at this tick, from which each site's row is summed up.
void IdealTeam::exchange() {
  const double dt_s = mission_.timing.dt_s;
  std::vector<MemberRow>& rows = sites_->rows();
  rows.clear();
  for (const Agent& agent : agents_) {
    rows.push_back({.name = {agent.author, 1},
                    .steps = tick_ + 1,
                    .elapsed_s = static_cast<double>(tick_ + 1) * dt_s,
                    .quality = quality(agent),
                    .sums = table_.sums_of(agent.author),
                    .gains = agent.gain.data(),
                    .gained_s = dt_s,
                    .lag_s = dt_s,
                    .counts_in_team = true});
  }
  sites_->update(tick_);
}

void IdealTeam::note(const Amendments& list) {
  shift_.note(list);
  law_changes_ = list.laws;
  targets_ = list.targets;
  if (efforts_) efforts_->note(list.notes, list.holds);
  if (shift_.any_of_samples()) table_.allow_shifts();
}

/// Gives each law the numbers and the target that hold at this tick.
void IdealTeam::use_amendments() {
  if (!law_changes_.empty()) {
    const LawChange* const change = law_at(law_changes_, tick_);
    for (const Agent& agent : agents_)
      agent.law->set_law(law_numbers(mission_, agent.kind, change));
  }
  const TargetChange* const target = target_at(targets_, tick_);
  if (target == nullptr || target->number == newest_target_) return;
  newest_target_ = target->number;
  for (const Agent& agent : agents_) agent.law->set_target(target->in_cosines());
}

void IdealTeam::step() {
  sample();
  use_amendments();
  if (sites_) {
    exchange();
  } else if (foresees_) {
    look_ahead();
  } else if (needs_.coverage) {
    table_.average(coverage_);
    compare_with_present();
    for (const auto& law : laws_) law->set_coverage(coverage_);
  }
  see_bodies();
  places_.clear();
  for (std::size_t i = 0; needs_.places && i < agents_.size(); ++i)
    places_.push_back({team_[i], agents_[i].x_m});
  search();
  for (Agent& agent : agents_) {
    if (sites_) {
      sites_->foresee(static_cast<std::size_t>(agent.author.agent), coverage_);
      agent.law->set_coverage(coverage_);
    } else if (foresees_) {
      foresee(agent);
      correct();
      compare_with_present();
      agent.law->set_coverage(coverage_);
    }
    const Eigen::Vector3d wanted_mps =
        agent.law->wanted_mps({agent.author.agent, tick_, agent.x_m, *agent.at, team_, places_,
                               efforts_ ? &*efforts_ : nullptr});
    agent.next_mps = executed(agent.motion, agent.v_mps, kept_apart(agent, wanted_mps));
    agent.b = agent.law->spectral_gradient();
  }
  for (Agent& agent : agents_) {
    const Eigen::Vector3d mean_mps = mean_velocity(agent.motion, agent.v_mps, agent.next_mps);
    agent.x_m = moved(mission_, agent.author.agent, tick_, agent.x_m, mean_mps);
    agent.v_mps = agent.next_mps;
    if (edges_ == Edges::kReflect) agent.x_m = reflect(agent.x_m, mission_.domain);
  }
  ++tick_;
}

void IdealTeam::search() {
  if (!efforts_) return;
  efforts_->set_now(tick_);
  for (const Agent& agent : agents_) {
    const AgentId id = agent.author.agent;
    efforts_->look(agent.author, tick_, agent.x_m);
    const ObjectSet detected = objects_.detected(id, tick_, agent.x_m);
    efforts_->report(agent.author, tick_,
                     reports_.cell(id, tick_, agent.x_m, detected, objects_.places_m()));
  }
}

void IdealTeam::see_bodies() {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    bodies_[i] = {
        agents_[i].author.agent, agents_[i].x_m, agents_[i].motion.speed_limit_mps, 0, true,
        agents_[i].v_mps};
}

/// What the filter leaves of a command: the last step, as in an agent.
Eigen::Vector3d IdealTeam::kept_apart(Agent& agent, const Eigen::Vector3d& v_mps) {
  if (!agent.filtered) return v_mps;
  const SafeVelocity safe = separation_->safe(
      {agent.author.agent, tick_, agent.x_m, agent.motion.speed_limit_mps, agent.v_mps},
      agent.follower ? agent.follower->aim(tick_, agent.x_m, v_mps) : v_mps, bodies_);
  if (agent.follower) agent.follower->note(safe.wall);
  agent.blocked_ticks = safe.blocked ? agent.blocked_ticks + 1 : 0;
  blocked_steps_ += safe.blocked ? 1 : 0;
  longest_block_ticks_ = std::max(longest_block_ticks_, agent.blocked_ticks);
  return safe.velocity_mps;
}

/// The sums of all agents at this tick, and what they gained since the last.
void IdealTeam::sample() {
  const std::int64_t halvings = table_.halvings();
  table_.set_now(tick_);
  const double kept = HalfLife::factor(halvings, table_.halvings());
  const double before_steps = table_.view(0, 0).remembered_steps;
  const TargetShift::Change* const change = shift_.of_sample(tick_);
  for (Agent& agent : agents_) {
    agent.at.emplace(agent.x_m, mission_.domain, mission_.basis);
    const double* const footprint = sensors_.of(agent.kind).footprint();
    table_.add_sample(agent.author, *agent.at, footprint);
    if (change != nullptr) table_.shift_sample(agent.author, change->by_slot.data());
    if (!foresees_) continue;
    if (mission_.dead_reckoning) {
      set_basis(*agent.at, mission_.basis, mission_.timing.dt_s, agent.gain.data());
      for (std::size_t k = 0; footprint != nullptr && k < agent.gain.size(); ++k)
        agent.gain[k] *= footprint[k];
      continue;
    }
    const double* sums = table_.sums_of(agent.author);
    for (std::size_t k = 0; k < agent.gain.size(); ++k) {
      agent.gain[k] = sums[k] - kept * agent.sent[k];
      agent.sent[k] = sums[k];
    }
  }
  gained_steps_ = mission_.dead_reckoning ? 1 : table_.view(0, 0).remembered_steps - before_steps;
}

/// Computes the parts of ĉ in core/law/forecast.h, in its order of additions, where every row was
/// sent in this tick. The sums of all agents take as many additions as those of one agent.
ERGOCAST_VECTORIZED
void IdealTeam::look_ahead() {
  const auto n = static_cast<int>(agents_.size());
  weight_s_ = look_ahead_.weight_s(look_ahead_.horizon_s(n, tick_), 1, 0, 1);
  share_ = weight_s_ / (gained_steps_ * mission_.timing.dt_s);
  weigh(agents_.front());
  std::fill(earlier_.begin(), earlier_.end(), 0);
  for (std::size_t i = agents_.size() - 1; i > 0; --i) {
    const double* sums = table_.sums_of(agents_[i].author);
    const double* gain = agents_[i].gain.data();
    const double* later = agents_[i].later.data();  // 0 for the last agent
    double* all = agents_[i - 1].later.data();
    const double q = quality(agents_[i]);
    for (std::size_t k = 0; k < earlier_.size(); ++k)
      all[k] = later[k] + q * (sums[k] + share_ * gain[k]);
  }
}

/// Sets the factors of all sums in the forecast of `agent`.
void IdealTeam::weigh(const Agent& agent) {
  double steps = 0;
  const double remembered_steps = table_.view(0, 0).remembered_steps;
  for (const Agent& each : agents_) steps += quality(each) * remembered_steps;
  double covered_s = steps * mission_.timing.dt_s;
  unshifted_s_ = 0;
  for (const Agent& other : agents_) {
    if (other.author == agent.author) continue;
    covered_s += quality(other) * weight_s_;
    unshifted_s_ += share_ * (quality(other) * mission_.timing.dt_s);
  }
  per_second_ = 1 / covered_s;
}

/// With dead reckoning a gain is f at a place, without the shift: what the forecast lacks.
void IdealTeam::correct() {
  const TargetShift::Change* const change =
      mission_.dead_reckoning ? shift_.of_sample(tick_) : nullptr;
  if (change == nullptr) return;
  const double share = unshifted_s_ * per_second_;
  for (std::size_t k = 0; k < earlier_.size(); ++k)
    coverage_[static_cast<Eigen::Index>(k)] -= change->by_slot[k] * share;
}

/// With law.history KEEP.
void IdealTeam::compare_with_present() {
  const TargetShift::Change* const present = shift_.of_coverage(tick_);
  if (present != nullptr) coverage_ -= present->by_mode;
}

/// Sets ĉ for the next agent in the order of the team.
ERGOCAST_VECTORIZED
void IdealTeam::foresee(const Agent& agent) {
  const double* own = table_.sums_of(agent.author);
  const double* gain = agent.gain.data();
  const double* later = agent.later.data();
  double* earlier = earlier_.data();
  double* foreseen = coverage_.data();
  const double q = quality(agent);
  if (!sensors_.uniform()) weigh(agent);
  for (std::size_t k = 0; k < earlier_.size(); ++k) {
    foreseen[k] = (earlier[k] + (later[k] + q * own[k])) * per_second_;
    earlier[k] += q * (own[k] + share_ * gain[k]);
  }
}

Coefficients IdealTeam::coverage() const {
  Coefficients known = Coefficients::Zero(mission_.basis.mode_count());
  table_.average(known);
  return known;
}

void IdealTeam::run_until(double t_s, const std::function<void()>& each) {
  while (this->t_s() < t_s - 1e-9) {
    step();
    each();
  }
}

}  // namespace ergocast::lab
