// SPDX-License-Identifier: BSD-3-Clause
// Writes the messages of all topics in order of time.
#include <algorithm>
#include <cmath>

#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "report/export/changes.h"
#include "report/export/exports.h"
#include "report/export/foxglove.h"
#include "report/export/mcap_writer.h"

namespace ergocast {
namespace {

/// The number of pictures of the coverage: evenly spaced in time, the last at the mission's end.
constexpr int kCoveragePictures = 20;

class McapExport {
 public:
  McapExport(const ExportRecord& record, const std::filesystem::path& file)
      : record_(record), mission_(record.mission), writer_(file, kMcapJson) {
    if (record.origin) plane_.emplace(*record.origin);
  }

  std::optional<std::string> write() {
    writer_.add_metadata("ergocast", single_values(record_));
    logs();
    amendments();
    metrics();
    targets();
    coverage();
    queue_.sort();
    poses();
    queue_.write_until(UINT64_MAX, writer_);
    return writer_.finish();
  }

 private:
  McapWriter::Channel channel(const std::string& topic, const foxglove::Schema& schema) {
    return writer_.add_channel(topic, schema.name, schema.text);
  }

  void logs() {
    if (record_.log.empty()) return;
    const auto topic = channel("/log", foxglove::log_schema());
    for (const ExportedLine& line : record_.log)
      queue_.add(line.time_ns, topic, foxglove::log(line));
  }

  /// What has changed, as lines of its operators.
  void amendments() {
    const std::vector<ExportedChange> changes = changes_of(record_);
    if (changes.empty()) return;
    const auto topic = channel("/amendments", foxglove::log_schema());
    for (const auto& [amendment, t_s, text] : changes) {
      const std::uint64_t time_ns = record_.time_ns(t_s);
      const std::string line = "amendment " + std::to_string(amendment.number) + ": " + text;
      queue_.add(time_ns, topic, foxglove::log({time_ns, "info", amendment.by, line}));
    }
  }

  void metrics() {
    const auto topic = channel("/metrics", foxglove::metrics_schema());
    for (const MetricsRow& row : record_.run.metrics) {
      const std::uint64_t time_ns = record_.time_ns(row.t_s);
      queue_.add(time_ns, topic, foxglove::metrics(time_ns, row, record_.metric_basis));
    }
  }

  /// The plan's target, and each later one from its tick on.
  void targets() {
    const auto target = channel("/target", foxglove::grid_schema());
    const auto show = [&](double t_s, const DensityCells& cells) {
      const std::uint64_t time_ns = record_.time_ns(t_s);
      queue_.add(time_ns, target, foxglove::grid(time_ns, cells, mission_));
    };
    show(0, record_.target);
    const auto [columns, rows] = coverage_cells(mission_);
    for (const ReceivedAmendment& one : record_.run.amendments.all()) {
      if (one.is_void || !one.target) continue;
      show(static_cast<double>(one.amendment.from) * mission_.timing.dt_s,
           density_of(one.target->in_cosines(), mission_, columns, rows));
    }
  }

  /// Where the team has been, whatever its targets were.
  void coverage() {
    const auto coverage = channel("/coverage", foxglove::grid_schema());
    const auto cells_along = coverage_cells(mission_);
    Coefficients sums = Coefficients::Zero(mission_.basis.mode_count());
    const Sensors sensors(mission_);
    const RecordedRests rests(record_.run, mission_);
    double samples = 0;  // each weighted by its quality
    int shown = 0;
    const double end_s = record_.run.end_s();
    const auto show = [&](double t_s) {
      const std::uint64_t time_ns = record_.time_ns(t_s);
      const DensityCells cells =
          density_of(sums / samples, mission_, cells_along.first, cells_along.second);
      queue_.add(time_ns, coverage, foxglove::grid(time_ns, cells, mission_));
    };
    double last_s = 0;
    for_each_row(record_.run, [&](AgentId agent, const TrackPoint& point) {
      if (point.t_s > last_s && samples > 0 && last_s >= end_s * shown / kCoveragePictures) {
        show(last_s);
        shown = 1 + static_cast<int>(std::floor(last_s / end_s * kCoveragePictures));
      }
      last_s = point.t_s;
      if (!mission_.domain.contains(point.x_m) || rests.rests(agent, point.tick) ||
          is_held(record_.run.holds(), point.tick))
        return;
      samples += sensors.of(planned_kind(mission_, agent))
                     .sample(BasisAt(point.x_m, mission_.domain, mission_.basis), mission_.basis, 1,
                             sums.data());
    });
    if (samples > 0) show(last_s);
  }

  void poses() {
    std::map<AgentId, McapWriter::Channel> poses, places;
    for (const auto& [agent, track] : record_.run.tracks) {
      const std::string name = "/agents/" + std::to_string(agent);
      poses[agent] = channel(name + "/pose", foxglove::pose_schema());
      if (plane_) places[agent] = channel(name + "/location", foxglove::location_schema());
    }
    for_each_row(record_.run, [&](AgentId agent, const TrackPoint& point) {
      const std::uint64_t time_ns = record_.time_ns(point.t_s);
      queue_.write_until(time_ns, writer_);
      writer_.add_message(poses.at(agent), time_ns, foxglove::pose(time_ns, point));
      if (!plane_) return;
      writer_.add_message(
          places.at(agent), time_ns,
          foxglove::location(time_ns, plane_->to_place(point.x_m.head<2>()), point.x_m.z()));
    });
  }

  const ExportRecord& record_;
  const Mission& mission_;
  McapWriter writer_;
  std::optional<LocalPlane> plane_;
  McapQueue queue_;
};

}  // namespace

std::optional<std::string> write_mcap(const ExportRecord& record,
                                      const std::filesystem::path& file) {
  return McapExport(record, file).write();
}

}  // namespace ergocast
