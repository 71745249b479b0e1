// SPDX-License-Identifier: BSD-3-Clause
// Goes through the record once, and shows what a display would have shown at each of its times.
#include <cmath>
#include <map>
#include <string>

#include "report/export/changes.h"
#include "report/export/exports.h"
#include "report/export/mcap_writer.h"
#include "report/export/ros_messages.h"
#include "report/export/team_so_far.h"
#include "text/shortest.h"

namespace ergocast {
namespace {

/// The number of pictures of grids and paths: evenly spaced in time, the last at the end.
constexpr int kPictures = 20;

class Ros2Export {
 public:
  Ros2Export(const ExportRecord& record, const std::filesystem::path& file)
      : record_(record), writer_(file, kMcapRos2), team_(record) {}

  std::optional<std::string> write() {
    writer_.add_metadata("ergocast", single_values(record_));
    logs();
    metrics();
    targets();
    queue_.sort();
    rows();
    queue_.write_until(UINT64_MAX, writer_);
    return writer_.finish();
  }

 private:
  McapWriter::Channel channel(const std::string& topic, ros::Type type) {
    const auto known = channels_.find(topic);
    if (known != channels_.end()) return known->second;
    const auto made = writer_.add_channel(topic, ros::name_of(type), ros::schema_of(type));
    return channels_[topic] = made;
  }
  McapWriter::Channel shown(const std::string& name, ros::Type type) {
    return channel("/ergocast/" + name, type);
  }

  /// Lines of logs, and amendments as lines of their operators.
  void logs() {
    const auto topic = channel("/rosout", ros::Type::kLog);
    for (const ExportedLine& line : record_.log) queue_.add(line.time_ns, topic, ros::log(line));
    for (const auto& [amendment, t_s, text] : changes_of(record_)) {
      const std::uint64_t time_ns = record_.time_ns(t_s);
      const std::string line = "amendment " + std::to_string(amendment.number) + ": " + text;
      queue_.add(time_ns, topic, ros::log({time_ns, "info", amendment.by, line}));
    }
  }

  void metrics() {
    const auto phi2 = shown("phi2", ros::Type::kFloat64);
    const auto found = shown("found", ros::Type::kFloat64);
    const auto status = shown("status", ros::Type::kString);
    for (const MetricsRow& row : record_.run.metrics) {
      const std::uint64_t time_ns = record_.time_ns(row.t_s);
      queue_.add(time_ns, phi2, ros::float64(row.ergodic_metric));
      queue_.add(time_ns, found, ros::float64(row.detection_probability));
      queue_.add(time_ns, status, ros::string(status_at(row)));
    }
  }

  std::string status_at(const MetricsRow& row) const {
    const Mission& mission = record_.mission;
    const Tick counted = counted_ticks(record_.run.holds(), row.tick);
    const char* state = is_held(record_.run.holds(), row.tick) ? "paused" : "running";
    return mission.name + ": " + state + ", tick " + std::to_string(counted) + " of " +
           std::to_string(mission.timing.tick_count) + ", φ² = " + shortest(row.ergodic_metric);
  }

  /// The plan's target, and each later one from its tick on.
  void targets() {
    const auto topic = shown("target", ros::Type::kOccupancyGrid);
    const Mission& mission = record_.mission;
    const auto show = [&](double t_s, const Coefficients& target) {
      add_grid(record_.time_ns(t_s), topic, occupancy_of(target, target, mission));
    };
    show(0, mission.target_coefficients);
    for (const ReceivedAmendment& one : record_.run.amendments.all()) {
      if (one.is_void || !one.target) continue;
      show(static_cast<double>(one.amendment.from) * mission.timing.dt_s, one.target->in_cosines());
    }
  }

  void add_grid(std::uint64_t time_ns, McapWriter::Channel topic, const OccupancyGrid& grid) {
    queue_.add(time_ns, topic, ros::occupancy_grid(time_ns, grid, record_.mission.domain.origin_m));
  }

  /// Each tick's places, and a picture of the team where one is due.
  void rows() {
    const double end_s = record_.run.end_s();
    int pictures = 0;
    double last_s = 0;
    std::size_t finds = 0;
    for_each_row(record_.run, [&](AgentId agent, const TrackPoint& point) {
      if (point.t_s > last_s && last_s >= end_s * pictures / kPictures) {
        show_team(record_.time_ns(last_s));
        pictures = 1 + static_cast<int>(std::floor(last_s / end_s * kPictures));
      }
      last_s = point.t_s;
      const std::uint64_t time_ns = record_.time_ns(point.t_s);
      queue_.write_until(time_ns, writer_);
      const std::string name = "agent" + std::to_string(agent);
      writer_.add_message(shown(name + "/odom", ros::Type::kOdometry), time_ns,
                          ros::odometry(time_ns, point, name));
      team_.add(agent, point);
      if (team_.finds().size() == finds) return;
      finds = team_.finds().size();
      show_finds(time_ns);
    });
    show_team(record_.time_ns(last_s));
  }

  /// What a latched topic holds from now on.
  void show(std::uint64_t time_ns, McapWriter::Channel topic, const std::string& message) {
    writer_.add_message(topic, time_ns, message);
  }
  void show_finds(std::uint64_t time_ns) {
    std::vector<Eigen::Vector3d> places_m;
    for (const Find& find : team_.finds()) places_m.push_back(find.x_m);
    show(time_ns, shown("finds", ros::Type::kPoseArray), ros::pose_array(time_ns, places_m));
  }
  void show_team(std::uint64_t time_ns) {
    const Eigen::Vector3d& origin_m = record_.mission.domain.origin_m;
    const auto show_grid = [&](const char* name, const OccupancyGrid& grid) {
      show(time_ns, shown(name, ros::Type::kOccupancyGrid),
           ros::occupancy_grid(time_ns, grid, origin_m));
    };
    if (const OccupancyGrid coverage = team_.coverage(); coverage.width > 0)
      show_grid("coverage", coverage);
    show_grid("left", team_.left());
    for (const auto& [id, path] : team_.paths())
      show(time_ns, shown("agent" + std::to_string(id) + "/path", ros::Type::kPath),
           ros::path(time_ns, path.path_m()));
    show_finds(time_ns);
    show(time_ns, shown("contacts", ros::Type::kPoseArray),
         ros::pose_array(time_ns, team_.contacts_m()));
  }

  const ExportRecord& record_;
  McapWriter writer_;
  TeamSoFar team_;
  std::map<std::string, McapWriter::Channel> channels_;
  McapQueue queue_;
};

}  // namespace

std::optional<std::string> write_ros2_mcap(const ExportRecord& record,
                                           const std::filesystem::path& file) {
  return Ros2Export(record, file).write();
}

}  // namespace ergocast
