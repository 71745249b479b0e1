// SPDX-License-Identifier: BSD-3-Clause
// Writes one sentence for each value, with the digits that a reader needs.
#include "report/conventions.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "core/measure/detection.h"
#include "core/mission/half_life.h"
#include "core/mission/kinds.h"
#include "core/motion/filter_rules.h"
#include "report/markup.h"

namespace ergocast {
namespace {

using Json = nlohmann::ordered_json;

std::string point_text(const Eigen::Vector2d& x_m) {
  const auto tenth = [](double value) { return readable(std::round(value * 10) / 10); };
  return '(' + tenth(x_m.x()) + ", " + tenth(x_m.y()) + ')';
}

std::string law_text(const ControlLaw& law) {
  const bool relative = law.regularization == Regularization::kRelative;
  std::string text = "u_max = " + readable(law.u_max_mps) + " m/s";
  text += ", ε = " + readable(law.epsilon) + (relative ? " × the residual gradient’s RMS" : "");
  text += ", σ = " + readable(law.noise_intensity);
  if (law.perturbation == Perturbation::kAdaptive) text += " to " + readable(law.noise_ceiling);
  text += " m/√s";
  text += ", k = " + readable(law.contraction_gain_per_s) + " /s";
  if (law.memory_half_life_s > 0)
    text += ", half-life of coverage " + readable(law.memory_half_life_s) + " s";
  if (law.history == TargetHistory::kKeep) text += ", all time counts against the present target";
  if (law.contraction_gain_per_s == 0) return text;
  return text + " towards " + point_text(law.contraction_center_m.head<2>()) + " m";
}

std::string vehicle_text(const VehicleLimits& vehicle) {
  const std::string turn = "turn by at most " + readable(vehicle.max_turn_radps) + " rad/s";
  switch (vehicle.kind) {
    case VehicleKind::kAcceleration:
      return "accelerate by at most " + readable(vehicle.max_acceleration_mps2) + " m/s²";
    case VehicleKind::kUnicycle:
      return turn + ", also on the spot";
    case VehicleKind::kFixedWing:
      return turn + ", and fly at " + readable(vehicle.min_speed_mps) + " m/s or faster";
    case VehicleKind::kPoint:
      break;
  }
  return "take every velocity at once";
}

std::string kind_text(const AgentKind& kind) {
  std::string text = kind.name + ": " + std::to_string(kind.count) +
                     (kind.count == 1 ? " agent" : " agents") +
                     ", u_max = " + readable(kind.u_max_mps) + " m/s";
  if (kind.footprint_sigma_m > 0)
    text += ", sees a Gaussian of " + readable(kind.footprint_sigma_m) + " m";
  if (kind.quality != 1) text += ", quality " + readable(kind.quality);
  if (kind.band_from > 0 || kind.band_to > 0) {
    text += ", steers by |k| from " + readable(kind.band_from);
    if (kind.band_to > 0) text += " to " + readable(kind.band_to);
  }
  if (kind.speed_limit_mps > 0) text += ", limited to " + readable(kind.speed_limit_mps) + " m/s";
  if (kind.vehicle) text += ", vehicles that " + vehicle_text(*kind.vehicle);
  return text;
}

std::string weights_text(const Basis& basis) {
  const bool squared = basis.sobolev_form == SobolevForm::kSquaredNorm;
  return std::string("λₖ = (1 + |k|") + (squared ? "²" : "") + ")^−" +
         readable(basis.sobolev_exponent) + ", |k|² = m² + n²" + (basis.planar() ? "" : " + l²");
}

}  // namespace

Json conventions(const Mission& mission, bool free_domain) {
  const Basis& basis = mission.basis;
  Json list = Json::array();
  const auto add = [&list](const char* name, const std::string& text) {
    list.push_back(Json::array({name, text}));
  };
  if (!mission.domain.planar()) {
    add("view",
        "slices show the sum of the modes in their plane; xy, xz and yz are averages along the "
        "third axis");
  }
  if (free_domain) {
    add("free domain",
        "agents steer by the modes of the domain without its walls, and φ² over time is of these: "
        "λₖ = (1 + νₖ L²/π²)^−s, mean fₖ² = ¼; maps and what follows are of cosines");
  }
  add("metric", std::string("φ² = Σ λₖ (cₖ − μₖ)²") + (basis.normalized ? " / hₖ²" : ""));
  add("weights", weights_text(basis));
  add("basis",
      "f = cos(mπx/Lx) cos(nπy/Ly) from the domain’s lower left corner, m = 0 … " +
          std::to_string(basis.modes_x - 1) + ", n = 0 … " + std::to_string(basis.modes_y - 1) +
          (basis.planar() ? ""
                          : "; times cos(lπz/Lz), l = 0 … " + std::to_string(basis.modes_z - 1)));
  add("hₖ", basis.normalized ? "√(Π Lᵢ · (½)^[kᵢ > 0])" : "not used: f is not normalised");
  add("control", law_text(mission.law));
  for (const AgentKind& kind : mission.kinds) add("kind", kind_text(kind));
  if (!Sensors(mission).uniform())
    add("seen", "coverage and φ² are of what the agents’ sensors have seen, weighted by quality");
  if (HalfLife(mission).any())
    add("memory", "coverage and φ² are of what is remembered: halved once in each half-life");
  if (mission.speed_limit_mps > 0) {
    add("speed limit", readable(mission.speed_limit_mps) + " m/s; faster commands are cut to it");
  }
  const bool all_have_own = std::ranges::all_of(
      mission.kinds, [](const AgentKind& kind) { return kind.vehicle.has_value(); });
  if (mission.kinds.empty() || !all_have_own) add("vehicles", vehicle_text(mission.vehicle));
  if (keeps_distance(mission)) {
    add("distance", readable(mission.separation.distance_m) + " m between any two bodies");
  }
  add("sensor", "finds an object within " + readable(sensor_radius_m(mission)) + " m at the rate " +
                    readable(mission.sensor.detections_per_s) + " /s, through walls");
  if (const ObjectMotion& motion = mission.objects.motion; motion.any())
    add("objects", "drift at " + readable(motion.speed_mps) + " m/s, persistence " +
                       readable(motion.persistence_s) + " s");
  if (mission.sensor.has_false_alarms())
    add("false alarms", readable(mission.sensor.false_alarms_per_s) + " /s; confirmed at " +
                            readable(mission.sensor.confirm_at));
  add("time step", readable(mission.timing.dt_s) + " s");
  add("maps", "Σ cₖ fₖ with f of unit norm, in multiples of the uniform density");
  return list;
}

}  // namespace ergocast
