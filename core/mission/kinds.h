// SPDX-License-Identifier: BSD-3-Clause
// Agents of several kinds: how each kind moves, what its sensor sees, and by which modes it steers.
//
//   S_k = Σ g_k f_k(x) dt,   g_k = exp(−½ w² |κ_k|²),   κ_k = π (m/Lx, n/Ly, l/Lz)
//   c_k = Σ_j q_j S_j,k / Σ_j q_j T_j
//
// w is the width of the Gaussian that a sensor sees around its agent, q its quality. g_k is exact
// with reflecting sides: the heat kernel is diagonal in the basis (2). The sender scales its own
// sums by g, so S_00 = T and |S| ≤ T hold as for points. Receivers weigh a row by its q, which
// follows from plan and roster. An agent steers by Σ λ g (ĉ − μ) ∇f over the modes of its band.
//
// A mission without kinds has one kind without a name, with the law's values and a sensor that sees
// a point. Kinds are numbered in the order of the plan.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/basis/basis.h"
#include "core/mission/mission.h"

namespace ergocast {

/// What the samples of one kind are worth.
struct Sensor {
  Coefficients g;      ///< empty: all 1
  double quality = 1;  ///< q

  /// g in the form that the tables take; null if all are 1.
  const double* footprint() const { return g.size() == 0 ? nullptr : g.data(); }

  /// Adds q g f dt to mode_count() sums; returns q dt, which the place adds to the time.
  double sample(const CosinesAt& at, const Basis& basis, double dt_s, double* sums) const;
};

/// g_k of a footprint of width `sigma_m`, mode_count() entries; empty for a width of 0.
Coefficients footprint_of(const Basis& basis, const Box& domain, double sigma_m);

/// The sensors of all kinds of a mission; at least one.
class Sensors {
 public:
  Sensors() : Sensors(Mission()) {}  ///< those of a mission without kinds
  explicit Sensors(const Mission& mission);

  /// Whether a row's sums depend on its kind at all.
  bool uniform() const { return uniform_; }
  /// The sensor of `kind`, or of kind 0 if the mission has no such kind.
  const Sensor& of(int kind) const;

 private:
  std::vector<Sensor> sensors_;
  bool uniform_;
};

/// The kind that the plan gives to agent `id`; beyond the plan the first kind, 0.
int planned_kind(const Mission& mission, AgentId id);

/// The number of the kind `name`; nothing if the mission has none of this name.
std::optional<int> kind_named(const Mission& mission, const std::string& name);

/// The name of a kind; empty if the mission has no kind `kind`.
const std::string& name_of_kind(const Mission& mission, int kind);

/// The vehicle of an agent of `kind`, and its speed limit [m/s], 0: none. They are the scenario's
/// where the kind has none of its own.
const VehicleLimits& vehicle_of(const Mission& mission, int kind);
double speed_limit_mps(const Mission& mission, int kind);

/// The law that an agent of `kind` follows. The look-ahead still uses the team's u_max_mps, so that
/// all agents compute the same forecast.
ControlLaw law_of(const Mission& mission, int kind);

/// λ_k g_k for the modes of the band of `kind`, 0 for all others: what an agent of it steers by.
Coefficients steering_weights(const Mission& mission, int kind);

/// Whether |k| = √(l² + m² + n²) of a mode other than 0 is in the kind's band.
bool covers_any_mode(const AgentKind& kind, const Basis& basis);

}  // namespace ergocast
