// SPDX-License-Identifier: BSD-3-Clause
// The method with perfect communication: every agent knows all coverage at once, as in the paper.
//
// It computes the same bits as a distributed lockstep team that broadcasts or knows all coverage
// each tick (tests/studies/same_as_simulate_test.cc), several times as fast: for statistics
// over many seeds. Divided into sites, it has less knowledge than that.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/law/coverage_table.h"
#include "core/law/law.h"
#include "core/law/look_ahead.h"
#include "core/law/target_shift.h"
#include "core/law/team_metric.h"
#include "core/measure/objects.h"
#include "core/mission/amendments.h"
#include "core/mission/kinds.h"
#include "core/mission/mission.h"
#include "core/motion/separation.h"
#include "core/motion/vehicle.h"
#include "core/motion/wall_following.h"
#include "core/search/reports.h"

namespace ergocast::lab {

class SiteExchange;
struct SiteRules;

/// What happens to a vehicle that crosses the domain's edge.
enum class Edges {
  kReflect,
  kNone,  ///< it continues: the paper's theorems have no edges
};

class IdealTeam {
 public:
  /// Throws std::logic_error if laws of the mission differ in their needs().
  explicit IdealTeam(Mission mission, Edges edges = Edges::kReflect,
                     const LawMaker& laws = make_law);
  IdealTeam(IdealTeam&&) noexcept;
  ~IdealTeam();

  /// Whether a distributed team would compute the same: it is in lockstep, every agent receives
  /// from every other, and no agent goes home; all coverage is broadcast each tick or known by dead
  /// reckoning, without rounding. Where teammates have searched is never known at once. A mission
  /// with sites has no other team.
  /// @param needs  of the mission's laws
  static bool stands_for(const Mission& mission, const LawNeeds& needs);
  /// The same under make_law().
  static bool stands_for(const Mission& mission) { return stands_for(mission, law_needs(mission)); }

  /// From now on agents know of other sites only by these sites' rows (lab/site_exchange.h). A
  /// mission with sites is divided already. Call it before the first step. Throws std::logic_error
  /// if there are fewer agents than sites, or if agents do not look ahead with dead reckoning, or
  /// forget, or if their laws read places.
  /// @pre no amendments
  void divide(const SiteRules& rules);

  /// Takes in the newest list of amendments, of which only targets and laws count: its ticks are
  /// those that count. A change of the target is for the ticks to come. A distributed team computes
  /// the same bits if it also broadcasts all coverage each tick, else the same up to rounding.
  void note(const Amendments& list);

  /// One tick: samples, commands from the common c_k, motion. Only the laws allocate. After an
  /// exception of a law, the mission has ended.
  void step();

  /// Steps up to `t_s`, calling `each` after every one.
  void run_until(
      double t_s, const std::function<void()>& each = [] {});

  const Mission& mission() const { return mission_; }
  /// Steps done, and the time they took.
  Tick tick() const { return tick_; }
  double t_s() const { return static_cast<double>(tick_) * mission_.timing.dt_s; }
  std::size_t size() const { return agents_.size(); }
  /// Where an agent is now.
  const Eigen::Vector3d& x_m(std::size_t agent) const { return agents_[agent].x_m; }
  /// An agent's velocity in the last step, or with inertia at the step's end.
  const Eigen::Vector3d& v_mps(std::size_t agent) const { return agents_[agent].v_mps; }
  /// B of (6) in the last step.
  const Eigen::Vector3d& b(std::size_t agent) const { return agents_[agent].b; }
  /// c_k of the last step, and its φ². With amendments each moment counts against the target of its
  /// own time (core/law/target_shift.h).
  Coefficients coverage() const;
  double metric() const { return metric_.of(coverage()); }
  /// Steps of single agents that a teammate or an edge has blocked, and the longest run of such
  /// steps of one agent.
  std::int64_t blocked_steps() const { return blocked_steps_; }
  std::int64_t longest_block_ticks() const { return longest_block_ticks_; }

 private:
  struct Agent {
    Author author;
    int kind = 0;
    Law* law;  // of laws_
    Motion motion;
    bool filtered = false;  // whether its commands pass the filter
    Eigen::Vector3d x_m{0, 0, 0}, v_mps{0, 0, 0}, next_mps{0, 0, 0}, b{0, 0, 0};
    std::optional<BasisAt> at;                            // x_m
    std::vector<double> sent;                             // its sums a tick ago
    std::vector<double> gain;                             // since then
    std::vector<double> later;                            // what all later agents will have covered
    std::int64_t blocked_ticks = 0;                       // without a break
    std::optional<WallFollower> follower = std::nullopt;  // where there are walls
  };

  void sample();
  void look_ahead();
  void foresee(const Agent& agent);
  void weigh(const Agent& agent);
  void exchange();
  void correct();
  void compare_with_present();
  double quality(const Agent& agent) const { return sensors_.of(agent.kind).quality; }
  void use_amendments();
  void see_bodies();
  void search();
  Eigen::Vector3d kept_apart(Agent& agent, const Eigen::Vector3d& v_mps);

  Mission mission_;
  Edges edges_;
  Tick tick_ = 0;
  CoverageTable table_;
  LookAhead look_ahead_;
  Coefficients coverage_;                             // known or foreseen
  std::vector<double> earlier_;                       // what all earlier agents will have covered
  double gained_steps_ = 1;                           // the time that all gains cover
  double weight_s_ = 0, share_ = 0, per_second_ = 0;  // of gains, share of gains, and factor of all
  double unshifted_s_ = 0;                            // of the forecast gains
  TargetShift shift_;
  std::vector<LawChange> law_changes_;
  std::vector<TargetChange> targets_;
  std::int32_t newest_target_ = -1;
  Sensors sensors_;
  TeamMetric metric_;
  /// One for each kind if one serves all its agents, else one for each agent.
  std::vector<std::unique_ptr<Law>> laws_;
  LawNeeds needs_;
  bool foresees_;  // the law reads the forecast coverage
  std::vector<AgentId> team_;
  std::vector<TeamPlace> places_;   // if the law needs them
  std::optional<Efforts> efforts_;  // the same
  Objects objects_;
  Reports reports_;
  std::vector<Agent> agents_;
  std::unique_ptr<SiteExchange> sites_;  // null: every agent receives from every other
  std::optional<SeparationFilter> separation_;
  std::vector<Neighbour> bodies_;
  std::int64_t blocked_steps_ = 0, longest_block_ticks_ = 0;
};

}  // namespace ergocast::lab
