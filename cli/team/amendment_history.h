// SPDX-License-Identifier: BSD-3-Clause
// All amendments of a running mission, for browsers. MISSION has only the newest ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/mission/amendments.h"

namespace ergocast {

class AmendmentHistory {
 public:
  /// Limit (Page): amendments on the page. Beyond it: the oldest is removed.
  static constexpr std::size_t kMost = 500;
  /// Limit (Page): targets on the page, beside the plan's. Beyond it: the page does not show the
  /// oldest, and its φ² is that of the agents.
  static constexpr std::size_t kMostTargets = 32;

  /// Takes in the list of a revision of MISSION.
  void note(const Amendments& list);

  /// What a browser has received so far.
  struct Cursor {
    std::uint64_t changes = 0, targets = 0;
  };
  /// Adds "amendments" and "zones", all of them, and "targets", those that this browser lacks, if
  /// anything has changed since; report/page_mission.h has them.
  void add_new(Cursor& cursor, const Mission& mission, nlohmann::ordered_json& frame) const;

 private:
  struct Target {
    std::uint64_t hash;
    nlohmann::ordered_json coefficients;  // as the page gets them
  };
  void keep(const TargetChange& change);

  std::vector<Amendment> amendments_;  // ascending by number
  std::vector<Zone> zones_;            // those of amendments_
  std::vector<LawChange> laws_;        // the same
  std::vector<SearchNote> notes_;      // the same
  std::deque<Target> targets_;         // in the order of their arrival
  std::uint64_t changes_ = 0, targets_ever_ = 0;
};

}  // namespace ergocast
