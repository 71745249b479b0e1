// SPDX-License-Identifier: BSD-3-Clause
// Counts the lines before an element.
#include "target/geo/svg_places.h"

#include <algorithm>
#include <utility>

namespace ergocast {

std::string SvgPlaces::of(const pugi::xml_node& node) const {
  const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, node.offset_debug()));
  if (offset < counted_) counted_ = breaks_ = 0;
  breaks_ +=
      static_cast<std::size_t>(std::ranges::count(text_.substr(counted_, offset - counted_), '\n'));
  counted_ = offset;
  return "line " + std::to_string(1 + breaks_) + ": <" + node.name() + ">";
}

void SvgPlaces::fail(const pugi::xml_node& node, std::string what, std::string remedy) const {
  throw BadSvg{{node ? of(node) : "", std::move(what), std::move(remedy)}};
}

}  // namespace ergocast
