// SPDX-License-Identifier: BSD-3-Clause
// Matches echoes with the own beacons that they name, and bounds the age of each position.
#include "team/beacon_book.h"

#include <algorithm>
#include <cmath>

#include "core/base/require.h"
#include "core/motion/filter_rules.h"
#include "core/motion/vehicle.h"

namespace ergocast {
namespace {

/// While no body is near, beacons are at most this time apart, and at most this part of the lease.
/// So three in a row may be lost.
constexpr double kRarePeriod_s = 1;
constexpr Tick kRarePeriodsPerLease = 8;

}  // namespace

BeaconBook::BeaconBook(const Mission& mission, const Author& self, std::int64_t revision)
    : self_(self),
      admitted_revision_(revision),
      lease_ticks_(lease_ticks(mission)),
      greatest_age_ticks_(lease_ticks_ + static_cast<Tick>(std::ceil(mission.separation.response_s /
                                                                     mission.timing.dt_s))),
      rare_ticks_(
          std::max<Tick>(1, std::min(lease_ticks_ / kRarePeriodsPerLease,
                                     static_cast<Tick>(kRarePeriod_s / mission.timing.dt_s)))),
      tick_ns_(seconds(mission.timing.dt_s / mission.timing.realtime_factor).count()),
      // Both bodies move during a few periods of rare beacons, and then until beacons come each
      // tick.
      near_m_(mission.separation.distance_m + fastest_mps(mission) * mission.timing.dt_s *
                                                  static_cast<double>(4 * rare_ticks_ + 8)),
      mission_(mission),
      sent_(static_cast<std::size_t>(lease_ticks_) + 1) {
  ERGOCAST_REQUIRE(uses_beacons(mission) && lease_ticks_ < kNumbers / 2);
}

void BeaconBook::note_roster(const std::vector<RosterEntry>& roster) {
  std::vector<Incarnation> members(bodies_.size());
  for (const RosterEntry& entry : roster) {
    const auto at = static_cast<std::size_t>(entry.author.agent);
    if (at >= members.size()) members.resize(at + 1);
    if (entry.active_until < 0) members[at] = entry.author.incarnation;
  }
  while (bodies_.size() < members.size()) {
    max_speeds_mps_.push_back(
        motion_of(mission_, static_cast<AgentId>(bodies_.size())).speed_limit_mps);
    bodies_.emplace_back();
  }
  for (const RosterEntry& entry : roster)
    bodies_[static_cast<std::size_t>(entry.author.agent)].exists = true;
  for (std::size_t id = 0; id < bodies_.size(); ++id) {
    Body& body = bodies_[id];
    if (body.member == members[id]) continue;
    // The position stays known. The lease limits how far the former incarnation moved the body. The
    // new one does not move it before we echo it.
    body.member = members[id];
    body.heard = 0;
    body.echoed = {};
    forget_echoes(static_cast<AgentId>(id));
  }
  neighbours_.reserve(bodies_.size());
}

void BeaconBook::forget_echoes(AgentId id) {
  if (id >= kMaxEchoesPerMessage) return;
  waiting_.numbers[static_cast<std::size_t>(id)] = 0;
  answered_.numbers[static_cast<std::size_t>(id)] = 0;
}

Tick BeaconBook::elapsed_ticks(const Moment& from, const Moment& now) const {
  const std::int64_t ns = (now.at - from.at).count();
  return std::max<Tick>(now.tick - from.tick, ns <= 0 ? 0 : (ns - 1) / tick_ns_ + 1);
}

/// Which of the own beacons has this number; −1: one that is too old to matter; nothing: none was
/// sent. An echo is never older than the lease when it is sent. So the half of all numbers behind
/// the newest one are old beacons, and the other half were not sent yet.
std::optional<std::int64_t> BeaconBook::count_of(std::uint16_t echo) {
  const int behind = (number_of(count_ + kNumbers - 1) - echo + kNumbers) % kNumbers;  // the newest
  if (behind > kNumbers / 2 || behind >= count_) return std::nullopt;
  const std::int64_t count = count_ - 1 - behind;
  const bool kept = sent_[static_cast<std::size_t>(count) % sent_.size()].count == count;
  return kept ? count : -1;
}

void BeaconBook::receive(const Beacon& beacon, bool fresh, const Moment& now) {
  const auto id = static_cast<std::size_t>(beacon.header.sender);
  if (id >= bodies_.size() || bodies_[id].member != beacon.header.incarnation ||
      beacon.header.sender == self_.agent)
    return;
  if (!fresh) {
    ++late_;
    return;
  }
  Body& body = bodies_[id];
  // Before it knew our incarnation, it echoed another one.
  const bool knows_us = beacon.roster_revision >= admitted_revision_;
  const std::uint16_t echo = knows_us && self_.agent < beacon.echo_count
                                 ? beacon.echoes[static_cast<std::size_t>(self_.agent)]
                                 : std::uint16_t{0};
  if (echo != 0) {
    const auto count = count_of(echo);
    if (!count) {
      ++from_the_future_;
      return;
    }
    if (*count > body.echoed.count)
      body.echoed = sent_[static_cast<std::size_t>(*count) % sent_.size()];
  }
  body.heard = beacon.number;
  body.heard_at = now;
  // A position of unknown age is ignored, unless the body was known before its agent came. That
  // agent has not moved the body, because we have not echoed it.
  if (!body.known && body.echoed.count < 0) return;
  body.known = true;
  body.position_m = beacon.position_m;
  body.velocity_mps = beacon.velocity_mps;
}

void BeaconBook::commands(const Moment& now) {
  if (waits_) return;  // until this round is answered
  waits_ = true;
  waiting_.until = now;
  const std::size_t last = std::min<std::size_t>(bodies_.size(), kMaxEchoesPerMessage);
  for (std::size_t id = 0; id < last; ++id) {
    const Body& body = bodies_[id];
    const bool recent = elapsed_ticks(body.heard_at, now) <= lease_ticks_;
    waiting_.numbers[id] = body.member != 0 && recent ? body.heard : std::uint16_t{0};
  }
}

void BeaconBook::measured(Tick answered, std::int64_t revision, const Eigen::Vector3d& position_m,
                          const Eigen::Vector3d& velocity_mps) {
  position_m_ = position_m;
  velocity_mps_ = velocity_mps;
  // A predecessor's command may have the same tick.
  if (!waits_ || answered < waiting_.until.tick || revision < admitted_revision_) return;
  answered_ = waiting_;
  waits_ = false;
  may_send_ = true;
}

std::optional<Beacon> BeaconBook::next(std::int64_t revision, const Moment& now) {
  const Tick period = anybody_near_ ? 1 : rare_ticks_;
  if (!may_send_ || (last_sent_ && elapsed_ticks(*last_sent_, now) < period)) return std::nullopt;
  Beacon beacon;
  beacon.roster_revision = revision;
  beacon.position_m = position_m_;
  beacon.velocity_mps = velocity_mps_;
  beacon.number = number_of(count_);
  beacon.echo_count =
      static_cast<std::int32_t>(std::min<std::size_t>(bodies_.size(), kMaxEchoesPerMessage));
  std::copy_n(answered_.numbers.begin(), beacon.echo_count, beacon.echoes.begin());
  sent_[static_cast<std::size_t>(count_) % sent_.size()] = {count_, now, answered_.until};
  ++count_;
  last_sent_ = now;
  return beacon;
}

std::span<const Neighbour> BeaconBook::bodies(const Eigen::Vector3d& own_position_m,
                                              const Moment& now) {
  neighbours_.clear();
  anybody_near_ = false;
  for (std::size_t at = 0; at < bodies_.size(); ++at) {
    const auto id = static_cast<AgentId>(at);
    const Body& body = bodies_[at];
    if (!body.exists || id == self_.agent) continue;
    const bool echoed = body.echoed.count >= 0;
    const Tick age = echoed ? std::min(greatest_age_ticks_, elapsed_ticks(body.echoed.sent, now))
                            : greatest_age_ticks_;
    const bool hears_us =
        body.member == 0 || (echoed && elapsed_ticks(body.echoed.measured, now) <= lease_ticks_);
    neighbours_.push_back(
        {id, body.position_m, max_speeds_mps_[at], age, body.known && hears_us, body.velocity_mps});
    anybody_near_ = anybody_near_ || !body.known || !hears_us ||
                    (body.position_m - own_position_m).norm() < near_m_;
  }
  return neighbours_;
}

}  // namespace ergocast
