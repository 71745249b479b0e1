// SPDX-License-Identifier: BSD-3-Clause
// Two agents, coordinator, world and logger exchange messages by virtual time, and all tables
// are checked afterwards.
#include "tests/fuzz/support/small_team.h"

#include <cmath>

#include "cli/team/team_text.h"
#include "core/base/require.h"
#include "lcmtypes/codec.h"
#include "plan/plan.h"
#include "tests/support/team.h"

namespace ergocast::fuzz {
namespace {

using namespace std::chrono_literals;
using test::kRun;

constexpr int kAgents = 2;
/// The maximum number of answers at one instant: about one lockstep tick.
constexpr int kMostRounds = 4;

}  // namespace

Mission mission_with(std::uint8_t features) {
  Mission mission = test::small_mission(kAgents);
  mission.law.contraction_gain_per_s = 1e-3;
  mission.law.contraction_center_m = mission.domain.center_m();
  mission.law.noise_intensity = 0.1;
  mission.timing.tick_count = 40;
  mission.timing.dt_s = 0.1;
  if (features & kRealtimePace) mission.timing.pace = Pace::kRealtime;
  if (features & kLooksAhead) {
    mission.law.anticipation = 2;
    mission.dead_reckoning = true;
    mission.timing.broadcast_period_ticks = 4;
  }
  if (features & kRadioRange) mission.radio_range_m = 150;
  if (features & kForgetting) mission.forget_silent_after_s = 4;
  if (features & kEviction) mission.timing.on_timeout = OnTimeout::kEvict;
  mission.wait_for_logger = (features & kWaitsForLogger) != 0;
  if (features & kTwoBlocks) {
    mission.basis.modes_x = mission.basis.modes_y = 12;
    mission.target_coefficients = Coefficients::Zero(144);
    mission.target_coefficients[0] = 1;
  }
  return mission;
}

AgentId transmitter_in(const Message& message, AgentId transmitter) {
  const bool may_be_relayed = std::holds_alternative<Contribution>(message);
  return may_be_relayed && transmitter < kMaxAgents ? transmitter : header_of(message).sender;
}

void check(const Agent& agent) {
  if (agent.coverage() == nullptr) return;
  const auto most = static_cast<std::size_t>(kMaxAgents * kMaxIncarnationsPerAgent);
  ERGOCAST_REQUIRE(agent.coverage()->row_count() <= most);
  for (const double c : agent.team_coverage().reshaped()) {
    ERGOCAST_REQUIRE(std::abs(c) <= 1 + 1e-6);
  }
}

void check(const TeamPicture& picture) {
  for (const std::string& text : {team_table(picture, false), team_json(picture)}) {
    for (const char c : text) ERGOCAST_REQUIRE(c == '\n' || (c & 0xE0) != 0);
  }
}

void check_table(std::string_view table) {
  ERGOCAST_REQUIRE(table.find("nan") == table.npos && table.find("inf") == table.npos);
}

SmallTeam::SmallTeam(std::uint8_t features)
    : mission_(mission_with(features)),
      world_(kRun, test::kWorldLife),
      coordinator_({kRun, test::kCoordinatorLife, "base", "1"}, encode_plan(mission_),
                   features & kCoordinatorTakesOver ? Takeover::kIfRunning : Takeover::kNever),
      recorder_(kRun, test::kLoggerLife, trajectory_, metrics_),
      view_(kRun, now_) {
  for (AgentId id = 0; id < kAgents; ++id) {
    agents_.emplace_back(AgentIdentity{kRun, id, test::incarnation_of(id), "here", "1"});
  }
}

void SmallTeam::take(const Message& message, AgentId transmitter) {
  for (Agent& agent : agents_) test::give(agent, message, now_, transmitter);
  test::give(world_, message, now_);
  test::give(coordinator_, message, now_);
  test::give(recorder_, message, now_);
  test::give(view_, message, now_);
}

void SmallTeam::receive(std::span<const std::byte> datagram, AgentId transmitter) {
  const auto decoded = decode(datagram, kRun);
  if (decoded) take(*decoded, transmitter_in(*decoded, transmitter));
}

void SmallTeam::pass(std::chrono::nanoseconds time) {
  now_ += time;
  advance_all();
}

void SmallTeam::advance_all() {
  for (int round = 0; round < kMostRounds; ++round) {
    Outbox out;
    coordinator_.advance(now_, out);
    world_.advance(now_, out);
    for (Agent& agent : agents_) agent.advance(now_, out);
    recorder_.advance(now_, out);
    if (out.empty()) return;
    deliver(out);
  }
}

void SmallTeam::deliver(const Outbox& out) {
  for (const Outgoing& outgoing : out) {
    encode(outgoing.message, bytes_);
    const auto decoded = decode(bytes_, kRun);
    // The team's own messages are valid, whatever it received.
    ERGOCAST_REQUIRE(decoded.has_value());
    const AgentId transmitter =
        outgoing.relayer == kUnassigned ? header_of(outgoing.message).sender : outgoing.relayer;
    if (on_sent) on_sent(transmitter, bytes_);
    take(*decoded, transmitter);
  }
}

void SmallTeam::check() const {
  for (const Agent& agent : agents_) fuzz::check(agent);
  ERGOCAST_REQUIRE(world_.tick() >= 0 && world_.tick() <= mission_.timing.tick_count);
  check_table(trajectory_.view());
  check_table(metrics_.view());
  fuzz::check(view_.picture(now_));
}

}  // namespace ergocast::fuzz
