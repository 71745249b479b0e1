// SPDX-License-Identifier: BSD-3-Clause
// The law that searches: cells, rows of looks, the potential, and teams that find more.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/base/noise.h"
#include "core/law/searcher.h"
#include "core/measure/detection.h"
#include "core/measure/target_mass.h"
#include "core/search/efforts.h"
#include "core/search/search_field.h"
#include "core/search/search_heading.h"
#include "lab/ideal_team.h"

namespace ergocast {
namespace {

using Eigen::Vector3d;

/// 400 m × 200 m with a uniform target.
Mission field() {
  Mission mission;
  mission.domain = {{-20, 5, 0}, {400, 200, 0}};
  mission.basis.modes_x = mission.basis.modes_y = 8;
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  mission.target_coefficients[0] = 1;
  mission.law.kind = LawKind::kSearch;
  mission.law.u_max_mps = 5;
  mission.law.regularization = Regularization::kRelative;
  mission.timing.dt_s = 0.1;
  mission.sensor.radius_m = 10;
  return mission;
}

/// All looks of all cells.
std::uint64_t looks_in(const Efforts& efforts) {
  std::uint64_t all = 0;
  const Cells& cells = efforts.cells().cells;
  for (int i = 0; i < cells.count.x(); ++i) {
    for (int j = 0; j < cells.count.y(); ++j) all += efforts.looks(efforts.cells().tile_cell(i, j));
  }
  return all;
}

TEST(SearchCells, HaveTheSizeOfTheSensor) {
  const SearchCells cells(field());
  EXPECT_EQ(cells.cells.count.x(), 40);
  EXPECT_EQ(cells.cells.count.y(), 20);
  EXPECT_EQ(cells.radius_m, 10);
  EXPECT_EQ(cells.tile_count(), 5u * 3);
  // 8 nats at 0.5 per second are 16 s.
  EXPECT_NEAR(cells.most_looks * static_cast<double>(cells.ticks_per_look) * 0.1, 16, 1);
}

TEST(SearchCells, OfASmallSensorDetectAsMuchInAll) {
  Mission mission = field();
  mission.sensor.radius_m = 2;
  const SearchCells cells(mission);
  EXPECT_EQ(cells.cells.count.x(), 64);
  EXPECT_GE(cells.radius_m, 0.75 * cells.cells.size_m.head<2>().maxCoeff());
  const double look_s = static_cast<double>(cells.ticks_per_look) * 0.1;
  EXPECT_NEAR(cells.nats_per_look * std::pow(cells.radius_m, 2), 0.5 * look_s * 2 * 2, 1e-12);
}

TEST(Efforts, CountTheCellsThatASensorSees) {
  Efforts efforts(field());
  const Author author{3, 1};
  efforts.add_row(author);
  for (Tick tick = 0; tick < 100; ++tick) efforts.look(author, tick, {100, 100, 0});
  const SearchCells& cells = efforts.cells();
  const std::int64_t looks = cells.looks_by(99);
  EXPECT_GT(looks, 3);
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 20; ++j) {
      const double distance_m =
          std::hypot(cells.cells.center_m(0, i) - 100, cells.cells.center_m(1, j) - 100);
      EXPECT_EQ(efforts.looks(cells.tile_cell(i, j)),
                distance_m <= 10 ? std::min<std::int64_t>(looks, cells.most_looks) : 0)
          << i << ' ' << j;
    }
  }
  // Ticks that are counted again add nothing.
  const std::uint64_t before = looks_in(efforts);
  for (Tick tick = 50; tick < 100; ++tick) efforts.look(author, tick, {100, 100, 0});
  EXPECT_EQ(looks_in(efforts), before);
}

/// Three agents that walk, and the tiles that they send on their way.
struct Walkers {
  struct Sent {
    Author author;
    std::size_t tile;
    EffortTile content;
    Tick at;
  };

  explicit Walkers(const Mission& mission) : all(mission) {
    for (AgentId id : {0, 1, 2}) all.add_row({id, 7});
    for (Tick tick = 0; tick < 400; ++tick) {
      all.set_now(tick);
      for (AgentId id : {0, 1, 2}) {
        const double along_m = static_cast<double>(tick) * 0.8;
        all.look({id, 7}, tick, {along_m, 30 + 60.0 * id + along_m / 8, 0});
        if (tick % 20 != 19) continue;
        const std::vector<EffortTile>& row = *all.row_of({id, 7});
        for (std::size_t tile = 0; tile < row.size(); ++tile) {
          if (row[tile].newest_look >= 0) sent.push_back({{id, 7}, tile, row[tile], tick});
        }
      }
    }
  }

  Efforts all;
  std::vector<Sent> sent;
};

void expect_equal(const Efforts& one, const Efforts& other) {
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 20; ++j) {
      const TileCell cell = one.cells().tile_cell(i, j);
      EXPECT_EQ(one.looks(cell), other.looks(cell)) << i << ' ' << j;
    }
  }
}

TEST(Efforts, AreTheSameInWhateverOrderTilesArrive) {
  Walkers walkers(field());
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    std::vector<std::size_t> order(2 * walkers.sent.size());  // each arrives twice
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i % walkers.sent.size();
    for (std::size_t i = order.size(); i > 1; --i) {
      const RandomBits bits = random_words(seed, Purpose::kFault, 0, i);
      std::swap(order[i - 1], order[bits.first % i]);
    }
    Efforts heard(field());
    heard.set_now(399);
    for (const std::size_t i : order) {
      const Walkers::Sent& one = walkers.sent[i];
      EXPECT_TRUE(heard.merge(one.author, one.tile, one.content, one.at));
    }
    expect_equal(heard, walkers.all);
  }
}

TEST(Efforts, FadeAlikeForAuthorAndReceiver) {
  Mission mission = field();
  mission.law.memory_half_life_s = 10;
  Walkers walkers(mission);
  Efforts heard(mission);
  heard.set_now(399);
  for (const Walkers::Sent& one : walkers.sent)
    EXPECT_TRUE(heard.merge(one.author, one.tile, one.content, one.at));
  expect_equal(heard, walkers.all);
  Walkers lasting(field());
  EXPECT_LT(looks_in(walkers.all), looks_in(lasting.all));
  EXPECT_GT(looks_in(walkers.all), 0u);
}

TEST(Efforts, RefuseWhatNobodyCanHaveDone) {
  Efforts efforts(field());
  EffortTile tile;
  tile.newest_look = 50;
  tile.looks[5] = static_cast<std::uint16_t>(efforts.cells().looks_by(50) + 1);
  EXPECT_FALSE(efforts.merge({1, 1}, 0, tile, 60)) << "more looks than ticks";
  tile.looks[5] = 1;
  EXPECT_FALSE(efforts.merge({1, 1}, 0, tile, 40)) << "a look after the message";
  tile.newest_look = -1;
  EXPECT_FALSE(efforts.merge({1, 1}, 0, tile, 60)) << "looks without a tick";
  tile.newest_look = 100000;
  tile.looks[5] = static_cast<std::uint16_t>(efforts.cells().most_looks + 1);
  EXPECT_FALSE(efforts.merge({1, 1}, 0, tile, 100000)) << "more than counts of one agent";
  EXPECT_EQ(looks_in(efforts), 0u);
}

TEST(SearchField, SolvesItsEquation) {
  const Cells cells({{0, 0, 0}, {90, 60, 0}}, 3);
  const double a_m = 12;
  const Rings walls{{{30, -1}, {30.5, -1}, {30.5, 50}, {30, 50}}};
  SearchField field(cells, walls, a_m);
  Eigen::VectorXd source = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(cells.total()));
  source[static_cast<Eigen::Index>(cells.cell_of({20, 10, 0}))] = -1;
  field.solve(source);
  const auto index = [&](int i, int j) {
    return static_cast<Eigen::Index>(cells.column(i, 0)) + j;
  };
  const auto& u = field.potential();
  for (int i = 0; i < cells.count.x(); ++i) {
    for (int j = 0; j < cells.count.y(); ++j) {
      double flow = 0;
      const auto with = [&](int ni, int nj, bool linked) {
        if (linked) flow += u[index(i, j)] - u[index(ni, nj)];
      };
      with(i + 1, j, field.linked(0, i, j));
      with(i, j + 1, field.linked(1, i, j));
      if (i > 0) with(i - 1, j, field.linked(0, i - 1, j));
      if (j > 0) with(i, j - 1, field.linked(1, i, j - 1));
      EXPECT_NEAR(u[index(i, j)] + a_m * a_m / 9 * flow, source[index(i, j)], 1e-12);
    }
  }
  EXPECT_NEAR(u.sum(), -1, 1e-9);
  // Behind the wall the way leads round its end, not through it.
  EXPECT_GT(-field.gradient({40, 10, 0}).y(), 0);
  EXPECT_FALSE(field.linked(0, 9, 3));
  EXPECT_TRUE(field.linked(0, 9, 18));
}

/// What an agent in the middle of field() knows, where all is left. The gradient pulls to the east.
struct Knowledge {
  Eigen::Vector3d heading(const IndexedRings& walls, const Vector3d& gradient) const {
    return SearchHeading(cells, walls, 0.5).best({180, 105, 0}, {left, missed}, gradient, 5, 1);
  }
  Eigen::Index at(const Vector3d& x_m) const {
    return static_cast<Eigen::Index>(cells.cells.cell_of(x_m));
  }

  SearchCells cells{field()};
  Eigen::VectorXd left = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(cells.cells.total()));
  Eigen::VectorXd missed = Eigen::VectorXd::Ones(left.size());
};

TEST(SearchHeading, LeadsWhereTheMostIsFound) {
  Knowledge known;
  EXPECT_EQ(known.heading({}, {0, 0, 0}), Vector3d(0, 0, 0)) << "all ways are equal";
  EXPECT_NEAR(known.heading({}, {-1e-5, 0, 0}).x(), 1, 1e-12) << "nothing is near";
  known.left[known.at({180, 118, 0})] = 1;
  EXPECT_GT(known.heading({}, {0, 0, 0}).y(), 0.9);
}

TEST(SearchHeading, PrefersWhatLiesBesideSearchedCells) {
  Knowledge known;
  for (const double side : {-15, 15}) known.left[known.at({180, 105 + side, 0})] = 0.5;
  for (const double side : {-15, 15}) {
    known.missed.setOnes();
    for (const double off_m : {-20, -10, 10, 20})
      known.missed[known.at({180 + off_m, 105 + side, 0})] = 0.1;
    EXPECT_GT(known.heading({}, {0, 0, 0}).y() * side, 0) << side;
  }
}

TEST(SearchHeading, TakesNoWayThroughAWall) {
  const Knowledge known;
  const IndexedRings wall{{{182, 0}, {184, 0}, {184, 300}, {182, 300}}};
  const Vector3d gradient(-1e-5, -0.5e-5, 0);
  EXPECT_GT(known.heading({}, gradient).x(), 0.8);
  EXPECT_LT(known.heading(wall, gradient).x(), 0.2);
  EXPECT_GT(known.heading(wall, gradient).y(), 0.9);
}

/// What a team has found of `mission` with a law, from random starts.
double found(Mission mission, LawKind kind, int agents, std::uint64_t seed) {
  mission.law.kind = kind;
  mission.seed = seed;
  mission.starts_m.clear();
  for (int i = 0; i < agents; ++i)
    mission.starts_m.push_back(
        uniform_in(mission.domain, seed, Purpose::kStart, static_cast<std::uint32_t>(i), 0));
  lab::IdealTeam team(mission);
  Detection detection(mission);
  detection.begin_target(
      target_mass(mission.basis, mission.walls, mission.target_coefficients, detection.cells()), 0);
  for (Tick tick = 0; tick < 1800; ++tick) {
    for (std::size_t i = 0; i < team.size(); ++i) detection.see(tick, team.x_m(i));
    team.step();
  }
  return detection.probability();
}

TEST(Searcher, FindsMoreThanCoverageAndMoreAsATeam) {
  Mission mission = field();
  mission.target_coefficients[1] = 0.3;
  mission.target_coefficients[mission.basis.modes_y] = 0.5;
  double search = 0, cover = 0, alone = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    search += found(mission, LawKind::kSearch, 3, seed) / 6;
    cover += found(mission, LawKind::kCover, 3, seed) / 6;
    alone += found(mission, LawKind::kSearch, 1, seed) / 6;
  }
  EXPECT_GT(search, cover + 0.03);
  EXPECT_GT(search, 1.5 * alone);
}

TEST(Searcher, PassesBesideItsPasses) {
  double search = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    search += found(field(), LawKind::kSearch, 4, seed) / 6;
  EXPECT_GT(search, 0.63);
}

TEST(Searcher, GoesOnFromASymmetricPlace) {
  Mission mission = field();
  mission.starts_m = {{180, 105, 0}};
  lab::IdealTeam team(mission);
  for (int i = 0; i < 300; ++i) team.step();
  EXPECT_GT((team.x_m(0) - mission.starts_m[0]).norm(), 20);
}

TEST(Searcher, SearchesANewTarget) {
  Mission mission = field();
  Searcher law(mission);
  Efforts efforts(mission);
  // Mass in the east, then in the west.
  Coefficients east = mission.target_coefficients;
  east[mission.basis.modes_y] = -0.9;
  law.set_target(east);
  const Vector3d x_m(180, 105, 0);
  const BasisAt at(x_m, mission.domain, mission.basis);
  const std::vector<AgentId> team{0};
  const std::vector<TeamPlace> places{{0, x_m}};
  const auto wanted = [&] { return law.wanted_mps({0, 0, x_m, at, team, places, &efforts}); };
  EXPECT_NEAR(wanted().x(), 5, 0.5);
  Coefficients west = east;
  west[mission.basis.modes_y] = 0.9;
  law.set_target(west);
  EXPECT_NEAR(wanted().x(), -5, 0.5);
}

TEST(Searcher, KeepsAwayFromATeammate) {
  Mission mission = field();
  Searcher law(mission);
  Efforts efforts(mission);
  const Vector3d x_m(180, 105, 0);
  const BasisAt at(x_m, mission.domain, mission.basis);
  const std::vector<AgentId> team{0, 1};
  const std::vector<TeamPlace> places{{0, x_m}, {1, {210, 105, 0}}};
  EXPECT_LT(law.wanted_mps({0, 0, x_m, at, team, places, &efforts}).x(), -3);
}

}  // namespace
}  // namespace ergocast
