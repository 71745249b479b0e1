// SPDX-License-Identifier: BSD-3-Clause
// How likely a team has found an object, and how long it has left places alone.
//
// The object stands still somewhere, with the target's masses m_i as its probabilities. A sensor
// detects it at the rate γ while it is at most r away, whatever is between. Detections are
// independent. τ_i is the time that sensors have spent within r of cell i, one added to another:
//
//   P = Σ_i m_i (1 − exp(−γ τ_i))
//
// The age of a place is the time since a sensor was last within r of it, or since the mission's
// start.
//
// The sum over cells is exact up to the cells' size, a third of r or a little more than that if r
// is small. Sensors look once in several ticks, each time for all of them: in between an agent
// moves by half a cell at most, up to its noise.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "core/base/ids.h"
#include "core/measure/cells.h"
#include "core/mission/mission.h"

namespace ergocast {

/// r [m]: the plan's, or 2.5 % of the shorter side in the plane. It is at least 1.5 times the
/// longest side of a measure_cell, along the axes that are divided.
double sensor_radius_m(const Mission& mission);

/// The cells of a mission's measures: three to the radius that is wanted, if kMaxMeasureCells
/// allows it, else larger ones.
Cells measure_cells(const Mission& mission);

/// In how many ticks the sensors of a mission look once: the fastest agent then moves by half of
/// one of its measure_cells() at most.
Tick ticks_per_look(const Mission& mission, const Cells& cells);

class Detection {
 public:
  Detection() = default;
  explicit Detection(const Mission& mission);

  /// From tick `counted` on an object is drawn from `mass`, one number a cell. Nothing of it has
  /// been found. Ages go on.
  void begin_target(std::vector<double> mass, Tick counted);
  /// A sensor was at `x_m` for tick `counted`; ticks ascend. Does not allocate.
  void see(Tick counted, const Eigen::Vector3d& x_m);
  /// Tick `counted` is over.
  void pass(Tick counted);

  /// P of an object of the newest target.
  double probability() const { return std::min(found_, 1.0); }
  /// The time from the newest target on until P was at least ½, or ⅘ [s]; nothing: it never was.
  std::optional<double> half_time_s() const { return times_s_[0]; }
  std::optional<double> four_fifths_time_s() const { return times_s_[1]; }
  /// The least age that cells with the share `share` of the mass never exceeded before tick
  /// `counted` [s].
  double greatest_age_s(Tick counted, double share) const;

  const Cells& cells() const { return cells_; }
  const std::vector<double>& mass() const { return mass_; }
  /// exp(−γ τ_i): how likely an object in cell i is still not found.
  const std::vector<double>& missed() const { return missed_; }

 private:
  /// A sensor is near a cell.
  void look(std::size_t cell, Tick turn);

  Cells cells_;
  double dt_s_ = 1, radius_m_ = 0;
  Tick ticks_per_look_ = 1;
  double missed_in_look_ = 1;  // exp(−γ dt) for each of these ticks
  std::vector<double> mass_, missed_;
  // In looks: after the last one with a sensor near, and the longest time between two such looks.
  std::vector<Tick> seen_, longest_;
  double found_ = 0;  // a sum of many shares: rounding may lead above 1
  Tick begun_ = 0;    // of the newest target
  std::array<std::optional<double>, 2> times_s_;
};

}  // namespace ergocast
