// SPDX-License-Identifier: BSD-3-Clause
// Finds the known name that a mistyped word probably meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ergocast {

/// Changes of one letter, and swaps of two neighbours, that turn `a` into `b`.
int edit_distance(std::string_view a, std::string_view b);

/// The maximum edit distance between a word and the name that it may mean.
int most_typos_in(std::string_view word);

/// The one of `names` that `word` most likely means, the first of equals; empty if none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& names);

}  // namespace ergocast
