// SPDX-License-Identifier: BSD-3-Clause
// The mock robot on CycloneDDS, by its C interface.
#include <dds/dds.h>

#include <cmath>
#include <stdexcept>

#include "ros_types.h"
#include "tests/bridges/ros2/robot_port.h"

namespace ergocast::test {
namespace {

dds_entity_t must(dds_entity_t made) {
  if (made < 0) throw std::runtime_error(dds_strretcode(made));
  return made;
}

class CyclonePort final : public RobotPort {
 public:
  explicit CyclonePort(const PortOptions& options)
      : options_(options), participant_(must(dds_create_participant(0, nullptr, nullptr))) {
    dds_qos_t* commands = dds_create_qos();
    dds_qset_reliability(commands, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    if (options.latched_commands) dds_qset_durability(commands, DDS_DURABILITY_TRANSIENT_LOCAL);
    reader_ =
        must(dds_create_reader(participant_,
                               topic(options.stamped ? geometry_msgs_msg_dds__TwistStamped__desc
                                                     : geometry_msgs_msg_dds__Twist__desc,
                                     options.name + "/cmd_vel"),
                               commands, nullptr));
    dds_delete_qos(commands);
    const std::string position = options.name + (options.pose ? "/pose" : "/odom");
    position_ = topic(
        options.pose ? geometry_msgs_msg_dds__PoseStamped__desc : nav_msgs_msg_dds__Odometry__desc,
        options.position_topic.empty() ? position : options.position_topic);
    writer_ = new_writer();
  }
  ~CyclonePort() override { dds_delete(participant_); }

  std::optional<TwistNumbers> take() override {
    void* sample[1] = {nullptr};
    dds_sample_info_t info[1];
    std::optional<TwistNumbers> twist;
    while (dds_take(reader_, sample, info, 1, 1) > 0) {
      if (info[0].valid_data) twist = numbers_of(sample[0]);
      dds_return_loan(reader_, sample, 1);
    }
    return twist;
  }

  void send(const PositionNumbers& at) override {
    if (options_.pose) {
      geometry_msgs_msg_dds__PoseStamped_ message{header_of(at), pose_of(at)};
      dds_write(writer_, &message);
      return;
    }
    nav_msgs_msg_dds__Odometry_ message{};
    message.header = header_of(at);
    message.child_frame_id = const_cast<char*>(at.base_frame.c_str());
    message.pose.pose = pose_of(at);
    message.twist.twist.linear = {at.twist[0], at.twist[1], 0};
    message.twist.twist.angular = {0, 0, at.twist[2]};
    dds_write(writer_, &message);
  }

  void set_second(bool second) override {
    if (second == (second_ != 0)) return;
    if (second) {
      second_ = new_writer();
    } else {
      dds_delete(second_);
      second_ = 0;
    }
  }

 private:
  dds_entity_t topic(const dds_topic_descriptor_t& type, const std::string& name) const {
    return must(dds_create_topic(participant_, &type, ("rt/" + name).c_str(), nullptr, nullptr));
  }
  dds_entity_t new_writer() const {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(
        qos, options_.best_effort ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE, 0);
    const dds_entity_t writer = must(dds_create_writer(participant_, position_, qos, nullptr));
    dds_delete_qos(qos);
    return writer;
  }
  TwistNumbers numbers_of(const void* sample) const {
    const auto& twist =
        options_.stamped ? static_cast<const geometry_msgs_msg_dds__TwistStamped_*>(sample)->twist
                         : *static_cast<const geometry_msgs_msg_dds__Twist_*>(sample);
    return {twist.linear.x, twist.linear.y, twist.angular.z};
  }
  static std_msgs_msg_dds__Header_ header_of(const PositionNumbers& at) {
    return {{static_cast<std::int32_t>(at.stamp_ns / 1'000'000'000),
             static_cast<std::uint32_t>(at.stamp_ns % 1'000'000'000)},
            const_cast<char*>(at.frame.c_str())};
  }
  static geometry_msgs_msg_dds__Pose_ pose_of(const PositionNumbers& at) {
    return {{at.x_m, at.y_m, 0}, {0, 0, std::sin(at.yaw_rad / 2), std::cos(at.yaw_rad / 2)}};
  }

  PortOptions options_;
  dds_entity_t participant_, reader_ = 0, position_ = 0, writer_ = 0, second_ = 0;
};

}  // namespace

std::unique_ptr<RobotPort> make_port(const PortOptions& options) {
  return std::make_unique<CyclonePort>(options);
}

}  // namespace ergocast::test
