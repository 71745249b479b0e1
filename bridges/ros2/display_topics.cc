// SPDX-License-Identifier: BSD-3-Clause
// Grids, paths, numbers and texts as messages of ROS 2.
#include "bridges/ros2/display_topics.h"

#include <utility>
#include <vector>

#include "bridges/ros2/message_types.h"

namespace ergocast::ros2 {
namespace {

constexpr Quality kLatched{true, Latching::kNewest};

std_msgs_msg_dds__Header_ header_of(const std::string& frame, const Moment& at) {
  return {stamp_of(at.wall_ns), const_cast<char*>(frame.c_str())};
}

geometry_msgs_msg_dds__Pose_ pose_at(const Eigen::Vector3d& x_m) {
  return {{x_m.x(), x_m.y(), x_m.z()}, {0, 0, 0, 1}};
}

}  // namespace

Result<DisplayConnection> DisplayConnection::make(DdsNode& node, const DisplayTopics& topics) {
  DisplayConnection made(node, topics);
  const std::string prefix = topics.prefix + "/";
  const auto open = [&](std::optional<Writer>& writer, const MessageType& type,
                        const std::string& name) -> std::optional<std::string> {
    auto opened = Writer::make(node, type, prefix + name, kLatched);
    if (!opened) return opened.error();
    writer = *std::move(opened);
    return std::nullopt;
  };
  for (const auto& problem :
       {open(made.coverage_, kOccupancyGrid, "coverage"),
        open(made.target_, kOccupancyGrid, "target"), open(made.left_, kOccupancyGrid, "left"),
        open(made.metric_, kFloat64, "phi2"), open(made.found_, kFloat64, "found"),
        open(made.finds_, kPoseArray, "finds"), open(made.contacts_, kPoseArray, "contacts"),
        open(made.status_, kString, "status")}) {
    if (problem) return failure(*problem);
  }
  return made;
}

void DisplayConnection::show(const Display& display, const Moment& at) {
  const Display::Status status = display.status(at.now);
  if (status.ergodic_metric) {
    const std_msgs_msg_dds__Float64_ metric{*status.ergodic_metric};
    metric_->write(&metric);
  }
  if (status.found) {
    const std_msgs_msg_dds__Float64_ found{*status.found};
    found_->write(&found);
  }
  show_places(*finds_, status.finds_m, at);
  show_places(*contacts_, status.contacts_m, at);
  const std_msgs_msg_dds__String_ text{const_cast<char*>(status.text.c_str())};
  status_->write(&text);
  if (target_number_ != display.target_number()) {
    target_number_ = display.target_number();
    show_grid(*target_, display.target(), display.domain(), at);
  }
  if (const OccupancyGrid coverage = display.coverage(); coverage.width > 0)
    show_grid(*coverage_, coverage, display.domain(), at);
  show_grid(*left_, display.left(), display.domain(), at);
  for (const auto& [id, path] : display.paths()) show_path(id, path.path_m(), at);
}

void DisplayConnection::show_grid(Writer& writer, const OccupancyGrid& grid, const Box& domain,
                                  const Moment& at) {
  nav_msgs_msg_dds__OccupancyGrid_ message{};
  message.header = header_of(topics_.frame.name, at);
  message.info.map_load_time = message.header.stamp;
  message.info.resolution = static_cast<float>(grid.resolution_m);
  message.info.width = grid.width;
  message.info.height = grid.height;
  message.info.origin = pose_at(domain.origin_m - topics_.frame.origin_m);
  const auto size = static_cast<std::uint32_t>(grid.data.size());
  message.data = {size, size, const_cast<std::int8_t*>(grid.data.data()), false};
  writer.write(&message);
}

void DisplayConnection::show_places(Writer& writer, const std::vector<Eigen::Vector3d>& places_m,
                                    const Moment& at) {
  std::vector<geometry_msgs_msg_dds__Pose_> poses;
  for (const Eigen::Vector3d& x_m : places_m)
    poses.push_back(pose_at(x_m - topics_.frame.origin_m));
  const auto size = static_cast<std::uint32_t>(poses.size());
  const geometry_msgs_msg_dds__PoseArray_ message{header_of(topics_.frame.name, at),
                                                  {size, size, poses.data(), false}};
  writer.write(&message);
}

void DisplayConnection::show_path(AgentId id, const std::vector<Eigen::Vector3d>& path_m,
                                  const Moment& at) {
  auto writer = paths_.find(id);
  if (writer == paths_.end()) {
    auto made = Writer::make(*node_, kPath,
                             topics_.prefix + "/agent" + std::to_string(id) + "/path", kLatched);
    if (!made) return;
    writer = paths_.emplace(id, *std::move(made)).first;
  }
  const std_msgs_msg_dds__Header_ header = header_of(topics_.frame.name, at);
  std::vector<geometry_msgs_msg_dds__PoseStamped_> poses;
  for (const Eigen::Vector3d& x_m : path_m)
    poses.push_back({header, pose_at(x_m - topics_.frame.origin_m)});
  const auto size = static_cast<std::uint32_t>(poses.size());
  const nav_msgs_msg_dds__Path_ message{header, {size, size, poses.data(), false}};
  writer->second.write(&message);
}

}  // namespace ergocast::ros2
