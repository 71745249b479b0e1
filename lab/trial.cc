// SPDX-License-Identifier: BSD-3-Clause
// Reports all events of a simulation to the invariants, compares the team's views after healing,
// and decides which failures the faults excuse.
#include "lab/trial.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "plan/plan.h"

namespace ergocast::lab {
namespace {

/// Above 0, so that no loop stops time.
constexpr PacingClock::duration kLatency = std::chrono::microseconds(200);
/// How often the team's views are compared after healing.
constexpr auto kCheckPeriod = std::chrono::seconds(1);
/// After the last tick: how long the slowest process may take to end.
constexpr double kLinger_s = 10;
/// More messages than this for each process, without a new tick, are a storm.
constexpr std::int64_t kMostMessagesPerTick = 10000;

class Trial : SimulationObserver {
 public:
  Trial(SimulationOptions options, std::ostream& trajectory, std::ostream& metrics)
      : faults_(options.faults),
        mission_(decode_plan_with_table(options.plan).value()),
        invariants_(mission_),
        agents_(mission_.starts_m.size()),
        simulation_(std::move(options), trajectory, metrics, this) {
    if (only_wishes(faults_)) invariants_.expect_zones_to_be_left();
  }

  TrialResult run();

 private:
  struct Recovery {
    Instant since;
    std::vector<std::pair<Author, std::int64_t>> lacks;
  };
  struct AgentState {
    Tick begun = -1, answered = -1;
    bool judged = false;  // it has finished, and finished() has checked whether it may
    std::optional<Recovery> recovery;
  };

  void started(NodeId node, Incarnation incarnation, bool again) override;
  void sends(NodeId node, const Outbox& outbox) override;
  void decoded(const Decoded& result, bool damaged) override {
    invariants_.decoded(t_s(), result, damaged);
  }
  void arrives(NodeId node, const Message& message) override;
  void received(NodeId node, const Message& message) override;
  void advanced(NodeId node, bool hurries) override;
  void healed() override;

  double t_s() const { return in_seconds(simulation_.now()); }
  bool is_agent(NodeId node) const { return static_cast<std::size_t>(node) < agents_.size(); }
  AgentState& at(NodeId node) { return agents_[static_cast<std::size_t>(node)]; }
  TableView view_of(NodeId node) const;
  std::vector<TableView> views(bool also_finished) const;
  bool shut_out(NodeId node) const;
  std::vector<TableView> expected_back() const;

  void note_tick(NodeId node);
  void note_answer(NodeId node, const Command& command, const TableView& view);
  void expect_back(NodeId node);
  void look_for_recovery(NodeId node);
  void check_coordinator();
  void check_recovered();
  std::string still_running() const;
  bool our_doing(Instant at) const;
  bool evicted(NodeId node) const;
  bool struck(NodeId node) const;
  bool failed() const;
  bool storm();
  TrialResult result();

  const Faults faults_;
  const Mission mission_;
  Invariants invariants_;
  std::vector<AgentState> agents_;
  Simulation simulation_;  // calls us for each start while it is constructed

  std::optional<Instant> failed_since_;
  Tick excused_ = 0;  // ticks whose states may have been kept from the logger
  Instant next_check_ = Instant::max(), deadline_ = Instant::max();
  std::optional<Tick> acknowledged_;  // by the logger, as far as the running world has received it
  bool logger_lost_ = false;          // from that world's view
  Tick newest_tick_ = -1;
  std::int64_t messages_before_ = 0;  // number of messages sent before that tick
  double recovery_sum_s_ = 0;
  TrialFigures figures_;
};

// ---- what happens ----

void Trial::started(NodeId node, Incarnation incarnation, bool again) {
  if (is_agent(node)) {
    at(node) = {};
    invariants_.started({node, incarnation});
    if (again) expect_back(node);
  } else if (again && node == simulation_.world_node()) {
    acknowledged_.reset();
    logger_lost_ = false;
  }
}

void Trial::sends(NodeId node, const Outbox& outbox) {
  if (is_agent(node)) note_tick(node);
  // Computed once for all messages, because adding up c_k takes long.
  // An agent that has finished knows no more about the tick that it stops its vehicle at.
  const bool takes_part = is_agent(node) && !simulation_.agent(node).finished();
  const TableView view = takes_part ? view_of(node) : TableView();
  for (const Outgoing& sent : outbox) {
    invariants_.sent(t_s(), sent, view.table != nullptr ? &view : nullptr);
    const auto* command = std::get_if<Command>(&sent.message);
    if (command != nullptr && takes_part) note_answer(node, *command, view);
    if (command != nullptr && !takes_part) invariants_.commanded_after(t_s(), *command);
  }
}

/// Called once for each tick that an agent begins.
void Trial::note_tick(NodeId node) {
  const Agent& agent = simulation_.agent(node);
  // The tick after the last one is not begun.
  if (agent.finished() || agent.tick() == at(node).begun) return;
  at(node).begun = agent.tick();
  TableView view{agent.author(), agent.coverage(), nullptr, &agent.counted_roster()};
  view.answered = agent.tick();
  view.roster_revision = agent.roster_revision();
  view.holds = agent.follower().holds();
  view.amendments = &agent.follower().amendments();
  invariants_.began(t_s(), view);
}

/// Called once for each tick that an agent answers.
void Trial::note_answer(NodeId node, const Command& command, const TableView& view) {
  if (command.header.tick <= at(node).answered) return;
  at(node).answered = command.header.tick;
  ++figures_.agent_steps;
  invariants_.answered(t_s(), view, command.position_m);
}

void Trial::arrives(NodeId node, const Message& message) {
  const auto* ack = std::get_if<RecordAck>(&message);
  if (ack == nullptr || node != simulation_.world_node()) return;
  acknowledged_ = std::max(acknowledged_.value_or(-1), ack->header.tick);
}

void Trial::received(NodeId node, const Message& message) {
  if (!is_agent(node)) return;
  const Agent& agent = simulation_.agent(node);
  const auto* digest = std::get_if<Digest>(&message);
  if (digest != nullptr) invariants_.digest_received(agent.author(), *digest);
  TableView view{agent.author(), agent.coverage(), nullptr, &agent.counted_roster()};
  view.holds = agent.follower().holds();
  view.amendments = &agent.follower().amendments();
  invariants_.received(view, message);
}

void Trial::advanced(NodeId node, bool hurries) {
  invariants_.wakeup(t_s(), simulation_.name_of(node), hurries);
  if (is_agent(node)) {
    const Agent& agent = simulation_.agent(node);
    note_tick(node);
    invariants_.refused(t_s(), agent.author(), agent.refused());
    look_for_recovery(node);
    if (!agent.finished() || at(node).judged) return;
    at(node).judged = true;  // by the state at this moment
    const bool over = simulation_.mission_over() || evicted(node) || simulation_.sent_out(node);
    invariants_.finished(t_s(), agent.author(), agent.reason(), over);
  } else if (node == simulation_.world_node()) {
    const World& world = simulation_.world();
    if (world.logger_lost() && !logger_lost_) {
      invariants_.gave_up_logger(t_s(), acknowledged_, world.tick());
    }
    logger_lost_ = world.logger_lost();
  }
}

void Trial::healed() {
  if (!spares_the_record(faults_)) excused_ = invariants_.last_tick() + 1;
  next_check_ = simulation_.now() + seconds(recovery_bound_s(mission_, faults_));
  // Without coordinator and agents the world ends by itself, and only then the logger.
  const double cut_off_s = 2 * (mission_.timing.lockstep_timeout_s + kFarewellPatience_s);
  deadline_ = next_check_ + seconds((simulation_.planned_s() + cut_off_s + kLinger_s) /
                                    (1 - faults_.clock_rate_error));
}

// ---- recovery ----

void Trial::expect_back(NodeId node) {
  Recovery recovery{simulation_.now(), {}};
  const auto team = views(false);
  for (const Author& author : invariants_.authors()) {
    if (author.agent != node) continue;
    std::int64_t most = 0;
    for (const TableView& view : team) {
      if (view.table != nullptr) most = std::max(most, steps_of(*view.table, author));
    }
    if (most > 0) recovery.lacks.emplace_back(author, most);
  }
  at(node).recovery = std::move(recovery);
}

void Trial::look_for_recovery(NodeId node) {
  auto& recovery = at(node).recovery;
  const CoverageTable* table = simulation_.agent(node).coverage();
  if (!recovery || table == nullptr) return;
  std::erase_if(recovery->lacks,
                [&](const auto& lack) { return steps_of(*table, lack.first) >= lack.second; });
  if (!recovery->lacks.empty()) return;
  const double took_s = t_s() - in_seconds(recovery->since);
  recovery_sum_s_ += took_s;
  figures_.recovery_max_s = std::max(figures_.recovery_max_s, took_s);
  ++figures_.recoveries;
  recovery.reset();
}

TableView Trial::view_of(NodeId node) const {
  const Agent& agent = simulation_.agent(node);
  return {agent.author(),
          agent.coverage(),
          &agent.team_coverage(),
          &agent.counted_roster(),
          agent.tick(),
          agent.roster_revision(),
          &agent.foreseen_coverage(),
          agent.follower().holds(),
          &agent.follower().amendments(),
          agent.counted_tick(),
          agent.efforts(),
          agent.held()};
}

/// The views of all agents that are up. An agent that has reached the plan's end has finished.
std::vector<TableView> Trial::views(bool also_finished) const {
  std::vector<TableView> views;
  for (NodeId node = 0; is_agent(node); ++node) {
    if (!simulation_.up(node)) continue;
    if (also_finished || !simulation_.finished(node)) views.push_back(view_of(node));
  }
  return views;
}

/// Whether it is a process that was away when its number was sent out, and that has received no
/// whole MISSION since. It is not admitted any more. It also does not learn of the end if the
/// coordinator is killed during it: the team has left without waiting for it.
bool Trial::shut_out(NodeId node) const {
  return is_agent(node) && simulation_.sent_out(node) && simulation_.up(node) &&
         simulation_.agent(node).follower().revision() < 0;
}

std::vector<TableView> Trial::expected_back() const {
  std::vector<TableView> views;
  for (NodeId node = 0; is_agent(node); ++node) {
    const bool runs = simulation_.up(node) && !simulation_.finished(node);
    if (runs && !shut_out(node)) views.push_back(view_of(node));
  }
  return views;
}

// ---- judgement ----

void Trial::check_coordinator() {
  const NodeId node = simulation_.coordinator_node();
  if (failed() && !failed_since_) failed_since_ = simulation_.now();
  if (!simulation_.up(node) || !simulation_.finished(node) || simulation_.mission_over()) return;
  invariants_.finished(t_s(), {kCoordinator, 0}, simulation_.coordinator().reason(), false);
}

void Trial::check_recovered() {
  if (simulation_.now() < next_check_) return;
  next_check_ = simulation_.now() + kCheckPeriod;
  if (simulation_.mission_over() || faults_.lasting_share >= 1) return;
  const auto living = expected_back();
  invariants_.recovered(t_s(), living);
  invariants_.coordinated(t_s(), simulation_.coordinator(),
                          simulation_.local_time(simulation_.coordinator_node()), living);
}

std::string Trial::still_running() const {
  std::string names;
  for (NodeId node = 0; node < simulation_.node_count(); ++node) {
    if (simulation_.finished(node) || shut_out(node)) continue;
    names += (names.empty() ? "" : ", ") + simulation_.name_of(node);
  }
  return names;
}

/// Whether a failure at `at` may be due to our faults: after each hindrance all processes need time
/// to recover.
bool Trial::our_doing(Instant at) const {
  const auto hindered = simulation_.hindered();
  return hindered && at < *hindered + seconds(recovery_bound_s(mission_, faults_));
}

/// Whether the agent was evicted, as the scenario allows, because it did not answer in time.
bool Trial::evicted(NodeId node) const {
  return mission_.timing.on_timeout == OnTimeout::kEvict && struck(node) &&
         our_doing(simulation_.now());
}

/// Whether the agent is struck off the roster.
bool Trial::struck(NodeId node) const {
  const Agent& agent = simulation_.agent(node);
  const RosterEntry* entry = agent.follower().entry_of(agent.author().incarnation);
  return entry != nullptr && entry->active_until >= 0;
}

/// A coordinator that restarted after the end has no mission that could fail.
bool Trial::failed() const {
  const Coordinator& coordinator = simulation_.coordinator();
  return coordinator.state() == MissionState::kFailed && coordinator.mission() != nullptr;
}

/// Without a bound, two processes that answer each other would stop time.
bool Trial::storm() {
  const std::int64_t messages = simulation_.counts().messages;
  if (simulation_.last_tick() != newest_tick_) {
    newest_tick_ = simulation_.last_tick();
    messages_before_ = messages;
  }
  return messages - messages_before_ > kMostMessagesPerTick * simulation_.node_count();
}

TrialResult Trial::run() {
  while (!invariants_.violation() && simulation_.step(std::min(next_check_, deadline_))) {
    check_coordinator();
    check_recovered();
    if (simulation_.now() >= deadline_ || storm()) break;
  }
  return result();
}

TrialResult Trial::result() {
  TrialResult result;
  // The mission was given up because of our faults.
  result.timed_out = failed_since_ && our_doing(*failed_since_);
  if (!result.timed_out && !invariants_.violation()) {
    if (faults_.lasting_share < 1) invariants_.recovered(t_s(), expected_back());
    invariants_.compare_views(views(true));
    const std::string failure = failed() ? simulation_.coordinator().reason() : "";
    invariants_.ended(t_s(), still_running(), failure, simulation_.recorder().facts(), excused_);
  }
  result.violation = invariants_.violation();
  static_cast<SimulationCounts&>(figures_) = simulation_.counts();
  figures_.seed = mission_.seed;
  figures_.virtual_s = t_s();
  figures_.held_ticks = simulation_.recorder().facts().held_ticks;
  figures_.ergodic_metric = simulation_.recorder().facts().ergodic_metric_last;
  figures_.view_error = invariants_.largest_view_error();
  for (NodeId node = 0; is_agent(node); ++node) {
    figures_.evictions += simulation_.finished(node) && struck(node) && !simulation_.sent_out(node);
  }
  if (figures_.recoveries > 0) {
    figures_.recovery_mean_s = recovery_sum_s_ / static_cast<double>(figures_.recoveries);
  }
  result.figures = figures_;
  return result;
}

}  // namespace

TrialResult run_trial(SimulationOptions options, std::ostream& trajectory, std::ostream& metrics) {
  options.latency = kLatency;
  return Trial(std::move(options), trajectory, metrics).run();
}

}  // namespace ergocast::lab
