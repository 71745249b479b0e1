// SPDX-License-Identifier: BSD-3-Clause
// Places teams on each invariant set and compares the normal part of B with the rounding error
// of its sum.
#include "studies/theorems/invariance.h"

#include <cmath>
#include <numbers>

#include "core/base/noise.h"
#include "core/base/require.h"
#include "core/basis/basis.h"
#include "lab/ideal_team.h"
#include "lab/manifolds.h"

namespace ergocast::studies {
namespace {

using Team = std::vector<Eigen::Vector2d>;
using Share = Eigen::Vector2d;

template <int kX, int kY>  // of the sides; 2 stands for anywhere
Team edge_or_corner(const Share& share, const Rectangle& domain) {
  const Share at(kX == 2 ? share.x() : kX, kY == 2 ? share.x() : kY);
  return {at.cwiseProduct(domain.size_m)};
}

Team on_midline_x(const Share& share, const Rectangle& domain) {
  return {{0.5 * domain.size_m.x(), share.x() * domain.size_m.y()}};
}
Team on_midline_y(const Share& share, const Rectangle& domain) {
  return {{share.x() * domain.size_m.x(), 0.5 * domain.size_m.y()}};
}
Team on_diagonal(const Share& share, const Rectangle& domain) {
  return {share.x() * domain.size_m};
}
Team on_antidiagonal(const Share& share, const Rectangle& domain) {
  const double along_m = share.x() * domain.size_m.x();
  return {{along_m, domain.size_m.x() - along_m}};
}

Team midline_and_mirrored_pair(const Share& share, const Rectangle& domain) {
  Team team = on_midline_x(share, domain);
  const double aside_m = 0.5 * share.y() * domain.size_m.x(), up_m = share.y() * domain.size_m.y();
  team.push_back({aside_m, up_m});
  team.push_back({domain.size_m.x() - aside_m, up_m});
  return team;
}
Team midline_and_another(const Share& share, const Rectangle& domain) {
  Team team = midline_and_mirrored_pair(share, domain);
  team.pop_back();
  return team;
}
Team diagonal_and_mirrored_pair(const Share& share, const Rectangle& domain) {
  Team team = on_diagonal(share, domain);
  const Eigen::Vector2d aside_m = share.y() * domain.size_m.cwiseProduct(Eigen::Vector2d(0.5, 1));
  team.push_back(aside_m);
  team.push_back(aside_m.reverse());
  return team;
}
Team diagonal_and_another(const Share& share, const Rectangle& domain) {
  Team team = diagonal_and_mirrored_pair(share, domain);
  team.pop_back();
  return team;
}

}  // namespace

std::span<const InvariantSet> invariant_sets() {
  static const InvariantSet kSets[] = {
      {"origin", "origin", edge_or_corner<0, 0>, true},
      {"axis-x", "axis x = 0", edge_or_corner<0, 2>},
      {"axis-y", "axis y = 0", edge_or_corner<2, 0>},
      {"far-corner", "far corner (Lx, Ly)", edge_or_corner<1, 1>, true},
      {"far-edge-x", "far edge x = Lx", edge_or_corner<1, 2>},
      {"far-edge-y", "far edge y = Ly", edge_or_corner<2, 1>},
      {"midline-x", "midline x = Lx/2", on_midline_x},
      {"midline-y", "midline y = Ly/2", on_midline_y},
      {"midline-pair", "midline x = Lx/2, two others mirrored", midline_and_mirrored_pair},
      {"diagonal", "diagonal y = x", on_diagonal},
      {"antidiagonal", "diagonal y = Lx − x", on_antidiagonal},
      {"diagonal-pair", "diagonal y = x, two others mirrored", diagonal_and_mirrored_pair},
      {"midline-other", "midline x = Lx/2, one other anywhere", midline_and_another, false, false},
      {"diagonal-other", "diagonal y = x, one other anywhere", diagonal_and_another, false, false},
  };
  return kSets;
}

Mission classical(const InvariantSet& set, Mission mission, std::uint64_t seed) {
  mission.law.epsilon = mission.law.noise_intensity = mission.law.contraction_gain_per_s = 0;
  mission.starts_m.clear();
  const Share share = uniform_pair(seed, Purpose::kStart, 0, 0);
  for (const Eigen::Vector2d& x_m : set.team(share, base_of(mission.domain))) {
    mission.starts_m.push_back(on_ground(x_m));
  }
  return mission;
}

NormalResidual normal_residual(const Mission& mission, Tick tick) {
  const auto set = lab::manifold_at(mission.starts_m.front(), mission.domain);
  ERGOCAST_REQUIRE(set.has_value());
  lab::IdealTeam team(mission);
  while (team.tick() <= tick) team.step();
  const Coefficients weights = sobolev_weights(mission.basis, mission.domain);
  const Coefficients difference = team.coverage() - mission.target_coefficients;
  const Eigen::Vector2d across =
      set->normal.isZero() ? Eigen::Vector2d(1, 1) : set->normal.cwiseAbs();
  const Eigen::Vector2d wave =
      std::numbers::pi * across.cwiseQuotient(mission.domain.size_m.head<2>());
  double size = 0;
  for (int m = 0; m < mission.basis.modes_x; ++m) {
    for (int n = 0; n < mission.basis.modes_y; ++n) {
      const int k = m * mission.basis.modes_y + n;
      size += std::abs(weights[k] * difference[k]) * (m * wave.x() + n * wave.y());
    }
  }
  const Eigen::Vector2d field = team.b(0).head<2>();
  const double b = field.norm();
  const double normal = set->normal.isZero() ? b : std::abs(field.dot(set->normal));
  return {normal / (0x1p-53 * size), b > 0 ? normal / b : 0};
}

}  // namespace ergocast::studies
