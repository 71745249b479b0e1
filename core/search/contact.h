// SPDX-License-Identifier: BSD-3-Clause
// A contact as people are shown it: where sensors with false alarms have reported something.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

#include "core/base/ids.h"

namespace ergocast {

struct Contact {
  std::int32_t cell = 0;     ///< of core/search/search_cells.h, the likeliest of its neighbours
  std::int32_t reports = 0;  ///< that count, in the cell and its neighbours
  Tick newest = 0;           ///< the counted tick of the newest of them
  double probability = 0;  ///< o / (1 + o) of core/search/contacts.h; when it was confirmed, if so
  bool confirmed = false;
  // What receivers add: messages do not have it.
  Eigen::Vector2d x_m{0, 0};  ///< SearchCells::middle_m()
  double t_s = 0;             ///< mission time of the newest report
};

/// "87 % likely at (412.0, 77.5) m, 3 reports, the newest after 123.4 s", and ", confirmed".
std::string to_text(const Contact& contact);

}  // namespace ergocast
