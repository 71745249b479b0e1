// SPDX-License-Identifier: BSD-3-Clause
// Sends messages of any bytes by Fast DDS, several times: fast-sender FILE TOPIC TYPE TIMES. Each
// line of FILE has the CDR of a message in hex. A message of twelve bytes or more gets a present
// stamp. With a fifth word, latched or volatile, it is the topic's durability: the messages are
// sent once, and the program runs until a signal.
#include <chrono>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/bridges/ros2/raw_type.h"

namespace ergocast::test {
namespace {

namespace dds = eprosima::fastdds::dds;

RawBytes from_hex(const std::string& hex) {
  RawBytes bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<unsigned char>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  return bytes;
}

/// A header begins with seconds and nanoseconds, after the four bytes that name the encoding.
void stamp(RawBytes& bytes) {
  if (bytes.size() < 12) return;
  const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                      std::chrono::system_clock::now().time_since_epoch())
                      .count();
  const auto sec = static_cast<std::int32_t>(ns / 1'000'000'000);
  const auto nanosec = static_cast<std::uint32_t>(ns % 1'000'000'000);
  std::memcpy(&bytes[4], &sec, sizeof sec);
  std::memcpy(&bytes[8], &nanosec, sizeof nanosec);
}

void send(const std::string& file, const std::string& topic, const std::string& type, int times,
          const std::string& durability) {
  std::vector<RawBytes> messages;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) messages.push_back(from_hex(line));
  auto* participant = dds::DomainParticipantFactory::get_instance()->create_participant(
      0, dds::PARTICIPANT_QOS_DEFAULT);
  dds::TypeSupport raw(new RawType(type));
  raw.register_type(participant);
  auto* publisher = participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
  dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
  if (durability == "latched") qos.durability().kind = dds::TRANSIENT_LOCAL_DURABILITY_QOS;
  if (durability == "volatile") qos.durability().kind = dds::VOLATILE_DURABILITY_QOS;
  auto* writer = publisher->create_datawriter(
      participant->create_topic("rt/" + topic, type, dds::TOPIC_QOS_DEFAULT), qos);
  if (!durability.empty()) {
    for (RawBytes& message : messages) writer->write(&message);
    for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  dds::PublicationMatchedStatus matched;
  while (matched.current_count == 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    writer->get_publication_matched_status(matched);
  }
  for (int i = 0; i < times; ++i) {
    for (RawBytes& message : messages) {
      stamp(message);
      writer->write(&message);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }
}

}  // namespace
}  // namespace ergocast::test

int main(int argc, char** argv) {
  ergocast::test::send(argv[1], argv[2], argv[3], std::stoi(argv[4]), argc > 5 ? argv[5] : "");
}
