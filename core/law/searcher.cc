// SPDX-License-Identifier: BSD-3-Clause
// Adds up what is left and where teammates are, in cells.
#include "core/law/searcher.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/portable_math.h"
#include "core/base/require.h"
#include "core/measure/target_mass.h"

namespace ergocast {
namespace {

constexpr double kRenewal_s = 1;
/// a, as a part of the side of an agent's share of the domain, but between two numbers of the
/// sensor's radii; ℓ, in radii.
constexpr double kSmoothing = 0.3, kLeastSmoothing = 3.2, kMostSmoothing = 6, kSpread = 6;

double smoothing_m(const Mission& mission, double radius_m) {
  const auto agents = static_cast<double>(std::max<std::size_t>(1, mission.starts_m.size()));
  const double side_m = std::sqrt(mission.domain.content() / agents);
  return std::clamp(kSmoothing * side_m, kLeastSmoothing * radius_m, kMostSmoothing * radius_m);
}

/// γ of a sensor with the radius of the cells.
double rate_per_s(const SearchCells& cells, const Mission& mission) {
  return cells.nats_per_look / (static_cast<double>(cells.ticks_per_look) * mission.timing.dt_s);
}

}  // namespace

Searcher::Searcher(const Mission& mission, int kind)
    : basis_(in_cosines(mission).basis),
      walls_(mission.walls),
      steering_(mission, kind),
      cells_(mission),
      spread_m_(kSpread * cells_.radius_m),
      potential_(cells_.cells, mission.walls, smoothing_m(mission, cells_.radius_m)),
      heading_(cells_, mission.walls, rate_per_s(cells_, mission)),
      contacts_(mission),
      left_(static_cast<Eigen::Index>(cells_.cells.total())),
      missed_(left_.size()),
      source_(left_.size()),
      along_x_(cells_.cells.count.x()),
      along_y_(cells_.cells.count.y()),
      renewal_ticks_(std::max<Tick>(1, std::llround(kRenewal_s / mission.timing.dt_s))) {
  Coefficients uniform = Coefficients::Zero(basis_.mode_count());
  uniform[0] = 1;
  const std::vector<double> masses = target_mass(basis_, walls_, uniform, cells_.cells);
  free_ = Eigen::Map<const Eigen::VectorXd>(masses.data(), source_.size()).cwiseSign();
  set_target(in_cosines(mission).target_coefficients);
}

void Searcher::set_target(const Coefficients& target) {
  prior_ = target_mass(basis_, walls_, target, cells_.cells);
  contacts_.set_prior(prior_);
  turn_ = -1;
}

Eigen::Vector3d Searcher::wanted_mps(const LawInput& input) {
  const Tick turn = (input.tick + input.agent) / renewal_ticks_;
  if (turn != turn_) {
    turn_ = turn;
    renew(input);
  }
  return steering_.velocity_mps(input.agent, input.tick, input.x_m, {.gradient = gradient_}, 0);
}

void Searcher::renew(const LawInput& input) {
  ERGOCAST_REQUIRE(input.efforts != nullptr);
  contacts_.renew(*input.efforts);
  set_left(input);
  source_ = -left_;
  add_teammates(input);
  potential_.solve(source_);
  gradient_ = -heading_.best(input.x_m, {left_, missed_}, potential_.gradient(input.x_m),
                             steering_.law().u_max_mps, kRenewal_s);
}

/// Sets b, as masses of cells. Only differences of efforts count, so exp() does not vanish
/// everywhere.
void Searcher::set_left(const LawInput& input) {
  const Efforts& efforts = *input.efforts;
  const Cells& cells = cells_.cells;
  std::uint32_t fewest = std::numeric_limits<std::uint32_t>::max();
  const auto each = [&](auto&& visit) {
    std::size_t cell = 0;
    for (int i = 0; i < cells.count.x(); ++i) {
      for (int j = 0; j < cells.count.y(); ++j, ++cell) {
        if (prior_[cell] > 0) visit(cell, efforts.looks(cells_.tile_cell(i, j)));
      }
    }
  };
  each([&](std::size_t, std::uint32_t looks) { fewest = std::min(fewest, looks); });
  left_.setZero();
  missed_.setZero();
  double left = 0;
  each([&](std::size_t cell, std::uint32_t looks) {
    if (contacts_.confirmed(cell)) return;
    const auto at = static_cast<Eigen::Index>(cell);
    const double nats = cells_.nats_per_look * (looks - fewest);
    missed_[at] = portable::exp(-nats);
    left_[at] = prior_[cell] * missed_[at];
    if (contacts_.nats(cell) != 0 && is_nearest(input, cell))
      left_[at] = prior_[cell] * portable::exp(contacts_.nats(cell) - nats);
    left += left_[at];
  });
  if (left > 0) left_ /= left;
}

/// Whether no teammate is nearer to a cell.
bool Searcher::is_nearest(const LawInput& input, std::size_t cell) const {
  const auto rows = static_cast<std::size_t>(cells_.cells.count.y());
  const Eigen::Vector3d x_m(cells_.cells.center_m(0, static_cast<int>(cell / rows)),
                            cells_.cells.center_m(1, static_cast<int>(cell % rows)), 0);
  const double own_m = (input.x_m - x_m).norm();
  return std::ranges::all_of(input.places, [&](const TeamPlace& mate) {
    return mate.agent == input.agent || (mate.x_m - x_m).norm() >= own_m;
  });
}

/// Adds p, as masses of cells. A teammate's Gaussian has its whole mass in free cells.
void Searcher::add_teammates(const LawInput& input) {
  const auto columns = along_x_.size(), rows = along_y_.size();
  for (const TeamPlace& mate : input.places) {
    if (mate.agent == input.agent) continue;
    set_gaussian(0, mate.x_m, along_x_);
    set_gaussian(1, mate.x_m, along_y_);
    double mass = 0;
    for (Eigen::Index i = 0; i < columns; ++i)
      mass += along_x_[i] * along_y_.dot(free_.segment(i * rows, rows));
    if (!(mass > 0)) continue;
    const double share = 1 / (mass * static_cast<double>(input.places.size()));
    for (Eigen::Index i = 0; i < columns; ++i)
      source_.segment(i * rows, rows).array() +=
          share * along_x_[i] * along_y_.array() * free_.segment(i * rows, rows).array();
  }
}

void Searcher::set_gaussian(int axis, const Eigen::Vector3d& x_m, Eigen::VectorXd& along) const {
  for (int cell = 0; cell < cells_.cells.count[axis]; ++cell) {
    const double off = (cells_.cells.center_m(axis, cell) - x_m[axis]) / spread_m_;
    along[cell] = portable::exp(-off * off / 2);
  }
}

}  // namespace ergocast
