// SPDX-License-Identifier: BSD-3-Clause
// A turn is 5 ms; at each fourth one the vehicles move.
#include "tests/bridges/mavlink/fleet.h"

#include <algorithm>
#include <cmath>

#include "plan/plan.h"
#include "team/subscriptions.h"

namespace ergocast::mavlink {
namespace {

constexpr RunId kRun = 0x77;

nlohmann::json wishes_of(const Mission& mission, const EarthPlace& origin) {
  auto all = nlohmann::json::array();
  for (const Eigen::Vector3d& start_m : mission.starts_m) {
    const EarthPlace at = place_at(origin, start_m.head<2>());
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.9f,%.9f", at.latitude_deg, at.longitude_deg);
    const std::size_t number = all.size();
    all.push_back({{"system", std::to_string(number + 1)},
                   {"make", number % 2 == 0 ? "px4" : "ardupilot"},
                   {"at", text.data()}});
  }
  return all;
}

}  // namespace

Fleet::Fleet(const Mission& mission, const VehicleOptions& options, const std::string& node_mavlink,
             unsigned seed)
    : dice_(seed),
      options_(options),
      coordinator_({kRun, 300, "host", "version"}, encode_plan(mission)),
      seats_(mission.starts_m.size()),
      team_(weather_, dice_),
      up_(weather_, dice_),
      down_(weather_, dice_),
      mocks_(ERGOCAST_SOURCE_DIR "/tests/bridges/mavlink/reference/fleet.cjs", node_mavlink,
             wishes_of(mission, *options.origin)) {
  for (std::size_t i = 0; i < size(); ++i) {
    seats_[i].agent = std::make_unique<Agent>(
        AgentIdentity{kRun, static_cast<AgentId>(i), 400 + i, "host", "version"});
    start_driver(i);
  }
}

void Fleet::start_driver(std::size_t vehicle) {
  Seat& seat = seats_[vehicle];
  seat.driver =
      std::make_unique<Driver>(kRun, next_identity_++, static_cast<AgentId>(vehicle), options_);
  seat.writer = std::make_unique<FrameWriter>();
  seat.allowed = false;
}

double Fleet::now_s() const {
  return std::chrono::duration<double>(now_.time_since_epoch()).count() - 1000;
}

double Fleet::longest_gap_s() const {
  int steps = 0;
  for (const nlohmann::json& state : states_) steps = std::max(steps, state["gap"].get<int>());
  return std::chrono::duration<double>(steps * MockFleet::kStep).count();
}

void Fleet::pass(double seconds) {
  end_ = now_ + std::chrono::milliseconds(std::lround(seconds * 1000));
  while (now_ < end_) turn();
}

void Fleet::turn() {
  now_ += kTurn;
  team_.arrive(now_, [this](const Sent& sent) { deliver(sent); });
  down_.arrive(now_, [this](const Frame& frame) { take_frame(frame); });
  up_.arrive(now_,
             [this](const Frame& frame) { arrived_.emplace_back(frame.vehicle, frame.bytes); });
  advance();
  if (now_.time_since_epoch() % MockFleet::kStep == Instant::duration(0)) step_vehicles();
}

// ---- the team ----

void Fleet::deliver(const Sent& sent) {
  const auto give = [&](auto& core) {
    core.receive(*sent.message, sent.bus, sent.transmitter, now_);
  };
  if (sent.to < size()) return give(*seats_[sent.to].agent);
  if (sent.to == size()) return give(coordinator_);
  if (auto& driver = seats_[sent.to - size() - 1].driver) give(*driver);
}

void Fleet::publish(const Outbox& out) {
  for (const Outgoing& one : out) {
    const auto message = std::make_shared<const Message>(one.message);
    const AgentId from = one.relayer != kUnassigned ? one.relayer : header_of(one.message).sender;
    for (std::size_t to = 0; to <= 2 * size(); ++to) {
      const Role role = to < size()    ? Role::kAgent
                        : to == size() ? Role::kCoordinator
                                       : Role::kDriver;
      if (subscribes(subscriptions_of(role), one.bus, one.message))
        team_.send(now_, {message, one.bus, from, to});
    }
  }
}

void Fleet::advance() {
  Outbox out;
  for (std::size_t i = 0; i < size(); ++i) {
    Seat& seat = seats_[i];
    if (!seat.agent->finished()) seat.agent->advance(now_, out);
    if (!seat.driver) continue;
    std::vector<Packet> packets;
    seat.driver->advance(now_, out, packets);
    send_packets(i, packets);
    if (seat.driver->finished() && !std::exchange(seat.ended, true))
      seat.log += std::to_string(now_s()) + " finished: " + seat.driver->reason() + "\n";
    for (const Note& note : seat.driver->take_notes())
      seat.log += std::to_string(now_s()) + " " + note.text + "\n";
  }
  if (!coordinator_.finished()) coordinator_.advance(now_, out);
  publish(out);
}

// ---- the vehicles ----

void Fleet::send_packets(std::size_t vehicle, const std::vector<Packet>& packets) {
  Seat& seat = seats_[vehicle];
  for (const Packet& packet : packets) {
    const auto* setpoint = std::get_if<SetPositionTargetLocalNed>(&packet);
    if (setpoint != nullptr && !seat.allowed && (setpoint->vx != 0 || setpoint->vy != 0))
      ++disobeyed_;
    up_.send(now_, {vehicle, seat.writer->frame_of(packet, seat.driver->source())});
  }
}

void Fleet::take_frame(const Frame& frame) {
  Seat& seat = seats_[frame.vehicle];
  if (!seat.driver) return;
  FrameReader reader;
  std::vector<Received> all;
  reader.read(frame.bytes, all);
  for (const Received& received : all) {
    if (const auto* heartbeat = std::get_if<Heartbeat>(&received.packet)) {
      const std::uint32_t external = frame.vehicle % 2 == 0 ? 6U << 16 : 4U;
      seat.allowed = heartbeat->custom_mode == external && (heartbeat->base_mode & 128) != 0;
    }
    seat.driver->receive(received, now_);
  }
}

void Fleet::step_vehicles() {
  std::vector<MockFleet::Body> bodies;
  if (bodies_) {
    wanted_mps_.resize(size());
    bodies = bodies_(wanted_mps_);
  }
  MockFleet::Step step = mocks_.step(now_.time_since_epoch() - std::chrono::seconds(900), arrived_,
                                     orders_, now_ + MockFleet::kStep > end_, bodies);
  wanted_mps_ = std::move(step.wanted_mps);
  arrived_.clear();
  orders_.clear();
  for (auto& [vehicle, bytes] : step.frames) down_.send(now_, {vehicle, std::move(bytes)});
  if (!step.states.empty()) states_ = std::move(step.states);
  take_places(step.at);
}

void Fleet::take_places(const std::vector<std::array<double, 3>>& at) {
  std::vector<Eigen::Vector3d> places_m;
  for (const auto& [latitude, longitude, up] : at) {
    const auto plane_m = local_m(*options_.origin, {latitude, longitude, 0});
    places_m.emplace_back(plane_m->x(), plane_m->y(), up);
  }
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    if (i < places_m_.size()) seats_[i].way_m += (places_m[i] - places_m_[i]).head<2>().norm();
    for (std::size_t j = 0; j < i; ++j)
      least_distance_m_ = std::min(least_distance_m_, (places_m[i] - places_m[j]).head<2>().norm());
  }
  places_m_ = std::move(places_m);
}

}  // namespace ergocast::mavlink
