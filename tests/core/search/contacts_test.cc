// SPDX-License-Identifier: BSD-3-Clause
// Sensors with false alarms: what they report, what agreeing reports mean, and what is confirmed.
#include "core/search/contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "core/base/noise.h"
#include "core/law/searcher.h"
#include "core/measure/objects.h"
#include "core/search/confirmations.h"
#include "core/search/reports.h"
#include "tests/core/search/field.h"

namespace ergocast {
namespace {

using Eigen::Vector3d;

std::vector<double> uniform(const Mission& mission) {
  const std::size_t cells = SearchCells(mission).cells.total();
  return std::vector<double>(cells, 1 / static_cast<double>(cells));
}

/// The number of the cell that contains a place.
std::int32_t cell_at(const Mission& mission, const Vector3d& x_m) {
  return static_cast<std::int32_t>(SearchCells(mission).cells.cell_of(x_m));
}

TEST(Reports, AreOfObjectsWithAnErrorAndOfNothingAtTheirRate) {
  Mission mission = searched_field();
  const Vector3d object_m(105, 45, 0);
  mission.objects = {0, {object_m}};
  Objects objects(mission);
  const Reports reports(mission);
  const SearchCells cells(mission);
  int false_alarms = 0, true_reports = 0, right = 0;
  constexpr Tick kTicks = 400000;
  for (Tick tick = 0; tick < kTicks; ++tick) {
    const Vector3d x_m(50, 50, 0);
    const std::int32_t cell =
        reports.cell(3, tick, x_m, objects.detected(3, tick, x_m), objects.places_m());
    if (cell == kNoCell) continue;
    ++false_alarms;
    const int i = cell / cells.cells.count.y(), j = cell % cells.cells.count.y();
    EXPECT_LT(std::hypot(cells.cells.center_m(0, i) - 50, cells.cells.center_m(1, j) - 50),
              10 + 10 / std::numbers::sqrt2);
  }
  for (Tick tick = 0; tick < 20000; ++tick) {
    const ObjectSet detected = objects.detected(3, tick, {109, 45, 0});
    const std::int32_t cell = reports.cell(3, tick, {109, 45, 0}, detected, objects.places_m());
    if (detected == 0) continue;
    ++true_reports;
    right += cell == cell_at(mission, object_m) ? 1 : 0;
  }
  EXPECT_NEAR(false_alarms, kTicks * 0.1 * 0.02, 4 * std::sqrt(kTicks * 0.1 * 0.02));
  // The object is on the edge of two rows of cells, in the middle of its column.
  const double in_column = std::erf(5 / 2.0 / std::numbers::sqrt2);
  EXPECT_NEAR(right / static_cast<double>(true_reports), in_column / 2, 0.06);
  mission.sensor.false_alarms_per_s = 0;
  EXPECT_EQ(Reports(mission).cell(3, 1, object_m, 1, {object_m}), kNoCell);
}

/// The counts after an agent has looked at the middle for so many looks, and has reported there.
Efforts looked(const Mission& mission, std::int64_t looks, int reports) {
  Efforts efforts(mission);
  efforts.add_row({0, 1});
  const SearchCells& cells = efforts.cells();
  for (Tick tick = 0; cells.looks_by(tick) <= looks; ++tick) {
    efforts.look({0, 1}, tick, {85, 60, 0});
    if (tick < reports) efforts.report({0, 1}, tick, cell_at(mission, {85, 60, 0}));
  }
  return efforts;
}

// o = Σ m exp(−n L) g / (1 − Σ m) over the cell of the reports and its neighbours.
TEST(Contacts, HaveTheOddsOfTheirLooksAndReports) {
  const Mission mission = searched_field();
  const double sides = 10 / 2.0;
  const double own = std::erf(sides / std::numbers::sqrt2) -
                     std::sqrt(2 / std::numbers::pi) / sides * (1 - std::exp(-sides * sides / 2));
  const int i = 10, j = 5;
  ASSERT_EQ(cell_at(mission, {85, 60, 0}), i * 10 + j);
  for (const int reports : {1, 2, 3}) {
    const Efforts efforts = looked(mission, 4, reports);
    const SearchCells& cells = efforts.cells();
    double odds = 0;
    for (const int di : {-1, 0, 1}) {
      for (const int dj : {-1, 0, 1}) {
        const double share = (di == 0 ? own : (1 - own) / 2) * (dj == 0 ? own : (1 - own) / 2);
        const double gain = 1 + 0.5 * std::numbers::pi * 100 * share / (0.02 * 100);
        const double left =
            std::exp(-cells.nats_per_look * efforts.looks(cells.tile_cell(i + di, j + dj))) / 200;
        odds += left * std::pow(gain, reports) / (1 - 9.0 / 200);
      }
    }
    for (const double factor : {0.99, 1.01}) {
      Mission close = mission;
      close.sensor.confirm_at = odds * factor / (1 + odds * factor);
      Contacts contacts(close);
      contacts.set_prior(uniform(close));
      contacts.renew(efforts);
      EXPECT_EQ(contacts.confirmed_contacts().size(), factor < 1 ? 1u : 0u) << reports;
      for (const Vector3d& x_m : {Vector3d(85, 60, 0), Vector3d(95, 50, 0)})
        EXPECT_EQ(contacts.confirmed(static_cast<std::size_t>(cell_at(close, x_m))), factor < 1);
      EXPECT_FALSE(contacts.confirmed(static_cast<std::size_t>(cell_at(close, {105, 60, 0}))));
    }
  }
}

TEST(Contacts, OfWhichNothingComesLoseTheirWeight) {
  const Mission mission = searched_field();
  const auto cell = static_cast<std::size_t>(cell_at(mission, {85, 60, 0}));
  double before = 1e9;
  for (const std::int64_t looks : {1, 10, 20}) {
    const Efforts efforts = looked(mission, looks, 1);
    Contacts contacts(mission);
    contacts.set_prior(uniform(mission));
    contacts.renew(efforts);
    const double nats =
        contacts.nats(cell) -
        efforts.cells().nats_per_look *
            efforts.looks(efforts.cells().tile_cell(static_cast<std::int32_t>(cell)));
    EXPECT_LT(nats, before);
    before = nats;
  }
  EXPECT_LT(before, 0);
}

TEST(Contacts, DoNotExistWithoutFalseAlarms) {
  Mission mission = searched_field();
  mission.sensor.false_alarms_per_s = 0;
  const Efforts efforts = looked(mission, 4, 3);
  Contacts contacts(mission);
  contacts.set_prior(uniform(mission));
  contacts.renew(efforts);
  EXPECT_TRUE(contacts.confirmed_contacts().empty());
  EXPECT_EQ(contacts.nats(static_cast<std::size_t>(cell_at(mission, {85, 60, 0}))), 0);
}

/// Two agents look and report; their tiles arrive in any order, some never, some twice.
TEST(Contacts, AreTheSameInWhateverOrderTilesArrive) {
  struct Sent {
    Author author;
    std::size_t tile;
    EffortTile content;
    Tick at;
  };
  const Mission mission = searched_field();
  Efforts all(mission);
  std::vector<Sent> sent;
  for (AgentId id : {0, 1}) all.add_row({id, 7});
  for (Tick tick = 0; tick < 200; ++tick) {
    for (AgentId id : {0, 1}) {
      const Vector3d x_m(static_cast<double>(tick) * 0.5, 30 + 30.0 * id, 0);
      all.look({id, 7}, tick, x_m);
      if (tick % 7 == id) all.report({id, 7}, tick, cell_at(mission, x_m));
      if (tick % 20 != 19) continue;
      const std::vector<EffortTile>& row = *all.row_of({id, 7});
      for (std::size_t tile = 0; tile < row.size(); ++tile)
        if (row[tile].newest_look >= 0) sent.push_back({{id, 7}, tile, row[tile], tick});
    }
  }
  Contacts expected(mission);
  expected.set_prior(uniform(mission));
  expected.renew(all);
  EXPECT_FALSE(expected.confirmed_contacts().empty());
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    std::vector<std::size_t> order(2 * sent.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i % sent.size();
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[random_words(seed, Purpose::kFault, 0, i).first % i]);
    Efforts heard(mission);
    heard.set_now(199);
    for (const std::size_t i : order) {
      const bool lost =
          sent[i].at < 199 && random_words(seed, Purpose::kFault, 1, i).first % 3 == 0;
      if (!lost) heard.merge(sent[i].author, sent[i].tile, sent[i].content, sent[i].at);
    }
    Contacts contacts(mission);
    contacts.set_prior(uniform(mission));
    contacts.renew(heard);
    EXPECT_EQ(contacts.confirmed_contacts(), expected.confirmed_contacts());
  }
}

/// What is confirmed by the formulas of contacts.h: the odds of every contact again after each.
std::vector<std::size_t> confirmed_one_by_one(const Mission& mission, const Efforts& efforts,
                                              const std::vector<double>& prior) {
  const SearchCells& cells = efforts.cells();
  const int columns = cells.cells.count.x(), rows = cells.cells.count.y();
  const auto total = static_cast<int>(cells.cells.total());
  const double sides = cells.cells.size_m.x() / mission.sensor.position_error_m;
  const double own = std::erf(sides / std::numbers::sqrt2) -
                     std::sqrt(2 / std::numbers::pi) / sides * (1 - std::exp(-sides * sides / 2));
  const double ratio = mission.sensor.detections_per_s * std::numbers::pi * 100 /
                       (mission.sensor.false_alarms_per_s * 100);
  const auto near = [&](int cell, auto&& each) {
    for (int i = std::max(0, cell / rows - 1); i <= std::min(columns - 1, cell / rows + 1); ++i)
      for (int j = std::max(0, cell % rows - 1); j <= std::min(rows - 1, cell % rows + 1); ++j)
        each(i * rows + j);
  };
  std::vector<double> reports, left;
  for (int cell = 0; cell < total; ++cell) {
    reports.push_back(efforts.reports(cells.tile_cell(cell)));
    left.push_back(prior[static_cast<std::size_t>(cell)] *
                   std::exp(-cells.nats_per_look * efforts.looks(cells.tile_cell(cell))));
  }
  const auto odds_of = [&](int contact) {
    double sum = 0, others = 1;
    near(contact, [&](int cell) {
      double gain = 1;
      near(cell, [&](int other) {
        const double share = (other / rows == cell / rows ? own : (1 - own) / 2) *
                             (other % rows == cell % rows ? own : (1 - own) / 2);
        gain *= std::pow(1 + ratio * share, reports[static_cast<std::size_t>(other)]);
      });
      sum += left[static_cast<std::size_t>(cell)] * gain;
      others -= prior[static_cast<std::size_t>(cell)];
    });
    return sum / others;
  };
  std::vector<std::size_t> confirmed;
  while (true) {
    double best = mission.sensor.confirm_at / (1 - mission.sensor.confirm_at);
    int likeliest = -1;
    for (int cell = 0; cell < total; ++cell) {
      if (reports[static_cast<std::size_t>(cell)] == 0 || odds_of(cell) <= best) continue;
      best = odds_of(cell);
      likeliest = cell;
    }
    if (likeliest < 0) return confirmed;
    confirmed.push_back(static_cast<std::size_t>(likeliest));
    near(likeliest, [&](int cell) {
      reports[static_cast<std::size_t>(cell)] = left[static_cast<std::size_t>(cell)] = 0;
    });
  }
}

std::vector<double> uneven(const Mission& mission) {
  std::vector<double> prior = uniform(mission);
  for (std::size_t cell = 0; cell < prior.size(); ++cell)
    prior[cell] *= 2 * uniform_pair(1, Purpose::kStart, 0, cell).x();
  return prior;
}

TEST(Contacts, AreConfirmedOneByOneTheLikeliestFirst) {
  const Mission mission = searched_field();
  std::size_t confirmed = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Efforts efforts(mission);
    efforts.add_row({0, 1});
    for (Tick tick = 0; tick < static_cast<Tick>(20 * seed); ++tick) {
      const auto number = static_cast<std::uint64_t>(tick);
      const Vector3d x_m = uniform_in(mission.domain, seed, Purpose::kStart, 0, number);
      efforts.look({0, 1}, tick, x_m);
      efforts.report({0, 1}, tick, cell_at(mission, x_m));
    }
    Contacts contacts(mission);
    contacts.set_prior(uneven(mission));
    contacts.renew(efforts);
    EXPECT_EQ(contacts.confirmed_contacts(),
              confirmed_one_by_one(mission, efforts, uneven(mission)))
        << "seed " << seed;
    confirmed += contacts.confirmed_contacts().size();
  }
  EXPECT_GT(confirmed, 100u);
}

// A sensor that reports something at every tick delays no agent.
TEST(Contacts, OfTheMostReportsAreConsideredAFewTimesEach) {
  Mission mission = searched_field();
  mission.domain.size_m = {640, 640, 0};
  Efforts efforts(mission);
  efforts.add_row({0, 1});
  const std::size_t cells = efforts.cells().cells.total();
  ASSERT_EQ(cells, std::size_t{kMaxSearchCells});
  for (std::size_t tick = 0; tick < kMaxReports * cells; ++tick)
    efforts.report({0, 1}, static_cast<Tick>(tick), static_cast<std::int32_t>(tick % cells));
  Contacts contacts(mission);
  for (const std::vector<double>& prior : {uniform(mission), uneven(mission)}) {
    contacts.set_prior(prior);
    contacts.renew(efforts);
    EXPECT_GT(contacts.confirmed_contacts().size(), 400u);
    EXPECT_LT(contacts.considered(), 4 * cells);
  }
}

TEST(Efforts, CountReportsOnceAndOnlyWhileLooksCount) {
  const Mission mission = searched_field();
  Efforts efforts(mission);
  efforts.add_row({0, 1});
  const std::int32_t cell = cell_at(mission, {85, 60, 0});
  const TileCell at = efforts.cells().tile_cell(cell);
  efforts.report({0, 1}, 5, cell);
  efforts.report({0, 1}, 5, cell);
  efforts.report({0, 1}, 4, cell);
  EXPECT_EQ(efforts.reports(at), 1u);
  efforts.report({0, 1}, 6, kNoCell);
  efforts.report({0, 1}, 7, 200);
  for (Tick tick = 10; tick < 60; ++tick) efforts.report({0, 1}, tick, cell);
  EXPECT_EQ(efforts.reports(at), kMaxReports);
  EXPECT_EQ(efforts.looks(at), 0u);
  const std::int32_t other = cell_at(mission, {85, 80, 0});
  for (Tick tick = 100; tick < 1000; ++tick) efforts.look({0, 1}, tick, {85, 80, 0});
  efforts.report({0, 1}, 1000, other);
  EXPECT_EQ(efforts.reports(efforts.cells().tile_cell(other)), 0u) << "no look counts any more";
  EXPECT_EQ(efforts.looks(efforts.cells().tile_cell(other)), efforts.cells().most_looks);
}

/// A searcher at `x_m` whose agent has reported something in a cell so many times.
Vector3d wanted(const Mission& mission, const Vector3d& x_m, std::int32_t cell, int reports) {
  Searcher law(mission);
  Efforts efforts(mission);
  efforts.add_row({0, 1});
  for (Tick tick = 0; tick < reports; ++tick) efforts.report({0, 1}, tick, cell);
  const BasisAt at(x_m, mission.domain, mission.basis);
  const std::vector<AgentId> team{0, 1};
  const std::vector<TeamPlace> places{{0, x_m}, {1, mission.domain.origin_m}};
  return law.wanted_mps({0, 0, x_m, at, team, places, &efforts});
}

TEST(Searcher, LooksAgainWhereSomethingWasReported) {
  const Mission mission = searched_field();
  const std::int32_t west = cell_at(mission, {50, 55, 0}), east = cell_at(mission, {110, 55, 0});
  EXPECT_LT(wanted(mission, {80, 55, 0}, west, 2).x(), -3);
  EXPECT_GT(wanted(mission, {80, 55, 0}, east, 2).x(), 3);
  // The teammate in the corner is nearer.
  const std::int32_t near = cell_at(mission, {0, 15, 0});
  EXPECT_NEAR(
      (wanted(mission, {80, 55, 0}, near, 2) - wanted(mission, {80, 55, 0}, near, 0)).norm(), 0,
      1e-9);
}

TEST(Searcher, LeavesWhatIsConfirmed) {
  Mission mission = searched_field();
  mission.domain = {{0, 0, 0}, {60, 30, 0}};
  mission.target_coefficients[mission.basis.modes_y] = -0.9;  // most of it in the east
  const std::int32_t east = cell_at(mission, {45, 15, 0});
  EXPECT_GT(wanted(mission, {32, 15, 0}, east, 0).x(), 3);
  EXPECT_LT(wanted(mission, {32, 15, 0}, east, 9).x(), -3);
}

/// What a sensor finds that stays near a place, and how many of its contacts are wrong.
TEST(Confirmations, AreOfObjectsAndRarelyWrong) {
  int found = 0, wrong = 0;
  constexpr int kMissions = 60;
  for (std::uint64_t seed = 1; seed <= kMissions; ++seed) {
    Mission mission = searched_field();
    mission.seed = seed;
    mission.objects = {0, {{100, 45, 0}}};
    Objects objects(mission);
    const Reports reports(mission);
    Confirmations confirmations(mission);
    Tick first = -1;
    for (Tick tick = 0; tick < 600; ++tick) {
      // One circles around the object, the other one around nothing.
      for (AgentId id : {0, 1}) {
        const double angle = static_cast<double>(tick) * 0.05;
        const Vector3d x_m =
            Vector3d(id == 0 ? 98 : 30, 45, 0) + 5 * Vector3d(std::cos(angle), std::sin(angle), 0);
        const ObjectSet detected = objects.detected(id, tick, x_m);
        const std::int32_t cell = reports.cell(id, tick, x_m, detected, objects.places_m());
        if (first < 0 && detected != 0) first = tick;
        const ObjectSet set = confirmations.see(id, tick, x_m, detected, cell);
        EXPECT_TRUE(set == 0 || (first >= 0 && tick > first)) << "one report is not enough";
        if (tick == 599 && id == 1) found += set == 1 ? 1 : 0;
      }
    }
    wrong += confirmations.wrong();
  }
  EXPECT_GE(found, kMissions - 1);
  EXPECT_LE(wrong, 1);
}

TEST(Confirmations, WithoutFalseAlarmsAreDetections) {
  Mission mission = searched_field();
  mission.sensor.false_alarms_per_s = 0;
  Confirmations confirmations(mission);
  EXPECT_EQ(confirmations.see(0, 3, {85, 60, 0}, 5, kNoCell), 5u);
  EXPECT_EQ(confirmations.see(0, 4, {85, 60, 0}, 0, kNoCell), 0u);
}

}  // namespace
}  // namespace ergocast
