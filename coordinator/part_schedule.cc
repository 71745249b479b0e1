// SPDX-License-Identifier: BSD-3-Clause
// Compares the hashes with those sent last, and remembers which part is next in turn.
#include "coordinator/part_schedule.h"

#include <algorithm>

namespace ergocast {

std::vector<std::size_t> PartSchedule::next(const std::vector<std::uint64_t>& hashes) {
  parts_.resize(hashes.size());
  std::vector<std::size_t> chosen;
  std::vector<bool> is_chosen(hashes.size());
  const std::size_t most = std::min(hashes.size(), kMostAtOnce);
  const auto choose = [&](std::size_t p) {
    if (is_chosen[p] || chosen.size() >= most) return;
    is_chosen[p] = true;
    chosen.push_back(p);
    parts_[p].owed = std::max(0, parts_[p].owed - 1);
  };
  for (std::size_t p = 0; p < hashes.size(); ++p) {
    if (parts_[p].hash != hashes[p]) parts_[p] = {hashes[p], kTimesSent};
  }
  for (int owed = kTimesSent; owed > 0; --owed) {  // those never sent come first
    for (std::size_t p = 0; p < hashes.size(); ++p) {
      if (parts_[p].owed == owed) choose(p);
    }
  }
  while (chosen.size() < most) choose(turn_++ % hashes.size());
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

bool PartSchedule::behind() const {
  return std::any_of(parts_.begin(), parts_.end(),
                     [](const Part& part) { return part.owed == kTimesSent; });
}

}  // namespace ergocast
