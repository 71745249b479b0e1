// SPDX-License-Identifier: BSD-3-Clause
// Notes φ² at fixed times, escapes at the first tick far enough away, and motion as running
// sums.
#include "studies/study_measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/require.h"
#include "logger/slope.h"

namespace ergocast::studies {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr int kTicksInDecade = 20;

/// The first ticks at or after kLadder_s, up to `last`. A time that dt divides up to rounding is
/// that multiple.
std::vector<Tick> ladder_ticks(double dt_s, Tick last) {
  std::vector<Tick> ticks;
  for (const double t_s : kLadder_s) {
    const auto tick = static_cast<Tick>(std::ceil(t_s / dt_s * (1 - 1e-12)));
    if (tick > last) break;
    ticks.push_back(tick);
  }
  return ticks;
}

std::vector<Tick> decade_ticks(Tick last) {
  std::vector<Tick> ticks;
  for (int i = kTicksInDecade; i >= 0; --i) {
    const double share = std::pow(10, -static_cast<double>(i) / kTicksInDecade);
    ticks.push_back(std::llround(std::ceil(static_cast<double>(last) * share * (1 - 1e-12))));
  }
  ticks.erase(std::unique(ticks.begin(), ticks.end()), ticks.end());
  return ticks;
}

double distance_to_edge_m(const Eigen::Vector3d& x_m, const Box& domain) {
  const Eigen::Vector3d low = x_m - domain.origin_m, high = domain.size_m - low;
  const Eigen::Vector3d nearest = low.cwiseMin(high);
  return domain.planar() ? nearest.head<2>().minCoeff() : nearest.minCoeff();
}

}  // namespace

StudyMeasure::StudyMeasure(const Mission& mission)
    : mission_(mission),
      team_(mission),
      objects_(mission),
      reports_(mission),
      confirmations_(mission),
      finds_(mission.objects.total()),
      escape_distance_m_(lab::escape_distance_m(mission.domain)),
      at_edge_m_(kAtEdgeShare * mission.domain.shortest_side_m()),
      ladder_(ladder_ticks(mission.timing.dt_s, mission.timing.tick_count - 1)),
      decade_(decade_ticks(mission.timing.tick_count - 1)) {
  std::merge(ladder_.begin(), ladder_.end(), decade_.begin(), decade_.end(),
             std::back_inserter(ticks_));
  ticks_.erase(std::unique(ticks_.begin(), ticks_.end()), ticks_.end());
  metrics_.assign(ticks_.size(), kNone);
  figures_.seed = mission.seed;
  figures_.agents = static_cast<std::int32_t>(mission.starts_m.size());
  figures_.escape_time_s.fill(kNone);
  for (std::size_t i = 0; i < mission.starts_m.size(); ++i) {
    manifolds_.push_back(lab::manifold_at(mission.starts_m[i], mission.domain));
    if (manifolds_.back()) figures_.escape_time_s[i] = kNever;
  }
}

void StudyMeasure::position(std::size_t agent, Tick tick, const Eigen::Vector3d& x_m, bool covers) {
  ++positions_;
  const auto id = static_cast<AgentId>(agent);
  team_.see(id, tick, x_m, covers);
  if (covers) {
    const ObjectSet detected = objects_.detected(id, tick, x_m);
    const std::int32_t cell = reports_.cell(id, tick, x_m, detected, objects_.places_m());
    finds_.note(confirmations_.see(id, tick, x_m, detected, cell),
                {.agent = id, .tick = tick, .t_s = t_s(tick), .x_m = x_m});
  }
  const double offset2_m2 = (x_m - mission_.law.contraction_center_m).squaredNorm();
  offset2_sum_m2_ += offset2_m2;
  figures_.offset2_max_m2 = std::max(figures_.offset2_max_m2, offset2_m2);
  if (distance_to_edge_m(x_m, mission_.domain) < at_edge_m_) ++at_edge_;
  double& escape_time_s = figures_.escape_time_s[agent];
  if (escape_time_s == kNever && manifolds_[agent]->distance_m(x_m) > escape_distance_m_) {
    escape_time_s = t_s(tick);
  }
}

void StudyMeasure::command(const Eigen::Vector3d& v_mps) {
  ++commands_;
  speed_sum_mps_ += v_mps.norm();
}

void StudyMeasure::metric(Tick tick, double metric) {
  // In real time a tick may be missing: the next one takes its place.
  for (; next_ < ticks_.size() && ticks_[next_] <= tick; ++next_) metrics_[next_] = metric;
}

double StudyMeasure::sampled_metric(Tick tick) const {
  const auto at = std::lower_bound(ticks_.begin(), ticks_.end(), tick) - ticks_.begin();
  return metrics_[static_cast<std::size_t>(at)];
}

double StudyMeasure::slope() const {
  std::vector<double> times_s, metrics;
  for (const Tick tick : decade_) {
    times_s.push_back(t_s(tick));
    metrics.push_back(sampled_metric(tick));
  }
  return log_log_slope(times_s, metrics).value_or(kNone);
}

StudyFigures StudyMeasure::figures() const {
  ERGOCAST_REQUIRE(positions_ > 0);
  StudyFigures figures = figures_;
  figures.complete = next_ == ticks_.size();
  figures.metric_at.fill(kNone);
  for (std::size_t i = 0; i < ladder_.size(); ++i)
    figures.metric_at[i] = sampled_metric(ladder_[i]);
  figures.metric = metrics_.back();
  figures.slope = slope();
  const TeamFigures team = team_.figures();
  figures.detection_probability = team.detection_probability;
  figures.half_time_s = team.half_time_s.value_or(kNever);
  figures.four_fifths_time_s = team.four_fifths_time_s.value_or(kNever);
  figures.greatest_age_s = team.greatest_age_s;
  figures.wasserstein_m = team.wasserstein_m;
  figures.path_m = team.path_m;
  const bool any = finds_.objects() > 0;
  figures.objects_found = any ? static_cast<double>(finds_.list().size()) : kNone;
  figures.wrong_confirmations =
      mission_.sensor.has_false_alarms() ? static_cast<double>(confirmations_.wrong()) : kNone;
  const double first_s = finds_.list().empty() ? kNever : finds_.list().front().t_s;
  figures.first_find_time_s = any ? first_s : kNone;
  figures.offset2_mean_m2 = offset2_sum_m2_ / static_cast<double>(positions_);
  figures.edge_share = static_cast<double>(at_edge_) / static_cast<double>(positions_);
  figures.speed_mean_mps = commands_ > 0 ? speed_sum_mps_ / static_cast<double>(commands_) : kNone;
  return figures;
}

}  // namespace ergocast::studies
