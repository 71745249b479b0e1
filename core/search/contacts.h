// SPDX-License-Identifier: BSD-3-Clause
// What reports of sensors with false alarms mean: how likely an object is where some of them agree.
//
// Reports D_j of cell j make an object in cell i more likely by the factor
//
//   g_i = Π_j (1 + γ π r² K_ij / (γ₀ A))^D_j
//
// γ and γ₀ are the rates of detections and false alarms, A is a cell's area, and K_ij is how
// likely an object in i is reported in j, which is i or one of its neighbours. False alarms are
// uniform over what a sensor sees, so their rate in a cell is γ₀ A / (π r²).
//
// A contact is a cell with reports. The odds that an object is there or in one of the neighbours,
// the set B, are o = Σ_{i∈B} m_i exp(−E_i) g_i / (1 − Σ_{i∈B} m_i), where m_i is the target's mass
// and E_i the effort of all looks. The target has one object: if there are more, they are confirmed
// with more reports than they need.
//
// A contact with o / (1 + o) ≥ sensor.confirm_at is confirmed, the likeliest first. Reports in B
// are then explained, and count nowhere else. All of it follows from sums of counts, so it does not
// depend on the order in which they arrived.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/mission/mission.h"
#include "core/search/efforts.h"
#include "core/search/search_cells.h"

namespace ergocast {

class Contacts {
 public:
  /// @pre a plane
  explicit Contacts(const Mission& mission);

  /// @param mass  of each cell of SearchCells, by its number
  void set_prior(const std::vector<double>& mass);
  /// Takes in the counts. Does nothing in a mission without false alarms.
  void renew(const Efforts& efforts);

  /// The contacts that are not confirmed raise what is left in their cells: ln of the factor. It is
  /// such that all of B holds o / (1 + o). 0 elsewhere.
  double nats(std::size_t cell) const { return nats_[cell]; }
  /// Whether a cell is in the set B of a contact that is confirmed.
  bool confirmed(std::size_t cell) const { return confirmed_[cell] != 0; }
  /// The cells of contacts that are confirmed, the likeliest first.
  const std::vector<std::size_t>& confirmed_contacts() const { return confirmed_contacts_; }
  /// A contact and how likely it is.
  struct Judged {
    std::size_t contact;
    double probability;
    bool confirmed;
  };
  /// The contacts, the likeliest first: those that are confirmed, then others. One that is in the
  /// set B of a likelier one is part of that.
  std::vector<Judged> judged() const;
  /// Calls each(cell) for a cell and its neighbours.
  void for_neighbours(std::size_t cell, auto&& each) const {
    for_near(cell, 1, [&](std::size_t near, std::size_t, std::size_t) { each(near); });
  }
  /// How often the last renewal has compared a contact's odds: what it takes grows with that.
  std::size_t considered() const { return considered_; }

 private:
  /// Calls each(cell, column, row) for the cells up to so many columns and rows away.
  void for_near(std::size_t cell, std::size_t reach, auto&& each) const {
    const auto columns = static_cast<std::size_t>(cells_.cells.count.x());
    const auto rows = static_cast<std::size_t>(cells_.cells.count.y());
    const std::size_t column = cell / rows, row = cell % rows;
    const std::size_t last_column = std::min(column + reach, columns - 1);
    const std::size_t last_row = std::min(row + reach, rows - 1);
    for (std::size_t i = column - std::min(column, reach); i <= last_column; ++i)
      for (std::size_t j = row - std::min(row, reach); j <= last_row; ++j) each(i * rows + j, i, j);
  }
  void read(const Efforts& efforts);
  struct Likely {
    double odds;  // their ln
    std::size_t contact;
  };
  void confirm_likely();
  void consider(std::size_t contact, double odds);
  static bool less_likely(const Likely& one, const Likely& other);
  void confirm(const Likely& likely);
  void weigh();
  double log_gain(std::size_t cell) const;
  double log_odds(std::size_t contact) const;
  double others(std::size_t contact) const;

  SearchCells cells_;
  bool has_false_alarms_;
  /// ln of the factor of one report, by how many columns and rows its cell is away.
  std::array<std::array<double, 2>, 2> gain_{};
  double confirmed_at_;  // ln of the odds
  std::vector<double> prior_, left_, nats_;
  std::vector<double> gain_at_;         // g near contacts
  std::vector<std::uint32_t> reports_;  // that are not explained
  std::vector<char> confirmed_;
  std::vector<std::size_t> contacts_, confirmed_contacts_;
  std::vector<Likely> likely_;          // a heap
  std::vector<double> confirmed_odds_;  // of confirmed_contacts_: their ln, when it was confirmed
  std::size_t considered_ = 0;
};

}  // namespace ergocast
