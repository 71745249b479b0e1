// SPDX-License-Identifier: BSD-3-Clause
// Adds up each position that the world or a driver publishes.
#include "bridges/ros2/display.h"

#include <algorithm>

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
    paths_[vehicle.id].add(vehicle.position_m);
    if (!counts || !mission_->domain.contains(vehicle.position_m)) continue;
    detection_.see(counted, vehicle.position_m);
    samples_ += sensors_.of(planned_kind(*mission_, vehicle.id))
                    .sample(BasisAt(vehicle.position_m, mission_->domain, mission_->basis),
                            mission_->basis, 1, sums_.data());
  }
}

const Coefficients& Display::present_target() const {
  const TargetChange* change = target_at(me_->follower().amendments().targets, tick_);
  return change != nullptr ? change->in_cosines() : mission_->target_coefficients;
}

std::int32_t Display::target_number() const {
  const TargetChange* change = target_at(me_->follower().amendments().targets, tick_);
  return change != nullptr ? change->number : -1;
}

OccupancyGrid Display::coverage() const {
  return samples_ > 0 ? occupancy_of(sums_ / samples_, present_target(), *mission_)
                      : OccupancyGrid();
}
OccupancyGrid Display::target() const {
  return occupancy_of(present_target(), present_target(), *mission_);
}
OccupancyGrid Display::left() const {
  return occupancy_left(detection_, present_target(), *mission_);
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
