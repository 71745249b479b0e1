// SPDX-License-Identifier: BSD-3-Clause
// Delivers every message in flight before time passes, then jumps to the earliest wake-up of a
// process.
#include "lab/swarm.h"

#include <algorithm>
#include <stdexcept>

#include "core/noise.h"
#include "team/plan.h"
#include "team/subscriptions.h"
#include "lcmtypes/codec.h"

namespace ergocast::lab {
namespace {

Incarnation incarnation_of(std::uint64_t seed, int node) {
  return random_words(seed, Purpose::kIncarnation, static_cast<std::uint32_t>(node), 0).first | 1;
}

Mission decoded(const Options& options) {
  return std::get<Mission>(decode_plan(options.plan));
}

}  // namespace

Swarm::Swarm(Options options, std::ostream& trajectory, std::ostream& metrics)
    : options_(std::move(options)),
      run_(incarnation_of(decoded(options_).seed, -1)),
      world_(run_, incarnation_of(decoded(options_).seed, kWorldSeat)),
      coordinator_({run_, incarnation_of(decoded(options_).seed, kCoordinatorSeat), options_.host,
                    options_.version},
                   options_.plan),
      recorder_(run_, incarnation_of(decoded(options_).seed, kLoggerSeat), trajectory, metrics) {
  const std::uint64_t seed = decoded(options_).seed;
  for (int i = 0; i < options_.agents; ++i) {
    agents_.push_back(std::make_unique<Agent>(
        AgentIdentity{run_, i, incarnation_of(seed, i), options_.host, options_.version}));
  }
}

void Swarm::run(std::chrono::nanoseconds limit) {
  while (now_.time_since_epoch() < limit && step()) {
  }
}

bool Swarm::step() {
  if (in_flight_.empty()) {
    if (everybody_finished()) return false;
    pass_time();
  }
  const std::size_t batch = in_flight_.size();
  for (std::size_t i = 0; i < batch; ++i) {
    deliver(in_flight_.front());
    spare_.push_back(std::move(in_flight_.front().bytes));
    in_flight_.pop_front();
  }
  advance_all();
  return true;
}

void Swarm::pass_time() {
  const Instant next = next_wakeup();
  // Whoever asks for the past would keep its process at full load, and time here from passing.
  if (started_ && next <= now_) throw std::logic_error("a process asks to be woken in the past");
  now_ = std::max(now_, next);
  started_ = true;
}

void Swarm::advance_all() {
  coordinator_.advance(now_, outbox_);
  world_.advance(now_, outbox_);
  for (auto& agent : agents_) agent->advance(now_, outbox_);
  recorder_.advance(now_, outbox_);
  send(outbox_);
}

void Swarm::send(Outbox& out) {
  for (const Outgoing& outgoing : out) {
    std::vector<std::byte> bytes;
    if (!spare_.empty()) {
      bytes = std::move(spare_.back());
      spare_.pop_back();
    }
    encode(outgoing.message, bytes);
    const AgentId sender = header_of(outgoing.message).sender;
    const bool relayed = outgoing.relayer != kUnassigned;
    in_flight_.push_back({outgoing.bus, relayed ? outgoing.relayer : sender, std::move(bytes)});
    ++messages_sent_;
  }
  out.clear();
}

bool Swarm::reaches(const Message& message, int node) {
  if (!options_.delivers || options_.delivers(message, node)) return true;
  ++messages_dropped_;
  return false;
}

void Swarm::deliver(const Datagram& datagram) {
  const auto decoded = decode(datagram.bytes, run_);
  const Message* message = std::get_if<Message>(&decoded);
  if (message == nullptr) return;
  const auto tell = [&]<class Core>(Core& core, int node) {
    const bool heard = hears(subscriptions_of(Core::kRole), datagram.bus, *message);
    if (heard && reaches(*message, node)) {
      core.receive(*message, datagram.bus, datagram.transmitter, now_);
    }
  };
  for (std::size_t i = 0; i < agents_.size(); ++i) tell(*agents_[i], static_cast<int>(i));
  tell(coordinator_, kCoordinatorSeat);
  tell(world_, kWorldSeat);
  tell(recorder_, kLoggerSeat);
}

bool Swarm::everybody_finished() const {
  return coordinator_.finished() && recorder_.finished() && world_.finished() &&
         std::all_of(agents_.begin(), agents_.end(), [](const auto& a) { return a->finished(); });
}

Instant Swarm::next_wakeup() const {
  Instant next = coordinator_.finished() ? Instant::max() : coordinator_.next_wakeup();
  next = std::min({next, world_.next_wakeup(), recorder_.next_wakeup()});
  for (const auto& agent : agents_) next = std::min(next, agent->next_wakeup());
  return next == Instant::max() ? now_ + std::chrono::milliseconds(100) : next;
}

}  // namespace ergocast::lab
