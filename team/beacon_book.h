// SPDX-License-Identifier: BSD-3-Clause
// Where teammates are, by what their agents say: places, and ages of places without a common clock.
//
// Each agent numbers its beacons. A beacon has the place of its sender's body, and as an echo for
// each teammate the number of that one's newest beacon that was heard before the place was
// measured. So whoever finds its own beacon k in a beacon knows: the place is younger than k.
//
//   age_ij = now_i − the moment at which i sent the newest own beacon that j has echoed
//
// The place that a beacon says is measured by another process, the driver. A command is the proof:
// a state that answers command n was measured after n was sent, and n was sent after its echoes
// were heard. So echoes wait for the state that answers the command which followed them.
//
// The lease: a body moves only while every other member has echoed a beacon of it whose place is
// younger than L = separation.lease_s. So whoever knows a place knows that the body is within
// V_j (L + T + hold) of it for ever, however long nothing is heard, and counts no age beyond L + T,
// T the response_s of vehicles that follow late. This also holds for bodies whose agents have left:
// nobody echoes them, so they stand.
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

#include "core/ids.h"
#include "core/mission.h"
#include "core/roster.h"
#include "core/separation.h"
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

  /// Who takes part. Another incarnation under a number has heard nothing of us.
  void note_roster(const std::vector<RosterEntry>& roster);

  // ---- what teammates say ----
  /// Takes in a beacon. One of nobody in the roster has no effect. One that came after a later one,
  /// or that echoes a number which was never sent, has none either, and is counted.
  /// @param fresh  no later message of its sender came before
  void receive(const Beacon& beacon, bool fresh, const Moment& now);
  /// Beacons that came after a later one of their sender.
  std::int64_t late() const { return late_; }
  /// Beacons that echo what was not sent yet.
  std::int64_t from_the_future() const { return from_the_future_; }

  // ---- what we say ----
  /// Called before a command for `now.tick` is sent.
  void commands(const Moment& now);
  /// Takes the newest place of the own body.
  /// @param answered  the newest tick whose command had arrived before it was measured
  /// @param revision  of the roster that who measured it knew
  void measured(Tick answered, std::int64_t revision, const Eigen::Vector3d& position_m,
                const Eigen::Vector3d& velocity_mps);
  /// The next beacon, if one is due: each tick, more rarely while nobody is near; nothing before a
  /// command has been answered.
  /// @param revision  of the roster that is known
  std::optional<Beacon> next(std::int64_t revision, const Moment& now);

  // ---- what the filter needs ----
  /// All other bodies, in ascending order of their numbers. Where one is not known, or its agent
  /// is not known to hear us, `known` is false: we must stand.
  std::span<const Neighbour> bodies(const Eigen::Vector3d& own_position_m, const Moment& now);

 private:
  static constexpr int kNumbers = 65535;  // of beacons, from 1 on; 0 is none

  using Numbers = std::array<std::uint16_t, kMaxEchoesPerMessage>;
  /// The numbers heard until a command was sent.
  struct Echoes {
    Moment until{};
    Numbers numbers{};
  };
  /// An own beacon.
  struct Sent {
    std::int64_t count = -1;    // of all beacons; −1: none
    Moment sent{}, measured{};  // the latter at the earliest
  };
  struct Body {
    bool exists = false, known = false;
    Incarnation member = 0;  // that drives it now; 0: none
    Eigen::Vector3d position_m{0, 0, 0}, velocity_mps{0, 0, 0};
    std::uint16_t heard = 0;  // its newest number
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
  std::vector<Body> bodies_;            // by number, up to the greatest that was heard of
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
