// SPDX-License-Identifier: BSD-3-Clause
// Where the elements of a drawing stand in its text, and problems that name the place.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "target/geo/polygon_file.h"
#include "target/geo/svg_syntax.h"

namespace ergocast {

/// What ends the reading of a drawing.
struct BadSvg {
  PolygonFileProblem problem;
};

class SvgPlaces {
 public:
  /// @param text  of the whole drawing; it outlives this object
  explicit SvgPlaces(std::string_view text) : text_(text) {}

  /// "line 12: <path>"
  std::string of(const pugi::xml_node& node) const;

  /// Throws BadSvg. An empty node stands for the whole drawing.
  [[noreturn]] void fail(const pugi::xml_node& node, std::string what, std::string remedy) const;

  /// What `read` makes of an attribute; a syntax error becomes a problem of the element.
  template <class Read>
  auto in(const pugi::xml_node& node, const std::string& attribute, Read read) const {
    try {
      return read(node.attribute(attribute.c_str()).value());
    } catch (const SvgSyntaxError& error) {
      fail(node, attribute + ' ' + error.what(), error.remedy);
    }
  }

 private:
  std::string_view text_;
  // The elements come in the order of the text: what was counted before is not counted again.
  mutable std::size_t counted_ = 0, breaks_ = 0;
};

}  // namespace ergocast
