// SPDX-License-Identifier: BSD-3-Clause
// The languages that the names of a drawing's elements and attributes belong to.
#pragma once

#include <pugixml.hpp>
#include <string_view>
#include <utility>
#include <vector>

namespace ergocast {

inline constexpr std::string_view kSvgSpace = "http://www.w3.org/2000/svg";
inline constexpr std::string_view kLinkSpace = "http://www.w3.org/1999/xlink";

/// "inkscape" from "inkscape:label"; local_of() has the "label".
inline std::string_view prefix_of(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == name.npos ? std::string_view() : name.substr(0, colon);
}
inline std::string_view local_of(std::string_view name) {
  return name.substr(name.find(':') == name.npos ? 0 : name.find(':') + 1);
}
inline std::string_view local_name(const pugi::xml_node& node) { return local_of(node.name()); }

/// The spaces that the prefixes stand for, at the element that a walk has reached.
class SvgNames {
 public:
  /// Takes in what an element declares. Returns how many spaces these are.
  std::size_t enter(const pugi::xml_node& node) {
    const std::size_t before = spaces_.size();
    for (const pugi::xml_attribute& one : node.attributes()) {
      const std::string_view name = one.name();
      if (name == "xmlns") spaces_.emplace_back("", one.value());
      if (name.starts_with("xmlns:")) spaces_.emplace_back(name.substr(6), one.value());
    }
    return spaces_.size() - before;
  }
  /// Forgets the newest ones.
  void leave(std::size_t declared) { spaces_.resize(spaces_.size() - declared); }

  /// Names without a prefix are SVG's unless something else is declared.
  std::string_view space_of(std::string_view prefix) const {
    for (std::size_t i = spaces_.size(); i-- > 0;)
      if (spaces_[i].first == prefix) return spaces_[i].second;
    return prefix.empty() ? kSvgSpace : std::string_view();
  }
  bool is_svg(const pugi::xml_node& node) const {
    return space_of(prefix_of(node.name())) == kSvgSpace;
  }

 private:
  std::vector<std::pair<std::string_view, std::string_view>> spaces_;  // prefix, address
};

}  // namespace ergocast
