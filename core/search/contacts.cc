// SPDX-License-Identifier: BSD-3-Clause
// Looks only at cells with reports, which are few.
#include "core/search/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/portable_math.h"
#include "core/base/require.h"
#include "core/measure/detection.h"

namespace ergocast {
namespace {

/// No target is so sure of a place that nothing is anywhere else.
constexpr double kLeastOthers = 1e-3;
/// More evidence is as good as this. Its exp() is finite.
constexpr double kMostEvidence = 300;

/// How likely a report is in the object's cell, along one axis: the object is uniform in the cell,
/// and the error is normal.
double in_own_cell(double error_m, double side_m) {
  if (!(error_m > 0)) return 1;
  const double sides = side_m / error_m;
  return portable::erf(sides / std::numbers::sqrt2) -
         std::sqrt(2 / std::numbers::pi) / sides * -portable::expm1(-sides * sides / 2);
}

}  // namespace

Contacts::Contacts(const Mission& mission)
    : cells_(mission),
      has_false_alarms_(mission.sensor.has_false_alarms()),
      confirmed_at_(portable::log(mission.sensor.confirm_at / (1 - mission.sensor.confirm_at))),
      prior_(cells_.cells.total(), 0),
      left_(prior_),
      nats_(prior_),
      gain_at_(prior_),
      reports_(prior_.size(), 0),
      confirmed_(prior_.size(), 0) {
  if (!has_false_alarms_) return;
  const SearchSensor& sensor = mission.sensor;
  const Eigen::Vector3d& side_m = cells_.cells.size_m;
  const double seen_m2 = std::numbers::pi * portable::square(sensor_radius_m(mission));
  const double ratio =
      sensor.detections_per_s * seen_m2 / (sensor.false_alarms_per_s * side_m.x() * side_m.y());
  for (const std::size_t columns : {0, 1}) {
    for (const std::size_t rows : {0, 1}) {
      const double own_column = in_own_cell(sensor.position_error_m, side_m.x());
      const double own_row = in_own_cell(sensor.position_error_m, side_m.y());
      const double share = (columns == 0 ? own_column : (1 - own_column) / 2) *
                           (rows == 0 ? own_row : (1 - own_row) / 2);
      gain_[columns][rows] = portable::log1p(ratio * share);
    }
  }
  contacts_.reserve(prior_.size());
  likely_.reserve(prior_.size());
  confirmed_contacts_.reserve(prior_.size());
  confirmed_odds_.reserve(prior_.size());
}

void Contacts::set_prior(const std::vector<double>& mass) {
  ERGOCAST_REQUIRE(mass.size() == prior_.size());
  prior_ = mass;
}

void Contacts::renew(const Efforts& efforts) {
  if (!has_false_alarms_) return;
  read(efforts);
  std::ranges::fill(confirmed_, 0);
  confirmed_contacts_.clear();
  confirmed_odds_.clear();
  std::ranges::fill(gain_at_, 0.0);
  for (const std::size_t contact : contacts_)
    for_neighbours(contact, [&](std::size_t cell) {
      if (gain_at_[cell] == 0) gain_at_[cell] = portable::exp(log_gain(cell));
    });
  confirm_likely();
  weigh();
}

void Contacts::read(const Efforts& efforts) {
  const Eigen::Array3i& count = cells_.cells.count;
  contacts_.clear();
  std::size_t cell = 0;
  for (int i = 0; i < count.x(); ++i) {
    for (int j = 0; j < count.y(); ++j, ++cell) {
      const TileCell at = cells_.tile_cell(i, j);
      reports_[cell] = efforts.reports(at);
      left_[cell] = prior_[cell] * portable::exp(-cells_.nats_per_look * efforts.looks(at));
      if (reports_[cell] > 0) contacts_.push_back(cell);
    }
  }
}

/// To confirm a contact only makes others less likely. So the first one in the heap is the
/// likeliest if its odds are still what they were when it was put there. Others go back with their
/// new odds.
void Contacts::confirm_likely() {
  likely_.clear();
  considered_ = 0;
  for (const std::size_t contact : contacts_) consider(contact, log_odds(contact));
  while (!likely_.empty()) {
    std::ranges::pop_heap(likely_, less_likely);
    const Likely first = likely_.back();
    likely_.pop_back();
    if (reports_[first.contact] == 0) continue;
    const double odds = log_odds(first.contact);
    if (odds < first.odds)
      consider(first.contact, odds);
    else
      confirm({odds, first.contact});
  }
}

void Contacts::consider(std::size_t contact, double odds) {
  ++considered_;
  if (odds < confirmed_at_) return;
  likely_.push_back({odds, contact});
  std::ranges::push_heap(likely_, less_likely);
}

/// The contact with the smaller number comes first if two are as likely.
bool Contacts::less_likely(const Likely& one, const Likely& other) {
  return one.odds != other.odds ? one.odds < other.odds : one.contact > other.contact;
}

void Contacts::confirm(const Likely& likely) {
  const std::size_t contact = likely.contact;
  confirmed_contacts_.push_back(contact);
  confirmed_odds_.push_back(likely.odds);
  for_neighbours(contact, [&](std::size_t cell) {
    confirmed_[cell] = 1;
    reports_[cell] = 0;
  });
  for_near(contact, 2, [&](std::size_t cell, std::size_t, std::size_t) {
    gain_at_[cell] = portable::exp(log_gain(cell));
  });
}

std::vector<Contacts::Judged> Contacts::judged() const {
  const auto likely = [](double odds) { return 1 / (1 + portable::exp(-odds)); };
  std::vector<Judged> all;
  for (std::size_t i = 0; i < confirmed_contacts_.size(); ++i)
    all.push_back({confirmed_contacts_[i], likely(confirmed_odds_[i]), true});
  std::vector<Likely> others;
  for (const std::size_t contact : contacts_)
    if (reports_[contact] > 0) others.push_back({log_odds(contact), contact});
  std::ranges::sort(others, [](const Likely& a, const Likely& b) { return less_likely(b, a); });
  std::vector<char> taken(prior_.size(), 0);
  for (const auto& [odds, contact] : others) {
    if (taken[contact] != 0) continue;
    for_neighbours(contact, [&](std::size_t cell) { taken[cell] = 1; });
    all.push_back({contact, likely(odds), false});
  }
  return all;
}

void Contacts::weigh() {
  std::ranges::fill(nats_, 0.0);
  for (const std::size_t contact : contacts_) {
    if (reports_[contact] == 0) continue;
    nats_[contact] = log_gain(contact) - portable::log(others(contact)) -
                     portable::log1p(portable::exp(log_odds(contact)));
  }
}

/// ln g.
double Contacts::log_gain(std::size_t cell) const {
  const auto rows = static_cast<std::size_t>(cells_.cells.count.y());
  const std::size_t column = cell / rows, row = cell % rows;
  double nats = 0;
  for_near(cell, 1, [&](std::size_t other, std::size_t i, std::size_t j) {
    nats += reports_[other] * gain_[i == column ? 0 : 1][j == row ? 0 : 1];
  });
  return std::min(nats, kMostEvidence);
}

/// ln o; −∞ where no object can be.
double Contacts::log_odds(std::size_t contact) const {
  double sum = 0;
  for_neighbours(contact, [&](std::size_t cell) {
    if (confirmed_[cell] == 0 && left_[cell] > 0) sum += left_[cell] * gain_at_[cell];
  });
  return portable::log(sum) - portable::log(others(contact));
}

/// 1 − Σ m.
double Contacts::others(std::size_t contact) const {
  double others = 1;
  for_neighbours(contact, [&](std::size_t cell) { others -= prior_[cell]; });
  return std::max(others, kLeastOthers);
}

}  // namespace ergocast
