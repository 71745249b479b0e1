// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <map>

#include "bridges/mavlink/checksum.h"
#include "bridges/mavlink/frame_reader.h"
#include "bridges/mavlink/frame_writer.h"
#include "bridges/mavlink/messages.h"

namespace ergocast::mavlink {
namespace {

using Bytes = std::vector<std::byte>;

GlobalPositionInt place() {
  GlobalPositionInt at;
  at.time_boot_ms = 123456;
  at.lat = 476535000;
  at.lon = -91750000;
  at.alt = 402500;
  at.vx = -150;
  at.hdg = 0;
  return at;
}

std::vector<Received> read_all(FrameReader& reader, const Bytes& bytes) {
  std::vector<Received> out;
  reader.read(bytes, out);
  return out;
}

SigningKey key_of(int byte) {
  SigningKey key;
  key.fill(static_cast<std::byte>(byte));
  return key;
}

// The numbers that MAVLink's own generator has printed into every implementation.
TEST(MavlinkMessages, HaveTheExtraChecksumsThatMavlinkPublishes) {
  const std::map<std::uint32_t, int> published{
      {0, 50},   {1, 124},  {32, 185}, {33, 104},  {40, 230},  {43, 132},
      {44, 221}, {47, 153}, {49, 39},  {51, 196},  {73, 38},   {76, 152},
      {77, 143}, {84, 143}, {111, 34}, {147, 154}, {245, 130}, {253, 83}};
  ASSERT_EQ(types().size(), published.size());
  for (const Type& type : types()) EXPECT_EQ(type.crc_extra, published.at(type.id)) << type.name;
  EXPECT_EQ(type_of(33)->base_bytes, 28U);
  EXPECT_EQ(type_of(77)->base_bytes, 3U);
  EXPECT_EQ(type_of(77)->whole_bytes, 10U);
  EXPECT_EQ(type_of(147)->base_bytes, 36U);
  EXPECT_EQ(type_of(147)->whole_bytes, 54U);
}

TEST(MavlinkFrames, ComeBackAsTheyWereAndZerosAtTheEndAreCut) {
  FrameWriter writer;
  const Bytes frame = writer.frame_of(place(), {7, 1});
  EXPECT_EQ(frame.size(), 10U + 22 + 2) << "two speeds and the heading are 0";
  FrameReader reader;
  const auto all = read_all(reader, frame);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].from, (Source{7, 1}));
  const auto& at = std::get<GlobalPositionInt>(all[0].packet);
  EXPECT_EQ(at.time_boot_ms, 123456U);
  EXPECT_EQ(at.lat, 476535000);
  EXPECT_EQ(at.lon, -91750000);
  EXPECT_EQ(at.vx, -150);
  EXPECT_EQ(at.hdg, 0);
}

TEST(MavlinkFrames, AreFoundInNoiseByteByByte) {
  FrameWriter writer;
  Bytes stream{std::byte{0xFD}, std::byte{3}, std::byte{0}};  // the beginning of a lost frame
  for (int i = 0; i < 20; ++i) {
    const Bytes frame = writer.frame_of(place(), {7, 1});
    stream.insert(stream.end(), frame.begin(), frame.end());
    stream.push_back(std::byte{0x55});
  }
  FrameReader reader;
  std::vector<Received> all;
  for (const std::byte byte : stream) reader.read(std::span(&byte, 1), all);
  EXPECT_GE(all.size(), 19U);
}

TEST(MavlinkFrames, OfWhichOneBitIsWrongAreRefused) {
  FrameWriter writer;
  const Bytes frame = writer.frame_of(place(), {7, 1});
  for (std::size_t bit = 0; bit < frame.size() * 8; ++bit) {
    Bytes damaged = frame;
    damaged[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
    FrameReader reader;
    EXPECT_TRUE(read_all(reader, damaged).empty()) << "bit " << bit;
  }
}

// Written down from the description of version 1: no flags, an id of one byte, all zeros sent.
TEST(MavlinkFrames, OfVersion1AreReadAndHaveNoExtensions) {
  Bytes frame;
  for (const int byte : {0xFE, 3, 42, 9, 1, 77, 0x90, 0x01, 4})
    frame.push_back(static_cast<std::byte>(byte));
  Checksum sum;
  sum.add(std::span(frame).subspan(1));
  sum.add(std::byte{143});
  frame.push_back(static_cast<std::byte>(sum.value() & 0xFF));
  frame.push_back(static_cast<std::byte>(sum.value() >> 8));
  FrameReader reader;
  const auto all = read_all(reader, frame);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].from, (Source{9, 1}));
  const auto& ack = std::get<CommandAck>(all[0].packet);
  EXPECT_EQ(ack.command, 400);
  EXPECT_EQ(ack.result, 4);
  EXPECT_EQ(ack.target_system, 0);
}

TEST(MavlinkSignatures, LetOnlyNewFramesWithTheSameKeyPass) {
  FrameWriter ours(key_of(1), 1'000'000'000), others(key_of(2), 1'000'000'000), bare;
  FrameReader reader(key_of(1), 1'000'000'000);
  const Bytes first = ours.frame_of(place(), {7, 1}), second = ours.frame_of(place(), {7, 1});
  EXPECT_EQ(read_all(reader, second).size(), 1U);
  EXPECT_EQ(read_all(reader, first).size(), 0U) << "an old frame";
  EXPECT_EQ(read_all(reader, second).size(), 0U) << "the same frame";
  EXPECT_EQ(read_all(reader, others.frame_of(place(), {7, 1})).size(), 0U);
  EXPECT_EQ(read_all(reader, bare.frame_of(place(), {7, 1})).size(), 0U);
  EXPECT_EQ(reader.counts().repeated, 2);
  EXPECT_EQ(reader.counts().wrong_key, 1);
  EXPECT_EQ(reader.counts().unsigned_, 1);
  EXPECT_EQ(read_all(reader, ours.frame_of(place(), {7, 1})).size(), 1U);
}

TEST(MavlinkSignatures, HaveNoTimeBeforeTheirEpoch) {
  EXPECT_FALSE(signing_time(0, 0)) << "1970";
  EXPECT_FALSE(signing_time(kSigningEpoch_s, 0));
  EXPECT_EQ(signing_time(kSigningEpoch_s + 1, 20'000), 100'002U);
  FrameReader reader(key_of(1), 1'000'000'000);
  FrameWriter since_1970(key_of(1), 7);
  EXPECT_EQ(read_all(reader, since_1970.frame_of(place(), {7, 1})).size(), 0U);
}

TEST(MavlinkSignatures, OfALongTimeAgoAreRefusedFromANewSender) {
  FrameReader reader(key_of(1), 1'000'000'000);
  FrameWriter old(key_of(1), 1'000'000'000 - kSigningSlack - 1);
  EXPECT_EQ(read_all(reader, old.frame_of(place(), {7, 1})).size(), 0U);
  FrameWriter late(key_of(1), 1'000'000'000 - kSigningSlack + 1);
  EXPECT_EQ(read_all(reader, late.frame_of(place(), {7, 1})).size(), 1U);
}

}  // namespace
}  // namespace ergocast::mavlink
