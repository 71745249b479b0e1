// SPDX-License-Identifier: BSD-3-Clause
// Adds up the coverage of each state, and makes grids only for topics that somebody reads.
#include "cli/foxglove/live_topics.h"

#include <algorithm>
#include <limits>

#include "cli/team/team_history.h"
#include "core/mission/end_schedule.h"
#include "logger/received_amendments.h"
#include "logger/summary.h"
#include "report/export/changes.h"

namespace ergocast::cli {
namespace {

constexpr std::int32_t kPlanned = -1;

/// As the logger computes it, of the agents that are present.
double blocked_share(const TeamPicture& picture, const MissionFollower& team) {
  std::int64_t blocked = 0, answered = 0;
  for (const AgentRow& row : picture.agents) {
    if (!row.status) continue;
    const RosterEntry* entry = team.entry_of(row.author.incarnation);
    const Tick from = entry == nullptr ? 0 : entry->active_from;
    answered += std::max<std::int64_t>(0, row.status->answered_tick + 1 - from);
    blocked += row.status->blocked_ticks;
  }
  return answered > 0 ? static_cast<double>(blocked) / static_cast<double>(answered) : 0;
}

}  // namespace

LiveTopics::LiveTopics(LiveChannels& channels, const std::optional<GeoPlace>& origin,
                       DensityCells target)
    : channels_(channels),
      planned_target_(std::move(target)),
      target_(channels.add("/target", foxglove::grid_schema())),
      coverage_(channels.add("/coverage", foxglove::grid_schema())),
      metrics_(channels.add("/metrics", foxglove::metrics_schema())),
      log_(channels.add("/log", foxglove::log_schema(), LiveChannels::Kind::kLog)),
      amendments_(channels.add("/amendments", foxglove::log_schema(), LiveChannels::Kind::kLog)) {
  if (origin) plane_.emplace(*origin);
}

LiveTopics::Sums::Sums(const Mission& planned)
    : mission(in_cosines(planned)),
      sensors(mission),
      sums(Coefficients::Zero(mission.basis.mode_count())) {}

void LiveTopics::Sums::add(AgentId id, const Eigen::Vector3d& x_m) {
  if (!mission.domain.contains(x_m)) return;
  samples +=
      sensors.of(planned_kind(mission, id))
          .sample(BasisAt(x_m, mission.domain, mission.basis), mission.basis, 1, sums.data());
  is_new = true;
}

LiveTopics::Shown& LiveTopics::shown(AgentId id) {
  const auto [at, is_new] = agents_.try_emplace(id);
  if (is_new) {
    const std::string name = "/agents/" + std::to_string(id);
    at->second.pose = channels_.add(name + "/pose", foxglove::pose_schema());
    if (plane_)
      at->second.location = channels_.add(name + "/location", foxglove::location_schema());
  }
  return at->second;
}

void LiveTopics::take(const WorldState& world, const MissionFollower& team) {
  if (!sums_ && team.mission()) sums_.emplace(*team.mission());
  note_recalls(world, team);
  const Tick tick = world.header.tick;
  const bool counts = sums_ && !is_held(team.holds(), tick);
  std::optional<EndSchedule> ends;
  if (counts) ends.emplace(sums_->mission, team.amendments());
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    Shown& agent = shown(vehicle.id);
    if (tick <= agent.newest.tick) continue;
    agent.newest = {.tick = tick, .x_m = vehicle.position_m, .v_mps = vehicle.velocity_mps};
    agent.is_new = true;
    if (!counts || ends->rests(sums_->mission, vehicle.id, counted_ticks(team.holds(), tick)))
      continue;
    const auto recall = recalled_from_.find(vehicle.id);
    if (recall == recalled_from_.end() || tick < recall->second)
      sums_->add(vehicle.id, vehicle.position_m);
  }
}

/// An agent rests from when the world uses the revision that recalls it.
void LiveTopics::note_recalls(const WorldState& world, const MissionFollower& team) {
  const std::pair newest(team.revision(), std::max(roster_.second, world.roster_revision));
  if (newest == roster_) return;
  roster_ = newest;
  for (const RosterEntry& entry : team.roster())
    if (entry.recalled_at(newest.second))
      recalled_from_.try_emplace(entry.author.agent, world.header.tick);
}

void LiveTopics::show_places(std::uint64_t time_ns) {
  // A clock that is set back delays by no more than a period.
  if (time_ns < next_places_ns_ && next_places_ns_ - time_ns <= kPlacesPeriod_ns) return;
  if (std::ranges::none_of(agents_, [](const auto& one) { return one.second.is_new; })) return;
  next_places_ns_ = time_ns + kPlacesPeriod_ns;
  for (auto& [id, agent] : agents_) {
    if (!std::exchange(agent.is_new, false)) continue;
    const Eigen::Vector3d& x_m = agent.newest.x_m;
    channels_.publish(agent.pose, time_ns, foxglove::pose(time_ns, agent.newest));
    if (!plane_) continue;
    const GeoPlace place = plane_->to_place(x_m.head<2>());
    channels_.publish(agent.location, time_ns, foxglove::location(time_ns, place, x_m.z()));
  }
}

void LiveTopics::show_line(std::uint64_t time_ns, const std::string& line) {
  ExportedLine exported = parse_log_line(line).value_or(ExportedLine{0, "info", "", line});
  exported.time_ns = time_ns;
  channels_.publish(log_, time_ns, foxglove::log(exported));
}

void LiveTopics::show(std::uint64_t time_ns, const TeamPicture& picture,
                      const MissionFollower& team) {
  if (!sums_) sums_.emplace(*team.mission());
  show_metrics(time_ns, picture, team);
  show_target(time_ns, picture.tick, team.amendments());
  show_amendments(time_ns, picture.tick, team);
  show_coverage(time_ns);
}

void LiveTopics::show_metrics(std::uint64_t time_ns, const TeamPicture& picture,
                              const MissionFollower& team) {
  const TeamHistory::Row row = TeamHistory::row_of(picture);
  if (!picture.ergodic_metric || row.t_s <= metrics_s_) return;
  metrics_s_ = row.t_s;
  const MetricsRow values{.tick = picture.tick,
                          .t_s = row.t_s,
                          .ergodic_metric = row.phi,
                          .detection_probability = picture.detection_probability.value_or(
                              std::numeric_limits<double>::quiet_NaN()),
                          .spread = row.spread,
                          .max_staleness_s = row.age_s,
                          .received = static_cast<double>(row.received),
                          .lost = static_cast<double>(row.lost),
                          .blocked_share = blocked_share(picture, team)};
  channels_.publish(metrics_, time_ns,
                    foxglove::metrics(time_ns, values, name_of_basis(team.mission()->basis)));
}

void LiveTopics::show_target(std::uint64_t time_ns, Tick tick, const Amendments& amendments) {
  const TargetChange* change = target_at(amendments.targets, tick);
  const std::int32_t number = change == nullptr ? kPlanned : change->number;
  if (target_number_ == number) return;
  target_number_ = number;
  const Mission& mission = sums_->mission;
  const auto [columns, rows] = coverage_cells(mission);
  const bool has_table = change == nullptr && planned_target_.size() > 0;
  const DensityCells cells =
      has_table ? planned_target_
                : density_of(change == nullptr ? mission.target_coefficients : change->in_cosines(),
                             mission, columns, rows);
  channels_.publish(target_, time_ns, foxglove::grid(time_ns, cells, mission));
}

/// Once each amendment holds, in the order of their numbers.
void LiveTopics::show_amendments(std::uint64_t time_ns, Tick tick, const MissionFollower& team) {
  if (team.amendments().named <= next_amendment_) return;
  ReceivedAmendments received;
  received.note(team.amendments());
  for (const ReceivedAmendment& one : received.all()) {
    if (one.amendment.number < next_amendment_) continue;
    if (one.amendment.from > tick) return;
    next_amendment_ = one.amendment.number + 1;
    channels_.publish(amendments_, time_ns,
                      foxglove::log({time_ns, "info", one.amendment.by,
                                     "amendment " + std::to_string(one.amendment.number) + ": " +
                                         change_text(one, *team.mission())}));
  }
}

void LiveTopics::show_coverage(std::uint64_t time_ns) {
  if (!sums_->is_new || time_ns < next_coverage_ns_ || !channels_.is_wanted(coverage_)) return;
  next_coverage_ns_ = time_ns + kCoveragePeriod_ns;
  sums_->is_new = false;
  const auto [columns, rows] = coverage_cells(sums_->mission);
  const DensityCells cells =
      density_of(sums_->sums / sums_->samples, sums_->mission, columns, rows);
  channels_.publish(coverage_, time_ns, foxglove::grid(time_ns, cells, sums_->mission));
}

}  // namespace ergocast::cli
