// SPDX-License-Identifier: BSD-3-Clause
// Problems of a drawing that name the element.
#pragma once

#include <string>
#include <utility>

#include "target/geo/polygon_file.h"
#include "target/geo/svg_syntax.h"
#include "target/geo/xml_places.h"

namespace ergocast {

/// What ends the reading of a drawing.
struct BadSvg {
  PolygonFileProblem problem;
};

class SvgPlaces : public XmlPlaces {
 public:
  using XmlPlaces::XmlPlaces;

  /// Throws BadSvg. An empty node stands for the whole drawing.
  [[noreturn]] void fail(const pugi::xml_node& node, std::string what, std::string remedy) const {
    throw BadSvg{{node ? of(node) : "", std::move(what), std::move(remedy)}};
  }

  /// What `read` makes of an attribute; a syntax error becomes a problem of the element.
  template <class Read>
  auto in(const pugi::xml_node& node, const std::string& attribute, Read read) const {
    try {
      return read(node.attribute(attribute.c_str()).value());
    } catch (const SvgSyntaxError& error) {
      fail(node, attribute + ' ' + error.what(), error.remedy);
    }
  }
};

}  // namespace ergocast
