// SPDX-License-Identifier: BSD-3-Clause
// One vehicle with a PX4 or ArduPilot autopilot: what it reports, and what it is ordered to do.
//
// The pilot decides. Unless the options say so, the driver never arms, takes off or changes modes;
// it only sends velocities, which the autopilot obeys in OFFBOARD (PX4) or GUIDED (ArduPilot). The
// vehicle follows its agent if all of why_not() hold, and else stands.
//
// Setpoints are sent every 0.05 s, whatever the mission's tick is, and at once when they change.
// PX4 gets them in every mode, because it enters OFFBOARD only while they arrive, and ignores them
// in all other modes. ArduPilot gets them only in GUIDED, in the air and from the mission's begin
// on, so they disturb neither a take-off nor a pilot in GUIDED before that.
//
// No socket, thread or clock.
#pragma once

#include <ergocast/core/base/geometry.h>
#include <ergocast/core/base/ids.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/mavlink/autopilots.h"
#include "bridges/mavlink/batteries.h"
#include "bridges/mavlink/fence.h"
#include "bridges/mavlink/fixes.h"
#include "bridges/mavlink/frame_reader.h"
#include "bridges/mavlink/orders.h"

namespace ergocast::mavlink {

struct VehicleOptions {
  std::uint8_t system = 0;  ///< of the vehicle; 0: the first autopilot on the link
  bool take_command = false;
  std::optional<EarthPlace> origin;
  std::optional<Eigen::Vector3d> local_origin_m;
  std::optional<double> altitude_m;  ///< above home, for planes and for take-off
  /// How far outside the domain the autopilot's fence is; nothing: it gets none. Needs `origin`.
  std::optional<double> fence_margin_m;
};

/// A vehicle that is slower stands [m/s].
inline constexpr double kStanding_mps = 0.2;

/// A line for the log.
struct Note {
  bool warning = false;
  std::string text;
};

class Vehicle {
 public:
  /// @param identity  not 0; tells this driver from others of the same vehicle
  Vehicle(const VehicleOptions& options, std::uint32_t identity);

  void receive(const Received& received, Instant now);
  /// What to send at `now`, with source().
  void advance(Instant now, std::vector<Packet>& out);
  Instant next_wakeup() const { return std::min(next_setpoint_, next_second_); }
  Source source() const;

  /// The mission runs: from now on the vehicle may follow.
  /// @param oldest_fix_s  the age from which positions are too old for this mission
  /// @param walls         for the fence
  void begin(const Box& domain, double speed_limit_mps, double oldest_fix_s = kOldestFix_s,
             const IndexedRings& walls = {});
  /// The velocity that the agent wants; 0: stand.
  void fly(const Eigen::Vector3d& velocity_mps);
  /// The mission is over: zero velocity until it stands, for 1 s to 10 s, then done().
  void finish();
  bool done() const { return done_; }

  /// The newest position, if it can be trusted.
  std::optional<Fix> fix(Instant now) const;
  /// What the autopilot says of its batteries, in millionths; −1: not known.
  std::int32_t charge_ppm(Instant now) const;
  /// Whether the newest position says that it stands, but for the noise of a vehicle that does.
  bool stands(Instant now) const;
  /// Why the vehicle does not follow its agent; empty if it does.
  std::string why_not(Instant now) const;
  /// Why the driver cannot go on; empty if it can.
  const std::string& fatal() const { return fatal_; }
  std::vector<Note> take_notes() { return std::exchange(notes_, {}); }

 private:
  template <class M>
  void on(const M&, Instant) {}
  void on(const GlobalPositionInt& at, Instant) { fixes_.take(at); }
  void on(const LocalPositionNed& at, Instant) { fixes_.take(at); }
  void on(const GpsGlobalOrigin& at, Instant) { fixes_.take(at); }
  void on(const Timesync& answer, Instant) { fixes_.clock().take(answer); }
  void on(const ExtendedSysState& state, Instant now);
  void on(const SysStatus& status, Instant now);
  void on(const BatteryStatus& status, Instant now);
  void on(const Statustext& text, Instant now);
  void on(const CommandAck& ack, Instant now);
  void on(const MissionRequest& m, Instant now) { take_for_fence(m, now); }
  void on(const MissionRequestInt& m, Instant now) { take_for_fence(m, now); }
  void on(const MissionAck& m, Instant now) { take_for_fence(m, now); }
  void on(const MissionCount& m, Instant now) { take_for_fence(m, now); }
  void on(const MissionItemInt& m, Instant now) { take_for_fence(m, now); }
  /// 0 names everybody.
  bool is_for_us(const auto& m) const {
    const Source me = source();
    return (m.target_system == 0 || m.target_system == me.system) &&
           (m.target_component == 0 || m.target_component == me.component);
  }
  void take_for_fence(const auto& m, Instant now) {
    if (is_for_us(m)) fence_.receive(m, now);
  }
  void take_heartbeat(const Received& received, const Heartbeat& heartbeat, Instant now);
  void adopt(const Source& from, const Heartbeat& heartbeat);
  void meet_driver(const Heartbeat& other);
  void forget_landed_state(Instant now);
  void tell_of_batteries(Instant now);
  void note(bool warning, std::string text) { notes_.push_back({warning, std::move(text)}); }

  bool known() const { return autopilot_.component != 0; }
  bool listened() const;
  bool in_external_mode() const { return mode_ == external_mode_of(make_, body_); }
  bool in_the_air() const;
  bool obeys_setpoints() const;
  std::string external_mode() const { return external_mode_name(make_); }
  std::string mode_name() const { return mavlink::mode_name(make_, body_, mode_); }
  std::string why_it_waits_for_the_pilot() const;
  std::string why_wrong_place(Instant now) const;
  std::string why_wrong_height(Instant now) const;
  std::string why_unfit(Instant now) const;
  std::string why_not_its_mission() const;
  Eigen::Vector3d setpoint_mps(Instant now) const;
  double climb_mps(Instant now) const;
  void note_change(Instant now);
  void each_second(Instant now, std::vector<Packet>& out);
  void advance_fence(Instant now, std::vector<Packet>& out);
  void ask_for_messages(std::vector<Packet>& out) const;
  std::optional<CommandLong> next_order() const;
  bool may_order() const { return options_.take_command && !taken_over_; }
  void take_command(std::vector<Packet>& out);
  CommandLong command(std::uint16_t number, float one, float two = 0, float seven = 0) const;

  VehicleOptions options_;
  std::uint32_t identity_;
  Fixes fixes_;
  Source autopilot_;
  Make make_ = Make::kPx4;
  Body body_ = Body::kCopter;
  std::uint32_t mode_ = 0;
  bool armed_ = false;
  std::int64_t heartbeats_ = 0;
  Instant heard_at_{};
  std::optional<std::uint8_t> landed_state_;
  Instant landed_at_{};       // when it arrived
  bool last_in_air_ = false;  // by the newest message that knows, however old
  std::set<std::uint8_t> strangers_;
  bool warned_of_driver_ = false;
  Batteries batteries_;
  int battery_told_percent_ = 100;
  std::string last_text_;

  Box domain_;
  bool begun_ = false, running_ = false, planar_ = true, finishing_ = false, done_ = false;
  Eigen::Vector3d wanted_mps_{0, 0, 0};
  int last_setpoints_ = 0;  // since the mission was over
  std::int64_t setpoints_ = 0;
  Instant next_setpoint_{}, next_second_{};

  Fence fence_;
  bool taken_over_ = false;  // by the pilot, or a failsafe
  Orders orders_;            // of a driver that takes command
  std::string last_why_ = "-", fatal_;
  std::vector<Note> notes_;
};

}  // namespace ergocast::mavlink
