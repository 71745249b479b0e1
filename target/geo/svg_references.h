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
  /// @param element  the local name of the element with this id; the first of several counts
  void define(const std::string& id, const std::string& element) { ids_.emplace(id, element); }
  /// @param around    the names of the elements around the one that refers
  /// @param property  that refers: "fill", "clip-path"; "href" for links of <use> and of gradients
  void refer(const pugi::xml_node& node, const std::vector<std::string>& around, std::string id,
             std::string property) {
    for (const std::string& outer : around) uses_[outer].insert(id);
    references_.push_back({node, std::move(id), std::move(property)});
  }

  /// Each leads to something that is painted there, and none back to itself.
  void check(const SvgPlaces& places, PolygonFileProblems& problems) const;

 private:
  struct Reference {
    pugi::xml_node node;
    std::string id, property;
  };
  std::string flaw_of(const Reference& reference) const;

  std::map<std::string, std::string> ids_;  // with the names of their elements
  std::vector<Reference> references_;
  std::map<std::string, std::set<std::string>> uses_;  // by elements around the reference
};

}  // namespace ergocast
