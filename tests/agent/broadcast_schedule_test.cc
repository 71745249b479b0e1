// When an agent speaks: in its turn within a fixed period, or as seldom as its error budget allows.
#include "agent/broadcast_schedule.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

Mission mission_with(double budget, int period = 2, int heartbeat = 40) {
  Mission mission = two_block_mission(2);
  mission.target_coefficients(1, 0) = 0.4;
  mission.target_coefficients(2, 3) = -0.2;
  mission.timing.broadcast_error_budget = budget;
  mission.timing.broadcast_period_ticks = period;
  mission.timing.broadcast_heartbeat_ticks = heartbeat;
  return mission;
}

/// Two agents on straight lines; the first speaks by its schedule, the second is always known.
class StraightFlight {
 public:
  struct Silence {
    Tick from, until;
    double error, allowed;  ///< √(Σ λ Δc²) just before it ended, and its share of φ
  };

  explicit StraightFlight(const Mission& mission)
      : mission_(mission),
        weights_(sobolev_weights(mission.basis, mission.domain)),
        all_(mission.basis, mission.timing.dt_s),
        schedule_(mission, author_of(0)) {}

  std::vector<Silence> fly(Tick ticks) {
    std::vector<Silence> silences;
    std::vector<Contribution> said;
    Tick last = -1, next = 0;
    for (Tick tick = 0; tick < ticks; ++tick) {
      const double s = static_cast<double>(tick);
      sample(author_of(0), {100 + 0.8 * s, 200 + 0.6 * s});
      sample(author_of(1), {1700 - 0.6 * s, 300 + 0.8 * s});
      if (tick < next) continue;
      const Coefficients coverage = average(all_);
      if (last >= 0) {
        const double phi = std::sqrt(ergodic_metric(coverage, mission_.target_coefficients, weights_));
        silences.push_back({last, tick,
                            std::sqrt(ergodic_metric(coverage, known_from(said), weights_)),
                            mission_.timing.broadcast_error_budget * phi / 2});
      }
      said = {all_.block(author_of(0), 0), all_.block(author_of(0), 1)};
      last = tick;
      next = schedule_.next_after(tick, all_, coverage, 2);
    }
    return silences;
  }

 private:
  void sample(const Author& author, const Eigen::Vector2d& x_m) {
    all_.add_sample(author, BasisAt(x_m, mission_.domain, mission_.basis));
  }
  Coefficients average(const CoverageTable& table) const {
    Coefficients coverage = Coefficients::Zero(12, 12);
    table.average(coverage);
    return coverage;
  }
  /// c as the teammate knows it.
  Coefficients known_from(const std::vector<Contribution>& said) const {
    CoverageTable known(mission_.basis, mission_.timing.dt_s);
    for (int b = 0; b < 2; ++b) {
      known.merge(said[static_cast<std::size_t>(b)], 1000000);
      known.merge(all_.block(author_of(1), b), 1000000);
    }
    return average(known);
  }

  Mission mission_;
  Coefficients weights_;
  CoverageTable all_;
  BroadcastSchedule schedule_;
};

TEST(FixedPeriod, EachAgentHasItsTurn) {
  Mission mission = small_mission(4);
  mission.timing.broadcast_period_ticks = 8;
  const CoverageTable table(mission.basis, mission.timing.dt_s);
  for (AgentId id = 0; id < 4; ++id) {
    BroadcastSchedule schedule(mission, author_of(id));
    for (Tick tick = 0; tick < 50; ++tick) {
      const Tick next = schedule.next_after(tick, table, Coefficients::Zero(5, 4), 4);
      EXPECT_GT(next, tick);
      EXPECT_LE(next, tick + 8);
      EXPECT_EQ(next % 8, 2 * id) << "the turns are spread over the period";
    }
  }
}

TEST(FixedPeriod, IsWhatNoBudgetMeansHoweverSmallTheError) {
  for (const StraightFlight::Silence& silence : StraightFlight(mission_with(0, 4)).fly(400)) {
    EXPECT_EQ(silence.until % 4, 0);
    EXPECT_EQ(silence.until - silence.from, 4);
  }
}

TEST(ErrorBudget, SilencesLastBetweenThePeriodAndTheHeartbeat) {
  for (const double budget : {1e-9, 0.05, 1.0}) {
    const auto silences = StraightFlight(mission_with(budget)).fly(1000);
    for (std::size_t i = 1; i < silences.size(); ++i) {  // the first is the turn within the period
      const Tick lasted = silences[i].until - silences[i].from;
      EXPECT_GE(lasted, 2);
      EXPECT_LE(lasted, 40);
    }
  }
}

TEST(ErrorBudget, TooSmallForAnythingMeansTheShortestPeriod) {
  for (const auto& silence : StraightFlight(mission_with(1e-9)).fly(400)) {
    EXPECT_EQ(silence.until - silence.from, 2);
  }
}

TEST(ErrorBudget, LargeMeansTheHeartbeatReachedByDoublings) {
  const auto silences = StraightFlight(mission_with(1, 2, 40)).fly(1000);
  ASSERT_GT(silences.size(), 6u);
  for (std::size_t i = 1; i < silences.size(); ++i) {
    EXPECT_LE(silences[i].until - silences[i].from, 2 * (silences[i - 1].until - silences[i - 1].from))
        << "the next stretch may not be like the last";
  }
  EXPECT_EQ(silences.back().until - silences.back().from, 40);
}

TEST(ErrorBudget, BoundsWhatSilenceCostsTheTeam) {
  for (const double budget : {0.01, 0.03, 0.1}) {
    int longer = 0;
    for (const auto& silence : StraightFlight(mission_with(budget)).fly(2000)) {
      if (silence.until - silence.from <= 2) continue;  // no shorter period is allowed
      // Foreseen as a straight line; what it is in the end bends by less than 5 % on this path.
      EXPECT_LE(silence.error, 1.05 * silence.allowed)
          << "budget " << budget << ", ticks " << silence.from << " to " << silence.until;
      ++longer;
    }
    EXPECT_GT(longer, 20) << "and there are silences to speak of";
  }
}

TEST(ErrorBudget, IsSharedByTheTeam) {
  // With twice the team, each may leave half as much unsaid.
  const Mission mission = mission_with(0.02, 1, 10000);
  const auto second_silence = [&](int agents) {
    CoverageTable table(mission.basis, mission.timing.dt_s);
    BroadcastSchedule schedule(mission, author_of(0));
    Coefficients coverage = Coefficients::Zero(12, 12);
    for (int i = 0; i < 500; ++i) {
      table.add_sample(author_of(1), BasisAt({1500, 900}, mission.domain, mission.basis));
    }
    Tick next = 0, silence = 0;
    for (Tick tick = 0; tick < 2000; ++tick) {
      table.add_sample(author_of(0), BasisAt({900, 400}, mission.domain, mission.basis));
      if (tick < next) continue;
      table.average(coverage);
      next = schedule.next_after(tick, table, coverage, agents);
      silence = next - tick;
    }
    return static_cast<double>(silence);
  };
  // Whole ticks, and both change along the way.
  EXPECT_NEAR(second_silence(2) / second_silence(4), 2, 0.25);
}

}  // namespace
}  // namespace ergocast
