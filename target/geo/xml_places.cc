// SPDX-License-Identifier: BSD-3-Clause
// Counts the lines before an element.
#include "target/geo/xml_places.h"

#include <algorithm>

namespace ergocast {

std::string XmlPlaces::of(const pugi::xml_node& node) const {
  const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, node.offset_debug()));
  if (offset < counted_) counted_ = breaks_ = 0;
  breaks_ +=
      static_cast<std::size_t>(std::ranges::count(text_.substr(counted_, offset - counted_), '\n'));
  counted_ = offset;
  return "line " + std::to_string(1 + breaks_) + ": <" + node.name() + ">";
}

}  // namespace ergocast
