// SPDX-License-Identifier: BSD-3-Clause
// Integrates the target of a free domain over its modes.
#include "scenario/compile/free_domain.h"

#include "modes/provide.h"

namespace ergocast {
namespace {

/// The share of the mass that each free cell has: e_k at a place is a mean of at most four cells.
Eigen::VectorXd masses_of_cells(const DensityGrid& density, FreeModes modes) {
  modes.origin_m.setZero();  // a density's places are from the domain's corner
  Eigen::VectorXd masses = Eigen::VectorXd::Zero(modes.cell_count);
  const Eigen::Vector2d count(static_cast<double>(density.rows()),
                              static_cast<double>(density.cols()));
  const Eigen::Vector2d step_m = modes.size_m.cwiseQuotient(count);
  for (Eigen::Index j = 0; j < density.cols(); ++j) {
    for (Eigen::Index i = 0; i < density.rows(); ++i) {
      const Eigen::Vector2d middle(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
      const FreePlace at(step_m.cwiseProduct(middle), modes);
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const auto cell = (at.corners[corner] - modes.values.data()) / modes.mode_count;
        masses[cell] += at.shares[corner] * density(i, j);
      }
    }
  }
  return masses / masses.sum();
}

Coefficients target_in(const FreeModes& modes, const DensityGrid& density) {
  const Eigen::VectorXd masses = masses_of_cells(density, modes);
  Coefficients target = Coefficients::Zero(modes.mode_count);
  for (int cell = 0; cell < modes.cell_count; ++cell) {
    const float* const values = modes.values_of(cell);
    for (int k = 0; k < modes.mode_count; ++k)
      target[k] += masses[cell] * static_cast<double>(values[k]);
  }
  target[0] = 1;  // exact, without rounding
  return target;
}

}  // namespace

std::optional<std::string> use_free_domain(const DensityGrid& density, Mission& mission) {
  Basis& basis = mission.basis;
  if (!basis.free_domain) return std::nullopt;
  auto table = table_of(mission);
  if (!table) return table.error();
  basis.table = *std::move(table);
  basis.table_hash = basis.table->hash;
  mission.cosine_target = std::move(mission.target_coefficients);
  mission.target_coefficients = target_in(*basis.table, density);
  return std::nullopt;
}

}  // namespace ergocast
