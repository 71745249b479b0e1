// SPDX-License-Identifier: BSD-3-Clause
// A zone that an operator has drawn on the page: one polygon, how long it lasts, and in a box its
// heights.
//
// A request of a page has numbers only, so that it can name no file of this host.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace ergocast::cli {

struct DrawnZone {
  std::vector<std::array<double, 2>> corners_m;
  double lasts_s = 0;                              ///< of the world's time, above 0
  std::optional<std::array<double, 2>> heights_m;  ///< low and high; without: the whole height

  /// The zone of {"corners_m": [[x_m, y_m], …], "lasts_s": …} and, in a box, "heights_m": [low,
  /// high]. Nothing if a key is unknown or missing, or a value has another form.
  static std::optional<DrawnZone> parse(const nlohmann::json& object);
  /// As the text of a zone's file. `ergocast amend` finds what is wrong with its numbers.
  std::string text() const;
  /// How long it lasts, as `ergocast amend --for` takes it: "600s".
  std::string duration() const;
};

}  // namespace ergocast::cli
