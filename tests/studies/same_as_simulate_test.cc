// SPDX-License-Identifier: BSD-3-Clause
// A study runs the same mission as `ergocast simulate`, bit for bit, for every scenario: without
// messages where the ideal team gives the same result, with messages elsewhere.
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <sstream>

#include "lab/ideal_team.h"
#include "lab/simulation.h"
#include "plan/plan.h"
#include "scenario/scenario.h"
#include "studies/study_run.h"
#include "tests/support/drawn_scenario.h"
#include "tests/support/temp_folder.h"

namespace ergocast::test {
namespace {

using studies::StudyFigures;

constexpr int kMissions = 150;

class Drawn {
 public:
  Drawn() { write_files(folder_.path()); }

  /// The text of the next valid scenario.
  std::string next() {
    while (true) {
      scenario = drawn_scenario(++seed_);
      std::string text;
      google::protobuf::TextFormat::PrintToString(scenario, &text);
      auto parsed = Scenario::parse(text, (folder_.path() / "drawn.textproto").string());
      if (parsed) {
        compiled.emplace(*std::move(parsed));
        return "drawn from seed " + std::to_string(seed_) + ":\n" + text;
      }
      ++refused;
    }
  }

  proto::Scenario scenario;
  std::optional<Scenario> compiled;
  int refused = 0;

 private:
  TempFolder folder_;
  std::uint64_t seed_ = 0;
};

/// What differs, nan being equal to itself; nothing if all bits are the same.
std::string difference(const StudyFigures& a, const StudyFigures& b) {
  std::string names;
  const auto compare = [&](const char* name, const auto& of_a, const auto& of_b) {
    if (std::memcmp(&of_a, &of_b, sizeof of_a) != 0) names += std::string(name) + ' ';
  };
  compare("seed", a.seed, b.seed);
  compare("agents", a.agents, b.agents);
  compare("complete", a.complete, b.complete);
  compare("metric_at", a.metric_at, b.metric_at);
  compare("metric", a.metric, b.metric);
  compare("slope", a.slope, b.slope);
  compare("escape_time_s", a.escape_time_s, b.escape_time_s);
  compare("offset2_mean_m2", a.offset2_mean_m2, b.offset2_mean_m2);
  compare("offset2_max_m2", a.offset2_max_m2, b.offset2_max_m2);
  compare("edge_share", a.edge_share, b.edge_share);
  compare("speed_mean_mps", a.speed_mean_mps, b.speed_mean_mps);
  compare("messages", a.messages, b.messages);
  return names;
}

/// φ² at the end as the logger of a simulation has it.
double recorded_metric(const std::vector<std::byte>& plan, bool free_domain) {
  std::ostringstream trajectory, metrics;
  lab::Simulation simulation({.plan = plan}, trajectory, metrics);
  simulation.run();
  const RunFacts& facts = simulation.recorder().facts();
  return free_domain ? facts.cosine_metric_last : facts.ergodic_metric_last;
}

TEST(SameAsSimulate, ForDrawnScenariosWithEveryField) {
  Drawn drawn;
  std::set<std::string> unused = all_fields();
  int stood_for = 0, others = 0, others_that_differ = 0;
  for (int i = 0; i < kMissions; ++i) {
    const std::string text = drawn.next();
    const Mission& mission = drawn.compiled->mission();
    const auto plan = encode_plan(drawn.compiled->mission());
    const StudyFigures simulated = studies::run_with_messages(plan);
    ASSERT_EQ(difference(studies::run_study_mission(plan), simulated), "") << text;
    if (mission.timing.pace == Pace::kLockstep) {
      const double recorded = recorded_metric(plan, mission.basis.free_domain);
      ASSERT_EQ(std::memcmp(&recorded, &simulated.metric, sizeof recorded), 0)
          << recorded << ", " << simulated.metric << '\n'
          << text;
    }
    if (lab::IdealTeam::stands_for(mission)) {
      ++stood_for;
      for (const std::string& field : fields_of(drawn.scenario)) unused.erase(field);
    } else {
      ++others;
      others_that_differ += !difference(studies::run_without_messages(mission), simulated).empty();
    }
  }
  EXPECT_EQ(::testing::PrintToString(unused), R"({ "Kind.reserve_s", "Kind.station" })")
      << "fields that no ideal team had; with stations none is ideal";
  EXPECT_GT(stood_for, kMissions / 3);
  EXPECT_GT(others_that_differ, others / 2) << "of " << others << ": the swarm is needed for these";
  EXPECT_LT(drawn.refused, kMissions);
}

}  // namespace
}  // namespace ergocast::test
