// SPDX-License-Identifier: BSD-3-Clause
// The ledger of a team that finds: the agent that detected each object first, where and when.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/ids.h"

namespace ergocast {

/// Which objects a sensor detects: bit j is object j.
using ObjectSet = std::uint32_t;

/// The first detection of an object.
struct Find {
  int object = 0;
  AgentId agent = kUnassigned;
  Tick tick = 0;                 ///< of the world
  double t_s = 0;                ///< mission time, without pauses
  Eigen::Vector3d x_m{0, 0, 0};  ///< where the agent was
};

/// "object 2 found by agent 3 at (412.0, 77.5) m after 123.4 s".
std::string to_text(const Find& find);

/// "1 contact that was confirmed is no object".
std::string wrong_confirmations_text(int count);

/// All finds in their order, at most one of each object.
class Finds {
 public:
  Finds() = default;
  /// @param objects  how many there are; others are ignored
  explicit Finds(int objects) : objects_(objects) {}

  /// Those of `detected` that exist.
  ObjectSet known(ObjectSet detected) const;
  /// @param at  whose object is not yet named; ticks ascend
  void note(ObjectSet detected, Find at);
  int objects() const { return objects_; }
  const std::vector<Find>& list() const { return list_; }

 private:
  int objects_ = 0;
  std::vector<Find> list_;
};

}  // namespace ergocast
