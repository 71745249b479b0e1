// SPDX-License-Identifier: BSD-3-Clause
// Where the elements of an XML file stand in its text.
#pragma once

#include <cstddef>
#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace ergocast {

class XmlPlaces {
 public:
  /// @param text  of the whole file; it outlives this object
  explicit XmlPlaces(std::string_view text) : text_(text) {}

  /// "line 12: <path>"
  std::string of(const pugi::xml_node& node) const;

 private:
  std::string_view text_;
  // Elements mostly come in the order of the text: what was counted is not counted again.
  mutable std::size_t counted_ = 0, breaks_ = 0;
};

}  // namespace ergocast
