// SPDX-License-Identifier: BSD-3-Clause
// Formats text for people: numbers with few digits and SI prefixes, and text escaped for XML.
#pragma once

#include <string>
#include <string_view>

namespace ergocast {

/// `text` for the content of an XML element or a quoted attribute. Characters that XML does not
/// allow become U+FFFD.
std::string escape(std::string_view text);

/// At most `decimals` digits after the point, trailing zeros cut: for coordinates in SVG.
std::string fixed(double value, int decimals);

/// About three significant digits: 0.368, 12.5, 143 976, 9.33 × 10⁻⁴. Whole numbers keep all their
/// digits.
std::string readable(double value);

/// readable() with an SI prefix before the unit: 11.2 km, 340 kB.
std::string with_unit(double value, std::string_view unit);

/// 85.3 s, 10 min, 1 h 23 min.
std::string duration(double seconds);

/// 10⁻³, or 0.001 if `plain`.
std::string power_of_ten(int exponent, bool plain);

/// The approximate width in pixels of `text` in a sans-serif font of `size` pixels.
double text_width(std::string_view text, double size);

/// A label of a linear axis whose ticks are `step` apart.
std::string axis_label(double value, double step);

}  // namespace ergocast
