// SPDX-License-Identifier: BSD-3-Clause
// What somebody meant who typed something else.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ergocast {

/// Changes of one letter, and swaps of two neighbours, that turn `a` into `b`.
int edit_distance(std::string_view a, std::string_view b);

/// How many changes a word may be away from what it was meant to be.
int most_typos_in(std::string_view word);

/// The one of `names` that `word` was most likely to be, the first of equals; empty if none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& names);

}  // namespace ergocast
