// SPDX-License-Identifier: BSD-3-Clause
// A study runs the same mission as `ergocast simulate`, bit for bit, for every scenario: without
// messages where the ideal team gives the same result, with messages elsewhere.
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/law/law.h"
#include "core/mission/amendments.h"
#include "core/mission/kinds.h"
#include "lab/ideal_team.h"
#include "lab/simulation.h"
#include "lab/site_simulation.h"
#include "plan/plan.h"
#include "scenario/scenario.h"
#include "studies/study_run.h"
#include "tests/support/drawn_scenario.h"
#include "tests/support/team.h"
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
  compare("detection_probability", a.detection_probability, b.detection_probability);
  compare("objects_found", a.objects_found, b.objects_found);
  compare("first_find_time_s", a.first_find_time_s, b.first_find_time_s);
  compare("half_time_s", a.half_time_s, b.half_time_s);
  compare("four_fifths_time_s", a.four_fifths_time_s, b.four_fifths_time_s);
  compare("greatest_age_s", a.greatest_age_s, b.greatest_age_s);
  compare("wasserstein_m", a.wasserstein_m, b.wasserstein_m);
  compare("path_m", a.path_m, b.path_m);
  return names;
}

/// φ² at the end as the logger of a simulation has it.
double recorded_metric(const std::vector<std::byte>& plan, const Mission& mission) {
  std::ostringstream trajectory, metrics;
  std::optional<lab::Simulation> simulation;
  std::optional<lab::SiteSimulation> sites;
  if (mission.sites.any()) {
    sites.emplace(plan, trajectory, metrics);
    while (sites->step()) {
    }
  } else {
    simulation.emplace(lab::SimulationOptions{.plan = plan}, trajectory, metrics);
    simulation->run();
  }
  const RunFacts& facts = (sites ? sites->recorder() : simulation->recorder()).facts();
  return mission.basis.free_domain ? facts.cosine_metric_last : facts.ergodic_metric_last;
}

TEST(SameAsSimulate, ForDrawnScenariosWithEveryField) {
  Drawn drawn;
  std::set<std::string> unused = all_fields();
  int stood_for = 0, others = 0, others_that_differ = 0, divided = 0;
  for (int i = 0; i < kMissions; ++i) {
    const std::string text = drawn.next();
    const Mission& mission = drawn.compiled->mission();
    const auto plan = encode_plan(drawn.compiled->mission());
    // A team of sites sends no messages.
    const StudyFigures simulated = mission.sites.any() ? studies::run_without_messages(mission)
                                                       : studies::run_with_messages(plan);
    divided += mission.sites.any() ? 1 : 0;
    ASSERT_EQ(difference(studies::run_study_mission(plan), simulated), "") << text;
    if (mission.timing.pace == Pace::kLockstep) {
      const double recorded = recorded_metric(plan, mission);
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
  EXPECT_EQ(
      ::testing::PrintToString(unused),
      R"({ "Battery.capacity_wh", "Battery.charge_w", "Battery.power_w", "Battery.reserve", "Kind.battery", )"
      R"("Kind.reserve_s", "Kind.station", "Objects.end_when_found", "Polygon.solid_white", )"
      R"("Polygon.unknown_free" })")
      << "fields that no ideal team had; with stations or an end by finding none is ideal, and "
         "neither maps nor "
         "drawings are drawn";
  EXPECT_GT(divided, 2);
  EXPECT_GT(stood_for, kMissions / 3);
  EXPECT_GT(others_that_differ, others / 2) << "of " << others << ": the swarm is needed for these";
  EXPECT_LT(drawn.refused, kMissions);
}

// ---- laws of a program's own ----

/// Reads all that a law may read: it goes on as before, away from the nearest teammate, and the
/// more so the more has been covered.
class Shy final : public Law {
 public:
  Shy(const Mission& mission, int kind)
      : planar_(mission.domain.planar()), u_max_mps_(law_of(mission, kind).u_max_mps) {}
  LawNeeds needs() const override { return {.team = true, .places = true}; }
  void set_law(const LawNumbers& numbers) override { u_max_mps_ = numbers.u_max_mps; }
  void set_coverage(const Coefficients& coverage) override { covered_ = coverage.sum(); }

  Eigen::Vector3d wanted_mps(const LawInput& input) override {
    EXPECT_TRUE(std::ranges::equal(input.team, input.places, {}, {}, &TeamPlace::agent));
    for (const TeamPlace& other : input.places) {
      EXPECT_TRUE(other.agent != input.agent || other.x_m == input.x_m);
      const Eigen::Vector3d away_m = input.x_m - other.x_m;
      if (away_m.norm() > 0) way_ += away_m * (1 + std::abs(covered_)) / away_m.squaredNorm();
    }
    if (planar_) way_.z() = 0;
    way_.normalize();
    return way_ * u_max_mps_;
  }

 private:
  bool planar_;
  double u_max_mps_, covered_ = 0;
  Eigen::Vector3d way_{1, 0, 0};
};

TEST(SameAsSimulate, UnderALawOfAProgramsOwn) {
  const LawMaker laws = [](const Mission& mission, int kind) {
    return std::make_unique<Shy>(mission, kind);
  };
  Drawn drawn;
  int stood_for = 0;
  while (stood_for < 20) {
    const std::string text = drawn.next();
    const Mission& mission = drawn.compiled->mission();
    if (!lab::IdealTeam::stands_for(mission, laws(mission, 0)->needs())) continue;
    if (mission.sites.any()) continue;  // agents do not know the places of other sites
    ++stood_for;
    const auto plan = encode_plan(mission);
    const StudyFigures simulated = studies::run_with_messages(plan, laws);
    ASSERT_EQ(difference(studies::run_study_mission(plan, laws), simulated), "") << text;
    ASSERT_NE(difference(studies::run_study_mission(plan), simulated), "") << text;
  }
}

TEST(IdealTeam, RefusesLawsThatDifferInTheirNeeds) {
  Mission mission = small_mission(3);
  mission.kinds.resize(2);
  mission.kinds[0].count = 2;
  mission.kinds[1].count = 1;
  const auto laws_until = [&](int first_shy) -> LawMaker {
    return [first_shy](const Mission& planned, int kind) -> std::unique_ptr<Law> {
      if (kind >= first_shy) return std::make_unique<Shy>(planned, kind);
      return make_law(planned, kind);
    };
  };
  using lab::Edges, lab::IdealTeam;
  EXPECT_NO_THROW(IdealTeam(mission, Edges::kReflect, laws_until(0)));
  EXPECT_THROW(IdealTeam(mission, Edges::kReflect, laws_until(1)), std::logic_error);
  EXPECT_NO_THROW(IdealTeam(mission, Edges::kReflect, laws_until(2)));
}

TEST(LawNeeds, AreThoseOfTheLawThatIsMade) {
  Mission mission = small_mission(2);
  for (const LawKind kind : {LawKind::kCover, LawKind::kMow, LawKind::kSearch}) {
    mission.law.kind = kind;
    EXPECT_EQ(law_needs(mission), make_law(mission)->needs()) << static_cast<int>(kind);
  }
}

// ---- targets that change in flight ----

constexpr Tick kChanges[] = {60, 130};

/// A team with one peak at x, and what `law`, `time` and `agents` say besides.
struct Case {
  const char *law, *time, *agents;
};

Mission mission_of(const Case& one, int peak_x_m) {
  const std::string text =
      "domain { size_x_m: 1000 size_y_m: 800 } target { gaussians { mean_x_m: " +
      std::to_string(peak_x_m) + " mean_y_m: 300 sigma_m: 120 } } law { u_max_mps: 20 " + one.law +
      " } time { duration_s: 30 " + one.time + " } agents { random_count: 5 " + one.agents + " }";
  return Scenario::parse(text, "peak").value().mission();
}

/// The targets of this case, each from its tick.
Amendments amendments_of(const Case& one) {
  Amendments list;
  for (const Tick from : kChanges) {
    TargetChange change;
    change.target = mission_of(one, 200 + 5 * static_cast<int>(from)).target_coefficients;
    name_target(list, from, change);
  }
  return list;
}

/// The places of all agents, by tick.
using Places = std::map<Tick, std::vector<Eigen::Vector3d>>;

class PlaceObserver : public lab::SimulationObserver {
 public:
  void received(lab::NodeId, const Message& message) override {
    const auto* const world = std::get_if<WorldState>(&message);
    if (world == nullptr || world->header.tick < 0) return;
    auto& at = places[world->header.tick];
    at.resize(5);
    for (const Vehicle& vehicle : world->vehicles_in_part())
      at[static_cast<std::size_t>(vehicle.id)] = vehicle.position_m;
  }
  Places places;
};

Places simulated_places(const Mission& mission, const Amendments& list) {
  std::ostringstream trajectory, metrics;
  PlaceObserver observer;
  lab::Simulation({.plan = encode_plan(mission), .amendments = list}, trajectory, metrics,
                  &observer)
      .run();
  return observer.places;
}

Places ideal_places(const Mission& mission, const Amendments& list) {
  Places places;
  lab::IdealTeam team(mission);
  team.note(list);
  while (true) {
    for (std::size_t i = 0; i < team.size(); ++i) places[team.tick()].push_back(team.x_m(i));
    if (team.tick() == mission.timing.tick_count) return places;
    team.step();
  }
}

/// The greatest distance between two places of one agent at one tick.
double distance_m(const Places& a, const Places& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double most_m = 0;
  for (const auto& [tick, of_a] : a) {
    for (std::size_t i = 0; i < of_a.size(); ++i)
      most_m = std::max(most_m, (of_a[i] - b.at(tick)[i]).norm());
  }
  return most_m;
}

class SameAsSimulateAmended : public ::testing::TestWithParam<Case> {};

TEST_P(SameAsSimulateAmended, WhereAllIsSentEachTick) {
  const Mission mission = mission_of(GetParam(), 200);
  const Amendments list = amendments_of(GetParam());
  const Places simulated = simulated_places(mission, list), ideal = ideal_places(mission, list);
  ASSERT_EQ(simulated.size(), 301U);
  EXPECT_EQ(distance_m(simulated, ideal), 0);
  EXPECT_GT(distance_m(ideal, ideal_places(mission, {})), 1) << "the changes matter";
}

INSTANTIATE_TEST_SUITE_P(
    Laws, SameAsSimulateAmended,
    ::testing::Values(Case{"", "broadcast_period_ticks: 1", ""},
                      Case{"", "broadcast_period_ticks: 1", "dead_reckoning: false"},
                      Case{"anticipation: 0", "", ""},
                      Case{"", "broadcast_period_ticks: 1",
                           "kind { name: \"wide\" count: 2 footprint_sigma_m: 60 quality: 0.7 } "
                           "kind { name: \"fine\" count: 3 }"}));

TEST(SameAsSimulate, UpToRoundingWithTargetsThatChangeBetweenBroadcasts) {
  for (const char* time : {"", "high_mode_period_factor: 3"}) {
    const Case one{"", time, ""};
    const Mission mission = mission_of(one, 200);
    ASSERT_GT(mission.timing.broadcast_period_ticks, 1);
    const Amendments list = amendments_of(one);
    EXPECT_LT(distance_m(simulated_places(mission, list), ideal_places(mission, list)), 1e-6);
  }
}

TEST(SameAsSimulate, WithATargetThatIsKnownBeforeItHolds) {
  const Case one{"", "broadcast_period_ticks: 1", "dead_reckoning: false"};
  const Mission mission = mission_of(one, 200);
  Amendments list;
  TargetChange change;
  change.target = mission_of(one, 800).target_coefficients;
  name_target(list, 1000, change);
  EXPECT_EQ(distance_m(simulated_places(mission, list), simulated_places(mission, {})), 0);
}

TEST(SameAsSimulate, WithLawsThatChange) {
  const Case one{"perturbation: ADAPTIVE", "broadcast_period_ticks: 1",
                 "kind { name: \"wide\" count: 2 u_max_mps: 10 } kind { name: \"fine\" count: 3 }"};
  const Mission mission = mission_of(one, 200);
  Amendments list;
  double share = 1;
  for (const Tick from : kChanges) {
    LawChange law = plans_law(mission);
    share /= 2;
    for (LawNumbers& numbers : law.kinds) numbers.u_max_mps *= share;
    name_law(list, from, law);
  }
  const Places ideal = ideal_places(mission, list);
  EXPECT_EQ(distance_m(simulated_places(mission, list), ideal), 0);
  EXPECT_GT(distance_m(ideal, ideal_places(mission, {})), 1) << "the changes matter";
}

}  // namespace
}  // namespace ergocast::test
