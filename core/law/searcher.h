// SPDX-License-Identifier: BSD-3-Clause
// The law that searches: each agent goes to where much is left to find and no teammate is near.
//
//   b_i ∝ m_i exp(−E_i)      what is left: the target's mass of a cell, and the looks of all agents
//   b_i is larger where reports make an object likely, and 0 in a contact that is confirmed, if the
//   sensors have false alarms (core/search/contacts.h)
//   p   = (1/N) Σ_j G_j      what teammates take care of: a Gaussian of width ℓ around each
//
// Each second, in turn, an agent solves for the potential u of core/search/search_field.h with the
// source p − b, and chooses a heading by it and by what it would find on the next metres
// (core/search/search_heading.h). It goes there at full speed: law.epsilon counts as 0. Without p
// all agents would go to the same place. Contraction and noise are those of the default law.
//
// Where all has been searched alike, b is the target again: the law goes on for ever.
//
// With the sensor's radius r of core/search/search_cells.h, ℓ = 6 r. a = 0.3 √(A / N), where A is
// the domain's area and N how many agents start, but at least 3.2 r and at most 6 r.
#pragma once

#include <vector>

#include "core/law/law.h"
#include "core/law/steering.h"
#include "core/search/contacts.h"
#include "core/search/search_cells.h"
#include "core/search/search_field.h"
#include "core/search/search_heading.h"

namespace ergocast {

class Searcher final : public Law {
 public:
  /// @pre a plane
  explicit Searcher(const Mission& mission, int kind = 0);

  static constexpr LawNeeds kNeeds{.coverage = false, .places = true, .search = true};
  LawNeeds needs() const override { return kNeeds; }
  void set_target(const Coefficients& target) override;
  void set_law(const LawNumbers& numbers) override { steering_.set_law(numbers); }
  /// @pre input.efforts is there
  Eigen::Vector3d wanted_mps(const LawInput& input) override;
  /// Against the heading, of length 1: only its direction counts.
  Eigen::Vector3d spectral_gradient() const override { return gradient_; }

 private:
  void renew(const LawInput& input);
  void set_left(const LawInput& input);
  bool is_nearest(const LawInput& input, std::size_t cell) const;
  void add_teammates(const LawInput& input);
  void set_gaussian(int axis, const Eigen::Vector3d& x_m, Eigen::VectorXd& along) const;

  Basis basis_;  // (2)
  Rings walls_;
  Steering steering_;
  SearchCells cells_;
  double spread_m_;
  SearchField potential_;
  SearchHeading heading_;
  std::vector<double> prior_;  // mass of each cell
  Contacts contacts_;
  Eigen::VectorXd free_;           // 1 for each cell that is not in a wall, else 0
  Eigen::VectorXd left_, missed_;  // b, and exp(−E) but for a factor: 1 where least was searched
  Eigen::VectorXd source_;
  Eigen::VectorXd along_x_, along_y_;  // a Gaussian at the middles of columns and rows
  Tick renewal_ticks_, turn_ = -1;
  Eigen::Vector3d gradient_{0, 0, 0};
};

}  // namespace ergocast
