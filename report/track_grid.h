// SPDX-License-Identifier: BSD-3-Clause
// The positions that the page draws: every tick, or every few ticks of a long mission.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/ids.h"

namespace ergocast {

/// Row r has the positions at tick r · stride. The stride begins with 1 and doubles whenever there
/// are too many positions.
class TrackGrid {
 public:
  /// Limit (Page): positions of all agents on the page. Beyond it: every second row is removed, and
  /// from then on only every second tick is added.
  static constexpr std::int64_t kMostPositions = 400'000;

  /// @param agents  the planned number; more may join
  /// @param headings  whether it keeps headings, too; only in a plane
  TrackGrid(const Box& domain, std::size_t agents, bool headings = false);

  Tick stride() const { return stride_; }
  /// One more than the last row with a position.
  std::int64_t rows() const { return rows_; }
  /// Ticks between rows are left out. The newest position of a tick counts.
  /// @param v_mps  its direction is the heading; along x if it is 0
  void put(AgentId agent, Tick tick, const Eigen::Vector3d& x_m,
           const Eigen::Vector3d& v_mps = {0, 0, 0});

  /// The rows [from, to) for the page, which reads them in report/web/data/tracks.js:
  ///   {"bits": b, "headings": true, "agents": [{"id": i, "runs": [first row, number of rows, …]},
  ///   …], "data": base64}
  /// A coordinate is a whole number, from 0 at the domain's origin to 2^b − 1 at its end. For each
  /// agent and each of its runs, `data` has all x, then all y, and in a box then all z. If it has
  /// headings, these follow: from 0 along x to 256 after a turn to the left. All are second
  /// differences; the first two assume preceding zeros. Each is zigzag coded as
  /// variable-length bytes, the lowest seven bits first.
  nlohmann::ordered_json encode(std::int64_t from, std::int64_t to) const;

 private:
  using Cell = std::array<std::int32_t, 3>;  // x, y, and z or the heading
  static constexpr std::int32_t kNothing = INT32_MIN;

  void coarsen();
  /// How many numbers of a cell are used.
  std::size_t numbers() const;

  Box domain_;
  bool headings_;
  Tick stride_ = 1;
  int bits_;
  std::int64_t rows_ = 0;
  std::map<AgentId, std::vector<Cell>> tracks_;
};

}  // namespace ergocast
