// SPDX-License-Identifier: BSD-3-Clause
// Positions of teammates from their beacons, with the ages of the positions, without a common
// clock.
//
// Each agent numbers its beacons. A beacon has the position of its sender's body, and one echo for
// each teammate. An echo is the number of the teammate's newest beacon that arrived before the
// position was measured. An agent that finds its own beacon k in a beacon knows that the position
// is younger than k.
//
//   age_ij = now_i − the moment at which i sent the newest own beacon that j has echoed
//
// Another process, the driver, measures the position in a beacon. A command proves the order. A
// state that answers command n was measured after n was sent, and n was sent after its echoes
// arrived. So echoes wait for the state that answers the command which followed them.
//
// The lease: a body moves only while every other member has echoed a beacon of it whose position is
// younger than L = separation.lease_s. So a body stays within V_j (L + T + hold) of each position
// that another agent knows, however long no beacon arrives. T is the response_s of vehicles that
// follow late. No age counts beyond L + T. This also holds for bodies whose agents have left: no
// agent echoes them, so they stand.
//
// Times are in ticks, rounded up: the ticks of the own driver or the time by the own clock,
// whichever is more. So it does not matter which of the two stood still.
// docs/safety.md has the proof. No call but note_roster() allocates memory.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "core/mission/roster.h"
#include "core/motion/separation.h"
#include "team/messages.h"

namespace ergocast {

/// A moment of one process.
struct Moment {
  Tick tick = 0;  ///< the newest of its driver
  Instant at{};   ///< by its own clock
};

class BeaconBook {
 public:
  /// @param self  the agent whose book it is
  /// @param revision  of the roster in which it found itself; see note_roster()
  /// @pre uses_beacons(mission)
  BeaconBook(const Mission& mission, const Author& self, std::int64_t revision);

  /// Takes in which agents take part. A new incarnation under a number has received nothing from
  /// us.
  void note_roster(const std::vector<RosterEntry>& roster);

  // ---- beacons of teammates ----
  /// Takes in a beacon. A beacon of no member has no effect. Two kinds have no effect and are
  /// counted: beacons that arrive after a later one, and beacons that echo a number which was never
  /// sent.
  /// @param fresh  no later message of its sender arrived before
  void receive(const Beacon& beacon, bool fresh, const Moment& now);
  /// Beacons that arrived after a later one of their sender.
  std::int64_t late() const { return late_; }
  /// Beacons that echo a number which was not sent yet.
  std::int64_t from_the_future() const { return from_the_future_; }

  // ---- own beacons ----
  /// Called before a command for `now.tick` is sent.
  void commands(const Moment& now);
  /// Takes in the newest position of the own body.
  /// @param answered  the newest tick whose command had arrived before it was measured
  /// @param revision  of the roster that the driver knew
  void measured(Tick answered, std::int64_t revision, const Eigen::Vector3d& position_m,
                const Eigen::Vector3d& velocity_mps);
  /// The next beacon, if one is due. Beacons are due each tick, more rarely while no body is near,
  /// and not before a command has been answered.
  /// @param revision  of the roster that is known
  std::optional<Beacon> next(std::int64_t revision, const Moment& now);

  // ---- what the filter needs ----
  /// All other bodies, in ascending order of their numbers. `known` is false if a body's position
  /// is not known, or its agent has not echoed us within the lease. We must then stand.
  std::span<const Neighbour> bodies(const Eigen::Vector3d& own_position_m, const Moment& now);

 private:
  static constexpr int kNumbers = 65535;  // of beacons, from 1 on; 0 is none

  using Numbers = std::array<std::uint16_t, kMaxEchoesPerMessage>;
  /// The numbers received until a command was sent.
  struct Echoes {
    Moment until{};
    Numbers numbers{};
  };
  /// An own beacon.
  struct Sent {
    std::int64_t count = -1;    // of all beacons; −1: none
    Moment sent{}, measured{};  // its position was measured at this moment or later
  };
  struct Body {
    bool exists = false, known = false;
    Incarnation member = 0;  // of the agent that drives it now; 0: none
    Eigen::Vector3d position_m{0, 0, 0}, velocity_mps{0, 0, 0};
    std::uint16_t heard = 0;  // number of its newest beacon
    Moment heard_at{};
    Sent echoed{};  // the newest own beacon that it has echoed
  };

  static std::uint16_t number_of(std::int64_t count) {
    return static_cast<std::uint16_t>(count % kNumbers + 1);
  }
  Tick elapsed_ticks(const Moment& from, const Moment& now) const;
  std::optional<std::int64_t> count_of(std::uint16_t echo);
  void forget_echoes(AgentId id);

  Author self_;
  std::int64_t admitted_revision_;
  Tick lease_ticks_, greatest_age_ticks_, rare_ticks_;
  std::int64_t tick_ns_;
  double near_m_;
  bool anybody_near_ = true;
  std::vector<Body> bodies_;            // by agent, up to the greatest in the roster
  std::vector<double> max_speeds_mps_;  // likewise
  Mission mission_;
  std::vector<Sent> sent_;  // a ring
  std::int64_t count_ = 0;  // of own beacons
  std::optional<Moment> last_sent_;
  Echoes waiting_, answered_;
  bool waits_ = false, may_send_ = false;
  Eigen::Vector3d position_m_{0, 0, 0}, velocity_mps_{0, 0, 0};
  std::vector<Neighbour> neighbours_;
  std::int64_t late_ = 0, from_the_future_ = 0;
};

}  // namespace ergocast
