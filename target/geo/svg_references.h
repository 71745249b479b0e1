// SPDX-License-Identifier: BSD-3-Clause
// Which elements of a drawing refer to which.
#pragma once

#include <map>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "target/geo/svg_places.h"

namespace ergocast {

class SvgReferences {
 public:
  void define(const std::string& id, bool is_pattern) {
    ids_.insert(id);
    if (is_pattern) patterns_.insert(id);
  }
  /// @param around  the names of the elements around the one that refers
  void refer(const pugi::xml_node& node, const std::vector<std::string>& around, std::string id) {
    for (const std::string& outer : around) uses_[outer].insert(id);
    references_.emplace_back(node, std::move(id));
  }

  /// Each leads to something that is painted, and none back to itself. Throws BadSvg.
  void check(const SvgPlaces& places) const;

 private:
  std::set<std::string> ids_, patterns_;
  std::vector<std::pair<pugi::xml_node, std::string>> references_;
  std::map<std::string, std::set<std::string>> uses_;  // by elements around the reference
};

}  // namespace ergocast
