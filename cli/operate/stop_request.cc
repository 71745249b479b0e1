// SPDX-License-Identifier: BSD-3-Clause
// Sends the same STOP every 0.1 s, each time with a new sequence number.
#include "cli/operate/stop_request.h"

#include <chrono>
#include <utility>

#include "lcmtypes/wire.h"
#include "runtime/bus/random_identity.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {
namespace {

constexpr auto kRepeatPeriod = std::chrono::milliseconds(100);

/// A tick that never passes. Without a key anybody can forge a STOP, so refusing old ones protects
/// nothing. With this tick, a host that receives nothing can stop the team, too.
constexpr Tick kNeverLate = kMostEver;

}  // namespace

StopRequest::StopRequest(RunId run, bool failed, std::string reason) {
  stop_.header = {run, kOperator, random_identity(), 0, 0};
  stop_.failed = failed;
  stop_.reason = std::move(reason);
}

void StopRequest::repeat(Instant now, bool at_once, Tick newest, bool keyed, Outbox& out) {
  // Sends at once when the tick becomes known, because a request without it may be ignored.
  const bool knows_now = stop_.header.tick == 0 && newest > 0;
  if (now < next_ && stop_.now == at_once && !knows_now) return;
  next_ = now + kRepeatPeriod;
  stop_.header.tick = keyed ? newest : kNeverLate;
  stop_.now = at_once;
  for (const Bus bus : {Bus::kCommand, Bus::kSwarm}) {  // the vehicles first
    ++stop_.header.sequence;
    out.push_back({bus, stop_});
  }
}

}  // namespace ergocast::cli
