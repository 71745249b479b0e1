// SPDX-License-Identifier: BSD-3-Clause
// Accelerated projected gradient over the masses of cells (Beck & Teboulle's FISTA). The gradient
// at the end gives the lower bound, because φ² is convex.
#include "scenario/rules/footprint_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/portable_math.h"
#include "core/basis/basis.h"
#include "core/mission/kinds.h"

namespace ergocast {
namespace {

constexpr int kCellsPerMode = 2;
constexpr int kMostSteps = 400, kFewestSteps = 40;
constexpr double kMostMultiplications = 1e9;
constexpr int kStepsBetweenLooks = 20;

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Masses = std::vector<Eigen::VectorXd>;  // by kind

/// The nearest vector of masses that are at least 0 and sum to 1.
void project(Eigen::VectorXd& masses) {
  Eigen::VectorXd sorted = masses;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  double sum = 0, excess = 0;
  for (Eigen::Index i = 0; i < sorted.size(); ++i) {
    sum += sorted[i];
    const double candidate = (sum - 1) / static_cast<double>(i + 1);
    if (sorted[i] <= candidate) break;
    excess = candidate;
  }
  masses = (masses.array() - excess).cwiseMax(0);
}

class Reach {
 public:
  explicit Reach(const Mission& mission)
      : modes_{mission.basis.modes_z, mission.basis.modes_x, mission.basis.modes_y},
        mu_(mission.target_coefficients),
        lambda_(sobolev_weights(mission.basis, mission.domain)) {
    lambda_[0] = 0;  // c_00 is always 1
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const int modes = modes_[axis], cells = modes == 1 ? 1 : kCellsPerMode * modes;
      cells_[axis] = cells;
      cosines_[axis] = Matrix::NullaryExpr(cells, modes, [cells](auto cell, auto mode) {
        const double at = (static_cast<double>(cell) + 0.5) / cells;
        return portable::cos(std::numbers::pi * static_cast<double>(mode) * at);
      });
    }
    const Sensors sensors(mission);
    double whole = 0;
    for (const AgentKind& kind : mission.kinds) whole += kind.count * kind.quality;
    for (std::size_t i = 0; i < mission.kinds.size(); ++i) {
      const AgentKind& kind = mission.kinds[i];
      const Coefficients& g = sensors.of(static_cast<int>(i)).g;
      const Coefficients ones = Coefficients::Ones(mission.basis.mode_count());
      seen_.push_back(kind.count * kind.quality / whole * (g.size() > 0 ? g : ones));
    }
  }

  int cell_count() const { return cells_[0] * cells_[1] * cells_[2]; }
  std::size_t kinds() const { return seen_.size(); }
  double even() const { return (lambda_.array() * mu_.array().square()).sum(); }

  /// λ's largest eigenvalue of φ²'s second derivatives: the cosines of cells' middles are
  /// orthogonal.
  double curvature() const {
    Coefficients shares = Coefficients::Zero(mu_.size());
    for (const Coefficients& seen : seen_) shares.array() += seen.array().square();
    return 2 * cell_count() * (lambda_.array() * shares.array()).maxCoeff();
  }

  /// The cost of a step.
  double multiplications() const {
    const double along_y = static_cast<double>(cells_[0]) * cells_[1] * cells_[2] * modes_[2];
    const double along_x = static_cast<double>(cells_[0]) * modes_[1] * cells_[1] * modes_[2];
    const double along_z = static_cast<double>(cells_[0]) * modes_[0] * modes_[1] * modes_[2];
    return 2 * static_cast<double>(kinds()) * (along_x + along_y + along_z);
  }

  /// λ (c − μ), and φ² of it.
  double residual(const Masses& masses, Coefficients& weighted) const {
    weighted = -mu_;
    for (std::size_t i = 0; i < kinds(); ++i)
      weighted += seen_[i].cwiseProduct(transformed(masses[i], cells_, true));
    const Coefficients plain = weighted;
    weighted = weighted.cwiseProduct(lambda_);
    return weighted.dot(plain);
  }

  /// The gradient of φ² by the masses of one kind.
  Eigen::VectorXd gradient(std::size_t kind, const Coefficients& weighted) const {
    return 2 * transformed(weighted.cwiseProduct(seen_[kind]), modes_, false);
  }

 private:
  /// Sums over the cells of each mode's cosines, or over the modes at each cell: axis by axis.
  Eigen::VectorXd transformed(const Eigen::VectorXd& from, std::array<int, 3> sizes,
                              bool to_modes) const {
    Eigen::VectorXd values = from;
    int before = 1, after = static_cast<int>(from.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Matrix table = to_modes ? Matrix(cosines_[axis].transpose()) : cosines_[axis];
      const auto size = static_cast<int>(table.rows());
      after /= sizes[axis];
      Eigen::VectorXd next(before * size * after);
      for (int i = 0; i < before; ++i) {
        const Eigen::Map<const Matrix> in(values.data() + i * sizes[axis] * after, sizes[axis],
                                          after);
        Eigen::Map<Matrix> out(next.data() + i * size * after, size, after);
        out.noalias() = table * in;
      }
      values = std::move(next);
      before *= size;
    }
    return values;
  }

  std::array<int, 3> modes_, cells_{};  // along z, x and y
  std::array<Matrix, 3> cosines_;       // cells by modes
  Coefficients mu_, lambda_;
  std::vector<Coefficients> seen_;  // a g by kind
};

/// A bound below which no density can come.
double lower_bound(const Reach& reach, const Masses& masses) {
  Coefficients weighted;
  double bound = reach.residual(masses, weighted);
  for (std::size_t i = 0; i < reach.kinds(); ++i) {
    const Eigen::VectorXd gradient = reach.gradient(i, weighted);
    bound += gradient.minCoeff() - gradient.dot(masses[i]);
  }
  return std::max(0.0, bound);
}

}  // namespace

FootprintReach footprint_reach(const Mission& mission, double enough) {
  const Reach reach(mission);
  const Eigen::VectorXd flat =
      Eigen::VectorXd::Constant(reach.cell_count(), 1.0 / reach.cell_count());
  Masses best(reach.kinds(), flat), ahead = best;
  const double curvature = reach.curvature();
  const int steps = static_cast<int>(
      std::clamp<double>(kMostMultiplications / reach.multiplications(), kFewestSteps, kMostSteps));
  Coefficients weighted;
  double momentum = 1;
  for (int step = 1; step <= steps && curvature > 0; ++step) {
    reach.residual(ahead, weighted);
    const double next = (1 + std::sqrt(1 + 4 * momentum * momentum)) / 2;
    for (std::size_t i = 0; i < reach.kinds(); ++i) {
      Eigen::VectorXd stepped = ahead[i] - reach.gradient(i, weighted) / curvature;
      project(stepped);
      ahead[i] = stepped + (momentum - 1) / next * (stepped - best[i]);
      best[i] = std::move(stepped);
    }
    momentum = next;
    if (step % kStepsBetweenLooks == 0 && reach.residual(best, weighted) <= enough) break;
  }
  const double low = lower_bound(reach, best);
  return {low, reach.residual(best, weighted), reach.even()};
}

}  // namespace ergocast
