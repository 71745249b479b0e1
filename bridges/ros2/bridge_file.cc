// SPDX-License-Identifier: BSD-3-Clause
// Protobuf's text format, with the line of each field that is refused.
#include "bridges/ros2/bridge_file.h"

#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "bridges/ros2/bridge.pb.h"
#include "text/input_file.h"
#include "text/printable.h"
#include "text/shortest.h"

namespace ergocast::ros2 {
namespace {

using google::protobuf::TextFormat;
using Locations = TextFormat::ParseInfoTree;

constexpr int kMaxDepth = 8;
constexpr int kGreatestDomain = 232;  // the last one with ports of its own
constexpr double kFarthest_m = 1e7;

/// The first error of the parser.
class FirstError : public google::protobuf::io::ErrorCollector {
 public:
  void AddError(int line, int, const std::string& message) override {
    if (!text.empty()) return;
    at_line = std::max(line, 0) + 1;
    text = printable(message.substr(0, 200));
  }

  int at_line = 0;
  std::string text;
};

/// A problem that has a place; thrown and caught in this file.
struct Refused {
  int line;
  std::string text;
};

/// One block of the file: refuses its fields, with their lines.
class Block {
 public:
  Block(const google::protobuf::Message& message, const Locations* locations, int line,
        std::string path)
      : message_(message), locations_(locations), line_(line), path_(std::move(path)) {}

  Block nested(const google::protobuf::Message& message, const std::string& field,
               int index = -1) const {
    const auto* descriptor = message_.GetDescriptor()->FindFieldByName(field);
    const std::string step = index < 0 ? field : field + "[" + std::to_string(index) + "]";
    return {message,
            locations_ == nullptr ? nullptr : locations_->GetTreeForNested(descriptor, index),
            line_of(field, index), path_.empty() ? step : path_ + "." + step};
  }

  [[noreturn]] void refuse(const std::string& field, const std::string& problem) const {
    throw Refused{line_of(field, -1), (path_.empty() ? "" : path_ + ".") + field + ": " + problem};
  }

  /// @pre the field is a double
  double number(const std::string& field, double low, double high) const {
    const auto* descriptor = message_.GetDescriptor()->FindFieldByName(field);
    const double value = message_.GetReflection()->GetDouble(message_, descriptor);
    if (!(value >= low && value <= high))
      refuse(field, shortest(value) + " is not from " + shortest(low) + " to " + shortest(high));
    return value;
  }

  double positive(const std::string& field, double high) const {
    const double value = number(field, 0, high);
    if (value == 0) refuse(field, "is missing; give the robot's own limit");
    return value;
  }

  std::string text(const std::string& field) const {
    const auto* descriptor = message_.GetDescriptor()->FindFieldByName(field);
    return message_.GetReflection()->GetString(message_, descriptor);
  }

  /// The name of a topic, as ROS 2 allows it.
  std::string topic(const std::string& field) const {
    const std::string name = text(field);
    if (name.empty()) refuse(field, "is missing; name a topic, such as 'robot1/" + field + "'");
    const auto topic = topic_named(name);
    if (!topic) refuse(field, no_topic(name));
    return *topic;
  }

 private:
  int line_of(const std::string& field, int index) const {
    if (locations_ == nullptr) return line_;
    const auto* descriptor = message_.GetDescriptor()->FindFieldByName(field);
    if (descriptor->is_repeated() && index < 0) return line_;
    const int line = locations_->GetLocation(descriptor, index).line;
    return line < 0 ? line_ : line + 1;
  }

  const google::protobuf::Message& message_;
  const Locations* locations_;
  int line_;  // of the block, for fields that it lacks
  std::string path_;
};

using Frames = std::map<std::string, FrameOrigin>;

Frames frames_of(const proto::Bridge& file, const Block& block) {
  Frames frames;
  for (int i = 0; i < file.frames_size(); ++i) {
    const proto::Frame& one = file.frames(i);
    const Block at = block.nested(one, "frames", i);
    if (one.name().empty()) at.refuse("name", "is missing; a frame_id, such as 'map'");
    FrameOrigin frame{one.name(), {0, 0, 0}, 0};
    for (const auto& [axis, field] : {std::pair(0, "x_m"), {1, "y_m"}, {2, "z_m"}})
      frame.origin_m[axis] = at.number(field, -kFarthest_m, kFarthest_m);
    frame.yaw_rad = at.number("yaw_deg", -360, 360) * M_PI / 180;
    if (!frames.emplace(one.name(), frame).second)
      at.refuse("name", "'" + printable(one.name()) + "' is there twice; leave one out");
  }
  return frames;
}

FrameOrigin frame_in(const Frames& frames, const Block& block) {
  const std::string name = block.text("frame");
  const auto found = frames.find(name);
  if (found != frames.end()) return found->second;
  if (name.empty()) block.refuse("frame", "is missing; name one of frames { }");
  std::string known;
  for (const auto& [other, frame] : frames) known += (known.empty() ? "" : ", ") + other;
  block.refuse("frame", "'" + printable(name) + "' is none of frames { } (" +
                            (known.empty() ? "there are none" : printable(known)) + ")");
}

DriveLimits limits_of(const proto::Robot& robot, const Block& block) {
  constexpr double kFastest_mps = 100, kFastest_radps = 100;
  DriveLimits limits;
  if (robot.drive() != proto::DIFFERENTIAL && robot.drive() != proto::HOLONOMIC)
    block.refuse("drive", "is missing; DIFFERENTIAL or HOLONOMIC");
  limits.max_speed_mps = block.positive("max_speed_mps", kFastest_mps);
  if (robot.drive() == proto::HOLONOMIC) {
    limits.kind = DriveKind::kHolonomic;
    if (robot.max_turn_radps() != 0)
      block.refuse("max_turn_radps", "a HOLONOMIC robot is not turned; leave it out");
    return limits;
  }
  limits.max_turn_radps = block.positive("max_turn_radps", kFastest_radps);
  return limits;
}

RobotTopics topics_of(const proto::Robot& robot, const Block& block) {
  RobotTopics topics;
  topics.cmd_vel = block.topic("cmd_vel");
  topics.has_odometry = robot.pose().empty();
  if (!robot.odom().empty() && !robot.pose().empty())
    block.refuse("pose", "the robot has odom, too; give one of both");
  topics.position = block.topic(topics.has_odometry ? "odom" : "pose");
  topics.stamped_command = robot.command_type() == proto::TWIST_STAMPED;
  if (topics.stamped_command && robot.base_frame().empty())
    block.refuse("command_type", "TWIST_STAMPED needs base_frame, the frame of the velocity");
  topics.reliable = robot.reliability() == proto::RELIABLE;
  return topics;
}

BridgedRobot robot_of(const proto::Robot& robot, const Block& block, const Frames& frames) {
  BridgedRobot bridged;
  if (!robot.has_id()) block.refuse("id", "is missing; the number of the robot's agent");
  if (robot.id() < 0 || robot.id() >= kMaxAgents)
    block.refuse(
        "id", std::to_string(robot.id()) + " is not from 0 to " + std::to_string(kMaxAgents - 1));
  bridged.id = robot.id();
  bridged.limits = limits_of(robot, block);
  bridged.topics = topics_of(robot, block);
  bridged.frame = frame_in(frames, block);
  bridged.base_frame = robot.base_frame();
  return bridged;
}

void refuse_twice(const std::string& name, std::set<std::string>& names, const Block& block,
                  const std::string& field) {
  if (!names.insert(name).second)
    block.refuse(field, "'" + name + "' is there twice; each robot has its own");
}

DisplayTopics display_of(const Block& block, const Frames& frames) {
  DisplayTopics display{block.topic("prefix"), frame_in(frames, block)};
  if (display.frame.yaw_rad != 0)
    block.refuse("frame", "'" + printable(display.frame.name) +
                              "' is turned, and a grid is not; name one without yaw_deg");
  return display;
}

BridgeFile checked(const proto::Bridge& file, const Locations& locations) {
  const Block block(file, &locations, 1, "");
  BridgeFile bridge;
  if (file.has_domain_id()) {
    if (file.domain_id() < 0 || file.domain_id() > kGreatestDomain)
      block.refuse("domain_id", std::to_string(file.domain_id()) + " is not from 0 to " +
                                    std::to_string(kGreatestDomain));
    bridge.domain_id = file.domain_id();
  }
  const Frames frames = frames_of(file, block);
  std::set<std::string> topics, ids;
  for (int i = 0; i < file.robots_size(); ++i) {
    const Block at = block.nested(file.robots(i), "robots", i);
    bridge.robots.push_back(robot_of(file.robots(i), at, frames));
    const BridgedRobot& robot = bridge.robots.back();
    refuse_twice(std::to_string(robot.id), ids, at, "id");
    refuse_twice(robot.topics.cmd_vel, topics, at, "cmd_vel");
    refuse_twice(robot.topics.position, topics, at, robot.topics.has_odometry ? "odom" : "pose");
  }
  std::ranges::sort(bridge.robots, {}, &BridgedRobot::id);
  if (file.has_display())
    bridge.display = display_of(block.nested(file.display(), "display"), frames);
  if (bridge.robots.empty() && !bridge.display)
    block.refuse("robots", "there is no robot and no display; add robots { } or display { }");
  return bridge;
}

}  // namespace

std::optional<std::string> topic_named(std::string name) {
  if (name.starts_with('/')) name.erase(0, 1);
  char before = '/';
  bool valid = name.size() < 200;
  for (const char c : name) {
    const bool digit = c >= '0' && c <= '9';
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    valid = valid && (letter || (digit && before != '/') || (c == '/' && before != '/'));
    before = c;
  }
  return valid && before != '/' ? std::optional(name) : std::nullopt;
}

std::string no_topic(const std::string& name) {
  return "'" + printable(name.substr(0, 200)) +
         "' is no topic of ROS 2: letters, digits and _, with / between names";
}

Result<BridgeFile> parse_bridge_file(std::string_view text, const std::string& name) {
  proto::Bridge file;
  FirstError error;
  Locations locations;
  TextFormat::Parser parser;
  parser.RecordErrorsTo(&error);
  parser.WriteLocationsTo(&locations);
  parser.SetRecursionLimit(kMaxDepth);
  google::protobuf::io::ArrayInputStream stream(text.data(), static_cast<int>(text.size()));
  if (!parser.Parse(&stream, &file))
    return failure(name + ":" + std::to_string(error.at_line) + ": " + error.text +
                   "; docs/robots/ros2.md has the fields");
  try {
    return checked(file, locations);
  } catch (const Refused& refused) {
    return failure(name + ":" + std::to_string(refused.line) + ": " + refused.text);
  }
}

Result<BridgeFile> read_bridge_file(const std::filesystem::path& file) {
  const auto text = read_whole(file, kMostFileBytes);
  if (!text) return failure(text.error().sentence(file));
  return parse_bridge_file(*text, file.string());
}

}  // namespace ergocast::ros2
