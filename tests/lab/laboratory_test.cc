// SPDX-License-Identifier: BSD-3-Clause
// Missions under faults: a seed always gives the same mission, and every kind of fault happens.
// Without faults the laboratory runs the same mission as `ergocast simulate`.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "lab/clock.h"
#include "lab/network.h"
#include "tests/support/simulated_team.h"

namespace ergocast::test {
namespace {

using lab::Faults;
using lab::TrialFigures;

const Scenario& faulty_team() {
  static const Scenario scenario = shipped_scenario("faulty_team");
  return scenario;
}

const Scenario& in_lockstep() {
  static const Scenario scenario = [] {
    Overrides overrides;
    overrides.pace = Pace::kLockstep;
    overrides.duration_s = 20;
    return shipped_scenario("paper_fig2b", overrides);
  }();
  return scenario;
}

TriedTeam run_trial(const Faults& faults, std::uint64_t seed,
                    const Scenario& scenario = faulty_team()) {
  return TriedTeam(faults, seed, scenario);
}

TEST(Laboratory, TheSameSeedGivesTheSameMission) {
  for (const std::uint64_t seed : {1U, 10U, 17U}) {
    const TriedTeam first = run_trial(lab::drawn(seed), seed),
                    second = run_trial(lab::drawn(seed), seed);
    EXPECT_EQ(first.trajectory, second.trajectory) << seed;
    EXPECT_EQ(first.result.figures.messages, second.result.figures.messages) << seed;
    EXPECT_EQ(first.result.figures.faults.lost, second.result.figures.faults.lost) << seed;
    EXPECT_EQ(first.result.figures.view_error, second.result.figures.view_error) << seed;
  }
  EXPECT_NE(run_trial(lab::drawn(1), 1).trajectory, run_trial(lab::drawn(2), 2).trajectory);
}

TEST(Laboratory, TheViewErrorIsOfAgentsThatReachedTheEnd) {
  Faults faults;
  faults.loss = 0.3;
  for (const double share : {0.6, 1.0}) {
    faults.lasting_share = share;
    const TriedTeam tried = run_trial(faults, 1);
    EXPECT_EQ(tried.problem(), "");
    EXPECT_GT(tried.result.figures.view_error, 0)
        << "the last reports, at different ticks, are not all";
    EXPECT_LT(tried.result.figures.view_error, 0.1);
  }
}

TEST(Laboratory, WithoutFaultsNothingIsDone) {
  const TriedTeam tried = run_trial({}, 1);
  EXPECT_EQ(tried.problem(), "");
  const TrialFigures& f = tried.result.figures;
  EXPECT_EQ(f.faults.lost + f.faults.cut + f.faults.duplicated + f.faults.replayed +
                f.faults.corrupted + f.faults.delayed + f.faults.reordered + f.faults.clogged +
                f.faults.clogs,
            0);
  EXPECT_EQ(f.splits + f.one_way_cuts + f.agent_crashes + f.coordinator_crashes + f.world_crashes +
                f.pauses + f.skewed_clocks,
            0);
  EXPECT_EQ(f.agent_steps, 4 * 600);
  EXPECT_EQ(f.relayed, 0);
}

TEST(Laboratory, LatencyAloneChangesNoLockstepTrajectory) {
  const Scenario& scenario = in_lockstep();
  SimulatedTeam simulated(scenario.mission());
  simulated.run();
  EXPECT_EQ(run_trial({}, scenario.mission().seed, scenario).trajectory,
            simulated.trajectory.str());
}

TEST(Laboratory, LostAndLateMessagesChangeNoLockstepTrajectory) {
  Faults faults;
  faults.loss = 0.2;
  faults.duplication = 0.2;
  faults.corruption = 0.1;
  faults.reordering = 0.2;
  faults.reordering_max_s = 0.05;
  faults.replay = 0.3;
  faults.replay_max_s = 60;
  const TriedTeam faulty = run_trial(faults, 3, in_lockstep()),
                  clean = run_trial({}, 3, in_lockstep());
  EXPECT_EQ(faulty.problem(), "");
  EXPECT_GT(faulty.result.figures.faults.lost, 1000);
  EXPECT_EQ(faulty.trajectory, clean.trajectory);
}

struct Kind {
  const char* name;
  void (*set)(Faults&);
  std::int64_t (*happened)(const TrialFigures&);
};

const Kind kKinds[] = {
    {"Loss", [](Faults& f) { f.loss = 0.3; }, [](const TrialFigures& f) { return f.faults.lost; }},
    {"Duplication", [](Faults& f) { f.duplication = 0.3; },
     [](const TrialFigures& f) { return f.faults.duplicated; }},
    {"Corruption", [](Faults& f) { f.corruption = 0.3; },
     [](const TrialFigures& f) { return f.faults.corrupted; }},
    {"Replay", [](Faults& f) { f.replay = 0.5, f.replay_max_s = 60; },
     [](const TrialFigures& f) { return f.faults.replayed; }},
    {"Delay", [](Faults& f) { f.delay_mean_s = 0.05, f.delay_max_s = 0.3; },
     [](const TrialFigures& f) { return f.faults.delayed; }},
    {"Reordering", [](Faults& f) { f.reordering = 0.3, f.reordering_max_s = 0.5; },
     [](const TrialFigures& f) { return f.faults.reordered; }},
    {"Clogging", [](Faults& f) { f.clogging = 0.01, f.clog_max_s = 2; },
     [](const TrialFigures& f) { return f.faults.clogged; }},
    {"Split", [](Faults& f) { f.partitions_per_s = 0.3, f.partition_max_s = 5; },
     [](const TrialFigures& f) { return f.splits * f.faults.cut; }},
    {"OneWayCut",
     [](Faults& f) { f.partitions_per_s = 0.3, f.partition_max_s = 5, f.one_way_share = 1; },
     [](const TrialFigures& f) { return f.one_way_cuts * f.faults.cut; }},
    {"AgentCrash", [](Faults& f) { f.agent_crashes_per_s = 0.3, f.downtime_max_s = 2; },
     [](const TrialFigures& f) { return f.agent_crashes * f.recoveries; }},
    {"CoordinatorCrash", [](Faults& f) { f.coordinator_crashes_per_s = 0.3, f.downtime_max_s = 2; },
     [](const TrialFigures& f) { return f.coordinator_crashes; }},
    {"WorldCrash", [](Faults& f) { f.world_crashes_per_s = 0.3, f.downtime_max_s = 2; },
     [](const TrialFigures& f) { return f.world_crashes; }},
    {"Pauses", [](Faults& f) { f.pauses_per_s = 0.15, f.pause_max_s = 5; },
     [](const TrialFigures& f) { return f.pauses * f.held_ticks; }},
    {"Sites",
     [](Faults& f) {
       f.sites = 4, f.link_delay_s = 0.1, f.link_jitter_s = 0.05, f.link_loss = 0.05;
       f.site_cut_s = 10, f.site_cut_at_s = 10;
     },
     [](const TrialFigures& f) { return f.splits * f.faults.cut * f.faults.lost; }},
    {"SkewedClocks", [](Faults& f) { f.clock_rate_error = 0.05, f.clock_offset_max_s = 1e6; },
     [](const TrialFigures& f) { return f.skewed_clocks; }},
};

class EachFault : public ::testing::TestWithParam<Kind> {};

TEST_P(EachFault, HappensAndIsSurvived) {
  Faults faults;
  GetParam().set(faults);
  const TriedTeam tried = run_trial(faults, 5);
  EXPECT_GT(GetParam().happened(tried.result.figures), 0);
  EXPECT_EQ(tried.problem(), "");
}

INSTANTIATE_TEST_SUITE_P(Laboratory, EachFault, ::testing::ValuesIn(kKinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(Laboratory, TheLawsOptionsBreakNoInvariant) {
  Overrides overrides;
  for (const char* option : {"law.ends_with_plan", "law.paired_pushes"}) {
    overrides.fields.push_back({option, "true", option});
  }
  EXPECT_EQ(run_trial(lab::drawn(7), 7, shipped_scenario("faulty_team", overrides)).problem(), "");
}

TEST(Laboratory, SwarmDrawsEveryKindForSomeSeedsOnly) {
  for (const lab::FaultField& field : lab::fault_fields()) {
    if (std::string(field.name) == "lasting_share") continue;  // no fault, and always there
    int on = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      const double value = lab::drawn(seed).*field.value;
      EXPECT_GE(value, 0) << field.name;
      EXPECT_LE(value, field.most) << field.name;
      on += value > 0 ? 1 : 0;
    }
    // These fields describe how faults happen, not whether. They are the same for all, or harmless
    // alone.
    const std::set<std::string> how = {"downtime_max_s", "lasting_share", "swarm_bus_only"};
    const bool of_sites =
        std::string(field.name).starts_with("site") || std::string(field.name).starts_with("link_");
    if (how.contains(field.name)) continue;
    if (of_sites) {  // only by a file
      EXPECT_EQ(on, 0) << field.name;
      continue;
    }
    EXPECT_GT(on, 20) << field.name;
    EXPECT_LT(on, 80) << field.name;
  }
}

TEST(Laboratory, ADamagedMessageIsNeverWhatItWas) {
  std::vector<std::byte> bytes(300);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i);
  for (std::uint64_t copy = 0; copy < 1000; ++copy) {
    auto damaged = bytes;
    lab::damage(damaged, 1, copy);
    EXPECT_NE(damaged, bytes) << copy;
  }
}

TEST(Laboratory, ASkewedClockIsReadBackToTheFirstMoment) {
  const lab::SkewedClock clock(1.0371, seconds(12345.678));
  for (std::int64_t ns = 1; ns < 100'000'000'000; ns = ns * 3 + 1) {
    const Instant wanted = clock.local(Instant(PacingClock::duration(ns)));
    const Instant at = clock.when(wanted);
    EXPECT_GE(clock.local(at), wanted) << ns;
    EXPECT_LT(clock.local(at - PacingClock::duration(2)), wanted) << ns;
  }
}

TEST(Laboratory, TheMissionLeavesTimeForLiveness) {
  const double healed_s = (1 - Faults().lasting_share) * 60;
  EXPECT_LT(lab::recovery_bound_s(faulty_team().mission(), {}), healed_s - 5);
}

}  // namespace
}  // namespace ergocast::test
