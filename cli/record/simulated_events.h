// SPDX-License-Identifier: BSD-3-Clause
// The event log of a simulated mission, with the messages that the logger of a run records.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/mission/mission.h"
#include "lab/simulation.h"
#include "runtime/record/event_log.h"

namespace ergocast::cli {

/// Observes a simulation and writes events-000.lcm, events-001.lcm, … Each message has the time of
/// its tick, counted from the construction of this object.
class SimulatedEvents : public lab::SimulationObserver {
 public:
  SimulatedEvents(const std::filesystem::path& folder, const Mission& mission);

  void sends(lab::NodeId, const Outbox& outbox) override;
  /// Returns the write error, if there was one.
  std::optional<std::string> flush() { return log_.flush(); }
  /// Segments removed because of the log's limit.
  int removed() const { return log_.removed(); }

 private:
  EventLog log_;
  double dt_s_;
  std::int64_t start_us_;
  Tick tick_ = 0;
  std::vector<std::byte> bytes_;
};

}  // namespace ergocast::cli
