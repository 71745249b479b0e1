// SPDX-License-Identifier: BSD-3-Clause
// The topics of a display; late subscribers get the newest message of each.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bridges/ros2/bridge_file.h"
#include "bridges/ros2/dds_node.h"
#include "bridges/ros2/display.h"

namespace ergocast::ros2 {

class DisplayConnection {
 public:
  static Result<DisplayConnection> make(DdsNode& node, const DisplayTopics& topics);

  /// Publishes all that has changed; call it once a second. @pre display.begun()
  void show(const Display& display, const Moment& at);

 private:
  DisplayConnection(DdsNode& node, DisplayTopics topics)
      : node_(&node), topics_(std::move(topics)) {}
  void show_grid(Writer& writer, const OccupancyGrid& grid, const Box& domain, const Moment& at);
  void show_places(Writer& writer, const std::vector<Eigen::Vector3d>& places_m, const Moment& at);
  void show_path(AgentId id, const std::vector<Eigen::Vector3d>& path_m, const Moment& at);

  DdsNode* node_;
  DisplayTopics topics_;
  std::optional<Writer> coverage_, target_, left_, metric_, found_, finds_, contacts_, status_;
  std::map<AgentId, Writer> paths_;
  std::optional<std::int32_t> target_number_;  // that was shown
};

}  // namespace ergocast::ros2
