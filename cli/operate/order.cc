// SPDX-License-Identifier: BSD-3-Clause
// Says in words which vehicles stand.
#include "cli/operate/order.h"

namespace ergocast::cli {

std::string standing_text(const MonitoredRun& team) {
  const MonitoredRun::Standing vehicles = team.standing();
  std::string text =
      std::to_string(vehicles.standing) + " of " + std::to_string(vehicles.all) + " stand";
  if (vehicles.circling > 0)
    text += ", " + std::to_string(vehicles.circling) +
            (vehicles.circling == 1 ? " circles" : " circle");
  if (!vehicles.moving.empty())
    text += "; " + listed(vehicles.moving) +
            (vehicles.moving.size() == 1 ? " still moves" : " still move");
  return text;
}

}  // namespace ergocast::cli
