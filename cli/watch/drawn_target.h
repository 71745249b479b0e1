// SPDX-License-Identifier: BSD-3-Clause
// A target that an operator has drawn on the page: peaks, polygons and a uniform part.
//
// A request of a page has numbers only, so that it can name no file of this host.
#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace ergocast::cli {

struct DrawnTarget {
  /// Limit (Page): peaks and polygons of a drawn target. Beyond it: it is refused with 400.
  static constexpr std::size_t kMostParts = 16;
  /// Limit (Page): share of the uniform part of a drawn target. Beyond it: it is refused with 400.
  static constexpr double kMostUniform = 0.9;

  /// A round Gaussian.
  struct Peak {
    double x_m = 0, y_m = 0, sigma_m = 0;
    std::optional<double> z_m{};  ///< only in a box
  };
  using Corner = std::array<double, 2>;
  using Corners = std::vector<Corner>;

  std::vector<Peak> peaks;
  std::vector<Corners> polygons;
  /// Only in a box: low and high of each polygon.
  std::vector<std::array<double, 2>> heights_m;
  /// The uniform part's share of the mass. All peaks and polygons have equal parts of the rest.
  double uniform = 0;

  /// The target of {"peaks": [[x_m, y_m, sigma_m], …], "polygons": [[[x_m, y_m], …], …],
  /// "uniform": share}; in a box with "heights_m": [[low, high], …], one of each polygon, and
  /// peaks [x_m, y_m, z_m, sigma_m]. Nothing if a key is unknown or missing, a value has another
  /// form, or there is neither peak nor polygon.
  static std::optional<DrawnTarget> parse(const nlohmann::json& object);
  /// As a scenario's text. `ergocast amend` finds what is wrong with its numbers.
  std::string text() const;
};

}  // namespace ergocast::cli
