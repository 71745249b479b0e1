// SPDX-License-Identifier: BSD-3-Clause
// Each number is aligned to its size, counted from behind the four bytes of the header.
#include "report/export/ros_messages.h"

#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace ergocast::ros {
namespace {

// ---- bytes ----

class Cdr {
 public:
  template <class Number>
  Cdr& number(Number value) {
    while ((bytes_.size() - kHeaderBytes) % sizeof value != 0) bytes_.push_back('\0');
    if constexpr (std::is_same_v<Number, double>) {
      raw(std::bit_cast<std::uint64_t>(value));
    } else if constexpr (std::is_same_v<Number, float>) {
      raw(std::bit_cast<std::uint32_t>(value));
    } else {
      raw(value);
    }
    return *this;
  }
  Cdr& size(std::size_t count) { return number(static_cast<std::uint32_t>(count)); }
  /// With its length, and the zero at its end.
  Cdr& text(std::string_view text) {
    size(text.size() + 1);
    bytes_ += text;
    bytes_.push_back('\0');
    return *this;
  }
  std::string take() { return std::move(bytes_); }

 private:
  static constexpr std::size_t kHeaderBytes = 4;
  template <class Whole>
  void raw(Whole value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
      bytes_.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xff));
  }
  std::string bytes_{0, 1, 0, 0};
};

void put_time(Cdr& cdr, std::uint64_t time_ns) {
  constexpr std::uint64_t kSecond_ns = 1'000'000'000;
  cdr.number(static_cast<std::int32_t>(time_ns / kSecond_ns));
  cdr.number(static_cast<std::uint32_t>(time_ns % kSecond_ns));
}

void put_header(Cdr& cdr, std::uint64_t time_ns) {
  put_time(cdr, time_ns);
  cdr.text(kFrame);
}

void put_vector(Cdr& cdr, const Eigen::Vector3d& v) {
  cdr.number(v.x()).number(v.y()).number(v.z());
}

void put_pose(Cdr& cdr, const Eigen::Vector3d& x_m, double heading_rad = 0) {
  put_vector(cdr, x_m);
  put_vector(cdr, {0, 0, std::sin(heading_rad / 2)});
  cdr.number(std::cos(heading_rad / 2));
}

/// Zero: not known.
void put_covariance(Cdr& cdr) {
  for (int i = 0; i < 36; ++i) cdr.number(0.0);
}

// ---- definitions ----

/// The fields of each type, "TYPE NAME" a line.
const std::map<std::string, std::string, std::less<>> kDefinitions = {
    {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"std_msgs/Float64", "float64 data\n"},
    {"std_msgs/String", "string data\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\ngeometry_msgs/Pose pose\n"},
    {"geometry_msgs/PoseArray", "std_msgs/Header header\ngeometry_msgs/Pose[] poses\n"},
    {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
    {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
    {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
    {"nav_msgs/Odometry",
     "std_msgs/Header header\nstring child_frame_id\n"
     "geometry_msgs/PoseWithCovariance pose\ngeometry_msgs/TwistWithCovariance twist\n"},
    {"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n"},
    {"nav_msgs/MapMetaData",
     "builtin_interfaces/Time map_load_time\nfloat32 resolution\nuint32 width\nuint32 height\n"
     "geometry_msgs/Pose origin\n"},
    {"nav_msgs/OccupancyGrid", "std_msgs/Header header\nnav_msgs/MapMetaData info\nint8[] data\n"},
    {"rcl_interfaces/Log",
     "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\n"
     "string function\nuint32 line\n"},
};

std::string short_name_of(Type type) {
  switch (type) {
    case Type::kFloat64:
      return "std_msgs/Float64";
    case Type::kString:
      return "std_msgs/String";
    case Type::kPoseArray:
      return "geometry_msgs/PoseArray";
    case Type::kOdometry:
      return "nav_msgs/Odometry";
    case Type::kPath:
      return "nav_msgs/Path";
    case Type::kOccupancyGrid:
      return "nav_msgs/OccupancyGrid";
    case Type::kLog:
      return "rcl_interfaces/Log";
  }
  return "";
}

/// Appends the definitions that `name` needs and that are not yet in `known`.
void add_used(const std::string& name, std::set<std::string>& known, std::string& text) {
  const std::string& fields = kDefinitions.at(name);
  for (std::size_t at = 0, end = 0; at < fields.size(); at = end + 1) {
    end = fields.find('\n', at);
    std::string type = fields.substr(at, fields.find(' ', at) - at);
    type.resize(std::min(type.size(), type.find('[')));
    if (!kDefinitions.contains(type) || !known.insert(type).second) continue;
    text += std::string(80, '=') + "\nMSG: " + type + '\n' + kDefinitions.at(type);
    add_used(type, known, text);
  }
}

}  // namespace

std::string name_of(Type type) {
  std::string name = short_name_of(type);
  return name.insert(name.find('/'), "/msg");
}

std::string schema_of(Type type) {
  std::set<std::string> known;
  std::string text = kDefinitions.at(short_name_of(type));
  add_used(short_name_of(type), known, text);
  return text;
}

std::string float64(double value) { return Cdr().number(value).take(); }

std::string string(std::string_view text) { return Cdr().text(text).take(); }

std::string pose_array(std::uint64_t time_ns, const std::vector<Eigen::Vector3d>& places_m) {
  Cdr cdr;
  put_header(cdr, time_ns);
  cdr.size(places_m.size());
  for (const Eigen::Vector3d& x_m : places_m) put_pose(cdr, x_m);
  return cdr.take();
}

std::string odometry(std::uint64_t time_ns, const TrackPoint& point, std::string_view child_frame) {
  Cdr cdr;
  put_header(cdr, time_ns);
  cdr.text(child_frame);
  put_pose(cdr, point.x_m, std::atan2(point.v_mps.y(), point.v_mps.x()));
  put_covariance(cdr);
  put_vector(cdr, {point.v_mps.head<2>().norm(), 0, point.v_mps.z()});
  put_vector(cdr, {0, 0, 0});
  put_covariance(cdr);
  return cdr.take();
}

std::string path(std::uint64_t time_ns, const std::vector<Eigen::Vector3d>& path_m) {
  Cdr cdr;
  put_header(cdr, time_ns);
  cdr.size(path_m.size());
  for (const Eigen::Vector3d& x_m : path_m) {
    put_header(cdr, time_ns);
    put_pose(cdr, x_m);
  }
  return cdr.take();
}

std::string occupancy_grid(std::uint64_t time_ns, const OccupancyGrid& grid,
                           const Eigen::Vector3d& origin_m) {
  Cdr cdr;
  put_header(cdr, time_ns);
  put_time(cdr, time_ns);
  cdr.number(static_cast<float>(grid.resolution_m)).number(grid.width).number(grid.height);
  put_pose(cdr, origin_m);
  cdr.size(grid.data.size());
  for (const std::int8_t cell : grid.data) cdr.number(cell);
  return cdr.take();
}

std::string log(const ExportedLine& line) {
  static const std::map<std::string, std::uint8_t> kLevels = {
      {"trace", 10}, {"debug", 10}, {"info", 20}, {"warning", 30}, {"error", 40}, {"critical", 50}};
  const auto level = kLevels.find(line.level);
  Cdr cdr;
  put_time(cdr, line.time_ns);
  cdr.number(level == kLevels.end() ? std::uint8_t{20} : level->second);
  cdr.text(line.process).text(line.text).text("").text("").number(std::uint32_t{0});
  return cdr.take();
}

}  // namespace ergocast::ros
