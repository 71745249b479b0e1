// SPDX-License-Identifier: BSD-3-Clause
// What every law is: it turns what an agent knows into the velocity that the agent wants.
//
// Limits of vehicles, distances, walls, zones, pauses, stations and recalls stay outside:
// agent/safe_motion.h makes a safe command of that velocity. A law is the same object in an agent's
// process, in a simulation and in a study. Equal inputs in equal order must give equal bits.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <span>

#include "core/base/ids.h"
#include "core/basis/basis.h"
#include "core/mission/law_change.h"
#include "core/mission/mission.h"
#include "core/search/efforts.h"

namespace ergocast {

/// What a law reads; nobody computes the rest.
struct LawNeeds {
  bool coverage = true;  ///< set_coverage() before each command
  bool team = false;     ///< LawInput::team
  bool places = false;   ///< LawInput::places
  bool search = false;   ///< LawInput::efforts
  /// One object may serve all agents of a kind: a command depends on nothing but its input, the
  /// last coverage and the numbers. Else each agent has an object of its own.
  bool serves_all = false;

  bool operator==(const LawNeeds&) const = default;
};

/// Where an agent is.
struct TeamPlace {
  AgentId agent;
  Eigen::Vector3d x_m;
};

/// An agent at a tick that counts. Its team are all agents whose coverage counts and that were not
/// recalled, itself among them. Agents that rest by plan stay in it.
struct LawInput {
  AgentId agent;
  Tick tick;
  const Eigen::Vector3d& x_m;     ///< its place
  const BasisAt& at;              ///< the basis there
  std::span<const AgentId> team;  ///< as above, ascending
  /// Where they are at this tick, the own agent among them; ascending. An agent whose state is not
  /// received, because it is out of radio range, is left out.
  std::span<const TeamPlace> places{};
  const Efforts* efforts =
      nullptr;  ///< where all agents have searched; null if the law does not ask
};

class Law {
 public:
  virtual ~Law() = default;

  virtual LawNeeds needs() const { return {}; }
  /// Takes in the coverage that the next commands answer to: known, or as forecast if the law looks
  /// ahead. mode_count() entries.
  virtual void set_coverage(const Coefficients&) {}
  /// From now on the team covers `target`: μ in the basis (2), in any mission. A law that answers
  /// to the coverage needs no target: c_k is shifted (core/law/target_shift.h).
  virtual void set_target(const Coefficients& /*target*/) {}
  /// From now on the law has these numbers.
  virtual void set_law(const LawNumbers& numbers) = 0;

  /// The velocity that the agent wants [m/s], at most u_max but for noise and contraction. In a
  /// plane v_z is 0. While team and target stay the same, it allocates only for a new way around
  /// walls.
  virtual Eigen::Vector3d wanted_mps(const LawInput& input) = 0;
  /// B of (6) for the last wanted_mps() [1/m]; 0 for a law without.
  virtual Eigen::Vector3d spectral_gradient() const { return {0, 0, 0}; }
};

/// Makes the law of an agent of `kind` in a mission: make_law(), or one of a program's own. Agents,
/// lab/simulation.h, lab/ideal_team.h and studies/study_run.h take it. The laws of all kinds of a
/// mission have the same needs().
using LawMaker = std::function<std::unique_ptr<Law>(const Mission&, int kind)>;

/// The law of an agent of `kind` (core/mission/kinds.h): that of ControlLaw::kind.
std::unique_ptr<Law> make_law(const Mission& mission, int kind = 0);
/// The needs() of that law, without making it.
LawNeeds law_needs(const Mission& mission);

}  // namespace ergocast
