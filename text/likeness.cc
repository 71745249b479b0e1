// SPDX-License-Identifier: BSD-3-Clause
// Computes edit distances, and accepts the nearest name if few letters differ.
#include "text/likeness.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace ergocast {

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1), above(b.size() + 1), above_that(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    above_that = std::exchange(above, row);
    row[0] = static_cast<int>(i) + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      row[j + 1] = std::min({above[j] + (a[i] == b[j] ? 0 : 1), above[j + 1] + 1, row[j] + 1});
      const bool swapped = i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j];
      if (swapped) row[j + 1] = std::min(row[j + 1], above_that[j - 1] + 1);
    }
  }
  return row.back();
}

int most_typos_in(std::string_view word) { return std::max(1, static_cast<int>(word.size()) / 3); }

std::string nearest(std::string_view word, const std::vector<std::string>& names) {
  std::string best;
  int least = most_typos_in(word) + 1;
  for (const std::string& name : names) {
    // The beginning of a name counts as one slip.
    const int distance = word.size() >= 3 && name.starts_with(word) ? 1 : edit_distance(word, name);
    if (distance >= least) continue;
    best = name;
    least = distance;
  }
  return best;
}

}  // namespace ergocast
