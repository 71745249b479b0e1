// SPDX-License-Identifier: BSD-3-Clause
// Properties of style attributes and style sheets: which of them a drawing may use.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ergocast {

/// Name and value, without blanks around and without "!important", in their order.
using SvgProperties = std::vector<std::pair<std::string, std::string>>;

/// The declarations of a style attribute, or of a block of a style sheet.
/// @throws SvgSyntaxError for what is none, and for properties and functions that are not painted
SvgProperties svg_properties(std::string_view style);

/// Whether a property is one that painting knows, as an attribute too.
bool is_painted_property(std::string_view name);

/// Whether a property changes text, or nothing that is solid; as an attribute too.
bool is_inert_property(std::string_view name);

/// Checks a value, and calls `refers(id)` for each element that it names by url(#id).
/// @throws SvgSyntaxError for other addresses, functions and words that are not painted
void check_svg_value(std::string_view name, std::string_view value,
                     const std::function<void(std::string)>& refers);

/// Calls `each` for the properties of each rule of a style sheet.
/// @throws SvgSyntaxError for rules that are not painted: conditions, imports, states of elements
void for_svg_rules(std::string_view sheet, const std::function<void(const SvgProperties&)>& each);

/// Whether a fill is opaque, and dark enough to be solid, however it is painted.
bool is_plainly_solid(std::string_view fill, bool solid_white);

}  // namespace ergocast
