// SPDX-License-Identifier: BSD-3-Clause
// Writes each table of the record to a file, with longitude and latitude if the origin is known.
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "logger/recorder.h"
#include "report/export/changes.h"
#include "report/export/exports.h"
#include "text/shortest.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

class Tables {
 public:
  Tables(const ExportRecord& record, const fs::path& folder) : record_(record), folder_(folder) {
    if (record.origin) plane_.emplace(*record.origin);
  }

  std::optional<std::string> write() {
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) return folder_.string() + ": " + error.message();
    trajectory();
    metrics();
    density();
    log();
    amendments();
    return problem_;
  }

 private:
  template <class Rows>
  void table(const char* name, const std::string& header, const Rows& rows) {
    std::ofstream file(folder_ / name, std::ios::binary);
    file << header << '\n';
    rows(file);
    file.close();
    if (!file && !problem_) problem_ = (folder_ / name).string() + ": " + std::strerror(errno);
  }
  std::string place_header() const { return plane_ ? ",longitude_deg,latitude_deg" : ""; }
  std::string place_at(const Eigen::Vector2d& x_m) const {
    if (!plane_) return "";
    const GeoPlace place = plane_->to_place(x_m);
    return ',' + shortest(place.longitude_deg) + ',' + shortest(place.latitude_deg);
  }

  void trajectory() {
    const bool planar = record_.mission.domain.planar();
    const bool with_objects = record_.mission.objects.total() > 0;
    const bool with_reports = record_.mission.sensor.has_false_alarms();
    const std::string header = trajectory_header(record_.mission);
    table("trajectory.csv", header + place_header(), [&](std::ostream& file) {
      for_each_row(record_.run, [&](AgentId agent, const TrackPoint& point) {
        file << point.tick << ',' << shortest(point.t_s) << ',' << agent;
        for (const Eigen::Vector3d& vector : {point.x_m, point.v_mps}) {
          for (int axis = 0; axis < (planar ? 2 : 3); ++axis) file << ',' << shortest(vector[axis]);
        }
        if (with_objects || with_reports) file << ',' << point.detected;
        if (with_reports) file << ',' << point.reported_cell;
        file << place_at(point.x_m.head<2>()) << '\n';
      });
    });
  }

  void metrics() {
    table("metrics.csv",
          "tick,t_s,ergodic_metric,detection_probability,metric_spread,max_staleness_s,"
          "contributions_received,contributions_lost,blocked_share,basis",
          [&](std::ostream& file) {
            for (const MetricsRow& row : record_.run.metrics) {
              file << row.tick;
              for (const double value :
                   {row.t_s, row.ergodic_metric, row.detection_probability, row.spread,
                    row.max_staleness_s, row.received, row.lost, row.blocked_share})
                file << ',' << shortest(value);
              file << ',' << record_.metric_basis << '\n';
            }
          });
  }

  /// The target that held at the end.
  DensityCells last_target() const {
    Tick last = 0;
    for (const auto& [agent, track] : record_.run.tracks) last = std::max(last, track.back().tick);
    const ReceivedAmendment* const change = record_.run.amendments.target_at(last);
    if (change == nullptr) return record_.target;
    return density_of(change->target->in_cosines(), record_.mission, record_.target.rows(),
                      record_.target.cols());
  }

  void density() {
    const DensityCells target = last_target();
    const DensityCells coverage = density_of(coverage_of(record_.run, record_.mission),
                                             record_.mission, target.rows(), target.cols());
    table("density.csv", "x_m,y_m,target,coverage" + place_header(), [&](std::ostream& file) {
      for (Eigen::Index j = 0; j < target.cols(); ++j) {
        for (Eigen::Index i = 0; i < target.rows(); ++i) {
          const Eigen::Vector2d x_m = center_of(i, j, target, record_.mission);
          file << shortest(x_m.x()) << ',' << shortest(x_m.y()) << ',' << shortest(target(i, j))
               << ',' << shortest(coverage(i, j)) << place_at(x_m) << '\n';
        }
      }
    });
  }

  static std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
    return result + '"';
  }

  void log() {
    table("log.csv", "t_s,level,process,message", [&](std::ostream& file) {
      for (const ExportedLine& line : record_.log) {
        const auto since = static_cast<std::int64_t>(line.time_ns - record_.start_ns);
        file << shortest(static_cast<double>(since) / 1e9) << ',' << line.level << ','
             << quoted(line.process) << ',' << quoted(line.text) << '\n';
      }
    });
  }

  void amendments() {
    const std::vector<ExportedChange> changes = changes_of(record_);
    if (changes.empty()) {
      std::error_code none;
      fs::remove(folder_ / "amendments.csv", none);  // of an earlier record
      return;
    }
    table("amendments.csv", "number,kind,from_tick,t_s,change,by", [&](std::ostream& file) {
      for (const auto& [amendment, t_s, text] : changes)
        file << amendment.number << ',' << to_string(amendment.kind) << ',' << amendment.from << ','
             << shortest(t_s) << ',' << quoted(text) << ',' << quoted(amendment.by) << '\n';
    });
  }

  const ExportRecord& record_;
  const fs::path folder_;
  std::optional<LocalPlane> plane_;
  std::optional<std::string> problem_;
};

}  // namespace

std::optional<std::string> write_tables(const ExportRecord& record, const fs::path& folder) {
  return Tables(record, folder).write();
}

}  // namespace ergocast
