// The life of every process: deliver what arrives, let the core act, publish what it says.
#pragma once

#include <functional>
#include <utility>

#include "core/messages.h"
#include "runtime/clock.h"
#include "runtime/signals.h"
#include "runtime/transport.h"

namespace ergocast {

/// Runs `core` until it has finished. A core has receive() (called by the transport's handler),
/// advance(now, out), next_wakeup() and finished().
/// @param on_signal  called for SIGINT or SIGTERM; it tells the core to finish
/// @param each_turn  called after every turn, for what only the process knows
template <class Core>
void live(Core& core, Transport& transport, StopSignals& signals,
          const std::function<void()>& on_signal, const std::function<void()>& each_turn = [] {}) {
  Outbox out;
  const auto act = [&] {
    core.advance(now(), out);
    for (const Outgoing& outgoing : out) transport.publish(outgoing);
    out.clear();
    each_turn();
  };
  act();
  while (!core.finished()) {
    transport.deliver_until(core.next_wakeup(), signals.fd());
    if (signals.take() > 0) on_signal();
    act();
  }
}

}  // namespace ergocast
