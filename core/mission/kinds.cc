// SPDX-License-Identifier: BSD-3-Clause
// Derives each kind's law, sensor and weights from the plan.
#include "core/mission/kinds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/portable_math.h"

namespace ergocast {
namespace {

/// Calls each(l, m, n, number of the mode) for every mode in the order of the basis.
template <class Each>
void for_modes(const Basis& basis, const Each& each) {
  int k = 0;
  for (int l = 0; l < basis.modes_z; ++l) {
    for (int m = 0; m < basis.modes_x; ++m) {
      for (int n = 0; n < basis.modes_y; ++n) each(l, m, n, k++);
    }
  }
}

double squared(int mode) { return static_cast<double>(mode) * mode; }

double squared(int mode, double length_m) {
  const double per_m = mode == 0 ? 0 : mode * std::numbers::pi / length_m;
  return per_m * per_m;
}

bool in_band(const AgentKind& kind, double length) {
  return length >= kind.band_from && (kind.band_to == 0 || length <= kind.band_to);
}

const AgentKind* kind_of(const Mission& mission, int kind) {
  const bool known = kind >= 0 && kind < static_cast<int>(mission.kinds.size());
  return known ? &mission.kinds[static_cast<std::size_t>(kind)] : nullptr;
}

}  // namespace

Coefficients footprint_of(const Basis& basis, const Box& domain, double sigma_m) {
  if (sigma_m == 0) return {};
  Coefficients g(basis.mode_count());
  for_modes(basis, [&](int l, int m, int n, int k) {
    const double per_m2 = squared(m, domain.size_m.x()) + squared(n, domain.size_m.y()) +
                          squared(l, domain.size_m.z());
    g[k] = portable::exp(-0.5 * sigma_m * sigma_m * per_m2);
  });
  return g;
}

double Sensor::sample(const CosinesAt& at, const Basis& basis, double dt_s, double* sums) const {
  const double weight_s = quality * dt_s;
  if (g.size() > 0) {
    accumulate_basis(at, basis, weight_s, g.data(), sums);
  } else {
    accumulate_basis(at, basis, weight_s, sums);
  }
  return weight_s;
}

Sensors::Sensors(const Mission& mission) {
  for (const AgentKind& kind : mission.kinds) {
    sensors_.push_back(
        {footprint_of(mission.basis, mission.domain, kind.footprint_sigma_m), kind.quality});
  }
  if (sensors_.empty()) sensors_.emplace_back();
  uniform_ = std::all_of(sensors_.begin(), sensors_.end(), [](const Sensor& sensor) {
    return sensor.g.size() == 0 && sensor.quality == 1;
  });
}

const Sensor& Sensors::of(int kind) const {
  const bool known = kind >= 0 && kind < static_cast<int>(sensors_.size());
  return sensors_[known ? static_cast<std::size_t>(kind) : 0];
}

int planned_kind(const Mission& mission, AgentId id) {
  AgentId end = 0;
  for (std::size_t kind = 0; kind < mission.kinds.size(); ++kind) {
    end += mission.kinds[kind].count;
    if (id < end) return static_cast<int>(kind);
  }
  return 0;
}

std::optional<int> kind_named(const Mission& mission, const std::string& name) {
  const auto at = std::find_if(mission.kinds.begin(), mission.kinds.end(),
                               [&](const AgentKind& kind) { return kind.name == name; });
  if (at == mission.kinds.end()) return std::nullopt;
  return static_cast<int>(at - mission.kinds.begin());
}

const std::string& name_of_kind(const Mission& mission, int kind) {
  static const std::string kNone;
  const AgentKind* const known = kind_of(mission, kind);
  return known == nullptr ? kNone : known->name;
}

const VehicleLimits& vehicle_of(const Mission& mission, int kind) {
  const AgentKind* const own = kind_of(mission, kind);
  return own != nullptr && own->vehicle ? *own->vehicle : mission.vehicle;
}

double speed_limit_mps(const Mission& mission, int kind) {
  const AgentKind* const own = kind_of(mission, kind);
  return own != nullptr && own->speed_limit_mps > 0 ? own->speed_limit_mps
                                                    : mission.speed_limit_mps;
}

ControlLaw law_of(const Mission& mission, int kind) {
  ControlLaw law = mission.law;
  if (const AgentKind* const own = kind_of(mission, kind)) {
    law.u_max_mps = own->u_max_mps;
    law.noise_intensity = own->noise_intensity;
    law.noise_ceiling = own->noise_ceiling;
  }
  return law;
}

Coefficients steering_weights(const Mission& mission, int kind) {
  Coefficients weights = sobolev_weights(mission.basis, mission.domain);
  const AgentKind* const own = kind_of(mission, kind);
  if (own == nullptr) return weights;
  const Coefficients g = footprint_of(mission.basis, mission.domain, own->footprint_sigma_m);
  if (g.size() > 0) weights = weights.cwiseProduct(g);
  for_modes(mission.basis, [&](int l, int m, int n, int k) {
    if (!in_band(*own, std::sqrt(squared(l) + squared(m) + squared(n)))) weights[k] = 0;
  });
  return weights;
}

bool covers_any_mode(const AgentKind& kind, const Basis& basis) {
  bool any = false;
  for_modes(basis, [&](int l, int m, int n, int k) {
    any = any || (k > 0 && in_band(kind, std::sqrt(squared(l) + squared(m) + squared(n))));
  });
  return any;
}

}  // namespace ergocast
