// SPDX-License-Identifier: BSD-3-Clause
// Lists the words of CSS and SVG.
#include "target/geo/svg_values.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "target/geo/svg_syntax.h"
#include "text/read_number.h"

namespace ergocast {
namespace {

using Words = std::set<std::string_view>;

const Words kColours = {
    "aliceblue", "antiquewhite", "aqua", "aquamarine", "azure", "beige", "bisque", "black",
    "blanchedalmond", "blue", "blueviolet", "brown", "burlywood", "cadetblue", "chartreuse",
    "chocolate", "coral", "cornflowerblue", "cornsilk", "crimson", "cyan", "darkblue", "darkcyan",
    "darkgoldenrod", "darkgray", "darkgreen", "darkgrey", "darkkhaki", "darkmagenta",
    "darkolivegreen", "darkorange", "darkorchid", "darkred", "darksalmon", "darkseagreen",
    "darkslateblue", "darkslategray", "darkslategrey", "darkturquoise", "darkviolet", "deeppink",
    "deepskyblue", "dimgray", "dimgrey", "dodgerblue", "firebrick", "floralwhite", "forestgreen",
    "fuchsia", "gainsboro", "ghostwhite", "gold", "goldenrod", "gray", "green", "greenyellow",
    "grey", "honeydew", "hotpink", "indianred", "indigo", "ivory", "khaki", "lavender",
    "lavenderblush", "lawngreen", "lemonchiffon", "lightblue", "lightcoral", "lightcyan",
    "lightgoldenrodyellow", "lightgray", "lightgreen", "lightgrey", "lightpink", "lightsalmon",
    "lightseagreen", "lightskyblue", "lightslategray", "lightslategrey", "lightsteelblue",
    "lightyellow", "lime", "limegreen", "linen", "magenta", "maroon", "mediumaquamarine",
    "mediumblue", "mediumorchid", "mediumpurple", "mediumseagreen", "mediumslateblue",
    "mediumspringgreen", "mediumturquoise", "mediumvioletred", "midnightblue", "mintcream",
    "mistyrose", "moccasin", "navajowhite", "navy", "oldlace", "olive", "olivedrab", "orange",
    "orangered", "orchid", "palegoldenrod", "palegreen", "paleturquoise", "palevioletred",
    "papayawhip", "peachpuff", "peru", "pink", "plum", "powderblue", "purple", "rebeccapurple",
    "red", "rosybrown", "royalblue", "saddlebrown", "salmon", "sandybrown", "seagreen", "seashell",
    "sienna", "silver", "skyblue", "slateblue", "slategray", "slategrey", "snow", "springgreen",
    "steelblue", "tan", "teal", "thistle", "tomato", "turquoise", "violet", "wheat", "white",
    "whitesmoke", "yellow", "yellowgreen",
    // No colours, but paint.
    "currentcolor", "inherit", "transparent"};
const Words kNoColours = {"none", "context-fill", "context-stroke"};
const Words kLengthProperties = {"cx", "cy",           "height", "r", "rx",
                                 "ry", "stroke-width", "width",  "x", "y"};

const Words kAttributes = {"alignment-baseline",
                           "baseProfile",
                           "class",
                           "clipPathUnits",
                           "contentScriptType",
                           "contentStyleType",
                           "cx",
                           "cy",
                           "d",
                           "download",
                           "externalResourcesRequired",
                           "fr",
                           "fx",
                           "fy",
                           "gradientTransform",
                           "gradientUnits",
                           "height",
                           "href",
                           "hreflang",
                           "id",
                           "lang",
                           "markerHeight",
                           "markerUnits",
                           "markerWidth",
                           "maskContentUnits",
                           "maskUnits",
                           "media",
                           "name",
                           "offset",
                           "orient",
                           "pathLength",
                           "patternContentUnits",
                           "patternTransform",
                           "patternUnits",
                           "ping",
                           "points",
                           "preserveAspectRatio",
                           "r",
                           "refX",
                           "refY",
                           "rel",
                           "role",
                           "rx",
                           "ry",
                           "spreadMethod",
                           "style",
                           "tabindex",
                           "target",
                           "title",
                           "transform",
                           "transform-origin",
                           "type",
                           "version",
                           "viewBox",
                           "viewTarget",
                           "width",
                           "x",
                           "x1",
                           "x2",
                           "xmlns",
                           "y",
                           "y1",
                           "y2",
                           "zoomAndPan"};

std::string lower_word(std::string_view text) {
  std::string low(text);
  for (char& c : low) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return low;
}

[[noreturn]] void reject_word(std::string_view property, std::string_view value,
                              const char* remedy) {
  throw SvgSyntaxError(std::string(property) + " is \"" + std::string(value.substr(0, 40)) +
                           "\", which is not painted",
                       remedy);
}

/// A finite number, which may have a percent sign.
bool is_number(std::string_view text, bool percent) {
  if (text.ends_with('%') != percent) return false;
  if (percent) text.remove_suffix(1);
  const auto value = read_number<double>(text);
  return value && std::isfinite(*value);
}

/// rgb(0, 0, 0), rgb(0%, 0%, 0%), hsl(0, 0%, 0%), and with opacity rgba() and hsla().
bool is_colour_function(std::string_view name, std::string_view list) {
  const bool hue = name.starts_with("hsl"), opacity = name.ends_with('a');
  if (name != "rgb" && name != "rgba" && name != "hsl" && name != "hsla") return false;
  const bool percent = !hue && list.substr(0, list.find(',')).find('%') != list.npos;
  for (int argument = 0;; ++argument) {
    const std::size_t comma = list.find(',');
    std::string_view one = list.substr(0, comma);
    one.remove_prefix(std::min(one.size(), one.find_first_not_of(' ')));
    one = one.substr(0, one.find_last_not_of(' ') + 1);
    const bool due = argument > 0 && hue ? argument < 3 : percent && argument < 3;
    if (!is_number(one, due) && !(argument == 3 && is_number(one, true))) return false;
    if (comma == list.npos) return argument == (opacity ? 3 : 2);
    list.remove_prefix(comma + 1);
  }
}

bool is_colour(std::string_view value) {
  if (value.starts_with('#')) {
    const std::string_view digits = value.substr(1);
    const bool known =
        digits.size() == 3 || digits.size() == 4 || digits.size() == 6 || digits.size() == 8;
    return known && digits.find_first_not_of("0123456789abcdefABCDEF") == digits.npos;
  }
  const std::string low = lower_word(value);
  const std::size_t open = low.find('(');
  if (open == low.npos) return kColours.contains(low);
  if (low.find(')') != low.size() - 1) return false;
  return is_colour_function(low.substr(0, open), low.substr(open + 1, low.size() - open - 2));
}

/// A colour, a reference and perhaps a colour, or none.
bool is_paint(std::string_view value) {
  if (value.starts_with("url(")) {
    const std::size_t end = value.find(')');
    if (end == value.npos) return false;
    value.remove_prefix(end + 1);
    value.remove_prefix(std::min(value.size(), value.find_first_not_of(' ')));
    if (value.empty()) return true;
  }
  return is_colour(value) || kNoColours.contains(lower_word(value));
}

bool is_share(std::string_view value) {
  return value == "inherit" || is_number(value, value.ends_with('%'));
}

}  // namespace

void check_svg_word(std::string_view property, std::string_view value) {
  const std::string low = lower_word(value);
  if (low == "initial" || low == "unset" || low == "revert" || low == "revert-layer")
    reject_word(property, value, "write the value itself");
  if ((property == "fill" || property == "stroke") && !is_paint(value))
    reject_word(property, value, "write a colour of CSS, such as #333 or black, or none");
  if ((property == "color" || property == "stop-color") && !is_colour(value))
    reject_word(property, value, "write a colour of CSS, such as #333 or black");
  if (property.ends_with("opacity") && !is_share(value))
    reject_word(property, value, "write a number from 0 to 1");
  if (property.ends_with("-rule") && low != "nonzero" && low != "evenodd" && low != "inherit")
    reject_word(property, value, "write nonzero or evenodd");
  if (!kLengthProperties.contains(property) || low == "inherit" || low == "auto") return;
  try {
    svg_length(value);
  } catch (const SvgSyntaxError& error) {
    throw SvgSyntaxError(std::string(property) + ' ' + error.what(), error.remedy);
  }
}

bool is_svg_attribute(std::string_view name) {
  return kAttributes.contains(name) || name.starts_with("data-") || name.starts_with("aria-");
}

}  // namespace ergocast
