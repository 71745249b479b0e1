// SPDX-License-Identifier: BSD-3-Clause
// An agent with a forecast: what its command depends on, when it may answer its tick, and that it
// never sends forecast coverage. reckoning_test.cc has the positions that it accepts.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/law/control.h"
#include "core/law/forecast.h"
#include "tests/agent/live_team.h"
#include "tests/support/bytes.h"

namespace ergocast {
namespace {

using namespace test;

Mission looking_ahead(int agents, bool dead_reckoning, Pace pace = Pace::kRealtime) {
  Mission mission = two_block_mission(agents);
  mission.law.anticipation = 2;
  mission.dead_reckoning = dead_reckoning;
  mission.timing.pace = pace;
  mission.timing.tick_count = 10000;
  return mission;
}

/// The position of agent `id` at `tick`; no two agents and ticks near each other have the same one.
Eigen::Vector3d whereabouts(AgentId id, Tick tick) {
  return {150.0 + 83.0 * id + 3.0 * static_cast<double>(tick % 100),
          200.0 + 7.0 * static_cast<double>(tick % 90), 0};
}
std::vector<Eigen::Vector3d> all_whereabouts(int agents, Tick tick) {
  std::vector<Eigen::Vector3d> places_m;
  for (AgentId id = 0; id < agents; ++id) places_m.push_back(whereabouts(id, tick));
  return places_m;
}
/// The world at `tick`, whose vehicles have all answered the tick before.
WorldState world_of(int agents, Tick tick) {
  return world_state(tick, all_whereabouts(agents, tick), tick - 1);
}

/// The blocks that agent `id` broadcasts at `tick`.
std::vector<Contribution> words_of(const Mission& mission, AgentId id, Tick tick,
                                   Tick period = 10) {
  std::vector<Eigen::Vector3d> path_m;
  for (Tick before = 0; before <= tick; ++before) path_m.push_back(whereabouts(id, before));
  return blocks_of(mission, author_of(id), path_m, tick + period);
}
void receive(Agent& agent, const std::vector<Contribution>& sent) {
  for (const Contribution& block : sent) give(agent, block, at(0s));
}

// ---- what it answers to ----

TEST(AgentForesees, ItsCommandUsesTheForecastAndItsStatusReportsWhatItKnows) {
  for (const bool dead_reckoning : {false, true}) {
    Mission mission = looking_ahead(3, dead_reckoning);
    mission.law.epsilon = 1e-4;
    mission.target_coefficients[25] = 0.4;
    Agent agent = running_agent(mission);
    CoverageTable table(mission.basis, mission.timing.dt_s);
    Forecast forecast(mission, author_of(0));
    Coefficients foreseen(144), known(144);
    Controller controller(mission);
    for (Tick tick = 0; tick < 25; ++tick) {
      if (tick % 10 == 3) {
        for (const Contribution& block : words_of(mission, 1, tick - 2)) {
          give(agent, block, at(0s));
          table.merge(block, 1000);
        }
      }
      const BasisAt here(whereabouts(0, tick), mission.domain, mission.basis);
      table.add_sample(author_of(0), here);
      for (const AgentId id : {1, 2}) forecast.see(id, tick, whereabouts(id, tick));
      const auto commands = only<Command>(deliver(agent, world_of(3, tick)));
      forecast.look_ahead(table, roster_of(3), tick, foreseen);
      table.average(known);
      ASSERT_EQ(agent.foreseen_coverage(), foreseen) << tick;
      ASSERT_EQ(agent.team_coverage(), known) << tick;
      controller.set_coverage(foreseen);
      ASSERT_EQ(commands.at(0).velocity_mps,
                controller.command(0, tick, whereabouts(0, tick), here))
          << tick;
    }
    ASSERT_NE(foreseen, known);
    EXPECT_EQ(status_after(agent, at(0s)).ergodic_metric, controller.metric(known));
  }
}

TEST(AgentForesees, NothingWithoutAnticipation) {
  Mission mission = looking_ahead(2, true);
  mission.law.anticipation = 0;
  Agent agent = running_agent(mission);
  receive(agent, words_of(mission, 1, 0));
  const auto commands = only<Command>(deliver(agent, world_of(2, 1)));
  Controller controller(mission);
  controller.set_coverage(agent.team_coverage());
  const BasisAt here(whereabouts(0, 1), mission.domain, mission.basis);
  EXPECT_EQ(commands.at(0).velocity_mps, controller.command(0, 1, whereabouts(0, 1), here));
}

// ---- the tick of a block ----

TEST(AgentForesees, TheSameOfARepeatAsOfTheBroadcast) {
  // A repeated block carries the tick of its broadcast. So an agent that receives only the repeat
  // computes the same age.
  Mission mission = looking_ahead(2, false, Pace::kLockstep);
  mission.timing.broadcast_period_ticks = 8;
  Agent author = running_agent(mission, 1);
  std::vector<Contribution> broadcast, repeated;
  for (Tick tick = 0; tick < 7; ++tick) {
    receive(author, words_of(mission, 0, tick, 8));
    const auto sent = only<Contribution>(deliver(author, world_of(2, tick)));
    if (!sent.empty()) broadcast = sent;
  }
  const Tick spoke = broadcast.at(0).header.tick;
  ASSERT_LT(spoke, 6);
  repeated = only<Contribution>(deliver(author, world_of(2, 6), at(20ms)));
  ASSERT_EQ(repeated.size(), 2u);
  for (const Contribution& block : repeated) {
    EXPECT_EQ(block.header.tick, spoke);
    EXPECT_GT(block.header.sequence, broadcast.back().header.sequence) << "a message of its own";
  }
  Coefficients foreseen[2];
  for (const auto& [sent, of_it] : {std::pair(broadcast, &foreseen[0]), {repeated, &foreseen[1]}}) {
    Agent listener = running_agent(mission, 0);
    receive(listener, sent);
    EXPECT_EQ(only<Command>(deliver(listener, world_of(2, 6))).size(), 1u);
    *of_it = listener.foreseen_coverage();
    EXPECT_NE(*of_it, listener.team_coverage());
  }
  EXPECT_EQ(foreseen[0], foreseen[1]);
}

TEST(AgentForesees, NothingFromWhatATeammateHasGainedSinceBeforeItTookPart) {
  // The data relayed to an agent by then differs for each agent that joins.
  const Mission mission = looking_ahead(3, false);
  const auto foreseen = [&](bool knows_more) {
    std::vector<RosterEntry> roster = roster_of(3);
    roster[0].active_from = 5;
    announce(mission);
    Agent agent(identity_of(0));
    give(agent, mission_part(0, MissionState::kRunning, roster), at(0s));
    deliver(agent, world_of(3, 4));
    if (knows_more) receive(agent, words_of(mission, 1, 3));
    receive(agent, words_of(mission, 1, 6));
    deliver(agent, world_of(3, 7));
    return agent.foreseen_coverage();
  };
  EXPECT_EQ(foreseen(true), foreseen(false));
}

// ---- places ----

/// A team in lockstep that broadcasts each `period` ticks: the commands of all agents at each tick.
std::vector<Eigen::Vector3d> commands_in_lockstep(Mission mission, int period, int ticks) {
  mission.timing.broadcast_period_ticks = period;
  LiveTeam team(mission);
  std::vector<Eigen::Vector3d> velocities_mps;
  const auto agents = static_cast<int>(mission.starts_m.size());
  for (Tick tick = 0; tick < ticks; ++tick) {
    std::map<AgentId, Eigen::Vector3d> by_agent;
    for (const Command& command : only<Command>(team.deliver(world_of(agents, tick), at(0s)))) {
      EXPECT_EQ(command.header.tick, tick);
      by_agent[command.header.sender] = command.velocity_mps;
    }
    EXPECT_EQ(by_agent.size(), mission.starts_m.size()) << tick;
    for (const auto& [id, velocity_mps] : by_agent) velocities_mps.push_back(velocity_mps);
  }
  return velocities_mps;
}

TEST(AgentReckons, SoThatALockstepTeamMovesTheSameHoweverSeldomItBroadcasts) {
  Mission mission = looking_ahead(4, true, Pace::kLockstep);
  mission.target_coefficients[14] = 0.3;
  const auto often = commands_in_lockstep(mission, 1, 60);
  EXPECT_EQ(commands_in_lockstep(mission, 3, 60), often) << "bit for bit";
  EXPECT_EQ(commands_in_lockstep(mission, 20, 60), often) << "bit for bit";
  mission.dead_reckoning = false;
  EXPECT_NE(commands_in_lockstep(mission, 20, 60), commands_in_lockstep(mission, 1, 60));
}

WorldState with_vehicle_1(Tick tick, const Eigen::Vector3d& x_m) {
  return world_state(tick, {whereabouts(0, tick), x_m}, tick - 1);
}

TEST(AgentReckons, NotByAVehicleOutsideTheDomain) {
  const auto foreseen = [](bool dead_reckoning, const Eigen::Vector3d& x_m) {
    const Mission mission = looking_ahead(3, dead_reckoning);
    Agent agent = running_agent(mission);
    receive(agent, words_of(mission, 1, 2));
    deliver(agent, with_vehicle_1(6, x_m));
    return agent.foreseen_coverage();
  };
  const Coefficients blind = foreseen(false, {1900, 300, 0});
  EXPECT_NE(foreseen(true, {1900, 300, 0}), blind);
  EXPECT_EQ(foreseen(true, {2001, 300, 0}), blind);
}

TEST(AgentReckons, NotByPlacesFromTheTimeOfAFormerIncarnation) {
  // 1 was restarted at tick 5. Its blocks from tick 5 on are of the new incarnation, those before
  // of the former one.
  const Mission mission = looking_ahead(3, true);
  const Author restarted{1, incarnation_of(1) + 7};
  const std::vector<RosterEntry> roster{
      {author_of(0), 0, -1}, {author_of(1), 0, 5}, {restarted, 5, -1}};
  const auto foreseen = [&](const Eigen::Vector3d& before_m) {
    announce(mission);
    Agent agent(identity_of(0));
    give(agent, mission_part(0, MissionState::kRunning, roster), at(0s));
    receive(agent, words_of(mission, 1, 2));
    for (Tick tick = 3; tick < 5; ++tick) deliver(agent, with_vehicle_1(tick, before_m));
    auto words = blocks_of(mission, restarted, {{700, 300, 0}}, 15);
    for (Contribution& block : words) block.header.tick = 5;
    receive(agent, words);
    for (Tick tick = 5; tick < 8; ++tick) deliver(agent, with_vehicle_1(tick, {700, 300, 0}));
    return agent.foreseen_coverage();
  };
  EXPECT_EQ(foreseen({1900, 900, 0}), foreseen({700, 300, 0}));
}

TEST(AgentReckons, AndSendsNothingOfIt) {
  const Mission mission = looking_ahead(3, true);
  Agent agent = running_agent(mission);
  const auto words = words_of(mission, 1, 2, 1);
  receive(agent, words);
  Outbox sent;
  std::int64_t sequence = 0;
  for (Tick tick = 3; tick < 60; ++tick) {
    // Each second agent 2 sends a digest without coverage of agent 1.
    if (tick % 10 == 0) {
      Digest digest;
      digest.header = {kRun, 2, incarnation_of(2), ++sequence, tick};
      digest.entry_count = 1;
      digest.entries[0] = {author_of(1), 0};
      give(agent, digest, at(tick * 100ms));
    }
    for (Outgoing& word : deliver(agent, world_of(3, tick), at(tick * 100ms)))
      sent.push_back(std::move(word));
    ASSERT_NE(agent.foreseen_coverage(), agent.team_coverage());
  }
  int relayed = 0;
  for (const Contribution& block : only<Contribution>(sent)) {
    if (block.header.sender == 0) {
      EXPECT_EQ(block.steps, block.header.tick - 2) << "its own, from where it was";
      continue;
    }
    ++relayed;
    EXPECT_EQ(bytes_of(block), bytes_of(words[static_cast<std::size_t>(block.block)]));
  }
  EXPECT_GT(relayed, 1);
  for (const Digest& digest : only<Digest>(sent)) EXPECT_EQ(digest.entries[1].steps, 3);
}

// ---- when a tick may be answered ----

constexpr int kInFirstPart = kMaxVehiclesPerState;

/// The two parts of the state of a team of twenty.
std::vector<WorldState> parts_of_twenty(Tick tick) {
  std::vector<WorldState> parts;
  for (int part = 0; part < 2; ++part) {
    WorldState& state = parts.emplace_back(world_state(tick, {}));
    state.part = part;
    state.parts = 2;
    state.vehicle_count = part == 0 ? kInFirstPart : 20 - kInFirstPart;
    for (int i = 0; i < state.vehicle_count; ++i) {
      Vehicle& vehicle = state.vehicles.at(static_cast<std::size_t>(i));
      vehicle.id = kInFirstPart * part + i;
      vehicle.answered_tick = tick - 1;
      vehicle.position_m = whereabouts(vehicle.id, tick);
    }
  }
  return parts;
}

TEST(AgentInLockstep, AnswersOnceAllPartsOfTheWorldsStateAreThere) {
  const Mission mission = looking_ahead(20, true, Pace::kLockstep);
  const auto foreseen = [&](AgentId self, std::vector<int> order) {
    Agent agent = running_agent(mission, self);
    for (AgentId id = 0; id < 20; ++id) {
      if (id != self) receive(agent, words_of(mission, id, 0, 3));
    }
    for (Tick tick = 0; tick < 3; ++tick) {
      const Instant now = at(tick * 1s);
      const auto parts = parts_of_twenty(tick), repeated = parts_of_twenty(tick);
      const auto first = static_cast<std::size_t>(order[static_cast<std::size_t>(tick)]);
      EXPECT_TRUE(only<Command>(deliver(agent, parts[first], now)).empty()) << self << ' ' << tick;
      EXPECT_TRUE(only<Command>(deliver(agent, repeated[first], now)).empty())
          << "the same is no other";
      if (static_cast<std::size_t>(self / kInFirstPart) == first) {
        EXPECT_EQ(status_after(agent, now).waiting_for, kWorld);
      }
      EXPECT_EQ(only<Command>(deliver(agent, parts[1 - first], now + 600ms)).size(), 1u);
    }
    return agent.foreseen_coverage();
  };
  for (const AgentId self : {0, 18}) {
    EXPECT_EQ(foreseen(self, {0, 0, 0}), foreseen(self, {1, 1, 1}));
    EXPECT_EQ(foreseen(self, {0, 0, 0}), foreseen(self, {0, 1, 0}));
  }
}

TEST(AgentInLockstep, WaitsForNoPartThatItDoesNotNeed) {
  for (const bool anticipates : {true, false}) {
    Mission mission = looking_ahead(20, !anticipates, Pace::kLockstep);
    if (!anticipates) mission.law.anticipation = 0;
    Agent agent = running_agent(mission);
    for (AgentId id = 1; id < 20; ++id) receive(agent, words_of(mission, id, 0, 3));
    EXPECT_EQ(only<Command>(deliver(agent, parts_of_twenty(0)[0])).size(), 1u);
  }
}

/// A law that reads nothing.
class Blind : public Law {
 public:
  LawNeeds needs() const override { return {.coverage = false}; }
  void set_law(const LawNumbers& /*numbers*/) override {}
  Eigen::Vector3d wanted_mps(const LawInput& /*input*/) override { return {1, 0, 0}; }
};

TEST(AgentInLockstep, WaitsForNoStateThatItsLawDoesNotRead) {
  const Mission mission = looking_ahead(20, true, Pace::kLockstep);
  announce(mission);
  Agent agent(identity_of(0),
              [](const Mission&, int /*kind*/) { return std::make_unique<Blind>(); });
  give(agent, mission_part(0, MissionState::kRunning, roster_of(20)), at(0s));
  for (AgentId id = 1; id < 20; ++id) receive(agent, words_of(mission, id, 0, 3));
  EXPECT_EQ(only<Command>(deliver(agent, parts_of_twenty(0)[0])).size(), 1u);
}

// ---- teammates that stopped ----

TEST(AgentForesees, NothingOfATeammateThatHasBeenSilentForLongerThanItLooksAhead) {
  for (const bool dead_reckoning : {false, true}) {
    Mission mission = looking_ahead(2, dead_reckoning);
    mission.law.u_max_mps = 2000 / std::sqrt(6) / 3;  // s / u_max is 3 s
    const LookAhead look_ahead(mission);
    const double horizon_s = look_ahead.horizon_s(2, 0);
    ASSERT_NEAR(horizon_s, 6 / std::sqrt(2), 1e-9);
    ASSERT_GT(horizon_s, 8 * 0.1) << "the longer of the two caps";
    Agent agent = running_agent(mission);
    for (Tick tick = 0; tick < 100; ++tick) {
      if (tick <= 20) receive(agent, words_of(mission, 1, tick, 1));
      WorldState world = world_of(2, tick);
      world.vehicles[1].answered_tick =
          std::min<Tick>(tick - 1, 20);  // it stopped; its vehicle drifts
      deliver(agent, world);
      // Its vehicle was last driven at tick 25.
      const double silent_s = 0.1 * static_cast<double>(tick - (dead_reckoning ? 25 : 20));
      const double ahead =
          (agent.foreseen_coverage() - agent.team_coverage()).cwiseAbs().maxCoeff();
      if (silent_s < horizon_s - 0.05) {
        EXPECT_GT(ahead, 1e-3) << tick;
      } else if (silent_s > horizon_s + 0.05 && !dead_reckoning) {
        EXPECT_LT(ahead, 1e-15) << tick;
      } else if (silent_s > horizon_s + 0.05) {
        // Its known coverage since its last message counts; nothing is forecast for it.
        CoverageTable table(mission.basis, mission.timing.dt_s);
        std::vector<Eigen::Vector3d> path_m, own_m;
        for (Tick t = 0; t <= 25; ++t) path_m.push_back(whereabouts(1, t));
        for (Tick t = 0; t <= tick; ++t) own_m.push_back(whereabouts(0, t));
        for (const Contribution& b : blocks_of(mission, author_of(1), path_m, 0))
          table.merge(b, 1000);
        for (const Contribution& b : blocks_of(mission, author_of(0), own_m, 0))
          table.merge(b, 1000);
        Coefficients known(144);
        table.average(known);
        EXPECT_LT((agent.foreseen_coverage() - known).cwiseAbs().maxCoeff(), 1e-12) << tick;
      }
    }
  }
}

}  // namespace
}  // namespace ergocast
