// SPDX-License-Identifier: BSD-3-Clause
// The numbers of commands and states are those of mavlink.io.
#include "bridges/mavlink/vehicle.h"

#include <ergocast/core/motion/charge.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace ergocast::mavlink {
namespace {

using namespace std::chrono_literals;

/// PX4 leaves OFFBOARD after 0.5 s without a setpoint. At 20 a second a link that loses each
/// twentieth makes no such gap in years of flight; at 10 a second sixteen vehicles had one in ten
/// minutes.
constexpr auto kSetpointPeriod = 50ms;
/// Limit (MAVLink): time without a heartbeat of the autopilot [s]. Beyond it: the vehicle is told
/// to stand, and its position is not sent.
constexpr double kLinkLost_s = 3;
/// The vehicle stands if the autopilot has not reported for so long whether it is in the air.
constexpr auto kOldestLandedState = 3s;
/// For how many of the autopilot's heartbeats it listens for another driver.
constexpr std::int64_t kListenedHeartbeats = 3;
/// How many setpoints of 0 it sends at the end, and at most where the vehicle does not stand yet.
constexpr int kLastSetpoints = 20, kMostLastSetpoints = 200;
/// In planes: the vehicle moves only this near to its height [m].
constexpr double kHeightError_m = 2;
constexpr double kFastestClimb_mps = 1, kClimbGain_per_s = 0.5;
/// Within what time after a heartbeat an order answers to it.
constexpr auto kOrderAfterHeartbeat = 150ms;
/// PX4 enters OFFBOARD only after setpoints have arrived for a while.
constexpr std::int64_t kSetpointsBeforeOffboard = 40;

constexpr std::uint8_t kCompanion = 191;  // MAV_COMP_ID_ONBOARD_COMPUTER
constexpr std::uint8_t kOnboardController = 18, kNoAutopilot = 8, kStandby = 3, kActive = 4;
constexpr std::uint8_t kArmed = 128;
constexpr std::uint8_t kOnGround = 1, kInAir = 2;

constexpr std::uint16_t kSetInterval = 511, kRequestMessage = 512;

}  // namespace

Vehicle::Vehicle(const VehicleOptions& options, std::uint32_t identity)
    : options_(options), identity_(identity), fixes_(options.origin, options.local_origin_m) {}

Source Vehicle::source() const {
  const std::uint8_t system = known() ? autopilot_.system : options_.system;
  return {system != 0 ? system : std::uint8_t{1}, kCompanion};
}

// ---- what the vehicle reports ----

void Vehicle::receive(const Received& received, Instant now) {
  if (const auto* heartbeat = std::get_if<Heartbeat>(&received.packet))
    return take_heartbeat(received, *heartbeat, now);
  if (!known() || received.from != autopilot_) return;
  std::visit([&](const auto& m) { on(m, now); }, received.packet);
}

void Vehicle::take_heartbeat(const Received& received, const Heartbeat& heartbeat, Instant now) {
  const Source& from = received.from;
  if (heartbeat.type == kOnboardController && from.component == kCompanion &&
      from.system == source().system && heartbeat.custom_mode != 0 &&
      heartbeat.custom_mode != identity_)
    return meet_driver(heartbeat);
  if (heartbeat.autopilot == kNoAutopilot) return;  // a ground station, a camera, this driver
  const bool right_system = options_.system == 0 || from.system == options_.system;
  if (!known() && right_system) adopt(from, heartbeat);
  if (!fatal_.empty()) return;
  if (from != autopilot_) {
    if (strangers_.size() < 8 && strangers_.insert(from.system).second)
      note(true, "system " + std::to_string(from.system) + " is on this link, too, and not driven" +
                     (known() ? ": --system chooses"
                              : "; waits for --system " + std::to_string(options_.system)));
    return;
  }
  heard_at_ = now;
  ++heartbeats_;
  const bool was_external = in_external_mode(), was_armed = armed_;
  mode_ = heartbeat.custom_mode;
  if (make_ == Make::kPx4) mode_ = mode_ >> 16 & 0xFF;
  armed_ = (heartbeat.base_mode & kArmed) != 0;
  const bool left = was_external && !in_external_mode(), disarmed = was_armed && !armed_;
  if (running_ && (left || disarmed)) taken_over_ = true;
  if (!options_.take_command) return;
  orders_.note_heartbeat(armed_);
  if (orders_.take_pilots()) taken_over_ = true;
}

void Vehicle::adopt(const Source& from, const Heartbeat& heartbeat) {
  const std::string name = "system " + std::to_string(from.system);
  const auto body = body_of(heartbeat.type);
  if (!body) {
    fatal_ = name + " " + why_refused(heartbeat.type) + ": this driver refuses it";
    return;
  }
  if (heartbeat.autopilot != 3 && heartbeat.autopilot != 12) {
    fatal_ = name + " has the autopilot " + std::to_string(heartbeat.autopilot) +
             " (MAV_AUTOPILOT): this driver knows PX4 (12) and ArduPilot (3)";
    return;
  }
  autopilot_ = from;
  make_ = heartbeat.autopilot == 12 ? Make::kPx4 : Make::kArduPilot;
  body_ = *body;
  note(false, name + ": " + (make_ == Make::kPx4 ? "PX4" : "ArduPilot") + ", " +
                  (body_ == Body::kCopter ? "a multicopter" : "a rover"));
}

/// The driver that already sends setpoints goes on. If both do, or none yet, the one with the
/// greater identity stops.
void Vehicle::meet_driver(const Heartbeat& other) {
  const bool we_began = listened(), it_began = other.system_status == kActive;
  if (we_began == it_began ? other.custom_mode < identity_ : it_began) {
    fatal_ = "another driver is on this vehicle: end that one first";
  } else if (!std::exchange(warned_of_driver_, true)) {
    note(true, "another driver has come to this vehicle, and has to end");
  }
}

void Vehicle::on(const ExtendedSysState& state, Instant now) {
  landed_state_.reset();
  if (state.landed_state != 0) landed_state_ = state.landed_state;  // MAV_LANDED_STATE_UNDEFINED
  landed_at_ = now;
  if (landed_state_) last_in_air_ = landed_state_ == kInAir;
}

/// Forgets what is too old, or was before a restart of the autopilot.
void Vehicle::forget_landed_state(Instant now) {
  const bool restarted = fixes_.take_restart();
  if (restarted) {
    last_in_air_ = false;
    fence_.begin_anew();
  }
  if (restarted || now - landed_at_ > kOldestLandedState) landed_state_.reset();
}

void Vehicle::on(const SysStatus& status, Instant now) {
  batteries_.take(status);
  tell_of_batteries(now);
}

void Vehicle::on(const BatteryStatus& status, Instant now) {
  batteries_.take(status, now);
  tell_of_batteries(now);
}

/// Each tenth is told once, from 50 % on.
void Vehicle::tell_of_batteries(Instant now) {
  constexpr int kFirstTold_percent = 50, kLow_percent = 20;
  const int left = batteries_.percent(now);
  if (left < 0 || left > kFirstTold_percent || left > battery_told_percent_ - 10) return;
  battery_told_percent_ = left - left % 10 + (left % 10 > 0 ? 10 : 0);
  note(left <= kLow_percent, "the battery has " + std::to_string(left) + " %");
}

std::int32_t Vehicle::charge_ppm(Instant now) const {
  const int percent = batteries_.percent(now);
  return percent < 0 ? kNoCharge : percent * (kWhole_ppm / 100);
}

void Vehicle::on(const Statustext& text, Instant) {
  constexpr std::uint8_t kWarning = 4;
  const std::string line = text_of(text.text);
  if (text.severity > kWarning || line == last_text_) return;
  last_text_ = line;
  note(true, "the autopilot: " + line);
}

void Vehicle::on(const CommandAck& ack, Instant) {
  if (!is_for_us(ack)) return;
  const auto refused = orders_.take_answer(ack);
  if (!refused) return;
  const std::string what = ack.command == kSetMode ? external_mode()
                           : ack.command == kArm   ? "to arm"
                                                   : "to take off";
  note(true, "the autopilot refuses " + what + ": " + *refused);
}

// ---- whether it follows ----

bool Vehicle::listened() const { return heartbeats_ >= kListenedHeartbeats; }

bool Vehicle::in_the_air() const { return body_ == Body::kRover || landed_state_ == kInAir; }

std::string Vehicle::why_it_waits_for_the_pilot() const {
  if (!in_external_mode() || !armed_) {
    const std::string state = armed_ ? mode_name() : "disarmed";
    if (taken_over_)
      return "the pilot or a failsafe has taken over (" + state +
             "): the agent rests until the vehicle is armed in " + external_mode();
    if (!in_external_mode())
      return "waits until the pilot chooses " + external_mode() + " (now " + mode_name() + ")";
    return "waits until the pilot arms";
  }
  if (body_ == Body::kCopter && !landed_state_)
    return "the autopilot does not send EXTENDED_SYS_STATE: whether it is in the air is not known";
  if (!in_the_air()) return "waits until the pilot has taken off";
  return "";
}

/// A vehicle that is farther outside of the domain than its longer side has probably another
/// origin.
std::string Vehicle::why_wrong_place(Instant now) const {
  const auto fix = fixes_.at(now);
  if (!fix) return "";
  const Eigen::Vector2d outside_m = (fix->position_m - domain_.nearest(fix->position_m)).head<2>();
  if (outside_m.norm() <= domain_.size_m.head<2>().maxCoeff()) return "";
  return "is far outside of the domain: is --origin that of the scenario?";
}

/// In a plane.
std::string Vehicle::why_wrong_height(Instant now) const {
  const auto fix = fixes_.at(now);
  if (!planar_ || body_ == Body::kRover || !fix) return "";
  if (std::abs(fix->height_m - *options_.altitude_m) <= kHeightError_m) return "";
  return "goes to its height first";
}

std::optional<Fix> Vehicle::fix(Instant now) const {
  return now - heard_at_ > seconds(kLinkLost_s) ? std::nullopt : fixes_.at(now);
}

bool Vehicle::stands(Instant now) const {
  const auto fix = fixes_.at(now);
  return fix && fix->velocity_mps.norm() < kStanding_mps;
}

/// Why it must not move, whatever the pilot does.
std::string Vehicle::why_unfit(Instant now) const {
  if (!known()) return "no autopilot is heard on the link";
  if (now - heard_at_ > seconds(kLinkLost_s)) return "the link is lost: no heartbeat for 3 s";
  if (!listened()) return "listens whether another driver is there";
  if (const std::string problem = fixes_.problem(now); !problem.empty()) return problem;
  if (!running_) return finishing_ ? "the mission is over" : "waits for the mission";
  return fence_.why_not();
}

std::string Vehicle::why_not(Instant now) const {
  if (const std::string unfit = why_unfit(now); !unfit.empty()) return unfit;
  if (const std::string waits = why_it_waits_for_the_pilot(); !waits.empty()) return waits;
  if (const std::string place = why_wrong_place(now); !place.empty()) return place;
  return why_wrong_height(now);
}

/// Notes each change of why the vehicle does not follow.
void Vehicle::note_change(Instant now) {
  const std::string why = why_not(now);
  if (why == last_why_) return;
  const bool warns = last_why_.empty() || fence_.failed();
  note(warns && running_, why.empty() ? "follows its agent" : why);
  last_why_ = why;
}

// ---- what it is ordered ----

void Vehicle::begin(const Box& domain, double speed_limit_mps, double oldest_fix_s,
                    const IndexedRings& walls) {
  running_ = begun_ = true;
  domain_ = domain;
  planar_ = domain.planar();
  fixes_.set_limits(speed_limit_mps, oldest_fix_s);
  if (!options_.fence_margin_m || !options_.origin) return;
  auto items = fence_items(*options_.origin, domain, *options_.fence_margin_m, walls);
  if (items) {
    fence_.begin(*std::move(items));
  } else {
    fatal_ = items.error();
  }
}

std::string Vehicle::why_not_its_mission() const {
  if (body_ == Body::kCopter && planar_ && !options_.altitude_m)
    return "the mission is in a plane: give its height above home by --altitude";
  if (body_ == Body::kRover && !planar_) return "the mission is in a box, and a rover cannot climb";
  if (!planar_ && options_.origin && !options_.origin->has_altitude)
    return "the mission is in a box: --origin needs the altitude of z = 0, too";
  return "";
}

void Vehicle::fly(const Eigen::Vector3d& velocity_mps) {
  if (velocity_mps != wanted_mps_) next_setpoint_ = {};
  wanted_mps_ = velocity_mps;
}

void Vehicle::finish() {
  running_ = false;
  finishing_ = true;
  done_ = !fatal_.empty() || !obeys_setpoints();
  fly({0, 0, 0});
}

bool Vehicle::obeys_setpoints() const {
  if (!known() || !listened()) return false;
  const bool in_air = body_ == Body::kRover || last_in_air_;
  return make_ == Make::kPx4 || (begun_ && in_external_mode() && armed_ && in_air);
}

/// In a plane a multicopter holds its height, also while it stands. PX4 takes off by climbing.
double Vehicle::climb_mps(Instant now) const {
  if (body_ == Body::kRover || !in_external_mode() || !armed_) return 0;
  if (!why_unfit(now).empty() || !why_wrong_place(now).empty()) return 0;
  const double missing_m = options_.altitude_m.value_or(0) - fixes_.at(now)->height_m;
  if (in_the_air())
    return std::clamp(kClimbGain_per_s * missing_m, -kFastestClimb_mps, kFastestClimb_mps);
  const bool takes_off = may_order() && !orders_.waits_for_answer() && landed_state_ &&
                         make_ == Make::kPx4 && missing_m > 0;
  return takes_off ? kFastestClimb_mps : 0;
}

Eigen::Vector3d Vehicle::setpoint_mps(Instant now) const {
  Eigen::Vector3d velocity_mps(0, 0, 0);
  if (why_not(now).empty()) velocity_mps = wanted_mps_;
  if (planar_ || !in_the_air()) velocity_mps.z() = climb_mps(now);
  return velocity_mps;
}

void Vehicle::advance(Instant now, std::vector<Packet>& out) {
  if (known() && running_ && fatal_.empty()) fatal_ = why_not_its_mission();
  if (!fatal_.empty()) return;
  forget_landed_state(now);
  note_change(now);
  if (now >= next_second_) {
    next_second_ = now + std::chrono::seconds(1);
    each_second(now, out);
  }
  if (running_ && listened()) advance_fence(now, out);
  const bool just_heard = now - heard_at_ <= kOrderAfterHeartbeat;
  if (may_order() && just_heard && why_unfit(now).empty()) take_command(out);
  if (now < next_setpoint_) return;
  next_setpoint_ = now + kSetpointPeriod;
  if (!obeys_setpoints()) return done_ = finishing_, void();
  SetPositionTargetLocalNed setpoint = setpoint_of(setpoint_mps(now));
  setpoint.target_system = autopilot_.system;
  setpoint.target_component = autopilot_.component;
  out.emplace_back(setpoint);
  ++setpoints_;
  if (!finishing_) return;
  ++last_setpoints_;
  const bool waits = fixes_.at(now) && !stands(now) && last_setpoints_ < kMostLastSetpoints;
  done_ = last_setpoints_ >= kLastSetpoints && !waits;
}

void Vehicle::each_second(Instant now, std::vector<Packet>& out) {
  Heartbeat heartbeat;
  heartbeat.custom_mode = identity_;
  heartbeat.type = kOnboardController;
  heartbeat.autopilot = kNoAutopilot;
  heartbeat.system_status = listened() ? kActive : kStandby;
  out.emplace_back(heartbeat);
  if (!known()) return;
  Timesync question = fixes_.clock().ask(now);
  question.target_system = autopilot_.system;
  question.target_component = autopilot_.component;
  out.emplace_back(question);
  if (!fixes_.at(now) || (body_ == Body::kCopter && !landed_state_)) ask_for_messages(out);
}

void Vehicle::advance_fence(Instant now, std::vector<Packet>& out) {
  const std::size_t before = out.size();
  fence_.advance(now, out);
  for (Packet& packet : std::span(out).subspan(before)) {
    std::visit(
        [&](auto& m) {
          if constexpr (requires { m.mission_type; }) {
            m.target_system = autopilot_.system;
            m.target_component = autopilot_.component;
          }
        },
        packet);
  }
}

CommandLong Vehicle::command(std::uint16_t number, float one, float two, float seven) const {
  CommandLong command;
  command.command = number;
  command.param1 = one;
  command.param2 = two;
  command.param7 = seven;
  command.target_system = autopilot_.system;
  command.target_component = autopilot_.component;
  return command;
}

/// Positions 20 times a second, and whether it is in the air.
void Vehicle::ask_for_messages(std::vector<Packet>& out) const {
  const bool local = options_.local_origin_m.has_value();
  out.emplace_back(
      command(kSetInterval,
              static_cast<float>(local ? LocalPositionNed::kId : GlobalPositionInt::kId), 50'000));
  out.emplace_back(command(kSetInterval, static_cast<float>(ExtendedSysState::kId), 500'000));
  if (!local) out.emplace_back(command(kRequestMessage, static_cast<float>(GpsGlobalOrigin::kId)));
}

/// The next step of mode, arming and take-off. A multicopter gets orders only on the ground, a
/// rover only while it is disarmed.
std::optional<CommandLong> Vehicle::next_order() const {
  const bool rests = body_ == Body::kRover ? !armed_ : landed_state_ == kOnGround;
  if (!rests) return std::nullopt;
  if (!in_external_mode()) {
    constexpr float kCustomMode = 1;
    return command(kSetMode, kCustomMode, static_cast<float>(external_mode_of(make_, body_)));
  }
  if (!armed_) return command(kArm, 1);
  if (make_ == Make::kPx4) return std::nullopt;
  return command(kTakeOff, 0, 0, static_cast<float>(options_.altitude_m.value_or(5)));
}

/// A vehicle that was armed by somebody else is a pilot's or a failsafe's.
void Vehicle::take_command(std::vector<Packet>& out) {
  if (make_ == Make::kPx4 && setpoints_ < kSetpointsBeforeOffboard) return;
  const std::optional<CommandLong> next = next_order();
  if (!next) return;
  if (orders_.due(next->command)) {
    if (next->command == kArm) out.emplace_back(command(kRunChecks, 0));
    out.emplace_back(*next);
  }
  if (orders_.take_pilots()) taken_over_ = true;
  if (orders_.take_gave_up())
    note(true, "has asked " + std::to_string(Orders::kMostRequests) +
                   " times in vain, and leaves it to the pilot");
}

}  // namespace ergocast::mavlink
