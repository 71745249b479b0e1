// SPDX-License-Identifier: BSD-3-Clause
// Builtin topics of DDS name the other programs' sides, with their quality of service.
#include "bridges/ros2/dds_node.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "text/printable.h"

namespace ergocast::ros2 {
namespace {

constexpr const char* kPrefix = "rt/";
/// In one turn, so that a flood does not keep commands from being sent.
constexpr std::uint32_t kMostSamples = 64;
/// The greatest number of other programs' sides that are remembered.
constexpr std::size_t kMostKnown = 256;

using Qos = std::unique_ptr<dds_qos_t, void (*)(dds_qos_t*)>;

Qos new_qos() { return {dds_create_qos(), dds_delete_qos}; }

Qos qos_of(const MessageType& type, const Quality& quality) {
  Qos qos = new_qos();
  dds_qset_reliability(qos.get(),
                       quality.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_MSECS(0));
  dds_qset_durability(qos.get(), quality.latching == Latching::kNewest
                                     ? DDS_DURABILITY_TRANSIENT_LOCAL
                                     : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
  const std::array<dds_data_representation_id_t, 1> plain{DDS_DATA_REPRESENTATION_XCDR1};
  dds_qset_data_representation(qos.get(), plain.size(), plain.data());
  const std::string hash = "typehash=" + std::string(type.hash) + ";";
  dds_qset_userdata(qos.get(), hash.data(), hash.size());
  return qos;
}

std::string problem_of(const std::string& what, dds_return_t code) {
  return what + ": " + dds_strretcode(code) + "; see $CYCLONEDDS_URI and the network";
}

/// A type or topic as ROS 2 shows it: "nav_msgs/msg/Odometry".
std::string ros_name(std::string type) {
  const std::string middle = "::msg::dds_::";
  const auto at = type.find(middle);
  if (at == type.npos || !type.ends_with('_')) return "'" + printable(type.substr(0, 80)) + "'";
  return printable(type.substr(0, at)) + "/msg/" +
         printable(type.substr(at + middle.size(), type.size() - at - middle.size() - 1));
}

struct Offer {
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_duration_t deadline = DDS_INFINITY;
  dds_liveliness_kind_t liveliness = DDS_LIVELINESS_AUTOMATIC;
  dds_duration_t lease = DDS_INFINITY;
  dds_ownership_kind_t ownership = DDS_OWNERSHIP_SHARED;
};

Offer offer_of(const dds_qos_t* qos) {
  Offer offer;
  dds_duration_t blocking = 0;
  dds_qget_reliability(qos, &offer.reliability, &blocking);
  dds_qget_durability(qos, &offer.durability);
  dds_qget_deadline(qos, &offer.deadline);
  dds_qget_liveliness(qos, &offer.liveliness, &offer.lease);
  dds_qget_ownership(qos, &offer.ownership);
  return offer;
}

Offer offer_of(const Quality& quality) {
  Offer offer;
  if (quality.reliable) offer.reliability = DDS_RELIABILITY_RELIABLE;
  if (quality.latching == Latching::kNewest) offer.durability = DDS_DURABILITY_TRANSIENT_LOCAL;
  return offer;
}

/// "reliability: the publisher offers BEST_EFFORT, the subscriber requests RELIABLE"; empty if they
/// match.
std::string mismatch(const Offer& publisher, const Offer& subscriber, const std::string& offers,
                     const std::string& requests) {
  const auto differ = [&](const char* policy, const std::string& one, const std::string& other) {
    return std::string(policy) + ": " + offers + " offers " + one + ", " + requests + " requests " +
           other;
  };
  constexpr std::array kReliabilities{"BEST_EFFORT", "RELIABLE"};
  constexpr std::array kDurabilities{"VOLATILE", "TRANSIENT_LOCAL", "TRANSIENT", "PERSISTENT"};
  if (publisher.reliability < subscriber.reliability)
    return differ("reliability", kReliabilities.at(publisher.reliability),
                  kReliabilities.at(subscriber.reliability));
  if (publisher.durability < subscriber.durability)
    return differ("durability", kDurabilities.at(publisher.durability),
                  kDurabilities.at(subscriber.durability));
  const auto period = [](dds_duration_t ns) {
    return ns == DDS_INFINITY ? std::string("none") : std::to_string(ns / 1'000'000) + " ms";
  };
  if (publisher.deadline > subscriber.deadline)
    return differ("deadline", period(publisher.deadline), period(subscriber.deadline));
  if (publisher.liveliness < subscriber.liveliness || publisher.lease > subscriber.lease)
    return differ("liveliness", period(publisher.lease), period(subscriber.lease));
  if (publisher.ownership != subscriber.ownership)
    return differ("ownership", publisher.ownership == DDS_OWNERSHIP_SHARED ? "SHARED" : "EXCLUSIVE",
                  subscriber.ownership == DDS_OWNERSHIP_SHARED ? "SHARED" : "EXCLUSIVE");
  return "";
}

}  // namespace

/// Another program's side of a followed topic.
struct DdsNode::Known {
  dds_instance_handle_t handle = 0;
  bool publisher = false;
  std::string topic, type;
  std::unique_ptr<dds_qos_t, void (*)(dds_qos_t*)> qos{dds_create_qos(), dds_delete_qos};
};

Result<std::unique_ptr<DdsNode>> DdsNode::open(int domain_id) {
  std::unique_ptr<DdsNode> node(new DdsNode);
  node->wake_fd_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (node->wake_fd_ < 0) return failure(std::string("eventfd: ") + std::strerror(errno));
  const Qos qos = new_qos();
  const std::string enclave = "enclave=/;";
  dds_qset_userdata(qos.get(), enclave.data(), enclave.size());
  node->participant_ =
      dds_create_participant(static_cast<dds_domainid_t>(domain_id), qos.get(), nullptr);
  if (node->participant_ < 0) return failure(problem_of("DDS", node->participant_));
  dds_get_guid(node->participant_, &node->guid_);
  // Readers inherit the listener of the participant.
  dds_listener_t* listener = dds_create_listener(&node->wake_fd_);
  dds_lset_data_available(listener, [](dds_entity_t, void* fd) {
    constexpr std::uint64_t kOne = 1;
    [[maybe_unused]] const auto written = ::write(*static_cast<int*>(fd), &kOne, sizeof kOne);
  });
  dds_set_listener(node->participant_, listener);
  dds_delete_listener(listener);
  node->publications_ =
      dds_create_reader(node->participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
  node->subscriptions_ =
      dds_create_reader(node->participant_, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION, nullptr, nullptr);
  if (node->publications_ < 0 || node->subscriptions_ < 0)
    return failure(problem_of("DDS", std::min(node->publications_, node->subscriptions_)));
  return node;
}

DdsNode::~DdsNode() {
  if (participant_ > 0) dds_delete(participant_);
  if (wake_fd_ >= 0) close(wake_fd_);
}

bool DdsNode::clear() {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto size = ::read(wake_fd_, &count, sizeof count);
  const bool one = take_changes(publications_, true);
  return take_changes(subscriptions_, false) || one;
}

bool DdsNode::take_changes(dds_entity_t reader, bool publishers) {
  bool changed = false;
  std::array<void*, kMostSamples> samples{};
  std::array<dds_sample_info_t, kMostSamples> infos{};
  while (true) {
    const auto count = dds_take(reader, samples.data(), infos.data(), kMostSamples, kMostSamples);
    if (count <= 0) return changed;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      changed |= std::erase_if(known_, [&](const auto& one) {
                   return one->handle == infos[i].instance_handle;
                 }) > 0;
      if (!infos[i].valid_data || infos[i].instance_state != DDS_IST_ALIVE) continue;
      const auto& found = *static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
      const bool own = std::memcmp(&found.participant_key, &guid_, sizeof guid_) == 0;
      if (own || !followed_.contains(found.topic_name) || known_.size() >= kMostKnown) continue;
      auto known = std::make_unique<Known>();
      known->handle = infos[i].instance_handle;
      known->publisher = publishers;
      known->topic = found.topic_name;
      known->type = found.type_name;
      dds_copy_qos(known->qos.get(), found.qos);
      known_.push_back(std::move(known));
      changed = true;
    }
    dds_return_loan(reader, samples.data(), count);
  }
}

std::vector<DdsNode::Peer> DdsNode::peers(const std::string& topic, bool publishers) const {
  std::vector<Peer> found;
  for (const auto& one : known_) {
    if (one->publisher == publishers && one->topic == kPrefix + topic)
      found.push_back({one->type, one->qos.get()});
  }
  return found;
}

dds_entity_t DdsNode::topic(const MessageType& type, const std::string& name) {
  const std::string dds_name = kPrefix + name;
  follow(dds_name);
  return dds_create_topic(participant_, &type.descriptor, dds_name.c_str(), nullptr, nullptr);
}

// ---- a topic that we publish ----

Result<Writer> Writer::make(DdsNode& node, const MessageType& type, const std::string& topic,
                            const Quality& quality) {
  Writer made;
  made.node_ = &node;
  made.name_ = topic;
  made.type_ = type.descriptor.m_typename;
  made.quality_ = quality;
  const dds_entity_t created = node.topic(type, topic);
  if (created < 0) return failure(problem_of(topic, created));
  made.writer_ =
      dds_create_writer(node.participant_, created, qos_of(type, quality).get(), nullptr);
  if (made.writer_ < 0) return failure(problem_of(topic, made.writer_));
  return made;
}

void Writer::write(const void* message) { dds_write(writer_, message); }

std::string Writer::problem() const {
  std::string problem = "nobody subscribes to " + name_;
  for (const DdsNode::Peer& peer : node_->peers(name_, false)) {
    if (peer.type != type_) {
      problem = "a subscriber of " + name_ + " expects " + ros_name(peer.type) +
                ", the bridge sends " + ros_name(type_);
      continue;
    }
    const std::string why =
        mismatch(offer_of(quality_), offer_of(peer.qos), "the bridge", "its subscriber");
    if (why.empty()) return "";
    problem = "QoS of " + name_ + " does not match, " + why;
  }
  return problem;
}

// ---- a topic that we subscribe to ----

Result<Reader> Reader::make(DdsNode& node, const MessageType& type, const std::string& topic,
                            const Quality& quality) {
  Reader made;
  made.node_ = &node;
  made.name_ = topic;
  made.type_ = type.descriptor.m_typename;
  made.quality_ = quality;
  const dds_entity_t created = node.topic(type, topic);
  if (created < 0) return failure(problem_of(topic, created));
  made.reader_ =
      dds_create_reader(node.participant_, created, qos_of(type, quality).get(), nullptr);
  if (made.reader_ < 0) return failure(problem_of(topic, made.reader_));
  return made;
}

void Reader::take(const std::function<void(const void*)>& on_message) {
  std::array<void*, kMostSamples> samples{};
  std::array<dds_sample_info_t, kMostSamples> infos{};
  const auto count = dds_take(reader_, samples.data(), infos.data(), kMostSamples, kMostSamples);
  for (std::size_t i = 0; count > 0 && i < static_cast<std::size_t>(count); ++i) {
    if (infos[i].valid_data) on_message(samples[i]);
  }
  if (count > 0) dds_return_loan(reader_, samples.data(), count);
}

std::string Reader::problem() const {
  const auto publishers = node_->peers(name_, true);
  if (publishers.empty()) return "nobody publishes " + name_;
  for (const DdsNode::Peer& peer : publishers) {
    if (peer.type != type_)
      return name_ + " is published as " + ros_name(peer.type) + ", the bridge expects " +
             ros_name(type_);
    const std::string why =
        mismatch(offer_of(peer.qos), offer_of(quality_), "its publisher", "the bridge");
    if (!why.empty()) return "QoS of " + name_ + " does not match, " + why;
  }
  if (publishers.size() > 1)
    return std::to_string(publishers.size()) + " publishers are on " + name_ +
           ": end all but one, because their messages would be mixed";
  return "";
}

}  // namespace ergocast::ros2
