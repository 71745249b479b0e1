// SPDX-License-Identifier: BSD-3-Clause
// A team of sites (core/mission/sites.h) in one process: an IdealTeam that is divided, and the
// recorder of the real processes, which receives the states that a world would send.
//
// All members of a site know the same, so the process holds each site's rows once. Its memory is
// O(N K + S² K) for N agents at S sites with K modes.
#pragma once

#include <cstddef>
#include <ostream>
#include <span>
#include <string>

#include "core/law/law.h"
#include "core/measure/objects.h"
#include "core/search/reports.h"
#include "lab/ideal_team.h"
#include "logger/recorder.h"
#include "team/messages.h"

namespace ergocast::lab {

class SiteSimulation {
 public:
  /// @param trajectory, metrics  what the recorder writes
  /// @pre the plan decodes and has sites, and both streams are good
  SiteSimulation(std::span<const std::byte> plan, std::ostream& trajectory, std::ostream& metrics,
                 const LawMaker& laws = make_law);

  /// Simulates one tick. Returns false and does nothing once the mission is over.
  bool step();
  /// Ends the mission before the next step.
  void end(std::string reason);

  const Recorder& recorder() const { return recorder_; }

 private:
  void start(std::span<const std::byte> plan);
  void publish_state();
  void record(double seconds_later);

  IdealTeam team_;
  Objects objects_;
  Reports reports_;
  Recorder recorder_;
  Header from_;  // of the states
};

}  // namespace ergocast::lab
