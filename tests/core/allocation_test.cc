// SPDX-License-Identifier: BSD-3-Clause
// The control step allocates nothing. The test counts every call of the allocator by this program's
// own code: operator new, replaced here, and malloc and its kin, which the linker redirects here
// (Eigen calls them directly).
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>
#include <tuple>
#include <utility>
#include <vector>

#include "core/law/control.h"
#include "core/law/coverage_table.h"
#include "core/law/forecast.h"
#include "core/law/searcher.h"
#include "core/law/site_row.h"
#include "core/law/site_table.h"
#include "core/motion/push.h"
#include "core/motion/separation.h"
#include "core/motion/wall_following.h"
#include "core/motion/walls.h"
#include "team/beacon_book.h"
#include "tests/modes/rooms.h"
#include "tests/support/team.h"

namespace {
// Atomic, because the compiler knows that malloc() changes no plain variable of ours.
std::atomic<std::size_t> g_allocations = 0;
}  // namespace

extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* block, std::size_t size);
void* __real_aligned_alloc(std::size_t alignment, std::size_t size);
int __real_posix_memalign(void** block, std::size_t alignment, std::size_t size);

void* __wrap_malloc(std::size_t size) {
  ++g_allocations;
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
  ++g_allocations;
  return __real_calloc(count, size);
}
void* __wrap_realloc(void* block, std::size_t size) {
  ++g_allocations;
  return __real_realloc(block, size);
}
void* __wrap_aligned_alloc(std::size_t alignment, std::size_t size) {
  ++g_allocations;
  return __real_aligned_alloc(alignment, size);
}
int __wrap_posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  ++g_allocations;
  return __real_posix_memalign(block, alignment, size);
}
}

// Not inlined, or the compiler sees free() at the end of a `new` and takes it for a mistake.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* block = std::malloc(size == 0 ? 1 : size)) return block;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  if (void* block = std::aligned_alloc(step, (size + step - 1) / step * step)) return block;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* block) noexcept { std::free(block); }
[[gnu::noinline]] void operator delete(void* block, std::size_t) noexcept { std::free(block); }
[[gnu::noinline]] void operator delete(void* block, std::align_val_t) noexcept { std::free(block); }
[[gnu::noinline]] void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
  std::free(block);
}

namespace ergocast {
namespace {

/// How often `action` called the allocator.
template <class Action>
std::size_t allocations_in(const Action& action) {
  const std::size_t before = g_allocations;
  action();
  return g_allocations - before;
}

/// An object that this points to must exist: the compiler may not leave its allocation out.
const void* volatile g_seen = nullptr;

TEST(Allocations, AreCountedWhateverTheWay) {
  struct alignas(64) Line {
    double value = 1;
  };
  EXPECT_EQ(allocations_in([] { g_seen = std::make_unique<double>(1).get(); }), 1u);
  EXPECT_EQ(allocations_in([] { g_seen = std::make_unique<Line>().get(); }), 1u);
  EXPECT_EQ(allocations_in([] { g_seen = std::vector<double>(100, 1.0).data(); }), 1u);
  EXPECT_EQ(allocations_in([] {
              const Coefficients coefficients = Coefficients::Constant(400, 1);
              g_seen = coefficients.data();
            }),
            1u);
  EXPECT_EQ(allocations_in([] { g_seen = nullptr; }), 0u);
}

/// The same with fewer modes, those of a free domain without walls.
void steer_by_free_domain(Mission& mission) {
  static const ModesTable table =
      test::table_of(test::grid_of(test::small_mission(4).domain, test::sees_all), 144);
  mission.basis.modes_x = mission.basis.modes_y = 12;
  mission.target_coefficients = Coefficients::Unit(144, 0);
  mission.basis.free_domain = true;
  mission.basis.table = table;
  mission.basis.table_hash = table->hash;
}

/// 20 × 20 modes, four agents, every feature of the law on; in a plane or in space.
Mission full_mission(Regularization regularization, Perturbation perturbation, int modes_z) {
  Mission mission = test::small_mission(4);
  mission.basis.modes_x = mission.basis.modes_y = 20;
  mission.basis.modes_z = modes_z;
  if (modes_z > 1) mission.domain.size_m.z() = 300;
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  mission.target_coefficients[0] = 1;
  mission.law.regularization = regularization;
  mission.law.epsilon = 0.1;
  mission.law.perturbation = perturbation;
  mission.law.noise_intensity = 1;
  mission.law.noise_ceiling = 20;
  mission.law.contraction_gain_per_s = 1e-3;
  return mission;
}

TEST(Allocations, AControlStepWithAllBlocksNewMakesNone) {
  const std::tuple<Regularization, Perturbation, int, bool> laws[] = {
      {Regularization::kAbsolute, Perturbation::kConstant, 1, false},
      {Regularization::kRelative, Perturbation::kAdaptive, 1, false},
      {Regularization::kAbsolute, Perturbation::kConstant, 3, false},
      {Regularization::kRelative, Perturbation::kAdaptive, 3, false},
      {Regularization::kAbsolute, Perturbation::kConstant, 1, true},
      {Regularization::kRelative, Perturbation::kAdaptive, 1, true}};
  for (const auto& [regularization, perturbation, modes_z, free_domain] : laws) {
    Mission mission = full_mission(regularization, perturbation, modes_z);
    if (free_domain) steer_by_free_domain(mission);
    Controller controller(mission);
    CoverageTable own(mission.basis, mission.timing.dt_s);
    Coefficients coverage = Coefficients::Zero(mission.basis.mode_count());
    std::vector<CoverageTable> teammates(3, CoverageTable(mission.basis, mission.timing.dt_s));
    const auto step = [&](Tick tick) {
      const Eigen::Vector3d x_m(100 + static_cast<double>(tick), 500,
                                0.5 * mission.domain.size_m.z());
      const BasisAt at(x_m, mission.domain, mission.basis);
      own.add_sample(test::author_of(0), at);
      for (AgentId id = 1; id < 4; ++id) {
        CoverageTable& theirs = teammates[static_cast<std::size_t>(id - 1)];
        theirs.add_sample(test::author_of(id), at);
        for (int b = 0; b < own.block_count(); ++b) {
          ASSERT_EQ(own.merge(theirs.block(test::author_of(id), b), tick + 1), Merge::kNewer);
        }
      }
      own.average(coverage);
      controller.set_coverage(coverage);
      ASSERT_TRUE(controller.command(0, tick, x_m, at).allFinite());
      ASSERT_GT(controller.metric(coverage), 0);
    };
    EXPECT_GT(allocations_in([&] { step(0); }), 0u) << "the first one makes the rows";
    step(1);  // and the next ones the blocks: each row keeps the one before, too
    step(2);
    for (Tick tick = 3; tick < 20; ++tick) {
      EXPECT_EQ(allocations_in([&] { step(tick); }), 0u) << "tick " << tick;
    }
  }
}

TEST(Allocations, SummingUpASiteAndMergingItsRowMakesNone) {
  const Mission mission = full_mission(Regularization::kAbsolute, Perturbation::kConstant, 1);
  constexpr int kModes = 400, kSites = 4;
  const LookAhead look_ahead(mission);
  const std::vector<double> covered(kModes, 0.5);
  std::vector<SiteRow> rows;
  for (int site = 0; site < kSites; ++site) rows.emplace_back(site, kModes);
  SiteTable table(kSites, 0, kModes, 10);
  std::vector<double> sums(kModes);
  double time_s = 0;
  const auto step = [&](Tick tick) {
    for (SiteRow& row : rows) {
      row.restart(1, {row.site(), 1}, tick);
      for (AgentId id = 0; id < 100; ++id) {
        row.add({.name = {{id, 1}, 1},
                 .steps = tick + 1,
                 .elapsed_s = 1,
                 .sums = covered.data(),
                 .gains = covered.data(),
                 .gained_s = 1,
                 .lag_s = 0.1});
      }
      ASSERT_EQ(table.merge(row), SiteMerge::kNewer);
    }
    time_s = table.add_forecast(look_ahead, 1, tick, sums.data());
    time_s += table.add_coverage(sums.data());
  };
  for (Tick tick = 0; tick < 5; ++tick)
    EXPECT_EQ(allocations_in([&] { step(tick); }), 0u) << "tick " << tick;
  EXPECT_GT(time_s, 600);
}

TEST(Allocations, KeepingADistanceMakesNone) {
  Mission mission = full_mission(Regularization::kAbsolute, Perturbation::kConstant, 1);
  mission.speed_limit_mps = 40;
  mission.separation.distance_m = 30;
  SeparationFilter filter(mission, 0);
  std::vector<Neighbour> others;
  for (AgentId id = 1; id < kMaxAgents; ++id)
    others.push_back({id, {500 + 30 * std::cos(id), 500 + 30 * std::sin(id), 0}, 40});
  const Mover self{0, 0, {500, 500, 0}, 40};
  EXPECT_EQ(allocations_in([&] { filter.safe(self, {30, 20, 0}, others); }), 0u);
}

TEST(Allocations, KnowingPlacesFromBeaconsMakesNone) {
  Mission mission = test::small_mission(4);
  mission.timing.pace = Pace::kRealtime;
  mission.speed_limit_mps = 40;
  mission.separation.distance_m = 30;
  mission.separation.lease_s = 2;
  std::vector<BeaconBook> books;
  for (AgentId id = 0; id < 4; ++id) {
    books.emplace_back(mission, test::author_of(id), 1);
    books.back().note_roster(test::roster_of(4));
  }
  int known = 0;
  const auto pass = [&](Tick tick) {
    const Moment now{tick, test::at(tick * std::chrono::milliseconds(100))};
    for (AgentId id = 0; id < 4; ++id) {
      BeaconBook& book = books[static_cast<std::size_t>(id)];
      book.measured(tick - 1, 1, {40.0 * id, 0, 0}, {0, 0, 0});
      if (auto beacon = book.next(1, now)) {
        beacon->header = {test::kRun, id, test::incarnation_of(id), tick, tick};
        for (BeaconBook& other : books) other.receive(*beacon, true, now);
      }
      for (const Neighbour& body : book.bodies({40.0 * id, 0, 0}, now)) known += body.known;
      book.commands(now);
    }
  };
  EXPECT_EQ(allocations_in([&] {
              for (Tick tick = 0; tick < 20; ++tick) pass(tick);
            }),
            0u);
  EXPECT_GT(known, 100);
}

TEST(Allocations, KeepingOutOfWallsMakesNone) {
  Mission mission = full_mission(Regularization::kAbsolute, Perturbation::kConstant, 1);
  mission.speed_limit_mps = 40;
  mission.disturbance_intensity = 5;
  Ring star;
  constexpr int kCorners = 1024;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 6.28 * i / kCorners, radius_m = i % 2 == 0 ? 3 : 300;
    star.emplace_back(500 + radius_m * std::cos(angle), 500 + radius_m * std::sin(angle));
  }
  mission.walls = {star};
  SeparationFilter filter(mission, 0);
  WallFollower follower(mission, 0);
  const auto step = [&](Tick tick) {
    const Eigen::Vector3d x_m(498, 502, 0);
    const Eigen::Vector3d aim_mps = follower.aim(tick, x_m, {30, 20, 0});
    const SafeVelocity safe = filter.safe({0, tick, x_m, 40}, aim_mps, {});
    follower.note(safe.wall);
    ASSERT_TRUE(moved(mission, 0, tick, x_m, safe.velocity_mps).allFinite());
  };
  for (Tick tick = 0; tick < 60; ++tick)
    EXPECT_EQ(allocations_in([&] { step(tick); }), 0u) << "tick " << tick;
  EXPECT_TRUE(follower.follows());
}

TEST(Allocations, SearchingMakesNone) {
  Mission mission = full_mission(Regularization::kRelative, Perturbation::kAdaptive, 1);
  mission.law.kind = LawKind::kSearch;
  Searcher law(mission);
  Efforts efforts(mission);
  efforts.add_row(test::author_of(0));
  const std::vector<AgentId> team{0, 1};
  const auto step = [&](Tick tick) {
    const Eigen::Vector3d x_m(100 + static_cast<double>(tick), 500, 0);
    const TeamPlace places[] = {{0, x_m}, {1, {700, 300, 0}}};
    const BasisAt at(x_m, mission.domain, mission.basis);
    efforts.look(test::author_of(0), tick, x_m);
    law.wanted_mps({0, tick, x_m, at, team, places, &efforts});
  };
  const Tick second = std::llround(1 / mission.timing.dt_s);
  for (Tick tick = 0; tick < 3 * second; ++tick)
    EXPECT_EQ(allocations_in([&] { step(tick); }), 0u) << "tick " << tick;
}

TEST(Allocations, LookingAheadMakesNoneOnceTheTeamIsKnown) {
  const std::tuple<bool, int, int, bool> missions[] = {
      {false, 1, 1, false}, {true, 1, 1, false}, {false, 3, 1, false}, {true, 3, 1, false},
      {false, 1, 4, false}, {true, 1, 4, false}, {false, 1, 1, true},  {true, 1, 1, true}};
  for (const auto& [dead_reckoning, modes_z, factor, free_domain] : missions) {
    Mission mission = full_mission(Regularization::kRelative, Perturbation::kAdaptive, modes_z);
    if (free_domain) steer_by_free_domain(mission);
    mission.law.anticipation = 2;
    mission.dead_reckoning = dead_reckoning;
    mission.timing.broadcast_period_ticks = 5;
    mission.timing.high_mode_period_factor = factor;
    const std::vector<RosterEntry> roster = test::roster_of(4);
    Forecast forecast(mission, test::author_of(0));
    CoverageTable own(mission.basis, mission.timing.dt_s);
    own.set_layout(BlockLayout(mission));
    Coefficients foreseen = Coefficients::Zero(mission.basis.mode_count());
    std::vector<CoverageTable> teammates(3, own);
    const auto step = [&](Tick tick) {
      for (AgentId id = 0; id < 4; ++id) {
        const Eigen::Vector3d x_m(100 + 30 * id + static_cast<double>(tick), 500,
                                  0.5 * mission.domain.size_m.z());
        const BasisAt at(x_m, mission.domain, mission.basis);
        forecast.see(id, tick, x_m);
        CoverageTable& theirs = id == 0 ? own : teammates[static_cast<std::size_t>(id - 1)];
        theirs.add_sample(test::author_of(id), at);
        // One agent's broadcasts are not all received, and one agent is received each tick.
        if (id == 0 || (tick % 5 != 0 && id != 3) || (tick % 10 == 5 && id == 1)) continue;
        for (int b = 0; b < own.block_count(); ++b) {
          if (b > 0 && mission.timing.high_mode_period_factor > 1 && tick % 4 == 2) continue;
          Contribution sent = theirs.block(test::author_of(id), b);
          sent.header.tick = tick;
          sent.next_broadcast_tick = tick + 5;
          ASSERT_EQ(own.merge(sent, tick + 1), Merge::kNewer);
        }
      }
      forecast.look_ahead(own, roster, tick, foreseen);
      ASSERT_NEAR(foreseen[0], 1, 1e-12);
    };
    EXPECT_GT(allocations_in([&] { step(0); }), 0u) << "the first one makes the rows";
    for (Tick tick = 1; tick < 20; ++tick) step(tick);  // each row keeps the block before, too
    // This lasts longer than places are kept.
    for (Tick tick = 20; tick < 200; ++tick) {
      EXPECT_EQ(allocations_in([&] { step(tick); }), 0u) << "tick " << tick;
    }
  }
}

}  // namespace
}  // namespace ergocast
