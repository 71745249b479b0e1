// SPDX-License-Identifier: BSD-3-Clause
// Encodes the simulated processes' messages, each once, in LCM's log format.
#include "cli/record/simulated_events.h"

#include <algorithm>
#include <chrono>

#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"

namespace ergocast::cli {
namespace {

std::int64_t wall_clock_us() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace

SimulatedEvents::SimulatedEvents(const std::filesystem::path& folder, const Mission& mission)
    : log_(folder), dt_s_(mission.timing.dt_s), start_us_(wall_clock_us()) {}

void SimulatedEvents::sends(lab::NodeId, const Outbox& outbox) {
  for (const Outgoing& sent : outbox) {
    if (const auto* world = std::get_if<WorldState>(&sent.message))
      tick_ = std::max(tick_, world->header.tick);
    // Messages on the command bus only repeat those of another bus.
    const bool repeats = std::holds_alternative<MissionPart>(sent.message) ||
                         std::holds_alternative<Stop>(sent.message);
    if (sent.bus == Bus::kCommand && repeats) continue;
    encode(sent.message, bytes_);
    const double t_us = 1e6 * static_cast<double>(tick_) * dt_s_;
    log_.write(channel_of(sent.message, sent.relayer), bytes_,
               start_us_ + static_cast<std::int64_t>(t_us));
  }
}

}  // namespace ergocast::cli
