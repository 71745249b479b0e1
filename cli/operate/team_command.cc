// SPDX-License-Identifier: BSD-3-Clause
// Keeps a MonitoredRun for each received run, up to a limit.
#include "cli/operate/team_command.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "cli/watch/diagnose_silence.h"

namespace ergocast::cli {
namespace {

/// The most runs beyond kMostRuns that are remembered.
constexpr std::size_t kMostInCrowd = 256;

}  // namespace

int TeamCommand::carry_out() {
  if (const auto failed = open()) return *failed;
  return act();
}

std::optional<int> TeamCommand::open() {
  if (!options_.authenticator.can_sign())
    return report_error(kExitBadInput, cannot_sign(options_.key_file));
  auto opened = listen_to_teams(
      options_,
      [this](const Message& message, Bus bus, AgentId transmitter) {
        receive(message, bus, transmitter);
      },
      [this](const Message& message, Bus, AgentId) { replay_ = header_of(message).run; });
  if (!opened) return report_error(kExitUnavailable, opened.error());
  transport_ = *std::move(opened);
  since_ = now();
  return std::nullopt;
}

void TeamCommand::receive(const Message& message, Bus bus, AgentId transmitter) {
  const RunId run = header_of(message).run;
  if (run == 0) return;
  if (runs_.size() < kMostRuns || runs_.contains(run)) {
    runs_.try_emplace(run, run, since_).first->second.receive(message, bus, transmitter, now());
  } else if (crowd_.size() < kMostInCrowd || crowd_.contains(run)) {
    Tick& tick = crowd_[run];
    tick = std::max(tick, header_of(message).tick);
  }
}

bool TeamCommand::look_around() {
  const auto enough = [this] {
    const bool one = options_.run != 0 || waited() >= kLookAround;
    return runs_.size() > 1 || (!runs_.empty() && one) || waited() >= kListeningTime;
  };
  while (!enough()) {
    if (!listen()) return false;
  }
  return true;
}

bool TeamCommand::listen() {
  transport_->deliver_until(now() + kTurnTime, signals_.fd());
  interrupted_ = interrupted_ || signals_.take() > 0;
  return !interrupted_;
}

std::optional<int> TeamCommand::choose_run() {
  if (!look_around()) return interrupted();
  if (runs_.empty()) return nobody();
  if (runs_.size() > 1) return choose();
  transport_->set_run(runs_.begin()->first);
  return std::nullopt;
}

OrderReport TeamCommand::turn(Order& order) {
  const MonitoredRun& team = runs_.begin()->second;
  Outbox out;
  order.send(team, now(), out);
  transport_->publish(out);
  return order.report(team, now());
}

std::optional<OrderReport> TeamCommand::obeyed(Order& order) {
  bool answered = false;
  while (true) {
    const OrderReport report = turn(order);
    if (report.ended() || report.state == OrderReport::State::kObeyed) return report;
    if (report.state == OrderReport::State::kAnswered && !std::exchange(answered, true)) {
      std::printf("%s\n", report.text.c_str());
      std::fflush(stdout);
    }
    if (!listen()) return std::nullopt;
  }
}

int TeamCommand::nobody() const {
  if (replay_ == 0) return report_error(kExitFailed, why_nobody(options_, *transport_));
  return report_error(
      kExitFailed,
      "the messages on " + options_.url.base() + " are a replay of run " + to_hex(replay_) +
          ": no team is there to obey. Ctrl-C ends `ergocast replay` in its own terminal");
}

}  // namespace ergocast::cli
