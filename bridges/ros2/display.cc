// SPDX-License-Identifier: BSD-3-Clause
// Adds up each position that the world or a driver publishes.
#include "bridges/ros2/display.h"

#include <algorithm>
#include <cmath>

#include "core/measure/target_mass.h"
#include "core/mission/amendments.h"
#include "text/shortest.h"

namespace ergocast::ros2 {

Display::Display(RunId run, Instant since, bool authenticated)
    : run_(run), since_(since), authenticated_(authenticated) {}

void Display::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  const RunId run = header_of(message).run;
  if (run == 0 || (run_ != 0 && run != run_)) return;
  run_ = run;
  if (!view_) {
    view_.emplace(run, since_, authenticated_);
    me_.emplace(kRole, Identity{run, kUnassigned, 0});
  }
  view_->receive(message, bus, transmitter, now);
  if (!me_->accept(message, bus, transmitter, now)) return;
  if (!mission_ && me_->knows_mission()) {
    mission_ = in_cosines(me_->mission());
    sensors_ = Sensors(*mission_);
    sums_ = Coefficients::Zero(mission_->basis.mode_count());
    detection_ = Detection(*mission_);
  }
  if (const auto* world = std::get_if<WorldState>(&message)) on(*world);
}

void Display::on(const WorldState& world) {
  if (!mission_) return;
  tick_ = std::max(tick_, world.header.tick);
  const Tick counted = me_->counted(world.header.tick);
  if (detected_target_ != target_number()) {
    detected_target_ = target_number();
    detection_.begin_target(
        target_mass(mission_->basis, mission_->walls, present_target(), detection_.cells()),
        counted);
  }
  const bool counts = !me_->is_held(world.header.tick) && !me_->is_over(world.header.tick);
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    const auto [newest, is_new] = newest_.try_emplace(vehicle.id, world.header.tick);
    if (!is_new && world.header.tick <= newest->second) continue;
    newest->second = world.header.tick;
    add_position(vehicle.id, vehicle.position_m);
    if (!counts || !mission_->domain.contains(vehicle.position_m)) continue;
    detection_.see(counted, vehicle.position_m);
    samples_ += sensors_.of(planned_kind(*mission_, vehicle.id))
                    .sample(BasisAt(vehicle.position_m, mission_->domain, mission_->basis),
                            mission_->basis, 1, sums_.data());
  }
}

void Display::add_position(AgentId id, const Eigen::Vector3d& at_m) {
  auto& path_m = paths_m_[id];
  auto& [every, offered] = strides_.try_emplace(id, 1, 0).first->second;
  if (offered++ % every != 0) return;
  path_m.push_back(at_m);
  if (path_m.size() < kMostPositions) return;
  every *= 2;
  for (std::size_t i = 0; 2 * i < path_m.size(); ++i) path_m[i] = path_m[2 * i];
  path_m.resize((path_m.size() + 1) / 2);
}

const Coefficients& Display::present_target() const {
  const TargetChange* change = target_at(me_->follower().amendments().targets, tick_);
  return change != nullptr ? change->in_cosines() : mission_->target_coefficients;
}

std::int32_t Display::target_number() const {
  const TargetChange* change = target_at(me_->follower().amendments().targets, tick_);
  return change != nullptr ? change->number : -1;
}

namespace {

/// Σ a_k f_k / mean(f_k²) at a place; for a box, averaged along z, which leaves the modes l = 0.
class Density {
 public:
  Density(const Coefficients& coefficients, const Mission& mission)
      : domain_(mission.domain), basis_(mission.basis) {
    basis_.modes_z = 1;
    scaled_ = coefficients.head(basis_.mode_count());
    auto weights = in_plane(scaled_, basis_);
    weights.bottomRows(weights.rows() - 1) *= 2;  // mean(cos²) = ½ along each axis that varies
    weights.rightCols(weights.cols() - 1) *= 2;
  }
  double at(const Eigen::Vector3d& x_m) const {
    return basis_values(x_m, domain_, basis_).dot(scaled_);
  }

 private:
  Box domain_;
  Basis basis_;
  Coefficients scaled_;
};

}  // namespace

/// In multiples of the target's greatest density.
Grid Display::grid_of(const Coefficients& coefficients) const {
  const Box& domain = mission_->domain;
  const Density density(coefficients, *mission_), target(present_target(), *mission_);
  const double longer_m = domain.size_m.head<2>().maxCoeff();
  Grid grid;
  grid.resolution_m = longer_m / kCells;
  const auto cells = [&](double side_m) {
    const double count = std::ceil(side_m / grid.resolution_m - 1e-9);
    return static_cast<std::uint32_t>(std::clamp(count, 1.0, static_cast<double>(kCells)));
  };
  grid.width = cells(domain.size_m.x());
  grid.height = cells(domain.size_m.y());
  std::vector<double> values;
  double greatest = 0;
  for (std::uint32_t j = 0; j < grid.height; ++j) {
    for (std::uint32_t i = 0; i < grid.width; ++i) {
      const Eigen::Vector3d x_m =
          domain.origin_m + grid.resolution_m * Eigen::Vector3d(i + 0.5, j + 0.5, 0);
      const bool inside = domain.contains(x_m);
      values.push_back(inside ? std::max(0.0, density.at(x_m)) : -1);
      if (inside) greatest = std::max(greatest, target.at(x_m));
    }
  }
  for (const double value : values)
    grid.data.push_back(static_cast<std::int8_t>(
        value < 0 ? -1 : std::lround(std::min(100.0, 100 * value / std::max(greatest, 1e-12)))));
  return grid;
}

Grid Display::coverage() const { return samples_ > 0 ? grid_of(sums_ / samples_) : Grid(); }
Grid Display::target() const { return grid_of(present_target()); }

/// What is missed in a cell of the grid is the mean over the cells of the measure in it, by their
/// mass. Where none has its middle in it, that of the cell around the grid's middle counts.
Grid Display::left() const {
  Grid grid = target();
  const Cells& cells = detection_.cells();
  const auto index = [&](int axis, int at, std::uint32_t count) {
    const double off_m = cells.center_m(axis, at) - mission_->domain.origin_m[axis];
    return std::min(static_cast<std::uint32_t>(off_m / grid.resolution_m), count - 1);
  };
  std::vector<double> mass(grid.data.size(), 0), missed(grid.data.size(), 0);
  for (int l = 0; l < cells.count.z(); ++l) {
    for (int i = 0; i < cells.count.x(); ++i) {
      const std::uint32_t column = index(0, i, grid.width);
      for (int j = 0; j < cells.count.y(); ++j) {
        const std::size_t from = cells.column(i, l) + static_cast<std::size_t>(j);
        const std::size_t to = std::size_t{index(1, j, grid.height)} * grid.width + column;
        mass[to] += detection_.mass()[from];
        missed[to] += detection_.mass()[from] * detection_.missed()[from];
      }
    }
  }
  for (std::size_t to = 0; to < grid.data.size(); ++to) {
    if (grid.data[to] <= 0) continue;
    const auto column = static_cast<double>(to % grid.width);
    const auto row = static_cast<double>(to / grid.width);
    const Eigen::Vector3d middle_m =
        mission_->domain.origin_m + grid.resolution_m * Eigen::Vector3d(column + 0.5, row + 0.5, 0);
    const double share =
        mass[to] > 0 ? missed[to] / mass[to] : detection_.missed()[cells.cell_of(middle_m)];
    grid.data[to] = static_cast<std::int8_t>(std::lround(share * grid.data[to]));
  }
  return grid;
}

Display::Status Display::status(Instant now) const {
  const TeamPicture picture = view_->picture(now);
  Status status{picture.ergodic_metric, picture.detection_probability, {}, {}, picture.scenario};
  for (const Find& find : picture.finds) status.finds_m.push_back(find.x_m);
  for (const Contact& contact : picture.contacts)
    status.contacts_m.emplace_back(contact.x_m.x(), contact.x_m.y(), 0);
  const char* state = picture.over ? "over" : picture.paused ? "paused" : "running";
  if (picture.state == MissionState::kWaiting) state = "waiting for agents";
  status.text += std::string(": ") + state + ", tick " + std::to_string(picture.counted) + " of " +
                 std::to_string(picture.tick_count) + ", " + std::to_string(picture.agents_alive) +
                 " of " + std::to_string(picture.agents_expected) + " agents";
  if (picture.ergodic_metric) status.text += ", φ² = " + shortest(*picture.ergodic_metric);
  if (picture.objects > 0)
    status.text += ", " + std::to_string(picture.finds.size()) + " of " +
                   std::to_string(picture.objects) + " hidden objects found";
  for (const AgentRow& row : picture.agents) {
    if (row.condition == Condition::kOk || row.condition == Condition::kFinished) continue;
    status.text += "; agent " + std::to_string(row.author.agent) + " " + to_string(row.condition);
  }
  return status;
}

}  // namespace ergocast::ros2
