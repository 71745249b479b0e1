// SPDX-License-Identifier: BSD-3-Clause
// A simulated process: its core, its clock, and whether it runs.
#pragma once

#include <cstdint>
#include <memory>
#include <variant>

#include "agent/agent.h"
#include "coordinator/coordinator.h"
#include "lab/clock.h"
#include "logger/recorder.h"
#include "sim/world.h"

namespace ergocast::lab {

struct Node {
  std::variant<std::unique_ptr<Agent>, std::unique_ptr<Coordinator>, std::unique_ptr<World>,
               std::unique_ptr<Recorder>>
      core;  ///< the newest incarnation, also while it is down
  SkewedClock clock;
  Instant wakeup{}, restart{};  ///< the latter while it is down
  std::uint32_t starts = 0;
  bool up = false, received = false;
  bool answered = false;  ///< a running agent has answered a tick

  bool finished() const {
    return std::visit([](const auto& one) { return one->finished(); }, core);
  }
};

}  // namespace ergocast::lab
