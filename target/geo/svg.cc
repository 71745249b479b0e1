// SPDX-License-Identifier: BSD-3-Clause
// Walks the elements of a parsed drawing with their transforms, and collects their problems.
#include "target/geo/svg.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "target/geo/svg_names.h"
#include "target/geo/svg_places.h"
#include "target/geo/svg_references.h"
#include "target/geo/svg_shapes.h"
#include "target/geo/svg_style.h"
#include "target/geo/svg_syntax.h"
#include "target/geo/svg_values.h"

namespace ergocast {
namespace {

/// Groups within groups; drawings have a few.
/// Limit (Files of a scenario): levels of nested tags in a drawing. Beyond it: the scenario is
/// refused.
constexpr int kDeepest = 64;
/// A tag of three bytes takes sixty in memory.
/// Limit (Files of a scenario): tags in a drawing. Beyond it: the scenario is refused.
constexpr std::size_t kMostTags = 1'000'000;

using Names = std::set<std::string_view>;
/// Elements that show no area, with all that is inside.
const Names kSilent = {"title", "desc", "metadata"};
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

std::size_t count_lines(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

class SvgWalk {
 public:
  SvgWalk(std::string_view text, bool solid_white) : places_(text), shapes_(places_, solid_white) {}

  Drawing drawing(pugi::xml_document& document) {
    pugi::xml_node root = document.document_element();
    check_prologue(document);
    names_.enter(root);
    if (local_name(root) != "svg" || !names_.is_svg(root))
      places_.fail({}, "is no SVG drawing", "name a file that a drawing program saved as SVG");
    document.find_node([&](const pugi::xml_node& node) {
      symbols_ = symbols_ || local_name(node) == "symbol";
      if (local_name(node) != "style") return false;
      sheets_ = true;
      for (const pugi::xml_node& part : node.children())
        sheets_hide_ = sheets_hide_ || std::strstr(part.value(), "display") != nullptr;
      return false;
    });
    if (sheets_) shapes_.note_sheets();
    Drawing result{view_box(root), {}, "", ""};
    element(root, SvgInherited{}, 0);
    references_.check(places_, problems_);
    if (!problems_.empty()) throw BadSvg{problems_.all()};
    shapes_.take(result);
    result.to_paint = printed(document, root);
    return result;
  }

 private:
  void check_prologue(pugi::xml_document& document) const {
    for (const pugi::xml_node& node : document.children()) {
      if (node.type() == pugi::node_doctype &&
          std::string_view(node.value()).find("<!ENTITY") != std::string_view::npos)
        places_.fail({}, "declares entities, which are not read", "save the drawing as plain SVG");
      if (node.type() == pugi::node_pi && std::strcmp(node.name(), "xml-stylesheet") == 0)
        places_.fail({}, "has its style in another file", "save the drawing as plain SVG");
    }
  }

  // ---- the page ----

  /// The size of the viewBox, or of a page without one; also sets begin_ and size_.
  Eigen::Vector2d view_box(pugi::xml_node& root) {
    auto box = places_.in(root, "viewBox", svg_numbers);
    if (!root.attribute("viewBox")) {
      for (const char* side : {"width", "height"}) {
        const auto length =
            root.attribute(side) ? places_.in(root, side, svg_length) : std::optional<double>();
        if (box.empty()) box = {0, 0};
        box.push_back(length.value_or(0));
      }
    }
    if (box.size() != 4 || !(box[2] > 0) || !(box[3] > 0)) {
      places_.fail(root, "has no viewBox of four numbers with a width and a height above 0",
                   "set the document's size in the drawing program and save it anew");
    }
    begin_ = {box[0], box[1]};
    size_ = {box[2], box[3]};
    shapes_.set_page(begin_, size_);
    return size_;
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
    if (!declares_svg(root))
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

  void children(pugi::xml_node& node, const SvgInherited& outer, int depth) {
    for (pugi::xml_node child = node.first_child(); child;) {
      const pugi::xml_node next = child.next_sibling();
      const std::size_t declared = names_.enter(child);
      if (problems_.full()) return;
      try {
        if (shows(child, outer)) {
          element(child, outer, depth);
        } else {
          node.remove_child(child);
        }
      } catch (const BadSvg& bad) {
        problems_.add(bad.problem);
      }
      names_.leave(declared);
      child = next;
    }
  }

  /// Whether the element is part of the drawing. Comments, and elements of other languages, are
  /// not.
  bool shows(const pugi::xml_node& node, const SvgInherited& outer) const {
    const std::string_view name = local_name(node);
    if (node.type() != pugi::node_element || !names_.is_svg(node) || kSilent.contains(name))
      return false;
    const auto refused = kRefused.find(name);
    if (refused == kRefused.end()) return true;
    const bool hidden = outer.hidden || (!sheets_hide_ && properties_of(node)["display"] == "none");
    if (!hidden || name == "script") places_.fail(node, "is not read", refused->second);
    return false;
  }

  std::map<std::string, std::string> properties_of(const pugi::xml_node& node) const {
    std::map<std::string, std::string> all;
    for (const pugi::xml_attribute& one : node.attributes())
      if (is_painted_property(one.name())) all[one.name()] = one.value();
    for (auto& [name, value] : places_.in(node, "style", svg_properties))
      all[name] = std::move(value);
    return all;
  }

  void element(pugi::xml_node& node, const SvgInherited& outer, int depth) {
    const std::string name(local_name(node));
    if (depth > kDeepest) places_.fail(node, "is in more than 64 groups", "ungroup the drawing");
    if (name == "style") return sheet(node);
    SvgInherited own = outer;
    if (const char* id = node.attribute("id").value(); *id != '\0') {
      own.ids.emplace_back(id);
      references_.define(id, name);
    }
    if (!is_svg_shape(name) && !kPainted.contains(name))
      places_.fail(node, "is no element that is painted",
                   "delete it, or save the drawing as plain SVG: inkscape --export-plain-svg");
    own.defined = own.defined || kDefinitions.contains(name);
    try {
      itself(node, own, name, depth);
    } catch (const BadSvg& bad) {
      problems_.add(bad.problem);
    }
    children(node, own, depth + 1);
  }

  /// An element without what is inside.
  void itself(pugi::xml_node& node, SvgInherited& own, const std::string& name, int depth) {
    attributes(node, own, name);
    if (depth > 0 && (name == "svg" || name == "use" || name == "switch"))
      shapes_.paint(node, "is no straight shape");
    auto properties = properties_of(node);
    own.hidden = own.hidden || (!sheets_hide_ && properties["display"] == "none");
    own.to_drawing = own.to_drawing * places_.in(node, "transform", svg_transform);
    shapes_.inherit(node, own, properties);
    check_emptiness(node, name, properties);
    if (is_svg_shape(name)) shapes_.add(node, name, own);
  }

  void check_emptiness(pugi::xml_node& node, const std::string& name,
                       std::map<std::string, std::string>& properties) {
    const std::string& overflow = properties["overflow"];
    if (name == "symbol" && (overflow == "visible" || overflow == "auto"))
      places_.fail(node, "is a symbol that overflows, which is not painted", "write a <g>");
    // librsvg before 2.57 does not clip symbols otherwise.
    if (name == "use") {
      const std::string style = node.attribute("style").value();
      node.remove_attribute("style");
      node.append_attribute("style").set_value((style + ";overflow:hidden !important").c_str());
    }
    const bool gradient = name == "linearGradient" || name == "radialGradient";
    const bool linked = node.attribute("href") || node.attribute("xlink:href");
    const bool stops =
        node.find_child([](const pugi::xml_node& child) { return local_name(child) == "stop"; });
    if (gradient && !linked && !stops)
      places_.fail(node, "has no stops, and paints nothing", "draw it anew, or delete it");
  }

  /// Checks all data of an element, and removes what other languages added.
  void attributes(pugi::xml_node& node, const SvgInherited& own, const std::string& name) {
    for (pugi::xml_attribute one = node.first_attribute(); one;) {
      const pugi::xml_attribute next = one.next_attribute();
      const std::string attribute = one.name();
      const std::string_view prefix = prefix_of(attribute), local = local_of(attribute);
      if (local == "href" && (prefix.empty() || names_.space_of(prefix) == kLinkSpace) &&
          name != "a") {
        link(node, own, one.value());
      } else if (!prefix.empty() && prefix != "xmlns" && prefix != "xml") {
        node.remove_attribute(one);
      } else {
        data(node, own, attribute, name);
      }
      one = next;
    }
  }

  void link(const pugi::xml_node& node, const SvgInherited& own, std::string_view to) {
    if (!to.starts_with('#'))
      places_.fail(node, "refers to another file", "put it into the drawing, or delete this");
    references_.refer(node, own.ids, std::string(to.substr(1)), "href");
  }

  void data(const pugi::xml_node& node, const SvgInherited& own, const std::string& attribute,
            const std::string& name) {
    if (attribute.starts_with("on"))
      places_.fail(node, attribute + " runs a script, which is not read", "remove it");
    for (const char* condition : {"systemLanguage", "requiredExtensions", "requiredFeatures"})
      if (attribute == condition)
        places_.fail(node, attribute + " makes it show on some machines only", "remove it");
    const bool root = node.parent().type() == pugi::node_document;
    const bool known = root || attribute.find(':') != attribute.npos ||
                       is_svg_attribute(attribute) || is_painted_property(attribute) ||
                       is_inert_property(attribute);
    if (!known)
      places_.fail(node, "has the attribute " + attribute + ", which is none of SVG",
                   "correct or remove it");
    const std::string_view value = node.attribute(attribute.c_str()).value();
    const bool at_origin = value.find_first_not_of("0px ,") == value.npos;
    if (attribute == "transform-origin" && !at_origin)
      places_.fail(node, "transform-origin is not painted", "ungroup it, or write transform alone");
    if (kLengths.contains(attribute) && value != "auto") places_.in(node, attribute, svg_length);
    if (kTransforms.contains(attribute)) places_.in(node, attribute, svg_transform);
    if (attribute == "points" || attribute == "viewBox") places_.in(node, attribute, svg_numbers);
    if (attribute == "d" && name == "path") places_.in(node, attribute, svg_path);
    try {
      if (is_painted_property(attribute) && attribute != "transform")
        check_value(node, own.ids, attribute, value);
      if (attribute == "style")
        for (const auto& [property, set] : svg_properties(value))
          check_value(node, own.ids, property, set);
    } catch (const SvgSyntaxError& error) {
      places_.fail(node, error.what(), error.remedy);
    }
  }

  void check_value(const pugi::xml_node& node, const std::vector<std::string>& around,
                   const std::string& property, std::string_view value) {
    check_svg_value(property, value, [&](std::string id) {
      references_.refer(node, around, std::move(id), property);
    });
  }

  void sheet(pugi::xml_node& node) {
    const std::string_view type = node.attribute("type").value();
    if ((!type.empty() && type != "text/css") || node.attribute("media"))
      places_.fail(node, "is no style sheet for every display", "remove its type and media");
    std::string text;
    for (const pugi::xml_node& part : node.children()) text += part.value();
    try {
      for_svg_rules(text, [&](const SvgProperties& rule) {
        shapes_.paint(node, "sets properties of shapes");
        for (const auto& [property, value] : rule) {
          if (property == "stroke-width") shapes_.note_sheet_width(value);
          if (property == "overflow" && value != "hidden" && symbols_)
            places_.fail(node, "lets symbols overflow, which is not painted", "remove overflow");
          check_value(node, {}, property, value);
        }
      });
    } catch (const SvgSyntaxError& error) {
      places_.fail(node, error.what(), error.remedy);
    }
  }

  const SvgPlaces places_;
  SvgNames names_;
  SvgReferences references_;
  SvgShapes shapes_;
  Eigen::Vector2d begin_{0, 0}, size_{0, 0};  // of the viewBox
  bool sheets_ = false, symbols_ = false;
  bool sheets_hide_ = false;  // they can show what an element hides, or the reverse
  PolygonFileProblems problems_;
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
  } catch (const BadSvg& bad) {
    return failure(bad.problem);
  }
}

Result<Drawing, PolygonFileProblem> read_svg(const std::filesystem::path& file, bool solid_white) {
  return text_of_polygon_file(file, ".svg", "leave out all but the walls")
      .and_then([&](const std::string& text) { return parse_svg(text, solid_white); });
}

}  // namespace ergocast
