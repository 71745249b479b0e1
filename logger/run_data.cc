// SPDX-License-Identifier: BSD-3-Clause
// Reads the tables row by row, stops a segment at its first damaged row, and samples the
// coverage again.
#include "logger/run_data.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "core/motion/home.h"
#include "logger/amendments_file.h"
#include "logger/recorder.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "logger/table_lines.h"
#include "modes/provide.h"
#include "modes/table_file.h"
#include "plan/plan.h"
#include "text/input_file.h"

namespace ergocast {
namespace {

constexpr std::size_t kMostColumns = 9;  // of either table
/// The numbers of a row, as many as its header has names.
struct Fields {
  std::array<double, kMostColumns> at;
  std::size_t count;
  std::size_t axes;  // of a place in it

  double operator[](std::size_t column) const { return at[column]; }
};

/// Larger than any mission; squares and sums of such numbers are still finite.
constexpr double kLargest = 1e100;

/// Reads fields.count numbers separated by commas, and nothing else. Returns the first column that
/// is no number, fields.count if more text follows, or nothing if all is right.
std::optional<std::size_t> first_bad_column(std::string_view line, Fields& fields) {
  const char* at = line.data();
  const char* const end = at + line.size();
  for (std::size_t i = 0; i < fields.count; ++i) {
    if (i > 0 && at == end) return i;
    if (i > 0 && *at++ != ',') return i - 1;
    const auto [next, error] = std::from_chars(at, end, fields.at[i]);
    if (error != std::errc() || !(std::abs(fields.at[i]) <= kLargest)) return i;
    at = next;
  }
  if (at != end) return fields.count;
  return {};
}

/// "agent", the name of a column in the header of its table.
std::string_view name_of(std::size_t column, std::string_view header) {
  for (; column > 0; --column) header.remove_prefix(header.find(',') + 1);
  return header.substr(0, header.find(','));
}

std::size_t columns_of(std::string_view header) {
  return 1 + static_cast<std::size_t>(std::ranges::count(header, ','));
}

std::string not_numbers(const std::string& line, std::size_t column, std::string_view header) {
  const std::size_t columns = columns_of(header);
  return "expected " + std::to_string(columns) + " numbers separated by commas, found " +
         in_quotes(line) +
         (column == columns ? ", which goes on"
                            : ", whose " + std::string(name_of(column, header)) + " is no number");
}

/// Passes each row to `accept`, which returns the error of the row or nothing. After a bad row the
/// rest of its segment is skipped.
std::optional<std::string> read_table(
    const std::filesystem::path& run_dir, const char* table, std::vector<std::string> headers,
    const std::function<std::optional<std::string>(const Fields&)>& accept) {
  TableLines lines(run_dir, table, std::move(headers));
  std::optional<std::string> damage;
  do {
    std::optional<std::string> wrong;
    for (std::string line; !wrong && lines.next(line);) {
      const std::size_t axes = lines.header().find(",z_m") == std::string::npos ? 2 : 3;
      Fields fields{{}, columns_of(lines.header()), axes};
      const std::optional<std::size_t> bad = first_bad_column(line, fields);
      wrong = bad ? not_numbers(line, *bad, lines.header()) : accept(fields);
    }
    if (damage) continue;
    damage = wrong ? lines.place() + *wrong +
                         ": copy the file again from where it was recorded, or "
                         "cut it off before this line"
                   : lines.problem();
  } while (lines.skip_segment());
  return damage;
}

constexpr double kExact = 0x1p53;     // larger whole numbers are not all doubles
constexpr double kMostSaid = 0x1p62;  // more than all agents together can report

bool is_count(double value, double most = kExact) {
  return value >= 0 && value <= most && value == std::floor(value);
}

/// Reads what a sensor saw, from a column on, if the table has it.
std::optional<std::string> add_seen(TrackPoint& point, const Fields& f, std::size_t column) {
  if (f.count <= column) return {};
  if (!is_count(f[column], std::numeric_limits<ObjectSet>::max()))
    return "the objects detected are not a whole number of 32 bits";
  point.detected = static_cast<ObjectSet>(f[column]);
  if (f.count <= ++column) return {};
  if (f[column] != kNoCell && !is_count(f[column], kMaxSearchCells - 1))
    return "the cell reported is neither -1 nor a whole number below " +
           std::to_string(kMaxSearchCells);
  point.reported_cell = static_cast<std::int32_t>(f[column]);
  return {};
}

std::optional<std::string> add_point(RunData& run, const Fields& f) {
  if (!is_count(f[0]) || f[1] < 0) return "the tick is not a whole number ≥ 0 at a time ≥ 0";
  if (!is_count(f[2]) || f[2] >= kMaxAgents) {
    return "the agent is not a whole number below " + std::to_string(kMaxAgents);
  }
  const auto agent = static_cast<AgentId>(f[2]);
  TrackPoint point{static_cast<Tick>(f[0]), f[1]};
  for (std::size_t axis = 0; axis < f.axes; ++axis) {
    point.x_m[static_cast<Eigen::Index>(axis)] = f[3 + axis];
    point.v_mps[static_cast<Eigen::Index>(axis)] = f[3 + f.axes + axis];
  }
  if (auto wrong = add_seen(point, f, 3 + 2 * f.axes)) return wrong;
  const auto track = run.tracks.find(agent);
  if (track != run.tracks.end() &&
      (point.tick <= track->second.back().tick || point.t_s <= track->second.back().t_s)) {
    return "the tick or its time does not follow the agent's previous row";
  }
  run.tracks[agent].push_back(point);
  return {};
}

std::optional<std::string> add_metrics(RunData& run, const Fields& f) {
  if (!is_count(f[0]) || f[1] < 0) return "the tick is not a whole number ≥ 0 at a time ≥ 0";
  if (!is_count(f[6], kMostSaid) || !is_count(f[7], kMostSaid)) {
    return "the contributions received and lost are not whole numbers ≥ 0";
  }
  if (f[3] < 0 || f[3] > 1) return "the detection probability is not between 0 and 1";
  if (f[8] < 0 || f[8] > 1) return "the blocked share is not between 0 and 1";
  const MetricsRow row{static_cast<Tick>(f[0]), f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8]};
  if (!run.metrics.empty() &&
      (row.tick <= run.metrics.back().tick || row.t_s <= run.metrics.back().t_s)) {
    return "the tick or its time does not follow the previous row";
  }
  run.metrics.push_back(row);
  return {};
}

}  // namespace

Eigen::Vector3d came_with_mps(const Track& track, Tick tick) {
  const auto at = std::ranges::lower_bound(track, tick, {}, &TrackPoint::tick);
  if (at == track.begin() || std::prev(at)->tick + 1 != tick)
    return Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  return std::prev(at)->v_mps;
}

bool RecordedRests::rests(AgentId id, Tick tick) const {
  const auto recall = run_.recalls.find(id);
  return (recall != run_.recalls.end() && tick >= recall->second) ||
         ends_.rests(mission_, id, counted_ticks(run_.holds(), tick)) || charges(id, tick);
}

bool RecordedRests::charges(AgentId id, Tick tick) const {
  if (battery_of(mission_, id) == nullptr) return false;
  const Track& track = run_.tracks.at(id);
  const auto at = std::ranges::lower_bound(track, tick, {}, &TrackPoint::tick);
  return at != track.end() && at->tick == tick &&
         ergocast::charges(mission_, id, at->x_m, came_with_mps(track, tick));
}

double RunData::end_s() const {
  double end_s = metrics.empty() ? 0 : metrics.back().t_s;
  for (const auto& [agent, track] : tracks) end_s = std::max(end_s, track.back().t_s);
  return end_s;
}

Result<Mission> read_mission(const std::filesystem::path& run_dir) {
  const auto file = run_dir / kPlanFile;
  const std::string name = file.string() + ": ";
  const auto plan = read_whole(file, kMaxPlanBytes);
  if (!plan) {
    const bool missing = plan.error().kind == FileProblem::Kind::kMissing;
    return failure(name + (missing ? "missing or not readable" : plan.error().what) +
                   ": is this a run directory?");
  }
  auto read = decode_plan(std::as_bytes(std::span(*plan)));
  if (!read) return failure(name + read.error());
  Mission& mission = *read;
  if (mission.basis.free_domain) {
    auto table = load_table(run_dir / table_file_name(mission.basis.table_hash));
    if (table) keep_table(*std::move(table));
  }
  if (const auto problem = provide_table(mission)) return failure(name + *problem);
  return read;
}

Result<RunData> read_tracks(const std::filesystem::path& run_dir) {
  RunData run;
  auto problem = read_table(run_dir, kTrajectoryFile, trajectory_headers(),
                            [&run](const Fields& fields) { return add_point(run, fields); });
  if (problem) return failure(*problem);
  return run;
}

std::optional<std::string> read_up_to_damage(const std::filesystem::path& run_dir, RunData& run) {
  const auto trajectory =
      read_table(run_dir, kTrajectoryFile, trajectory_headers(),
                 [&run](const Fields& fields) { return add_point(run, fields); });
  const auto metrics =
      read_table(run_dir, kMetricsFile, {kMetricsHeader},
                 [&run](const Fields& fields) { return add_metrics(run, fields); });
  return trajectory ? trajectory : metrics;
}

Result<RunData> read_run(const std::filesystem::path& run_dir, const Mission& mission) {
  RunData run;
  if (auto problem = read_up_to_damage(run_dir, run)) return failure(*problem);
  const auto summary = read_summary(run_dir);
  const auto known = summary.value_or(nlohmann::ordered_json());
  auto amendments = recorded_amendments(run_dir, known, mission);
  if (!amendments) return failure(amendments.error());
  run.amendments = *std::move(amendments);
  run.recalls = recorded_recalls(run_dir, known);
  return run;
}

void for_each_row(const RunData& run,
                  const std::function<void(AgentId, const TrackPoint&)>& visit) {
  std::map<AgentId, std::span<const TrackPoint>> ahead(run.tracks.begin(), run.tracks.end());
  while (!ahead.empty()) {
    Tick tick = std::numeric_limits<Tick>::max();
    for (const auto& [agent, rows] : ahead) tick = std::min(tick, rows.front().tick);
    for (auto& [agent, rows] : ahead) {
      if (rows.front().tick != tick) continue;
      visit(agent, rows.front());
      rows = rows.subspan(1);
    }
    std::erase_if(ahead, [](const auto& track) { return track.second.empty(); });
  }
}

std::optional<PowerLaw> fit_last_decade(const RunData& run) {
  std::vector<double> t_s, values;
  for (const MetricsRow& row : run.metrics) {
    const Tick counted = counted_ticks(run.holds(), row.tick);
    const bool same = counted == row.tick;
    t_s.push_back(same ? row.t_s
                       : row.t_s * static_cast<double>(counted) / static_cast<double>(row.tick));
    values.push_back(row.ergodic_metric);
  }
  return fit_last_decade(t_s, values);
}

Coefficients coverage_of(const RunData& run, const Mission& mission) {
  Coefficients sums = Coefficients::Zero(mission.basis.mode_count());
  double samples = 0;
  const Sensors sensors(mission);
  const RecordedRests rests(run, mission);
  for (const auto& [agent, track] : run.tracks) {
    const Sensor& sensor = sensors.of(planned_kind(mission, agent));
    for (const TrackPoint& point : track) {
      if (!mission.domain.contains(point.x_m) || is_held(run.holds(), point.tick)) continue;
      if (rests.rests(agent, point.tick)) continue;
      samples += sensor.sample(BasisAt(point.x_m, mission.domain, mission.basis), mission.basis, 1,
                               sums.data());
    }
  }
  if (samples > 0) sums /= samples;
  return sums;
}

}  // namespace ergocast
