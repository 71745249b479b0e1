// SPDX-License-Identifier: BSD-3-Clause
// A participant of DDS with topics as ROS 2 names them, on CycloneDDS.
//
// Topic robot1/odom is "rt/robot1/odom", its type "nav_msgs::msg::dds_::Odometry_", and messages
// are plain CDR (XCDR1). User data have the type's hash, which ROS 2 from Iron on expects. Threads
// of CycloneDDS only make a descriptor readable; all else happens in the caller's thread.
#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace ergocast::ros2 {

/// One of the messages of ros_types.idl.
struct MessageType {
  const dds_topic_descriptor_t& descriptor;
  const char* hash;  ///< RIHS01_…
};

enum class Latching {
  kNone,    ///< volatile: subscribers get what is sent from now on
  kNewest,  ///< transient local: late subscribers get the newest message
};

struct Quality {
  bool reliable = true;
  Latching latching = Latching::kNone;
};

class DdsNode {
 public:
  /// An error if DDS cannot be used on this machine.
  static Result<std::unique_ptr<DdsNode>> open(int domain_id);
  DdsNode(const DdsNode&) = delete;
  DdsNode& operator=(const DdsNode&) = delete;
  ~DdsNode();

  /// Readable when messages arrived, or other programs' topics have changed.
  int fd() const { return wake_fd_; }
  /// Makes fd() wait again; true if other programs' topics have changed since the last call.
  bool clear();

  /// Another program's side of a topic.
  struct Peer {
    std::string type;
    const dds_qos_t* qos;
  };

 private:
  friend class Writer;
  friend class Reader;
  DdsNode() = default;
  /// What others publish (or subscribe to) on a topic.
  std::vector<Peer> peers(const std::string& topic, bool publishers) const;
  dds_entity_t topic(const MessageType& type, const std::string& name);
  void follow(const std::string& dds_topic) { followed_.insert(dds_topic); }
  bool take_changes(dds_entity_t reader, bool publishers);

  struct Known;
  dds_entity_t participant_ = 0, publications_ = 0, subscriptions_ = 0;
  dds_guid_t guid_{};
  int wake_fd_ = -1;
  std::set<std::string> followed_;
  std::vector<std::unique_ptr<Known>> known_;
};

/// Publishes one topic.
class Writer {
 public:
  /// @param topic  as ROS 2 shows it, without the leading slash
  static Result<Writer> make(DdsNode& node, const MessageType& type, const std::string& topic,
                             const Quality& quality);

  /// Never waits for subscribers. @pre the message is of the topic's type
  void write(const void* message);
  /// Why a subscriber does not get the messages, or that there is none; empty if one gets them.
  std::string problem() const;
  /// How many others publish on this topic.
  std::size_t others() const { return node_->peers(name_, true).size(); }

 private:
  DdsNode* node_ = nullptr;
  std::string name_, type_;
  Quality quality_;
  dds_entity_t writer_ = 0;
};

/// Subscribes to one topic; keeps the newest message.
class Reader {
 public:
  static Result<Reader> make(DdsNode& node, const MessageType& type, const std::string& topic,
                             const Quality& quality);

  /// Passes on the messages that have arrived, which are valid during the call.
  void take(const std::function<void(const void*)>& on_message);
  /// Why the topic cannot be used: no publisher, several, or one that does not match.
  std::string problem() const;

 private:
  DdsNode* node_ = nullptr;
  std::string name_, type_;
  Quality quality_;
  dds_entity_t reader_ = 0;
};

}  // namespace ergocast::ros2
