// SPDX-License-Identifier: BSD-3-Clause
// Words a contact for logs, tables and maps.
#include "core/search/contact.h"

#include <cstdio>

namespace ergocast {

std::string to_text(const Contact& contact) {
  char text[160];
  std::snprintf(
      text, sizeof text, "%.3g %% likely at (%.1f, %.1f) m, %d report%s, the newest after %.1f s%s",
      100 * contact.probability, contact.x_m.x(), contact.x_m.y(), contact.reports,
      contact.reports == 1 ? "" : "s", contact.t_s, contact.confirmed ? ", confirmed" : "");
  return text;
}

}  // namespace ergocast
