// SPDX-License-Identifier: BSD-3-Clause
// The mock robot on eProsima Fast DDS, with types of its own generator.
#include <cmath>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <stdexcept>

#include "ros_typesPubSubTypes.h"
#include "tests/bridges/ros2/robot_port.h"

namespace ergocast::test {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace geometry = geometry_msgs::msg::dds_;
namespace nav = nav_msgs::msg::dds_;

template <class T>
T* must(T* made) {
  if (made == nullptr) throw std::runtime_error("Fast DDS has refused an entity");
  return made;
}

class FastPort final : public RobotPort {
 public:
  explicit FastPort(const PortOptions& options)
      : options_(options),
        participant_(must(dds::DomainParticipantFactory::get_instance()->create_participant(
            0, dds::PARTICIPANT_QOS_DEFAULT))),
        publisher_(must(participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT))),
        subscriber_(must(participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT))) {
    dds::DataReaderQos commands;
    commands.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    commands.history().depth = 1;
    if (options.latched_commands) commands.durability().kind = dds::TRANSIENT_LOCAL_DURABILITY_QOS;
    dds::TypeSupport twist = options.stamped
                                 ? dds::TypeSupport(new geometry::TwistStamped_PubSubType())
                                 : dds::TypeSupport(new geometry::Twist_PubSubType());
    reader_ =
        must(subscriber_->create_datareader(topic(twist, options.name + "/cmd_vel"), commands));
    const std::string position = options.name + (options.pose ? "/pose" : "/odom");
    dds::TypeSupport type = options.pose ? dds::TypeSupport(new geometry::PoseStamped_PubSubType())
                                         : dds::TypeSupport(new nav::Odometry_PubSubType());
    position_ = topic(type, options.position_topic.empty() ? position : options.position_topic);
    writer_ = new_writer();
  }

  std::optional<TwistNumbers> take() override {
    std::optional<TwistNumbers> newest;
    dds::SampleInfo info;
    while (true) {
      geometry::TwistStamped_ stamped;
      void* sample = options_.stamped ? static_cast<void*>(&stamped) : &stamped.twist();
      if (reader_->take_next_sample(sample, &info) != ReturnCode_t::RETCODE_OK) return newest;
      const geometry::Twist_& twist = stamped.twist();
      if (info.valid_data)
        newest = TwistNumbers{twist.linear().x(), twist.linear().y(), twist.angular().z()};
    }
  }

  void send(const PositionNumbers& at) override {
    nav::Odometry_ message;
    message.header().stamp().sec(static_cast<std::int32_t>(at.stamp_ns / 1'000'000'000));
    message.header().stamp().nanosec(static_cast<std::uint32_t>(at.stamp_ns % 1'000'000'000));
    message.header().frame_id(at.frame);
    message.child_frame_id(at.base_frame);
    geometry::Pose_& pose = message.pose().pose();
    pose.position().x(at.x_m);
    pose.position().y(at.y_m);
    pose.orientation().z(std::sin(at.yaw_rad / 2));
    pose.orientation().w(std::cos(at.yaw_rad / 2));
    geometry::Twist_& twist = message.twist().twist();
    twist.linear().x(at.twist[0]);
    twist.linear().y(at.twist[1]);
    twist.angular().z(at.twist[2]);
    if (!options_.pose) {
      writer_->write(&message);
      return;
    }
    geometry::PoseStamped_ stamped;
    stamped.header(message.header());
    stamped.pose(pose);
    writer_->write(&stamped);
  }

  void set_second(bool second) override {
    if (second == (second_ != nullptr)) return;
    if (second) {
      second_ = new_writer();
    } else {
      publisher_->delete_datawriter(second_);
      second_ = nullptr;
    }
  }

 private:
  dds::Topic* topic(dds::TypeSupport type, const std::string& name) {
    type.register_type(participant_);
    return must(
        participant_->create_topic("rt/" + name, type.get_type_name(), dds::TOPIC_QOS_DEFAULT));
  }
  dds::DataWriter* new_writer() {
    dds::DataWriterQos qos;
    qos.reliability().kind =
        options_.best_effort ? dds::BEST_EFFORT_RELIABILITY_QOS : dds::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
    return must(publisher_->create_datawriter(position_, qos));
  }

  PortOptions options_;
  dds::DomainParticipant* participant_;
  dds::Publisher* publisher_;
  dds::Subscriber* subscriber_;
  dds::DataReader* reader_ = nullptr;
  dds::Topic* position_ = nullptr;
  dds::DataWriter *writer_ = nullptr, *second_ = nullptr;
};

}  // namespace

std::unique_ptr<RobotPort> make_port(const PortOptions& options) {
  return std::make_unique<FastPort>(options);
}

}  // namespace ergocast::test
