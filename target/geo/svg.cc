// SPDX-License-Identifier: BSD-3-Clause
// Walks the elements of a parsed drawing with their transforms; the first problem ends the walk.
#include "target/geo/svg.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "target/geo/svg_painter.h"
#include "target/geo/svg_style.h"
#include "target/geo/svg_syntax.h"

namespace ergocast {
namespace {

/// Groups within groups; drawings have a few.
/// Limit (Files of a scenario): levels of nested tags in a drawing. Beyond it: the scenario is
/// refused.
constexpr int kDeepest = 64;
/// The longer side of a page over the width of what is painted surely: half a cell. Cairo leaves
/// out strokes below a fifth, and on a white page, less paint does not make a cell dark.
constexpr double kThinnest = 2 * kPaintedCells;
/// A tag of three bytes takes sixty in memory.
/// Limit (Files of a scenario): tags in a drawing. Beyond it: the scenario is refused.
constexpr std::size_t kMostTags = 1'000'000;

constexpr std::string_view kSvgSpace = "http://www.w3.org/2000/svg";
constexpr std::string_view kLinkSpace = "http://www.w3.org/1999/xlink";

struct BadElement {
  PolygonFileProblem problem;
};

using Names = std::set<std::string_view>;
/// Elements that show no area, with all that is inside.
const Names kSilent = {"title", "desc", "metadata"};
const Names kShapes = {"rect", "polygon", "path", "polyline", "line", "circle", "ellipse"};
const Names kPainted = {
    "svg",      "g",    "a",       "switch", "use",  "symbol",         "defs",
    "clipPath", "mask", "pattern", "marker", "stop", "linearGradient", "radialGradient"};
/// What is inside them is shown only where something refers to it.
const Names kDefinitions = {"defs",    "symbol", "clipPath",       "mask",
                            "pattern", "marker", "linearGradient", "radialGradient"};
const std::map<std::string_view, const char*> kRefused = {
    {"text",
     "delete it, hide it (display: none), or make it a path: in Inkscape, Path > Object to "
     "Path"},
    {"image", "delete it, hide it, or trace it: in Inkscape, Path > Trace Bitmap"},
    {"foreignObject", "delete it, or save the drawing as plain SVG"},
    {"script", "delete it, or save the drawing as plain SVG"},
};
const Names kLengths = {"x",  "y",  "width", "height", "rx", "ry", "r",
                        "cx", "cy", "x1",    "y1",     "x2", "y2"};
const Names kTransforms = {"transform", "gradientTransform", "patternTransform"};

/// Infinite if it is unknown.
double length_of(std::string_view text) {
  try {
    return svg_length(text).value_or(HUGE_VAL);
  } catch (const SvgSyntaxError&) {
    return HUGE_VAL;
  }
}

std::size_t count_lines(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

/// What elements inherit, as far as exact shapes need it.
struct Inherited {
  std::map<std::string, std::string> properties;
  Eigen::Affine2d to_drawing = Eigen::Affine2d::Identity();
  bool defined = false, hidden = false;
  std::vector<std::string> ids;  // of the elements around
};

class SvgWalk {
 public:
  SvgWalk(std::string_view text, bool solid_white) : text_(text), solid_white_(solid_white) {}

  Drawing drawing(pugi::xml_document& document) {
    pugi::xml_node root = document.document_element();
    check_prologue(document);
    enter_spaces(root);
    if (local_name(root) != "svg" || !is_svg(root))
      fail({}, "is no SVG drawing", "name a file that a drawing program saved as SVG");
    sheets_ = document.find_node([](const pugi::xml_node& node) {
      const std::string_view name = node.name();
      return name == "style" || name.ends_with(":style");
    });
    Drawing result{view_box(root), {}, "", ""};
    element(root, Inherited{}, 0);
    check_references();
    result.shapes = std::move(shapes_);
    result.paint_because = paint_because_;
    result.to_paint = printed(document, root);
    if (!paint_because_.empty()) {
      if (thin_problem_) throw BadElement{*thin_problem_};
      result.shapes.clear();
    } else if (exact_problem_) {
      throw BadElement{*exact_problem_};
    } else if (result.shapes.empty()) {
      fail({}, "has no filled or stroked shape",
           "draw walls as shapes; what has fill=\"none\" and no stroke is not shown");
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
    breaks_ += count_lines(text_.substr(counted_, offset - counted_));
    counted_ = offset;
    return "line " + std::to_string(1 + breaks_) + ": <" + node.name() + ">";
  }

  /// Runs `read`, and adds the place to a syntax error.
  template <class Read>
  auto in(const pugi::xml_node& node, const std::string& attribute, Read read) const {
    try {
      return read(node.attribute(attribute.c_str()).value());
    } catch (const SvgSyntaxError& error) {
      fail(node, attribute + ' ' + error.what(), error.remedy);
    }
  }

  void paint(const pugi::xml_node& node, const std::string& why) {
    if (paint_because_.empty()) paint_because_ = place_of(node) + ' ' + why;
  }

  // ---- names ----

  void check_prologue(pugi::xml_document& document) const {
    for (const pugi::xml_node& node : document.children()) {
      if (node.type() == pugi::node_doctype &&
          std::string_view(node.value()).find("<!ENTITY") != std::string_view::npos)
        fail({}, "declares entities, which are not read", "save the drawing as plain SVG");
      if (node.type() == pugi::node_pi && std::strcmp(node.name(), "xml-stylesheet") == 0)
        fail({}, "has its style in another file", "save the drawing as plain SVG");
    }
  }

  static std::string_view prefix_of(std::string_view name) {
    const std::size_t colon = name.find(':');
    return colon == name.npos ? std::string_view() : name.substr(0, colon);
  }
  static std::string_view local_of(std::string_view name) {
    return name.substr(name.find(':') == name.npos ? 0 : name.find(':') + 1);
  }
  static std::string_view local_name(const pugi::xml_node& node) { return local_of(node.name()); }

  /// Returns how many names of spaces the element declares.
  std::size_t enter_spaces(const pugi::xml_node& node) {
    const std::size_t before = spaces_.size();
    for (const pugi::xml_attribute& one : node.attributes()) {
      const std::string_view name = one.name();
      if (name == "xmlns") spaces_.emplace_back("", one.value());
      if (name.starts_with("xmlns:")) spaces_.emplace_back(name.substr(6), one.value());
    }
    return spaces_.size() - before;
  }
  std::string_view space_of(std::string_view prefix) const {
    for (std::size_t i = spaces_.size(); i-- > 0;)
      if (spaces_[i].first == prefix) return spaces_[i].second;
    return prefix.empty() ? kSvgSpace : std::string_view();
  }
  bool is_svg(const pugi::xml_node& node) const {
    return space_of(prefix_of(node.name())) == kSvgSpace;
  }

  // ---- the page ----

  /// The size of the viewBox, or of a page without one; also sets begin_.
  Eigen::Vector2d view_box(pugi::xml_node& root) {
    auto box = in(root, "viewBox", svg_numbers);
    if (!root.attribute("viewBox")) {
      for (const char* side : {"width", "height"}) {
        const auto length =
            root.attribute(side) ? in(root, side, svg_length) : std::optional<double>();
        if (box.empty()) box = {0, 0};
        box.push_back(length.value_or(0));
      }
    }
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

  /// The drawing as it was checked: the viewBox fills the page, nothing depends on other files.
  std::string printed(pugi::xml_document& document, pugi::xml_node& root) const {
    for (const char* name : {"width", "height", "x", "y", "viewBox", "preserveAspectRatio"})
      root.remove_attribute(name);
    std::ostringstream box;
    box.precision(17);
    box << begin_.x() << ' ' << begin_.y() << ' ' << size_.x() << ' ' << size_.y();
    root.append_attribute("viewBox").set_value(box.str().c_str());
    root.append_attribute("preserveAspectRatio").set_value("none");
    if (spaces_.empty() || space_of(prefix_of(root.name())) != kSvgSpace || !declares_svg(root))
      root.append_attribute("xmlns").set_value(std::string(kSvgSpace).c_str());
    std::ostringstream text;
    for (pugi::xml_node child : document.children())
      if (child == root) child.print(text, "", pugi::format_raw);
    return with_smooth_edges(text.str());
  }
  static bool declares_svg(const pugi::xml_node& root) {
    const std::string_view prefix = prefix_of(root.name());
    const std::string name = prefix.empty() ? "xmlns" : "xmlns:" + std::string(prefix);
    return static_cast<bool>(root.attribute(name.c_str()));
  }
  /// Without smooth edges, walls thinner than a pixel may not be painted at all.
  static std::string with_smooth_edges(std::string text) {
    std::string low = text;
    for (char& c : low) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    for (const std::string word : {"crispedges", "optimizespeed"})
      for (std::size_t at = low.find(word); at != low.npos; at = low.find(word, at + 1))
        text.replace(at, word.size(), "auto" + std::string(word.size() - 4, ' '));
    return text;
  }

  // ---- elements ----

  void children(pugi::xml_node& node, const Inherited& outer, int depth) {
    for (pugi::xml_node child = node.first_child(); child;) {
      const pugi::xml_node next = child.next_sibling();
      const std::size_t declared = enter_spaces(child);
      if (!shows(child, outer)) {
        node.remove_child(child);
      } else {
        element(child, outer, depth);
      }
      spaces_.resize(spaces_.size() - declared);
      child = next;
    }
  }

  /// Whether the element is part of the drawing. Comments, and elements of other languages, are
  /// not.
  bool shows(const pugi::xml_node& node, const Inherited& outer) const {
    const std::string_view name = local_name(node);
    if (node.type() != pugi::node_element || !is_svg(node) || kSilent.contains(name)) return false;
    const auto refused = kRefused.find(name);
    if (refused == kRefused.end()) return true;
    const bool hidden = outer.hidden || (!sheets_ && properties_of(node)["display"] == "none");
    if (hidden && name != "script") return false;
    fail(node, "is not read", refused->second);
  }

  std::map<std::string, std::string> properties_of(const pugi::xml_node& node) const {
    std::map<std::string, std::string> all;
    for (const pugi::xml_attribute& one : node.attributes())
      if (is_painted_property(one.name())) all[one.name()] = one.value();
    for (auto& [name, value] : in(node, "style", svg_properties)) all[name] = std::move(value);
    return all;
  }

  void element(pugi::xml_node& node, const Inherited& outer, int depth) {
    const std::string name(local_name(node));
    if (depth > kDeepest) fail(node, "is in more than 64 groups", "ungroup the drawing");
    if (name == "style") return sheet(node);
    if (!kShapes.contains(name) && !kPainted.contains(name))
      fail(node, "is no element that is painted",
           "delete it, or save the drawing as plain SVG: inkscape --export-plain-svg");
    Inherited own = outer;
    if (const char* id = node.attribute("id").value(); *id != '\0') {
      own.ids.emplace_back(id);
      ids_.insert(id);
      if (name == "pattern") patterns_.insert(id);
    }
    own.defined = own.defined || kDefinitions.contains(name);
    attributes(node, own, name);
    if (depth > 0 && (name == "svg" || name == "use" || name == "switch"))
      paint(node, "is no straight shape");
    auto properties = properties_of(node);
    own.hidden = own.hidden || (!sheets_ && properties["display"] == "none");
    own.to_drawing = outer.to_drawing * in(node, "transform", svg_transform);
    inherit(node, own, properties);
    if (kShapes.contains(name)) check_stroke(node, own);
    if (kShapes.contains(name)) shape(node, name, own);
    children(node, own, depth + 1);
  }

  /// Checks all data of an element, and removes what other languages added.
  void attributes(pugi::xml_node& node, const Inherited& own, const std::string& name) {
    const auto refers = [&](std::string id) { refer(node, own, std::move(id)); };
    for (pugi::xml_attribute one = node.first_attribute(); one;) {
      const pugi::xml_attribute next = one.next_attribute();
      const std::string attribute = one.name();
      const std::string_view prefix = prefix_of(attribute), local = local_of(attribute);
      if (local == "href" && (prefix.empty() || space_of(prefix) == kLinkSpace) && name != "a") {
        link(node, one.value(), refers);
      } else if (!prefix.empty() && prefix != "xmlns" && prefix != "xml") {
        node.remove_attribute(one);
      } else {
        data(node, attribute, name, refers);
      }
      one = next;
    }
  }

  void link(const pugi::xml_node& node, std::string_view to,
            const std::function<void(std::string)>& refers) const {
    if (!to.starts_with('#'))
      fail(node, "refers to another file", "put it into the drawing, or delete this");
    refers(std::string(to.substr(1)));
  }

  void data(const pugi::xml_node& node, const std::string& attribute, const std::string& name,
            const std::function<void(std::string)>& refers) {
    if (attribute.starts_with("on"))
      fail(node, attribute + " runs a script, which is not read", "remove it");
    for (const char* condition : {"systemLanguage", "requiredExtensions", "requiredFeatures"})
      if (attribute == condition)
        fail(node, attribute + " makes it show on some machines only", "remove it");
    const std::string_view value = node.attribute(attribute.c_str()).value();
    const bool at_origin = value.find_first_of("123456789%etc") == value.npos;
    if (attribute == "transform-origin" && !at_origin)
      fail(node, "transform-origin is not painted", "ungroup it, or write transform alone");
    if (kLengths.contains(attribute) && value != "auto") in(node, attribute, svg_length);
    if (kTransforms.contains(attribute)) in(node, attribute, svg_transform);
    if (attribute == "points" || attribute == "viewBox") in(node, attribute, svg_numbers);
    if (attribute == "d" && name == "path") in(node, attribute, svg_path);
    try {
      if (is_painted_property(attribute) && attribute != "transform")
        check_svg_value(attribute, value, refers);
      if (attribute == "style")
        for (const auto& [property, set] : svg_properties(value))
          check_svg_value(property, set, refers);
    } catch (const SvgSyntaxError& error) {
      fail(node, error.what(), error.remedy);
    }
  }

  void sheet(pugi::xml_node& node) {
    const std::string_view type = node.attribute("type").value();
    if ((!type.empty() && type != "text/css") || node.attribute("media"))
      fail(node, "is no style sheet for every display", "remove its type and media");
    std::string text;
    for (const pugi::xml_node& part : node.children()) text += part.value();
    try {
      for_svg_rules(text, [&](const SvgProperties& rule) {
        paint(node, "sets properties of shapes");
        for (const auto& [property, value] : rule) {
          if (property == "stroke-width")
            least_sheet_width_ = std::min(least_sheet_width_, length_of(value));
          check_svg_value(property, value,
                          [&](std::string id) { refer(node, Inherited{}, std::move(id)); });
        }
      });
    } catch (const SvgSyntaxError& error) {
      fail(node, error.what(), error.remedy);
    }
  }

  // ---- references ----

  void refer(const pugi::xml_node& node, const Inherited& own, std::string id) {
    for (const std::string& around : own.ids) uses_[around].insert(id);
    references_.emplace_back(node, std::move(id));
  }

  /// Each leads somewhere, and none back to itself.
  void check_references() const {
    for (const auto& [node, id] : references_) {
      if (!ids_.contains(id))
        fail(node, "refers to #" + id + ", which is not there", "delete it, or draw #" + id);
      // librsvg leaves out those with small tiles.
      if (patterns_.contains(id))
        fail(node, "has a pattern, which is not painted", "give it a colour");
    }
    std::map<std::string, std::size_t> waiting;
    std::map<std::string, std::vector<std::string>> users;
    std::vector<std::string> ready;
    for (const std::string& id : ids_) {
      const auto used = uses_.find(id);
      waiting[id] = used == uses_.end() ? 0 : used->second.size();
      if (waiting[id] == 0) ready.push_back(id);
      if (used == uses_.end()) continue;
      for (const std::string& other : used->second) users[other].push_back(id);
    }
    std::size_t done = 0;
    for (; !ready.empty(); ++done) {
      const std::string id = ready.back();
      ready.pop_back();
      for (const std::string& user : users[id])
        if (--waiting[user] == 0) ready.push_back(user);
    }
    if (done == ids_.size()) return;
    for (const auto& [node, id] : references_)
      if (waiting.at(id) > 0) fail(node, "refers to itself through #" + id, "delete it");
  }

  // ---- exact shapes ----

  /// Adds the properties, and finds those that exact shapes do not have.
  void inherit(const pugi::xml_node& node, Inherited& own,
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
      const bool plain = kAlways.contains(name) || value.empty() || value == "none" ||
                         value == "1" || value == "normal" || value == "visible" ||
                         value == "auto" || name.starts_with("stroke-") ||
                         name.starts_with("stop-");
      const bool by_attribute = name == "transform" && value == node.attribute("transform").value();
      if (!plain && !by_attribute) paint(node, "has " + name + ": " + value);
    }
    static const Names kGeometry = {"x", "y", "width", "height", "rx", "ry", "r", "cx", "cy"};
    for (const auto& [name, value] : properties)
      if (kGeometry.contains(name) && value != node.attribute(name.c_str()).value())
        paint(node, "has its place in its style");
  }

  /// Sheets may set any of their widths.
  void check_stroke(const pugi::xml_node& node, const Inherited& own) {
    const auto stroke = own.properties.find("stroke"), width = own.properties.find("stroke-width");
    const bool stroked = stroke != own.properties.end() && stroke->second != "none";
    if ((!stroked && !sheets_) || own.hidden) return;
    double least = width == own.properties.end() ? 1 : length_of(width->second);
    if (sheets_) least = std::min(least, least_sheet_width_);
    const Eigen::Matrix2d scale = own.to_drawing.linear();
    least *= scale.jacobiSvd().singularValues().minCoeff();
    if (least < size_.maxCoeff() / kThinnest && !thin_problem_)
      thin_problem_ = {place_of(node), "has a stroke too thin to be painted",
                       "write a greater stroke-width, or stroke: none"};
  }

  void shape(const pugi::xml_node& node, const std::string& name, const Inherited& own) {
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
      if (const auto ring = rectangle(node)) add(node, {*ring}, own.to_drawing);
    } else if (name == "polygon" || name == "polyline") {
      add(node, {corners(node)}, own.to_drawing);
    } else if (name == "path") {
      const SvgPath path = in(node, "d", svg_path);
      if (path.curved) return paint(node, "has curves");
      add(node, path.rings, own.to_drawing);
    } else {
      paint(node, "is no straight shape");
    }
  }

  /// What no program shows: an error where only exact shapes are, else the affair of painting.
  void empty(const pugi::xml_node& node, std::string what, std::string remedy) {
    if (!exact_problem_)
      exact_problem_ = PolygonFileProblem{place_of(node), std::move(what), std::move(remedy)};
  }

  /// Nothing if it is not straight, or empty.
  std::optional<DrawnRing> rectangle(const pugi::xml_node& node) {
    bool known = true;
    const auto value = [&](const char* attribute) {
      if (!node.attribute(attribute)) return 0.0;
      if (std::strcmp(node.attribute(attribute).value(), "auto") == 0) return 0.0;
      const auto length = in(node, attribute, svg_length);
      known = known && length.has_value();
      return length.value_or(0);
    };
    const double x = value("x"), y = value("y"), w = value("width"), h = value("height");
    const double round = std::max(value("rx"), value("ry"));
    if (!known || round > 0) {
      paint(node, known ? "has round corners" : "has lengths in percent or in sizes of a font");
      return std::nullopt;
    }
    if (w < 0 || h < 0) fail(node, "has a negative width or height", "write it above 0");
    if (w > 0 && h > 0) return DrawnRing{{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}};
    empty(node, "has no width or height above 0", "delete it");
    return std::nullopt;
  }

  DrawnRing corners(const pugi::xml_node& node) const {
    const auto numbers = in(node, "points", svg_numbers);
    if (numbers.size() % 2 != 0) fail(node, "has an odd number of coordinates", "save it anew");
    DrawnRing ring;
    for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)
      ring.emplace_back(numbers[i], numbers[i + 1]);
    return ring;
  }

  void check_width(const pugi::xml_node& node, const DrawnRing& ring) {
    double area = 0, length = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
      area += (a.x() * b.y() - a.y() * b.x()) / 2;
      length += (b - a).norm();
    }
    const double width = 2 * std::abs(area) / length, page = size_.maxCoeff();
    if (stroked_ || !(width > 1e-9 * page) || width > page / kThinnest || thin_problem_) return;
    thin_problem_ =
        PolygonFileProblem{place_of(node), "is too thin to be painted", "widen or delete it"};
  }

  /// Merges corners that the transform puts at one place, and a last corner that closes the ring.
  void add(const pugi::xml_node& node, const std::vector<DrawnRing>& rings,
           const Eigen::Affine2d& to_drawing) {
    DrawnShape& shape = shapes_.emplace_back();
    shape.element = place_of(node);
    shape.even_odd = even_odd_;
    for (const DrawnRing& ring : rings) {
      DrawnRing& drawn = shape.rings.emplace_back();
      for (const Eigen::Vector2d& corner : ring) {
        const Eigen::Vector2d place = in_plan(to_drawing * corner);
        if (!place.allFinite()) fail(node, "is infinitely large", "save it anew");
        if (drawn.empty() || drawn.back() != place) drawn.push_back(place);
      }
      while (drawn.size() > 1 && drawn.back() == drawn.front()) drawn.pop_back();
      check_width(node, drawn);
      if (drawn.size() < 3)
        empty(node, "has a part with fewer than three corners", "delete this part");
    }
    if (shape.rings.empty()) empty(node, "has no corners", "delete it");
  }

  std::string_view text_;
  const bool solid_white_;
  // The elements come in the order of the text: what was counted before is not counted again.
  mutable std::size_t counted_ = 0, breaks_ = 0;
  double least_sheet_width_ = HUGE_VAL;
  Eigen::Vector2d begin_{0, 0}, size_{0, 0};                           // of the viewBox
  std::vector<std::pair<std::string_view, std::string_view>> spaces_;  // prefix, address
  bool sheets_ = false, even_odd_ = false, stroked_ = false;
  std::set<std::string> ids_, patterns_;
  std::vector<std::pair<pugi::xml_node, std::string>> references_;
  std::map<std::string, std::set<std::string>> uses_;  // by elements around the reference
  std::vector<DrawnShape> shapes_;
  std::string paint_because_;
  std::optional<PolygonFileProblem> exact_problem_, thin_problem_;
};

}  // namespace

Result<Drawing, PolygonFileProblem> parse_svg(std::string_view text, bool solid_white) {
  if (static_cast<std::size_t>(std::count(text.begin(), text.end(), '<')) > kMostTags)
    return failure(
        PolygonFileProblem{"", "has more than 1 000 000 tags", "leave out all but the walls"});
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") ||
      text.substr(0, 64).find('\0') != text.npos)
    return failure(PolygonFileProblem{"", "is in UTF-16, not UTF-8",
                                      "convert it: iconv -f UTF-16 -t UTF-8 in.svg > out.svg"});
  pugi::xml_document document;
  const auto parsed = document.load_buffer(
      text.data(), text.size(), pugi::parse_default | pugi::parse_pi | pugi::parse_doctype);
  if (!parsed) {
    const auto before = text.substr(0, static_cast<std::size_t>(parsed.offset));
    return failure(PolygonFileProblem{"line " + std::to_string(1 + count_lines(before)),
                                      std::string("is no XML: ") + parsed.description(),
                                      "save the drawing anew"});
  }
  try {
    return SvgWalk(text, solid_white).drawing(document);
  } catch (const BadElement& bad) {
    return failure(bad.problem);
  }
}

Result<Drawing, PolygonFileProblem> read_svg(const std::filesystem::path& file, bool solid_white) {
  return text_of_polygon_file(file, ".svg", "leave out all but the walls")
      .and_then([&](const std::string& text) { return parse_svg(text, solid_white); });
}

}  // namespace ergocast
