// SPDX-License-Identifier: BSD-3-Clause
// Jumps to the earliest event, delivers what is due, and advances every process that heard
// something or wakes up.
#include "lab/flight.h"

#include <algorithm>

#include "core/noise.h"
#include "lab/random_stream.h"
#include "lcmtypes/codec.h"
#include "team/plan.h"

namespace ergocast::lab {
namespace {

/// More events than this in a virtual second are a storm of messages.
constexpr std::int64_t kMostMessagesPer_s = 100000;
/// A random stream beside those of lab/faults.cc.
constexpr std::uint32_t kClocks = 16;

}  // namespace

Flight::Flight(const TrialOptions& options, std::ostream& trajectory, std::ostream& metrics)
    : options_(options),
      mission_(std::get<Mission>(decode_plan(options.plan))),
      seed_(mission_.seed),
      run_(random_words(seed_, Purpose::kIncarnation, ~0U, 0).first | 1),
      agents_count_(static_cast<int>(mission_.starts_m.size())),
      nodes_(agents_count_ + 3),
      network_(seed_, options.faults, nodes_),
      invariants_(mission_),
      processes_(static_cast<std::size_t>(nodes_)),
      agents_(static_cast<std::size_t>(agents_count_)),
      recorder_(run_, 1, trajectory, metrics),
      planned_s_(static_cast<double>(mission_.timing.tick_count) * mission_.timing.dt_s /
                 mission_.timing.realtime_factor),
      answered_(static_cast<std::size_t>(agents_count_), -1),
      recoveries_(static_cast<std::size_t>(agents_count_)) {
  figures_.seed = seed_;
  faulty_s_ = options.faults.lasting_share * planned_s_;
  // To the end means to the end of a mission that began late, too.
  if (options.faults.lasting_share >= 1) faulty_s_ += mission_.timing.admission_timeout_s;
  events_ = fault_events(options.faults, seed_, agents_count_, faulty_s_);
  for (NodeId node = 0; node < nodes_; ++node) {
    for (std::size_t bus = 0; bus < kBusCount; ++bus) {
      on_bus_[bus].set(static_cast<std::size_t>(node), subscriptions(node)[bus] != 0);
    }
  }
  set_clocks();
  for (NodeId node = 0; node < nodes_; ++node) start(node);
}

const Subscriptions& Flight::subscriptions(NodeId node) const {
  const Role role = node < agents_count_          ? Role::kAgent
                    : node == coordinator_node() ? Role::kCoordinator
                    : node == world_node()       ? Role::kWorld
                                                 : Role::kLogger;
  return subscriptions_of(role, options_.subscriptions);
}

std::string Flight::name_of(NodeId node) const {
  if (node < agents_count_) return "agent " + std::to_string(node);
  return node == coordinator_node() ? "the coordinator" : node == world_node() ? "the world" : "the logger";
}

Incarnation Flight::incarnation_of(NodeId node) const {
  const std::uint32_t life = processes_[static_cast<std::size_t>(node)].life;
  return random_words(seed_, Purpose::kIncarnation, static_cast<std::uint32_t>(node), life).first | 1;
}

void Flight::set_clocks() {
  const Faults& faults = options_.faults;
  if (faults.clock_rate_error <= 0 && faults.clock_offset_max_s <= 0) return;
  RandomStream random(seed_, kClocks);
  for (Process& process : processes_) {
    const double rate = 1 + faults.clock_rate_error * (2 * random.uniform() - 1);
    process.clock = SkewedClock(rate, seconds(faults.clock_offset_max_s * random.uniform()));
    ++figures_.skewed_clocks;
  }
}

void Flight::start(NodeId node) {
  Process& process = at(node);
  const Incarnation incarnation = incarnation_of(node);
  if (node < agents_count_) {
    agents_[static_cast<std::size_t>(node)] = std::make_unique<Agent>(
        AgentIdentity{run_, node, incarnation, "laboratory", options_.version});
    answered_[static_cast<std::size_t>(node)] = -1;
    invariants_.born({node, incarnation});
  } else if (node == coordinator_node()) {
    const bool first = process.life == 0;
    coordinator_ = std::make_unique<Coordinator>(
        CoordinatorIdentity{run_, incarnation, "laboratory", options_.version},
        first ? options_.plan : std::vector<std::byte>(),
        first ? Takeover::kNever : Takeover::kMust);
  } else if (node == world_node()) {
    world_ = std::make_unique<World>(run_, incarnation);
    acknowledged_.reset();
    logger_lost_ = false;
  }
  process.up = true;
  process.judged = false;
  process.restart = Instant::max();
  process.wakeup = now_;
  ++process.life;
}

// ---- time ----------------------------------------------------------------------------------------

/// What the schedule of the faults goes by. A lockstep mission flies in no time where nobody is
/// late, so there it is mission time; but a mission that stands still is to be healed as well.
double Flight::progress_s() const {
  const double virtual_s = in_seconds(now_);
  if (mission_.timing.pace == Pace::kRealtime) return virtual_s;
  return std::max(virtual_s,
                  static_cast<double>(invariants_.last_tick()) * mission_.timing.dt_s /
                      mission_.timing.realtime_factor);
}

Instant Flight::next_time() {
  Instant next = std::min(network_.next(), next_check_);
  for (const Process& process : processes_) {
    next = std::min(next, process.up ? process.wakeup : process.restart);
  }
  for (const FaultEnd& end : fault_ends_) next = std::min(next, end.at);
  if (healed_) return std::min(next, deadline_);
  if (next_event_ < events_.size()) {
    next = std::min(next, Instant(seconds(events_[next_event_].at_s)));
  }
  return std::min(next, Instant(seconds(faulty_s_)));
}

TrialResult Flight::run() {
  while (!everybody_finished() && !invariants_.violation()) {
    now_ = std::max(now_, next_time());
    if (now_ >= deadline_) break;
    if (static_cast<double>(figures_.messages) > kMostMessagesPer_s * (progress_s() + 1)) break;
    if (!healed_) {
      end_events();
      begin_events();
      if (progress_s() >= faulty_s_ || mission_over()) heal();
    }
    restart_due();
    note_hindrance();
    deliver_due();
    advance_due();
    supervise_coordinator();
    if (failed() && !failed_since_) failed_since_ = now_;
    check_recovered();
  }
  return result();
}

// ---- messages ------------------------------------------------------------------------------------

void Flight::deliver_due() {
  while (network_.next() <= now_) {
    const Delivery delivery = network_.pop();
    for (NodeId node = 0; node < nodes_; ++node) {
      if (delivery.to.test(static_cast<std::size_t>(node)) && at(node).up) hear(node, delivery);
    }
  }
}

void Flight::hear(NodeId node, const Delivery& delivery) {
  Process& process = at(node);
  const Instant local = process.clock.local(now_);
  const Message& message = *delivery.message;
  const auto* ack = std::get_if<RecordAck>(&message);
  if (ack != nullptr && node == world_node()) {
    acknowledged_ = std::max(acknowledged_.value_or(-1), ack->header.tick);
  }
  // Everything on a bus arrives; what no subscription names goes no further.
  if (!hears(subscriptions(node), delivery.bus, message)) return;
  process.heard = true;
  const auto* digest = std::get_if<Digest>(&message);
  if (digest != nullptr && node < agents_count_) invariants_.heard(agent(node).author(), *digest);
  with(node, [&](auto& core) {
    core.receive(message, delivery.bus, delivery.transmitter, local);
  });
  if (node >= agents_count_) return;
  Agent& one = agent(node);
  invariants_.received({one.author(), one.coverage(), nullptr, &one.follower().roster()}, message);
}

void Flight::advance_due() {
  for (NodeId node = 0; node < nodes_; ++node) {
    if (at(node).up && (at(node).heard || at(node).wakeup <= now_)) advance(node);
  }
}

void Flight::advance(NodeId node) {
  Process& process = at(node);
  const Instant local = process.clock.local(now_);
  process.heard = false;
  with(node, [&](auto& core) { core.advance(local, outbox_); });
  publish(node);
  const Instant next = with(node, [](auto& core) { return core.finished() ? Instant::max() : core.next_wakeup(); });
  invariants_.wakeup(in_seconds(now_), name_of(node), next <= local);
  process.wakeup = process.clock.when(next);
  if (node < agents_count_) after_agent(node);
  if (node == world_node()) after_world();
}

void Flight::publish(NodeId node) {
  if (outbox_.empty()) return;  // most often, and c_k is added up for who holds it
  const bool is_agent = node < agents_count_;
  const TableView speaker = is_agent ? view_of(node) : TableView();
  for (const Outgoing& outgoing : outbox_) {
    const double t_s = in_seconds(now_);
    invariants_.sent(t_s, outgoing, speaker.table != nullptr ? &speaker : nullptr);
    if (is_agent) note_answer(node, outgoing.message, speaker);
    encode(outgoing.message, bytes_);
    auto decoded = decode(bytes_, run_);
    invariants_.decoded(t_s, decoded, false);
    if (std::holds_alternative<Refusal>(decoded)) continue;
    ++figures_.messages;
    if (const auto* part = std::get_if<MissionPart>(&outgoing.message)) {
      end_said_ |= part->state == MissionState::kEnded || part->state == MissionState::kFailed;
    }
    figures_.digests += std::holds_alternative<Digest>(outgoing.message);
    figures_.contributions += std::holds_alternative<Contribution>(outgoing.message);
    figures_.relayed += outgoing.relayer != kUnassigned;
    const AgentId sender = header_of(outgoing.message).sender;
    const int corrupted = network_.send(
        now_, node, on_bus_[static_cast<std::size_t>(outgoing.bus)], outgoing.bus,
        outgoing.relayer != kUnassigned ? outgoing.relayer : sender,
        std::make_shared<const Message>(std::get<Message>(std::move(decoded))));
    for (int i = 0; i < corrupted; ++i) {
      damaged_ = bytes_;
      damage(damaged_, seed_, static_cast<std::uint64_t>(network_.counted().corrupted - i));
      invariants_.decoded(t_s, decode(damaged_, run_), true);
    }
  }
  outbox_.clear();
}

void Flight::after_agent(NodeId node) {
  const double t_s = in_seconds(now_);
  Agent& one = agent(node);
  invariants_.refused(t_s, one.author(), one.refused());
  look_for_recovery(node);
  if (!one.finished() || at(node).judged) return;
  at(node).judged = true;  // by what is wrong at this moment
  invariants_.finished(t_s, one.author(), one.reason(), mission_over() || evicted(node));
}

void Flight::after_world() {
  if (world_->logger_lost() && !logger_lost_) {
    invariants_.gave_up_logger(in_seconds(now_), acknowledged_, world_->tick());
  }
  logger_lost_ = world_->logger_lost();
}

/// Once for each tick that an agent answers.
void Flight::note_answer(NodeId node, const Message& message, const TableView& holder) {
  const auto* command = std::get_if<Command>(&message);
  Tick& answered = answered_[static_cast<std::size_t>(node)];
  if (command == nullptr || command->header.tick <= answered) return;
  answered = command->header.tick;
  ++figures_.agent_steps;
  invariants_.answered(in_seconds(now_), holder);
}

void Flight::look_for_recovery(NodeId node) {
  auto& recovery = recoveries_[static_cast<std::size_t>(node)];
  const CoverageTable* table = agent(node).coverage();
  if (!recovery || table == nullptr) return;
  std::erase_if(recovery->lacks, [&](const auto& lack) {
    return table->steps_held(lack.first).value_or(0) >= lack.second;
  });
  if (!recovery->lacks.empty()) return;
  const double took_s = in_seconds(now_) - in_seconds(recovery->since);
  recovery_sum_s_ += took_s;
  figures_.recovery_max_s = std::max(figures_.recovery_max_s, took_s);
  ++figures_.recoveries;
  recovery.reset();
}

}  // namespace ergocast::lab
