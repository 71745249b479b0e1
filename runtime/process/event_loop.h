// SPDX-License-Identifier: BSD-3-Clause
// The connection and the main loop of every process: deliver messages, let the core act, publish
// its messages.
#pragma once

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "runtime/bus/clock.h"
#include "runtime/bus/transport.h"
#include "runtime/process/loop_lag.h"
#include "runtime/process/program_options.h"
#include "runtime/process/signals.h"
#include "team/messages.h"

namespace ergocast {

/// Opens the buses for `core`, which then receives what it subscribes to. Null, after a line in the
/// log, if LCM cannot be used.
/// @param more  handlers besides that of messages
template <class Core>
std::unique_ptr<Transport> connect(Core& core, const NodeOptions& node,
                                   Transport::Handlers more = {}) {
  if (!node.modes_problem.empty())
    spdlog::warn("{}; it is computed if need be", node.modes_problem);
  more.on_message = [&core](const Message& message, Bus bus, AgentId transmitter) {
    core.receive(message, bus, transmitter, now());
  };
  auto opened = Transport::open(node.url, node.run, node.authenticator,
                                subscriptions_of(Core::kRole), std::move(more));
  if (!opened) {
    spdlog::error("{}", opened.error());
    return nullptr;
  }
  return *std::move(opened);
}

/// Runs `core` until it has finished. A core has kRole, receive(), advance(now, out), next_wakeup()
/// and finished(). The transport's handler calls receive().
/// @param on_signal  called for SIGINT or SIGTERM; it makes the core finish
/// @param each_turn  called in every turn, for the work that only this process has
/// @param lag        measures every turn
template <class Core>
void run_core(Core& core, Transport& transport, StopSignals& signals,
              const std::function<void()>& on_signal, const std::function<void()>& each_turn,
              LoopLag& lag) {
  Outbox out;
  const auto act = [&] {
    core.advance(now(), out);
    transport.publish(out);
    out.clear();
    each_turn();
  };
  act();
  while (!core.finished()) {
    const Instant before = now();
    const Instant planned = std::clamp(core.next_wakeup(), before, before + kLongestWait);
    lag.woke(planned, transport.deliver_until(planned, signals.fd()));
    if (signals.take() > 0) on_signal();
    act();
    lag.done(now());
  }
}

template <class Core>
void run_core(
    Core& core, Transport& transport, StopSignals& signals, const std::function<void()>& on_signal,
    const std::function<void()>& each_turn = [] {}) {
  LoopLag nobody_asks;
  run_core(core, transport, signals, on_signal, each_turn, nobody_asks);
}

}  // namespace ergocast
