// SPDX-License-Identifier: BSD-3-Clause
// Adds an object to the list when it is detected for the first time.
#include "core/measure/finds.h"

#include <algorithm>
#include <cstdio>

namespace ergocast {

std::string to_text(const Find& find) {
  char text[120];
  std::snprintf(text, sizeof text, "object %d found by agent %d at (%.1f, %.1f) m after %.1f s",
                find.object, find.agent, find.x_m.x(), find.x_m.y(), find.t_s);
  return text;
}

std::string wrong_confirmations_text(int count) {
  return std::to_string(count) + (count == 1 ? " contact that was confirmed is no object"
                                             : " contacts that were confirmed are no objects");
}

ObjectSet Finds::known(ObjectSet detected) const {
  return detected & static_cast<ObjectSet>((std::uint64_t{1} << objects_) - 1);
}

void Finds::note(ObjectSet detected, Find at) {
  for (at.object = 0; at.object < objects_; ++at.object) {
    const bool now = (detected >> at.object & 1) != 0;
    if (now && std::ranges::find(list_, at.object, &Find::object) == list_.end())
      list_.push_back(at);
  }
}

}  // namespace ergocast
