// SPDX-License-Identifier: BSD-3-Clause
// Compares the team's views after the healing, and decides which failures the faults excuse.
#include "lab/trial.h"

#include <algorithm>

#include "lab/flight.h"

namespace ergocast::lab {
namespace {

/// How often the team's views are compared after healing.
constexpr auto kCheckPeriod = std::chrono::seconds(1);

}  // namespace

TableView Flight::view_of(NodeId node) {
  const Agent& one = agent(node);
  return {one.author(), one.coverage(), &one.team_coverage(), &one.follower().roster(), one.tick(),
          one.roster_revision(), &one.foreseen_coverage()};
}

std::vector<TableView> Flight::living() {
  std::vector<TableView> living;
  for (NodeId node = 0; node < agents_count_; ++node) {
    if (at(node).up && !agent(node).finished()) living.push_back(view_of(node));
  }
  return living;
}

/// Also who has reached the plan's end, as all have when their views are measured.
std::vector<TableView> Flight::present() {
  std::vector<TableView> present;
  for (NodeId node = 0; node < agents_count_; ++node) {
    if (at(node).up) present.push_back(view_of(node));
  }
  return present;
}

bool Flight::mission_over() const {
  return end_said_ || invariants_.last_tick() >= mission_.timing.tick_count;
}

bool Flight::everybody_finished() {
  for (NodeId node = 0; node < nodes_; ++node) {
    if (!at(node).up || !with(node, [](auto& core) { return core.finished(); })) return false;
  }
  return true;
}

/// Like an init system: who could take nothing over starts anew.
void Flight::supervise_coordinator() {
  if (!at(coordinator_node()).up || !coordinator_->finished() || mission_over()) return;
  if (!healed_ && coordinator_->mission() == nullptr) {
    ++figures_.coordinator_crashes;
    at(coordinator_node()).up = false;
    at(coordinator_node()).restart = now_;
    return;
  }
  invariants_.finished(in_seconds(now_), {kCoordinator, 0}, coordinator_->reason(), false);
}

void Flight::check_recovered() {
  if (now_ < next_check_) return;
  next_check_ = now_ + kCheckPeriod;
  if (mission_over() || options_.faults.lasting_share >= 1) return;
  const double t_s = in_seconds(now_);
  invariants_.recovered(t_s, living());
  invariants_.coordinated(t_s, *coordinator_, at(coordinator_node()).clock.local(now_), living());
}

std::string Flight::still_running() {
  std::string names;
  for (NodeId node = 0; node < nodes_; ++node) {
    if (with(node, [](auto& core) { return core.finished(); })) continue;
    names += (names.empty() ? "" : ", ") + name_of(node);
  }
  return names;
}

/// Somebody is down or cut off, or messages are so late or so few that nobody can tell.
void Flight::note_hindrance() {
  const bool away = std::any_of(processes_.begin(), processes_.end(),
                                [](const Process& process) { return !process.up; });
  const bool poor = !healed_ && hinders(options_.faults, mission_.timing.lockstep_timeout_s);
  if (away || poor || !fault_ends_.empty()) hindered_ = now_;
}

/// Whether what went wrong then may be due to what we have done: after each hindrance everybody has
/// the time to recover.
bool Flight::our_doing(Instant at) const {
  return hindered_ && at < *hindered_ + seconds(recovery_bound_s(mission_, options_.faults));
}

/// Whether a mission was given up because of what we did to it.
bool Flight::timed_out() const { return failed_since_ && our_doing(*failed_since_); }

/// Whether it has left the team as the scenario says, after it could not answer in time.
bool Flight::evicted(NodeId node) {
  return mission_.timing.on_timeout == OnTimeout::kEvict && struck(node) && our_doing(now_);
}

bool Flight::struck(NodeId node) {
  const RosterEntry* entry = agent(node).follower().entry_of(agent(node).author().incarnation);
  return entry != nullptr && entry->active_until >= 0;
}

/// A coordinator that came back when all was over has no mission that could fail.
bool Flight::failed() const {
  return coordinator_->state() == MissionState::kFailed && coordinator_->mission() != nullptr;
}

TrialResult Flight::result() {
  TrialResult result;
  result.timed_out = timed_out();
  const double t_s = in_seconds(now_);
  if (!result.timed_out && !invariants_.violation()) {
    if (options_.faults.lasting_share < 1) invariants_.recovered(t_s, living());
    invariants_.compare_views(present());
    invariants_.ended(t_s, still_running(), failed() ? coordinator_->reason() : "", recorder_.facts(), excused_);
  }
  result.violation = invariants_.violation();
  figures_.virtual_s = t_s;
  figures_.ergodic_metric = recorder_.facts().ergodic_metric_last;
  figures_.view_error = invariants_.largest_view_error();
  figures_.faults = network_.counted();
  for (NodeId node = 0; node < agents_count_; ++node) figures_.evictions += agent(node).finished() && struck(node);
  if (figures_.recoveries > 0) {
    figures_.recovery_mean_s = recovery_sum_s_ / static_cast<double>(figures_.recoveries);
  }
  result.figures = figures_;
  return result;
}

TrialResult fly_trial(const TrialOptions& options, std::ostream& trajectory, std::ostream& metrics) {
  return Flight(options, trajectory, metrics).run();
}

}  // namespace ergocast::lab
