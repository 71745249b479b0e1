// SPDX-License-Identifier: BSD-3-Clause
// Other numbers of the law that an operator writes for a mission: FIELD=VALUE, of all kinds of
// agents or, as KIND.FIELD=VALUE, of one.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/mission/law_change.h"
#include "core/mission/mission.h"

namespace ergocast::cli {

struct LawWish {
  std::string written;
  std::string kind{};   ///< empty: all kinds
  std::string field{};  ///< as scenarios name it
  double value = 0;
};

/// The wish of "u_max_mps=8", "law.u_max_mps=8" or "scout.u_max_mps=8"; nothing for another text.
std::optional<LawWish> law_wish_from(std::string_view text);

/// The law with these numbers in the place of those that hold, is_law(). A speed of all kinds
/// leaves those that are slower in the plan as they are there. An error has the problem and its
/// remedy.
/// @param holds  the law that holds, or plans_law()
Result<LawChange, std::string> law_with(const Mission& mission, const LawChange& holds,
                                        std::span<const LawWish> wishes);

/// The law that the mission's plan has, or the newest of the list, which may not hold yet.
LawChange newest_law(const Mission& mission, std::span<const LawChange> laws);

}  // namespace ergocast::cli
