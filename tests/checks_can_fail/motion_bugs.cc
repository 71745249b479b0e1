// SPDX-License-Identifier: BSD-3-Clause
// Bugs of the control law, of vehicles, walls and distances, and of beacons.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "core/law/law.h"
#include "core/motion/charge.h"
#include "core/motion/separation.h"
#include "core/motion/vehicle.h"
#include "core/motion/way_home.h"
#include "core/motion/zones.h"
#include "tests/checks_can_fail/bugs.h"

namespace ergocast {

// clang-format off
WRAPPED(std::unique_ptr<Law>, make_law, "_ZN8ergocast8make_lawERKNS_7MissionEi", const Mission&, int)
WRAPPED(double, ergodic_metric, "_ZN8ergocast14ergodic_metricERKN5Eigen6MatrixIdLin1ELi1ELi0ELin1ELi1EEES4_S4_", const Coefficients&, const Coefficients&, const Coefficients&)
WRAPPED(Eigen::Vector3d, reflect, "_ZN8ergocast7reflectERKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEERKNS_3BoxE", const Eigen::Vector3d&, const Box&)
WRAPPED(void, make_filter, "_ZN8ergocast16SeparationFilterC1ERKNS_7MissionEl", SeparationFilter*, const Mission&, Tick)
WRAPPED(bool, goes_home, "_ZN8ergocast7WayHome5begunElRKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEE", WayHome*, Tick, const Eigen::Vector3d&)
WRAPPED(bool, must_go, "_ZN8ergocast11ChargeWatch7must_goEd", ChargeWatch*, double)
WRAPPED(double, share_after, "_ZN8ergocast11share_afterERKNS_7BatteryEdbd", const Battery&, double, bool, double)
WRAPPED(bool, charges, "_ZN8ergocast7chargesERKNS_7MissionEiRKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEES7_", const Mission&, AgentId, const Eigen::Vector3d&, const Eigen::Vector3d&)
WRAPPED(Eigen::Vector3d, go_home, "_ZN8ergocast7WayHome12velocity_mpsERKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEES5_", WayHome*, const Eigen::Vector3d&, const Eigen::Vector3d&)
WRAPPED(bool, filters_again, "_ZN8ergocast13filters_againERKNS_7MissionE", const Mission&)
WRAPPED(SafeVelocity, safe, "_ZN8ergocast16SeparationFilter4safeERKNS_5MoverERKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEESt4spanIKNS_9NeighbourELm18446744073709551615EE", SeparationFilter*, const Mover&, const Eigen::Vector3d&, std::span<const Neighbour>)
WRAPPED(void, make_book, "_ZN8ergocast10BeaconBookC1ERKNS_7MissionERKNS_6AuthorEl", BeaconBook*, const Mission&, const Author&, std::int64_t)
WRAPPED(void, receive_beacon, "_ZN8ergocast10BeaconBook7receiveERKNS_6BeaconEbRKNS_6MomentE", BeaconBook*, const Beacon&, bool, const Moment&)
WRAPPED(std::span<const Neighbour>, bodies, "_ZN8ergocast10BeaconBook6bodiesERKN5Eigen6MatrixIdLi3ELi1ELi0ELi3ELi1EEERKNS_6MomentE", BeaconBook*, const Eigen::Vector3d&, const Moment&)
WRAPPED(bool, must_leave, "_ZN8ergocast10must_leaveESt4spanIKNS_4ZoneELm18446744073709551615EElRKNS_7MissionERKNS_6MotionERKNS_11StraightWayE", std::span<const Zone>, Tick, const Mission&, const Motion&, const StraightWay&)
WRAPPED(void, set_zones, "_ZN8ergocast16SeparationFilter9set_zonesESt4spanIKNS_4ZoneELm18446744073709551615EE", SeparationFilter*, std::span<const Zone>)
// clang-format on

bool bug_must_leave(std::span<const Zone> zones, Tick tick, const Mission& mission,
                    const Motion& motion, const StraightWay& way) {
  if (bug("nobody is led out of a zone")) return false;
  return real_must_leave(zones, tick, mission, motion, way);
}

void bug_set_zones(SeparationFilter* self, std::span<const Zone> zones) {
  std::vector<Zone> known(zones.begin(), zones.end());
  if (bug("no filter knows zones")) known.clear();
  if (bug("a zone closes only at its tick"))
    for (Zone& zone : known) zone.closed = zone.from;
  if (bug("a zone ends early"))
    for (Zone& zone : known) zone.until = (zone.from + zone.until) / 2;
  if (bug("a cancelled zone ends at once"))
    for (Zone& zone : known)
      if (zone.cancelled >= 0) zone.cancelled = zone.closed;
  real_set_zones(self, known);
}

namespace {

/// A law that wants twenty times the velocity of another.
class Uncut final : public Law {
 public:
  explicit Uncut(std::unique_ptr<Law> law) : law_(std::move(law)) {}
  LawNeeds needs() const override { return law_->needs(); }
  void set_coverage(const Coefficients& coverage) override { law_->set_coverage(coverage); }
  void set_target(const Coefficients& target) override { law_->set_target(target); }
  void set_law(const LawNumbers& numbers) override { law_->set_law(numbers); }
  Eigen::Vector3d wanted_mps(const LawInput& input) override {
    return 20 * law_->wanted_mps(input);
  }

 private:
  std::unique_ptr<Law> law_;
};

}  // namespace

std::unique_ptr<Law> bug_make_law(const Mission& mission, int kind) {
  auto law = real_make_law(mission, kind);
  if (bug("the input is not cut")) law = std::make_unique<Uncut>(std::move(law));
  return law;
}

double bug_ergodic_metric(const Coefficients& coverage, const Coefficients& target,
                          const Coefficients& weights) {
  return bug("phi^2 is no number") ? std::nan("") : real_ergodic_metric(coverage, target, weights);
}

Eigen::Vector3d bug_reflect(const Eigen::Vector3d& x_m, const Box& domain) {
  const Eigen::Vector3d back_m = real_reflect(x_m, domain);
  if (!bug("the edges push outwards")) return back_m;
  return back_m + (back_m - domain.center_m());
}

namespace {

/// A filter's settings and its earlier neighbours.
struct Filtered {
  Mission mission;
  std::map<AgentId, std::map<Tick, std::vector<Neighbour>>> sent;  // of each body
};
std::map<const SeparationFilter*, Filtered> filtered;

/// An age at which a body may have moved a small distance.
constexpr Tick kOld = 8;

/// The neighbours that a body got kOld ticks ago.
std::vector<Neighbour> old_news(SeparationFilter* self, const Mover& mover,
                                std::span<const Neighbour> others) {
  auto& sent = filtered.at(self).sent[mover.id];
  sent[mover.tick] = {others.begin(), others.end()};
  while (sent.begin()->first < mover.tick - kOld) sent.erase(sent.begin());
  return sent.begin()->second;
}

/// A number for a pair of bodies that stays constant for a second.
Tick draw_of(const Mover& mover, const Neighbour& other) {
  return mover.tick / 10 * 7 + mover.id * 5 + other.id * 3;
}

/// The filter's data on a body of another kind.
Neighbour misjudged_kind(const Mission& mission, const Mover& mover, const Neighbour& other) {
  const Motion motion = motion_of(mission, other.id);
  Neighbour sent = other;
  if (bug("a neighbour needs no way to brake") && motion.has_inertia()) sent.velocity_mps.setZero();
  if (bug("a neighbour's loiter circle is a point")) {
    const Eigen::Vector3d center_m = anchor_m(motion, other.position_m, other.velocity_mps);
    sent.position_m += loiter_radius_m(motion) * (center_m - mover.position_m).normalized();
  }
  if (bug("a neighbour is taken for another vehicle")) {
    const auto team = static_cast<AgentId>(mission.starts_m.size());
    do sent.id = (sent.id + 1) % team;
    while (sent.id == mover.id);
  }
  return sent;
}

/// The changed neighbours that the filter gets.
std::vector<Neighbour> misjudged(SeparationFilter* self, const Mover& mover,
                                 std::span<const Neighbour> others) {
  const Filtered& made = filtered.at(self);
  std::vector<Neighbour> sent(others.begin(), others.end());
  if (bug("only two bodies count")) sent.resize(std::min<std::size_t>(2, sent.size()));
  if (bug("a body takes the whole gap")) {
    for (Neighbour& other : sent) other.max_speed_mps *= 1e-9;
  }
  if (bug("old places count as new")) sent = old_news(self, mover, others);
  if (bug("places count as half as old")) {
    sent = old_news(self, mover, others);
    for (Neighbour& other : sent) other.age_ticks = kOld / 2;
  }
  if (bug("a body needs no way to brake")) {
    for (Neighbour& other : sent) other.velocity_mps.setZero();
  }
  if (bug("uncertainty narrows no direction")) sent = old_news(self, mover, others);
  if (bug("a body without messages does not exist")) {
    std::erase_if(sent, [&](const Neighbour& other) { return draw_of(mover, other) % 3 == 0; });
  }
  for (Neighbour& other : sent) {
    if (other.id != mover.id) other = misjudged_kind(made.mission, mover, other);
    const Eigen::Vector3d y_m = other.position_m - mover.position_m;
    if (bug("uncertainty narrows no direction") && y_m.norm() > 0) {
      const double near_m = other.max_speed_mps * made.mission.timing.dt_s * kOld;
      other.position_m -= y_m * std::min(1.0, near_m / y_m.norm());
    }
    if (bug("nobody knows of position errors")) {
      const double angle = static_cast<double>(draw_of(mover, other));
      other.position_m += made.mission.separation.position_error_m *
                          Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    }
  }
  return sent;
}

}  // namespace

void bug_make_filter(SeparationFilter* self, const Mission& mission, Tick hold_ticks) {
  Mission changed = mission;
  filtered[self] = {mission, {}};
  if (bug("no command is held")) hold_ticks = 0;
  if (bug("a body looks everywhere at once")) changed.vehicle = {};
  if (bug("a loiter circle is a point"))
    changed.separation.distance_m -= 2 * loiter_radius_m(motion_of(mission, 0));
  if (bug("walls are air")) changed.walls = IndexedRings();
  if (bug("walls keep half of their clearance")) changed.wall_clearance_m /= 2;
  if (bug("a loiter circle may reach into walls"))
    changed.wall_clearance_m -= loiter_radius_m(motion_of(mission, 0));
  if (bug("nobody knows of position errors")) changed.separation.position_error_m = 0;
  if (bug("edges count afterwards")) {
    changed.domain.origin_m.head<2>().array() -= 1000;
    changed.domain.size_m.head<2>().array() += 2000;
  }
  real_make_filter(self, changed, hold_ticks);
}

SafeVelocity bug_safe(SeparationFilter* self, const Mover& mover, const Eigen::Vector3d& wanted_mps,
                      std::span<const Neighbour> others) {
  if (bug("bodies are no bodies")) return {wanted_mps};
  if (bug("nobody brakes before walls")) {
    Mover standing = mover;
    standing.velocity_mps.setZero();
    return real_safe(self, standing, wanted_mps, misjudged(self, mover, others));
  }
  return real_safe(self, mover, wanted_mps, misjudged(self, mover, others));
}

namespace {

/// The messages that a book's owner has received.
struct Overheard {
  std::map<AgentId, Tick> heard;  // tick of the newest beacon
  std::map<AgentId, bool> known;  // ever
  std::vector<Neighbour> sent;
};
std::map<const BeaconBook*, Overheard> overheard;

}  // namespace

void bug_make_book(BeaconBook* self, const Mission& mission, const Author& author,
                   std::int64_t revision) {
  overheard[self] = {};  // clears the book of another mission
  real_make_book(self, mission, author, revision);
}

void bug_receive_beacon(BeaconBook* self, const Beacon& beacon, bool fresh, const Moment& now) {
  if (fresh) overheard[self].heard[beacon.header.sender] = now.tick;
  real_receive_beacon(self, beacon, fresh, now);
}

std::span<const Neighbour> bug_bodies(BeaconBook* self, const Eigen::Vector3d& x_m,
                                      const Moment& now) {
  const auto bodies = real_bodies(self, x_m, now);
  Overheard& memory = overheard[self];
  memory.sent.assign(bodies.begin(), bodies.end());
  for (Neighbour& body : memory.sent) {
    memory.known[body.id] = memory.known[body.id] || body.known;
    if (bug("places of beacons are always new")) body.age_ticks = 0;
    if (bug("a beacon's age counts from its arrival"))
      body.age_ticks = std::min(body.age_ticks, now.tick - memory.heard[body.id]);
    if (bug("nobody keeps to the lease")) body.known = memory.known[body.id];
  }
  return memory.sent;
}

bool bug_filters_again(const Mission& mission) {
  return real_filters_again(mission) && !bug("held commands know no walls");
}

Eigen::Vector3d bug_go_home(WayHome* self, const Eigen::Vector3d& x_m,
                            const Eigen::Vector3d& v_mps) {
  if (bug("a recalled agent stays where it is")) return {0, 0, 0};
  return real_go_home(self, x_m, v_mps);
}

/// A second and a half late.
bool bug_must_go(ChargeWatch* self, double way_s) {
  return real_must_go(self, bug("the way home needs no charge") ? 0 : way_s);
}

double bug_share_after(const Battery& battery, double share, bool at_station, double dt_s) {
  return real_share_after(battery, share, at_station || bug("batteries are charged anywhere"),
                          dt_s);
}

bool bug_charges(const Mission& mission, AgentId id, const Eigen::Vector3d& x_m,
                 const Eigen::Vector3d& v_mps) {
  return !bug("charging agents add samples") && real_charges(mission, id, x_m, v_mps);
}

bool bug_goes_home(WayHome* self, Tick counted, const Eigen::Vector3d& x_m) {
  return real_goes_home(self, bug("an agent goes home late") ? counted - 15 : counted, x_m);
}

}  // namespace ergocast
