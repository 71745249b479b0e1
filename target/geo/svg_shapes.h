// SPDX-License-Identifier: BSD-3-Clause
// The straight, filled shapes of a drawing, which need not be painted; and why others do.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "target/geo/svg.h"
#include "target/geo/svg_places.h"

namespace ergocast {

/// What elements inherit, as far as exact shapes need it.
struct SvgInherited {
  std::map<std::string, std::string> properties;
  Eigen::Affine2d to_drawing = Eigen::Affine2d::Identity();
  bool defined = false, hidden = false;
  std::vector<std::string> ids;  // of the elements around
};

/// Whether an element of SVG is a shape: <rect>, <polygon>, <path>, <circle> and others.
bool is_svg_shape(std::string_view name);

class SvgShapes {
 public:
  SvgShapes(const SvgPlaces& places, bool solid_white)
      : places_(places), solid_white_(solid_white) {}

  /// The viewBox, in its own units.
  void set_page(const Eigen::Vector2d& begin, const Eigen::Vector2d& size) {
    begin_ = begin;
    size_ = size;
  }
  /// The drawing has style sheets: any shape may have strokes.
  void note_sheets() { sheets_ = true; }
  void note_sheet_width(std::string_view stroke_width);

  /// Notes that the drawing has to be painted, because the element has or is something.
  void paint(const pugi::xml_node& node, const std::string& why);
  /// Adds an element's properties to the inherited ones, and finds those that exact shapes do not
  /// have.
  void inherit(const pugi::xml_node& node, SvgInherited& own,
               const std::map<std::string, std::string>& properties);
  /// @pre is_svg_shape(name)
  void add(const pugi::xml_node& node, const std::string& name, const SvgInherited& own);

  /// The exact shapes, or why the drawing has to be painted. Throws BadSvg if it shows nothing, or
  /// what painting could lose.
  void take(Drawing& drawing);

 private:
  using Ring = std::vector<Eigen::Vector2d>;

  Eigen::Vector2d in_plan(const Eigen::Vector2d& place) const;
  void check_stroke(const pugi::xml_node& node, const SvgInherited& own);
  void empty(const pugi::xml_node& node, std::string what, std::string remedy);
  std::optional<Ring> rectangle(const pugi::xml_node& node);
  Ring corners(const pugi::xml_node& node) const;
  void check_width(const pugi::xml_node& node, const Ring& ring);
  void add_rings(const pugi::xml_node& node, const std::vector<Ring>& rings,
                 const Eigen::Affine2d& to_drawing);

  const SvgPlaces& places_;
  const bool solid_white_;
  Eigen::Vector2d begin_{0, 0}, size_{0, 0};  // of the viewBox
  double least_sheet_width_ = HUGE_VAL;
  bool sheets_ = false, even_odd_ = false, stroked_ = false;
  std::vector<DrawnShape> shapes_;
  std::string paint_because_;
  std::optional<PolygonFileProblem> exact_problem_;
  PolygonFileProblems thin_problems_;
};

}  // namespace ergocast
