// SPDX-License-Identifier: BSD-3-Clause
// What the values of properties may be: librsvg takes another value for none that it does not know.
#pragma once

#include <string_view>

namespace ergocast {

/// Checks the value of a property whose misreading could lose a shape: colours, lengths,
/// opacities, fill rules. Others pass.
/// @throws SvgSyntaxError
void check_svg_word(std::string_view property, std::string_view value);

/// Whether an attribute without a prefix is one of SVG's.
bool is_svg_attribute(std::string_view name);

}  // namespace ergocast
