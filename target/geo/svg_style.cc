// SPDX-License-Identifier: BSD-3-Clause
// Lists what librsvg paints; it drops everything else without a word.
#include "target/geo/svg_style.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>

#include "target/geo/svg_luminance.h"
#include "target/geo/svg_syntax.h"
#include "target/geo/svg_values.h"
#include "text/read_number.h"

namespace ergocast {
namespace {

using Names = std::set<std::string_view>;

const Names kPaintedProperties = {"clip-path",
                                  "clip-rule",
                                  "color",
                                  "cx",
                                  "cy",
                                  "display",
                                  "fill",
                                  "fill-opacity",
                                  "fill-rule",
                                  "filter",
                                  "height",
                                  "isolation",
                                  "marker",
                                  "marker-end",
                                  "marker-mid",
                                  "marker-start",
                                  "mask",
                                  "mask-type",
                                  "mix-blend-mode",
                                  "opacity",
                                  "overflow",
                                  "paint-order",
                                  "r",
                                  "rx",
                                  "ry",
                                  "shape-rendering",
                                  "stop-color",
                                  "stop-opacity",
                                  "stroke",
                                  "stroke-dasharray",
                                  "stroke-dashoffset",
                                  "stroke-linecap",
                                  "stroke-linejoin",
                                  "stroke-miterlimit",
                                  "stroke-opacity",
                                  "stroke-width",
                                  "transform",
                                  "vector-effect",
                                  "visibility",
                                  "width",
                                  "x",
                                  "y"};
/// They change text, or nothing that is solid.
const Names kInert = {"alignment-baseline",
                      "background",
                      "background-color",
                      "baseline-shift",
                      "box-sizing",
                      "clip",
                      "color-interpolation",
                      "color-interpolation-filters",
                      "color-rendering",
                      "color-scheme",
                      "cursor",
                      "direction",
                      "dominant-baseline",
                      "enable-background",
                      "flood-color",
                      "flood-opacity",
                      "font",
                      "image-rendering",
                      "inline-size",
                      "kerning",
                      "letter-spacing",
                      "lighting-color",
                      "line-height",
                      "margin",
                      "max-height",
                      "max-width",
                      "pointer-events",
                      "shape-inside",
                      "shape-margin",
                      "shape-padding",
                      "solid-color",
                      "solid-opacity",
                      "unicode-bidi",
                      "user-select",
                      "white-space",
                      "word-spacing",
                      "writing-mode"};
const Names kFunctions = {"rgb",       "rgba",  "hsl",    "hsla",  "url",  "matrix",
                          "translate", "scale", "rotate", "skewX", "skewY"};

[[noreturn]] void reject(const std::string& what, std::string remedy) {
  throw SvgSyntaxError(what, std::move(remedy));
}

constexpr std::string_view kBlanks = " \t\r\n\f";

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string quoted(std::string_view text) { return '"' + std::string(text.substr(0, 40)) + '"'; }

bool is_name(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  });
}

std::string without_comments(std::string_view text) {
  std::string rest;
  while (!text.empty()) {
    const std::size_t begin = text.find("/*");
    rest += text.substr(0, begin);
    if (begin == text.npos) break;
    const std::size_t end = text.find("*/", begin + 2);
    if (end == text.npos) reject("has a comment that does not end", "write */ after it");
    text.remove_prefix(end + 2);
  }
  return rest;
}

/// A background shows where nothing else is painted.
bool is_white(std::string_view background) {
  static const Names kWhite = {"none",    "transparent", "white",  "#fff",
                               "#ffffff", "#FFF",        "#FFFFFF"};
  return kWhite.contains(background);
}

/// The address inside url(…), without quotes.
std::string_view address(std::string_view inside) {
  inside = trim(inside);
  if (inside.size() >= 2 && (inside.front() == '"' || inside.front() == '\'') &&
      inside.back() == inside.front())
    inside = inside.substr(1, inside.size() - 2);
  return inside;
}

const std::string kPlain = "save it as plain SVG, or set fill and stroke of the shapes themselves";

}  // namespace

bool is_painted_property(std::string_view name) { return kPaintedProperties.contains(name); }

bool is_inert_property(std::string_view name) {
  return kInert.contains(name) || name.starts_with('-') || name.starts_with("font-") ||
         name.starts_with("text-");
}

SvgProperties svg_properties(std::string_view style) {
  const std::string text = without_comments(style);
  SvgProperties properties;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view one = trim(rest.substr(0, rest.find(';')));
    rest.remove_prefix(
        std::min(rest.size(), rest.find(';') == rest.npos ? rest.size() : rest.find(';') + 1));
    if (one.empty()) continue;
    const std::size_t colon = one.find(':');
    const std::string_view name = trim(one.substr(0, colon));
    if (colon == one.npos || !is_name(name)) reject("has no property at " + quoted(one), kPlain);
    std::string_view value = trim(one.substr(colon + 1));
    if (value.ends_with("important"))
      if (const std::size_t mark = value.rfind('!'); mark != value.npos)
        value = trim(value.substr(0, mark));
    if (name.starts_with("background") && !is_white(value))
      reject(std::string(name) + " is " + quoted(value) + ", and backgrounds are not painted",
             "write it white, or draw a rect of the page's size");
    if (is_inert_property(name)) continue;
    if (!is_painted_property(name))
      reject("has the property " + std::string(name) + ", which is not painted",
             "remove it, or write it in small letters, or " + kPlain);
    properties.emplace_back(name, value);
  }
  return properties;
}

void check_svg_value(std::string_view name, std::string_view value,
                     const std::function<void(std::string)>& refers) {
  if (name == "filter" && trim(value) != "none")
    reject("has a filter, which is not painted",
           "remove it: in Inkscape, Filters > Remove Filters");
  if (name == "vector-effect" && trim(value) != "none")
    reject("has a vector-effect, which is not painted", "write a stroke-width in its own units");
  for (std::size_t open = value.find('('); open != value.npos; open = value.find('(', open + 1)) {
    std::size_t begin = open;
    while (begin > 0 && is_name(value.substr(begin - 1, 1))) --begin;
    const std::string_view function = value.substr(begin, open - begin);
    if (!kFunctions.contains(function))
      reject(std::string(name) + " has the function " + quoted(function) + ", which is not painted",
             "write the value itself");
    if (function != "url") continue;
    const std::string_view to = address(value.substr(open + 1, value.find(')', open) - open - 1));
    if (!to.starts_with('#'))
      reject(std::string(name) + " refers to " + quoted(to) + ", which is not in this file",
             "put it into the drawing, or remove it");
    refers(std::string(to.substr(1)));
  }
  check_svg_word(name, trim(value));
}

void for_svg_rules(std::string_view sheet, const std::function<void(const SvgProperties&)>& each) {
  const std::string text = without_comments(sheet);
  std::string_view rest = trim(text);
  while (!rest.empty()) {
    const std::size_t open = rest.find('{'), close = rest.find('}');
    const std::string_view selector = trim(rest.substr(0, open));
    const bool has_block = open != rest.npos && close != rest.npos && open < close;
    if (selector.starts_with('@') && !selector.starts_with("@font-face"))
      reject("has the rule " + quoted(selector) + ", which is not painted", kPlain);
    if (!has_block || rest.substr(open + 1, close - open - 1).find('{') != rest.npos)
      reject("has no rule at " + quoted(rest), kPlain);
    if (!selector.starts_with('@')) {
      const auto bad = std::ranges::find_if(selector, [](char c) {
        return !is_name({&c, 1}) && kBlanks.find(c) == kBlanks.npos &&
               std::string_view(".#,*>+~").find(c) == std::string_view::npos;
      });
      if (selector.empty() || bad != selector.end())
        reject("has the selector " + quoted(selector) + ", which is not painted",
               "name elements, .classes and #ids only");
      each(svg_properties(rest.substr(open + 1, close - open - 1)));
    }
    rest = trim(rest.substr(close + 1));
  }
}

bool is_plainly_solid(std::string_view fill, bool solid_white) {
  fill = trim(fill);
  if (fill.empty() || fill == "black") return true;
  static const Names kDark = {"gray",     "grey",   "dimgray", "dimgrey", "darkgray",
                              "darkgrey", "silver", "red",     "green",   "blue",
                              "navy",     "maroon", "brown",   "purple",  "teal"};
  if (kDark.contains(fill)) return true;
  if (fill == "white") return solid_white;
  if (!fill.starts_with('#') || (fill.size() != 4 && fill.size() != 7)) return false;
  const auto value = read_number<std::uint32_t>(fill.substr(1), 16);
  if (!value) return false;
  std::array<double, 3> part{};
  const unsigned bits = fill.size() == 4 ? 4 : 8, most = (1U << bits) - 1;
  for (unsigned i = 0; i < 3; ++i)
    part[i] = (*value >> (bits * (2 - i)) & most) / static_cast<double>(most);
  return solid_white || luminance(part[0], part[1], part[2]) < kSolidLuminance;
}

}  // namespace ergocast
