// SPDX-License-Identifier: BSD-3-Clause
// Reads the corners of shapes, and their widths, since what is thin could be lost in painting.
#include "target/geo/svg_shapes.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cstring>
#include <set>

#include "target/geo/svg_painter.h"
#include "target/geo/svg_style.h"
#include "target/geo/svg_syntax.h"

namespace ergocast {
namespace {

/// The longer side of a page over the width of what is painted surely: half a cell. Cairo leaves
/// out strokes below a fifth, and on a white page, less paint does not make a cell dark.
constexpr double kThinnest = 2 * kPaintedCells;
using Names = std::set<std::string_view>;

/// Infinite if it is unknown.
double length_of(std::string_view text) {
  try {
    return svg_length(text).value_or(HUGE_VAL);
  } catch (const SvgSyntaxError&) {
    return HUGE_VAL;
  }
}

}  // namespace

bool is_svg_shape(std::string_view name) {
  static const Names kShapes = {"rect", "polygon", "path", "polyline", "line", "circle", "ellipse"};
  return kShapes.contains(name);
}

void SvgShapes::note_sheet_width(std::string_view stroke_width) {
  least_sheet_width_ = std::min(least_sheet_width_, length_of(stroke_width));
}

void SvgShapes::paint(const pugi::xml_node& node, const std::string& why) {
  if (paint_because_.empty()) paint_because_ = places_.of(node) + ' ' + why;
}

void SvgShapes::take(Drawing& drawing) {
  drawing.paint_because = paint_because_;
  if (!paint_because_.empty()) {
    if (!thin_problems_.empty()) throw BadSvg{thin_problems_.all()};
    return;
  }
  if (exact_problem_) throw BadSvg{*exact_problem_};
  if (shapes_.empty())
    places_.fail({}, "has no filled or stroked shape",
                 "draw walls as shapes; what has fill=\"none\" and no stroke is not shown");
  drawing.shapes = std::move(shapes_);
}

/// A place of the drawing from the lower left corner of its viewBox, y up. The box's own edges
/// become exactly 0 and its height, wherever it begins.
Eigen::Vector2d SvgShapes::in_plan(const Eigen::Vector2d& place) const {
  const Eigen::Vector2d from_top = place - begin_;
  return {from_top.x(), size_.y() - from_top.y()};
}

void SvgShapes::inherit(const pugi::xml_node& node, SvgInherited& own,
                        const std::map<std::string, std::string>& properties) {
  static const Names kAlways = {"fill",
                                "stroke",
                                "fill-rule",
                                "display",
                                "x",
                                "y",
                                "width",
                                "height",
                                "rx",
                                "ry",
                                "r",
                                "cx",
                                "cy",
                                "overflow",
                                "color",
                                "shape-rendering",
                                "clip-rule",
                                "paint-order",
                                "vector-effect"};
  for (const auto& [name, value] : properties) {
    own.properties[name] = value;
    const bool plain = kAlways.contains(name) || value.empty() || value == "none" || value == "1" ||
                       value == "normal" || value == "visible" || value == "auto" ||
                       name.starts_with("stroke-") || name.starts_with("stop-");
    const bool by_attribute = name == "transform" && value == node.attribute("transform").value();
    if (!plain && !by_attribute) paint(node, "has " + name + ": " + value);
  }
  static const Names kGeometry = {"x", "y", "width", "height", "rx", "ry", "r", "cx", "cy"};
  for (const auto& [name, value] : properties)
    if (kGeometry.contains(name) && value != node.attribute(name.c_str()).value())
      paint(node, "has its place in its style");
}

/// Sheets may set any of their widths.
void SvgShapes::check_stroke(const pugi::xml_node& node, const SvgInherited& own) {
  const auto stroke = own.properties.find("stroke"), width = own.properties.find("stroke-width");
  const bool stroked = stroke != own.properties.end() && stroke->second != "none";
  if ((!stroked && !sheets_) || own.hidden) return;
  double least = width == own.properties.end() ? 1 : length_of(width->second);
  if (sheets_) least = std::min(least, least_sheet_width_);
  const Eigen::Matrix2d scale = own.to_drawing.linear();
  least *= scale.jacobiSvd().singularValues().minCoeff();
  if (least < size_.maxCoeff() / kThinnest)
    thin_problems_.add({places_.of(node), "has a stroke too thin to be painted",
                        "write a greater stroke-width, or stroke: none"});
}

void SvgShapes::add(const pugi::xml_node& node, const std::string& name, const SvgInherited& own) {
  check_stroke(node, own);
  if (own.defined || own.hidden) return;
  const auto get = [&](const char* property) {
    const auto found = own.properties.find(property);
    return found == own.properties.end() ? std::string() : found->second;
  };
  const std::string fill = get("fill"), stroke = get("stroke");
  stroked_ = !stroke.empty() && stroke != "none";
  if (stroked_) paint(node, "has a stroke");
  if (fill == "none" || name == "line") return;
  if (!is_plainly_solid(fill, solid_white_)) paint(node, "has the fill " + fill);
  even_odd_ = get("fill-rule") == "evenodd";
  if (name == "rect") {
    if (const auto ring = rectangle(node)) add_rings(node, {*ring}, own.to_drawing);
  } else if (name == "polygon" || name == "polyline") {
    add_rings(node, {corners(node)}, own.to_drawing);
  } else if (name == "path") {
    const SvgPath path = places_.in(node, "d", svg_path);
    if (path.curved) return paint(node, "has curves");
    add_rings(node, path.rings, own.to_drawing);
  } else {
    paint(node, "is no straight shape");
  }
}

/// What no program shows: an error where only exact shapes are, else the affair of painting.
void SvgShapes::empty(const pugi::xml_node& node, std::string what, std::string remedy) {
  if (!exact_problem_)
    exact_problem_ = PolygonFileProblem{places_.of(node), std::move(what), std::move(remedy)};
}

/// Nothing if it is not straight, or empty.
std::optional<SvgShapes::Ring> SvgShapes::rectangle(const pugi::xml_node& node) {
  bool known = true;
  const auto value = [&](const char* attribute) {
    if (!node.attribute(attribute)) return 0.0;
    if (std::strcmp(node.attribute(attribute).value(), "auto") == 0) return 0.0;
    const auto length = places_.in(node, attribute, svg_length);
    known = known && length.has_value();
    return length.value_or(0);
  };
  const double x = value("x"), y = value("y"), w = value("width"), h = value("height");
  const double round = std::max(value("rx"), value("ry"));
  if (!known || round > 0) {
    paint(node, known ? "has round corners" : "has lengths in percent");
    return std::nullopt;
  }
  if (w < 0 || h < 0) places_.fail(node, "has a negative width or height", "write it above 0");
  if (w > 0 && h > 0) return Ring{{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}};
  empty(node, "has no width or height above 0", "delete it");
  return std::nullopt;
}

SvgShapes::Ring SvgShapes::corners(const pugi::xml_node& node) const {
  const auto numbers = places_.in(node, "points", svg_numbers);
  if (numbers.size() % 2 != 0)
    places_.fail(node, "has an odd number of coordinates", "save it anew");
  Ring ring;
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)
    ring.emplace_back(numbers[i], numbers[i + 1]);
  return ring;
}

void SvgShapes::check_width(const pugi::xml_node& node, const Ring& ring) {
  double area = 0, length = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Eigen::Vector2d a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
    area += (a.x() * b.y() - a.y() * b.x()) / 2;
    length += (b - a).norm();
  }
  const double width = 2 * std::abs(area) / length, page = size_.maxCoeff();
  if (stroked_ || !(width > 1e-9 * page) || width > page / kThinnest) return;
  thin_problems_.add({places_.of(node), "is too thin to be painted", "widen or delete it"});
}

/// Merges corners that the transform puts at one place, and a last corner that closes the ring.
void SvgShapes::add_rings(const pugi::xml_node& node, const std::vector<Ring>& rings,
                          const Eigen::Affine2d& to_drawing) {
  DrawnShape& shape = shapes_.emplace_back();
  shape.element = places_.of(node);
  shape.even_odd = even_odd_;
  for (const Ring& ring : rings) {
    Ring& drawn = shape.rings.emplace_back();
    for (const Eigen::Vector2d& corner : ring) {
      const Eigen::Vector2d place = in_plan(to_drawing * corner);
      if (!place.allFinite()) places_.fail(node, "is infinitely large", "save it anew");
      if (drawn.empty() || drawn.back() != place) drawn.push_back(place);
    }
    while (drawn.size() > 1 && drawn.back() == drawn.front()) drawn.pop_back();
    check_width(node, drawn);
    if (drawn.size() < 3)
      empty(node, "has a part with fewer than three corners", "delete this part");
  }
  if (shape.rings.empty()) empty(node, "has no corners", "delete it");
}

}  // namespace ergocast
