// SPDX-License-Identifier: BSD-3-Clause
// Walks the elements of a parsed drawing with their transforms; the first problem ends the walk.
#include "target/geo/svg.h"

#include <algorithm>
#include <cstring>
#include <pugixml.hpp>
#include <set>

#include "target/geo/svg_syntax.h"

namespace ergocast {
namespace {

/// Groups within groups; drawings have a few.
/// Limit (Files of a scenario): levels of nested tags in a drawing. Beyond it: the scenario is
/// refused.
constexpr int kDeepest = 64;
/// A tag of three bytes takes sixty in memory.
/// Limit (Files of a scenario): tags in a drawing. Beyond it: the scenario is refused.
constexpr std::size_t kMostTags = 1'000'000;

struct BadElement {
  PolygonFileProblem problem;
};

/// Elements that show no area.
const std::set<std::string_view> kSilent = {"text", "title", "desc",  "metadata",
                                            "defs", "style", "script"};

/// The value of a property, as an attribute or in style="…".
std::string property(const pugi::xml_node& node, const std::string& name) {
  const std::string style = std::string(";") + node.attribute("style").value();
  std::string packed;
  for (const char c : style)
    if (c != ' ') packed += c;
  const std::size_t at = packed.find(";" + name + ":");
  if (at == std::string::npos) return node.attribute(name.c_str()).value();
  const std::size_t from = at + name.size() + 2;
  return packed.substr(from, packed.find(';', from) - from);
}

class SvgWalk {
 public:
  explicit SvgWalk(std::string_view text) : text_(text) {}

  Drawing drawing(const pugi::xml_node& root) {
    if (std::strcmp(root.name(), "svg") != 0)
      fail({}, "is no SVG drawing", "name a file that a drawing program saved as SVG");
    Drawing result{view_box(root), {}};
    for (const pugi::xml_node& child : root.children())
      element(child, Eigen::Affine2d::Identity(), property(root, "fill"), 0);
    result.shapes = std::move(shapes_);
    if (result.shapes.empty()) {
      fail({}, "has no filled rect, polygon or path",
           "draw walls as filled shapes; in Inkscape, Path > Stroke to Path makes them of lines");
    }
    return result;
  }

 private:
  [[noreturn]] void fail(const pugi::xml_node& node, std::string what, std::string remedy) const {
    throw BadElement{{node ? place_of(node) : "", std::move(what), std::move(remedy)}};
  }

  std::string place_of(const pugi::xml_node& node) const {
    const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, node.offset_debug()));
    if (offset < counted_) counted_ = breaks_ = 0;
    const auto since = text_.substr(counted_, offset - counted_);
    breaks_ += static_cast<std::size_t>(std::count(since.begin(), since.end(), '\n'));
    counted_ = offset;
    return "line " + std::to_string(1 + breaks_) + ": <" + node.name() + ">";
  }

  /// Runs `read`, and adds the place to a syntax error.
  template <class Read>
  auto in(const pugi::xml_node& node, const char* attribute, Read read) const {
    try {
      return read(node.attribute(attribute).value());
    } catch (const SvgSyntaxError& error) {
      fail(node, std::string(attribute) + ' ' + error.what(), error.remedy);
    }
  }

  /// The size of the viewBox; also sets begin_.
  Eigen::Vector2d view_box(const pugi::xml_node& root) {
    const auto box = in(root, "viewBox", svg_numbers);
    if (box.size() != 4 || !(box[2] > 0) || !(box[3] > 0)) {
      fail(root, "has no viewBox of four numbers with a width and a height above 0",
           "set the document's size in the drawing program and save it anew");
    }
    begin_ = {box[0], box[1]};
    size_ = {box[2], box[3]};
    return size_;
  }

  /// A place of the drawing from the lower left corner of its viewBox, y up. The box's own edges
  /// become exactly 0 and its height, wherever it begins.
  Eigen::Vector2d in_plan(const Eigen::Vector2d& place) const {
    const Eigen::Vector2d from_top = place - begin_;
    return {from_top.x(), size_.y() - from_top.y()};
  }

  void element(const pugi::xml_node& node, const Eigen::Affine2d& outer, const std::string& fill,
               int depth) {
    // Comments, and elements of other languages such as Inkscape's own, show nothing.
    const std::string_view name = node.name();
    const bool foreign = name.find(':') != name.npos;
    if (node.type() != pugi::node_element || foreign || kSilent.contains(name)) return;
    if (property(node, "display") == "none") return;
    if (depth > kDeepest) fail(node, "is in more than 64 groups", "ungroup the drawing");
    const Eigen::Affine2d to_drawing = outer * in(node, "transform", svg_transform);
    const std::string own_fill = property(node, "fill");
    const std::string& filled = own_fill.empty() ? fill : own_fill;
    if (name == "g") {
      for (const pugi::xml_node& child : node.children())
        element(child, to_drawing, filled, depth + 1);
    } else if (filled != "none") {
      shape(node, name, to_drawing);
    }
  }

  void shape(const pugi::xml_node& node, std::string_view name, const Eigen::Affine2d& to_drawing) {
    if (name == "rect") {
      add(node, {rectangle(node)}, to_drawing);
    } else if (name == "polygon") {
      add(node, {corners(node)}, to_drawing);
    } else if (name == "path") {
      add(node, in(node, "d", svg_path), to_drawing);
    } else {
      fail(node, "is no rect, polygon or path",
           "turn it into a path of straight lines, or give it fill=\"none\" to leave it out");
    }
  }

  DrawnRing rectangle(const pugi::xml_node& node) const {
    const auto value = [&](const char* attribute) {
      const auto numbers = in(node, attribute, svg_numbers);
      return numbers.empty() ? 0 : numbers.front();
    };
    if (value("rx") > 0 || value("ry") > 0) fail(node, "has round corners", "set rx and ry to 0");
    const double x = value("x"), y = value("y"), w = value("width"), h = value("height");
    if (!(w > 0) || !(h > 0)) fail(node, "has no width or height above 0", "delete it");
    return {{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}};
  }

  DrawnRing corners(const pugi::xml_node& node) const {
    const auto numbers = in(node, "points", svg_numbers);
    if (numbers.size() % 2 != 0) fail(node, "has an odd number of coordinates", "save it anew");
    DrawnRing ring;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)
      ring.emplace_back(numbers[i], numbers[i + 1]);
    return ring;
  }

  /// Merges corners that the transform puts at one place, and a last corner that closes the ring.
  void add(const pugi::xml_node& node, const std::vector<DrawnRing>& rings,
           const Eigen::Affine2d& to_drawing) {
    DrawnShape& shape = shapes_.emplace_back();
    shape.element = place_of(node);
    for (const DrawnRing& ring : rings) {
      DrawnRing& drawn = shape.rings.emplace_back();
      for (const Eigen::Vector2d& corner : ring) {
        const Eigen::Vector2d place = in_plan(to_drawing * corner);
        if (!place.allFinite()) fail(node, "is infinitely large", "save it anew");
        if (drawn.empty() || drawn.back() != place) drawn.push_back(place);
      }
      while (drawn.size() > 1 && drawn.back() == drawn.front()) drawn.pop_back();
      if (drawn.size() < 3)
        fail(node, "has a part with fewer than three corners", "delete this part");
    }
    if (shape.rings.empty()) fail(node, "has no corners", "delete it");
  }

  std::string_view text_;
  // The elements come in the order of the text: what was counted before is not counted again.
  mutable std::size_t counted_ = 0, breaks_ = 0;
  Eigen::Vector2d begin_{0, 0}, size_{0, 0};  // of the viewBox
  std::vector<DrawnShape> shapes_;
};

}  // namespace

Result<Drawing, PolygonFileProblem> parse_svg(std::string_view text) {
  if (static_cast<std::size_t>(std::count(text.begin(), text.end(), '<')) > kMostTags)
    return failure(
        PolygonFileProblem{"", "has more than 1 000 000 tags", "leave out all but the walls"});
  pugi::xml_document document;
  const auto parsed = document.load_buffer(text.data(), text.size());
  if (!parsed) {
    const auto before = text.substr(0, static_cast<std::size_t>(parsed.offset));
    return failure(PolygonFileProblem{
        "line " + std::to_string(1 + std::count(before.begin(), before.end(), '\n')),
        std::string("is no XML: ") + parsed.description(), "save the drawing anew"});
  }
  try {
    return SvgWalk(text).drawing(document.document_element());
  } catch (const BadElement& bad) {
    return failure(bad.problem);
  }
}

Result<Drawing, PolygonFileProblem> read_svg(const std::filesystem::path& file) {
  return text_of_polygon_file(file, ".svg", "leave out all but the walls").and_then(parse_svg);
}

}  // namespace ergocast
