// SPDX-License-Identifier: BSD-3-Clause
// Writes the bytes of one message of each topic, as Fast DDS receives them: fast-recorder FILE
// TOPIC TYPE [TOPIC TYPE]…
#include <chrono>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/bridges/ros2/raw_type.h"

namespace ergocast::test {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using Bytes = RawBytes;

std::string hex_of(const Bytes& bytes) {
  std::string hex;
  for (const unsigned char byte : bytes) {
    for (const int digit : {byte >> 4, byte & 15}) hex += "0123456789abcdef"[digit];
  }
  return hex;
}

struct Recorded {
  std::string topic, type;
  dds::DataReader* reader = nullptr;
  Bytes bytes{};
};

/// As `ros2 topic echo` subscribes to what is latched.
dds::DataReader* reader_of(dds::DomainParticipant* participant, dds::Subscriber* subscriber,
                           const Recorded& one) {
  dds::TypeSupport type(new RawType(one.type));
  type.register_type(participant);
  dds::DataReaderQos qos;
  const bool latched = one.topic.find("cmd_vel") == one.topic.npos;
  qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind =
      latched ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  qos.history().depth = 1;
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  auto* topic = participant->create_topic("rt/" + one.topic, one.type, dds::TOPIC_QOS_DEFAULT);
  auto* reader = subscriber->create_datareader(topic, qos);
  if (reader == nullptr) throw std::runtime_error("no reader of " + one.topic);
  return reader;
}

void record(const std::string& file, std::vector<Recorded> all) {
  auto* participant = dds::DomainParticipantFactory::get_instance()->create_participant(
      0, dds::PARTICIPANT_QOS_DEFAULT);
  auto* subscriber = participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  for (Recorded& one : all) one.reader = reader_of(participant, subscriber, one);
  for (std::size_t missing = all.size(); missing > 0;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    missing = 0;
    for (Recorded& one : all) {
      dds::SampleInfo info;
      Bytes bytes;
      while (one.reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
        if (info.valid_data) one.bytes = bytes;
      }
      if (one.bytes.empty()) ++missing;
    }
  }
  nlohmann::json recorded;
  for (const Recorded& one : all)
    recorded[one.topic] = {{"type", one.type}, {"hex", hex_of(one.bytes)}};
  std::ofstream(file + ".part") << recorded << std::flush;
  std::filesystem::rename(file + ".part", file);
}

}  // namespace
}  // namespace ergocast::test

int main(int argc, char** argv) {
  std::vector<ergocast::test::Recorded> all;
  for (int i = 2; i + 1 < argc; i += 2) all.push_back({argv[i], argv[i + 1]});
  ergocast::test::record(argv[1], std::move(all));
}
