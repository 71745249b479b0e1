// SPDX-License-Identifier: BSD-3-Clause
// A sighting as people write it, and the target that follows from it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/mission/amendments.h"
#include "core/mission/mission.h"
#include "scenario/scenario.h"
#include "team/messages.h"

namespace ergocast::cli {

/// How people write a sighting.
inline constexpr const char* kSightingForm = "X,Y[,SIGMA_M[,SHARE]]";

/// The place of "412,77.5" [m]; nothing for another text.
std::optional<Eigen::Vector2d> place_from(std::string_view text);

/// The sighting of kSightingForm; nothing for another text. Without SIGMA_M it has a σ of 0, and
/// without SHARE a share of a half.
std::optional<SearchNote> sighting_from(std::string_view text);

/// A target that follows from a sighting, and what is allowed but probably not intended.
struct SightedTarget {
  TargetChange target;
  SearchNote sighting;
  std::vector<Problem> warnings;
};

/// 1 − q of a target and q of a Gaussian around the place. A σ of 0 becomes twice the sensor's
/// radius, or the finest length that the target's modes resolve if that is more.
/// @param holds  the target of the mission that holds, target_now()
Result<SightedTarget, std::vector<Problem>> target_with(const Mission& mission,
                                                        const TargetChange& holds,
                                                        SearchNote sighting);

/// Why a contact at this place cannot be dismissed; nothing if it can.
std::optional<Problem> why_not_dismissed(const Mission& mission, const SearchNote& dismissal);

/// Why a dismissal would have no effect: no contact is near its place. Nothing if one is, or if
/// `recorded` may lack some.
/// @pre !why_not_dismissed(mission, dismissal)
std::optional<Problem> why_no_contact(const Mission& mission, const SearchNote& dismissal,
                                      const RecordAck& recorded);

/// A warning: no contact that `recorded` names is near the place, and it may lack some.
/// @pre !why_not_dismissed(mission, dismissal)
std::optional<Problem> why_perhaps_no_contact(const Mission& mission, const SearchNote& dismissal,
                                              const RecordAck& recorded);

}  // namespace ergocast::cli
