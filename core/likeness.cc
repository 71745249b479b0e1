#include "core/likeness.h"

#include <algorithm>
#include <numeric>

namespace ergocast {

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (const char letter : a) {
    int diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const int replaced = diagonal + (letter == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

int most_typos_in(std::string_view word) { return std::max(1, static_cast<int>(word.size()) / 3); }

std::string nearest(std::string_view word, const std::vector<std::string>& names) {
  std::string best;
  int least = most_typos_in(word) + 1;
  for (const std::string& name : names) {
    // What somebody began to type is as good as one slip.
    const int distance =
        word.size() >= 3 && name.starts_with(word) ? 1 : edit_distance(word, name);
    if (distance >= least) continue;
    best = name;
    least = distance;
  }
  return best;
}

}  // namespace ergocast
