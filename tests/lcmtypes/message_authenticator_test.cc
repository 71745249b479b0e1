// SPDX-License-Identifier: BSD-3-Clause
// The guarantees of a mission key: an outsider can at most repeat a member's message, unchanged and
// on its own channel, and a member cannot send as the coordinator.
#include "lcmtypes/message_authenticator.h"

#include <sodium.h>

#include "lcmtypes/channels.h"
#include "tests/lcmtypes/sample_messages.h"

namespace ergocast {
namespace {

using namespace test;

MissionKey key_of(unsigned char seed) {
  MissionKey key;
  key.shared.fill(static_cast<std::byte>(seed));
  const std::array<unsigned char, crypto_sign_SEEDBYTES> from{seed};
  crypto_sign_seed_keypair(reinterpret_cast<unsigned char*>(key.coordinator.data()),
                           reinterpret_cast<unsigned char*>(key.signing.emplace().data()),
                           from.data());
  return key;
}
MissionKey member_of(MissionKey key) {
  key.signing.reset();
  return key;
}

const MessageAuthenticator kCoordinatorSeal{key_of(1)};
const MessageAuthenticator kMemberSeal{member_of(key_of(1))};
const MessageAuthenticator kOtherTeam{key_of(2)};

Message unsigned_copy(Message message) {
  if (auto* part = std::get_if<MissionPart>(&message)) part->signature = {};
  if (auto* stop = std::get_if<Stop>(&message)) stop->signature = {};
  if (auto* pause = std::get_if<Pause>(&message)) pause->signature = {};
  return message;
}
bool is_signed(const Message& message) {
  return std::holds_alternative<MissionPart>(message) || std::holds_alternative<Stop>(message) ||
         std::holds_alternative<Pause>(message);
}

Bytes sealed(const Message& message, const MessageAuthenticator& seal,
             AgentId relayer = kUnassigned) {
  Bytes bytes;
  encode(message, bytes, seal, channel_of(message, relayer));
  return bytes;
}
std::string opened(const Bytes& bytes, const MessageAuthenticator& seal, std::string_view channel) {
  return verdict(decode(bytes, kRun, seal, channel));
}

TEST(MessageAuthenticator, EveryMessageOfTheTeamIsOpenedByEveryMember) {
  for (const Message& message : every_message()) {
    const Bytes bytes = sealed(unsigned_copy(message), kCoordinatorSeal);
    EXPECT_EQ(opened(bytes, kMemberSeal, channel_of(message)), "accepted") << message.index();
    EXPECT_EQ(opened(bytes, kCoordinatorSeal, channel_of(message)), "accepted") << message.index();
  }
}

TEST(MessageAuthenticator, FingerprintsAreEqualForEqualKeysOnly) {
  EXPECT_EQ(kMemberSeal.fingerprint(), kCoordinatorSeal.fingerprint());
  EXPECT_NE(kMemberSeal.fingerprint(), kOtherTeam.fingerprint());
  EXPECT_NE(kMemberSeal.fingerprint(), 0u);
  EXPECT_EQ(MessageAuthenticator().fingerprint(), 0u);
  MissionKey half = key_of(1);
  half.coordinator = key_of(2).coordinator;
  EXPECT_NE(MessageAuthenticator(half).fingerprint(), kMemberSeal.fingerprint())
      << "obeys somebody else";
}

TEST(MessageAuthenticator, WhatHasNoKeyOrAnotherIsRefusedByName) {
  for (const Message& message : every_message()) {
    const std::string& channel = channel_of(message);
    EXPECT_EQ(opened(sealed(message, MessageAuthenticator()), kMemberSeal, channel), "unkeyed");
    EXPECT_EQ(opened(sealed(unsigned_copy(message), kOtherTeam), kMemberSeal, channel), "tag");
    EXPECT_EQ(
        opened(sealed(unsigned_copy(message), kCoordinatorSeal), MessageAuthenticator(), channel),
        "tag");
  }
}

TEST(MessageAuthenticator, NoChangedBitIsAccepted) {
  for (const Message& message : every_message()) {
    const Bytes good = sealed(unsigned_copy(message), kCoordinatorSeal);
    for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
      Bytes bad = good;
      bad[bit / 8] ^= static_cast<std::byte>(1 << (bit % 8));
      EXPECT_NE(opened(bad, kMemberSeal, channel_of(message)), "accepted") << bit;
      // Knowledge of the format without the key does not help.
      ASSERT_NE(opened(retagged(bad), kMemberSeal, channel_of(message)), "accepted") << bit;
    }
  }
}

TEST(MessageAuthenticator, ARepeatUnderAnotherNameIsRefused) {
  const Bytes bytes = sealed(contribution(), kMemberSeal);
  EXPECT_EQ(opened(bytes, kMemberSeal, "ERGOCAST_CONTRIBUTION_3"), "accepted");
  for (const char* channel : {"ERGOCAST_CONTRIBUTION_4", "ERGOCAST_CONTRIBUTION", ""}) {
    EXPECT_EQ(opened(bytes, kMemberSeal, channel), "tag") << channel;
  }
  // A teammate relays it under its own name, which needs the key.
  EXPECT_EQ(opened(sealed(contribution(), kMemberSeal, 4), kMemberSeal, "ERGOCAST_CONTRIBUTION_4"),
            "accepted");
}

TEST(MessageAuthenticator, AMemberCannotSpeakForTheCoordinator) {
  for (const Message& message : every_message()) {
    if (!is_signed(message)) continue;
    const std::string& channel = channel_of(message);
    EXPECT_EQ(opened(sealed(unsigned_copy(message), kMemberSeal), kMemberSeal, channel),
              "unsigned");
    EXPECT_EQ(opened(sealed(message, kMemberSeal), kMemberSeal, channel), "unsigned");
  }
}

TEST(MessageAuthenticator, AMemberRepeatsWhatTheCoordinatorSignedButCannotChangeIt) {
  const Message said = unsigned_copy(mission_part());
  const Bytes bytes = sealed(said, kCoordinatorSeal);
  const auto decoded = decode(bytes, kRun, kMemberSeal, channel_of(said));
  auto part = std::get<MissionPart>(std::get<Message>(decoded));
  EXPECT_EQ(sealed(part, kMemberSeal), bytes);
  part.revision += 1;
  EXPECT_EQ(opened(sealed(part, kMemberSeal), kMemberSeal, channel_of(said)), "unsigned");
}

TEST(MessageAuthenticator, ASignatureIsOfOneMessageOfOneRun) {
  Stop stop;
  stop.header = header_of_sender(kOperator);
  const auto decoded = decode(sealed(stop, kCoordinatorSeal), kRun, kMemberSeal, channel_of(stop));
  Stop again = std::get<Stop>(std::get<Message>(decoded));
  again.header.run = kRun + 1;
  EXPECT_EQ(verdict(decode(sealed(again, kMemberSeal), 0, kMemberSeal, channel_of(stop))),
            "unsigned");
}

/// The same team with another coordinator's public key: the first one's signatures are invalid for
/// it.
MessageAuthenticator obeying_another() {
  MissionKey key = member_of(key_of(1));
  key.coordinator = key_of(2).coordinator;
  return MessageAuthenticator(key);
}

TEST(KnownSignatures, ASignatureThatHasHeldIsNotCheckedAgain) {
  const Message said = unsigned_copy(mission_part());
  const Bytes bytes = sealed(said, kCoordinatorSeal);
  const std::string& channel = channel_of(said);
  KnownSignatures known;
  EXPECT_EQ(verdict(decode(bytes, kRun, obeying_another(), channel, &known)), "unsigned");
  EXPECT_EQ(verdict(decode(bytes, kRun, kMemberSeal, channel, &known)), "accepted");
  // A check would refuse it as before.
  EXPECT_EQ(verdict(decode(bytes, kRun, obeying_another(), channel, &known)), "accepted");
}

TEST(KnownSignatures, WhatIsRefusedIsNotRemembered) {
  const Message said = unsigned_copy(mission_part());
  const std::string& channel = channel_of(said);
  const Bytes forged = sealed(said, kMemberSeal);
  KnownSignatures known;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(verdict(decode(forged, kRun, kMemberSeal, channel, &known)), "unsigned");
  }
  const Bytes good = sealed(said, kCoordinatorSeal);
  EXPECT_EQ(verdict(decode(good, kRun, kMemberSeal, channel, &known)), "accepted");
}

TEST(KnownSignatures, AKnownTagMakesNoOtherBytesAcceptable) {
  const Message said = unsigned_copy(mission_part());
  const std::string& channel = channel_of(said);
  const Bytes good = sealed(said, kCoordinatorSeal);
  KnownSignatures known;
  ASSERT_EQ(verdict(decode(good, kRun, kMemberSeal, channel, &known)), "accepted");
  for (std::size_t at = 0; at < good.size(); ++at) {
    Bytes bad = good;
    bad[at] ^= std::byte{1};
    EXPECT_NE(verdict(decode(bad, kRun, kMemberSeal, channel, &known)), "accepted") << at;
  }
  // The message of a former run is still refused.
  EXPECT_EQ(verdict(decode(good, kRun + 1, kMemberSeal, channel, &known)), "run");
}

TEST(KnownSignatures, HaveRoomForSoManyAndCheckTheOthersAgain) {
  KnownSignatures known;
  const int many = 2 * static_cast<int>(KnownSignatures::kCapacity);
  std::vector<Bytes> all;
  int checked_again = 0;
  for (int i = 0; i < many; ++i) {
    Bytes bytes(kSignatureEnd);
    for (std::size_t b = 0; b < 16; ++b)
      bytes[44 + b] = static_cast<std::byte>(i * 2654435761U >> (b % 4 * 8));
    known.add(bytes);
    EXPECT_TRUE(known.contains(bytes)) << "the newest";
    all.push_back(bytes);
  }
  for (const Bytes& bytes : all) checked_again += known.contains(bytes) ? 0 : 1;
  EXPECT_GE(checked_again, many - static_cast<int>(KnownSignatures::kCapacity));
}

TEST(MessageAuthenticator, ShortMessagesWithoutRoomForASignatureAreRefused) {
  Bytes bytes = sealed(stop(), kCoordinatorSeal);
  bytes.resize(kHeaderBytes + 63);
  kMemberSeal.close(bytes, false, channel_of(stop()));
  EXPECT_EQ(opened(bytes, kMemberSeal, channel_of(stop())), "unsigned");
}

TEST(MessageAuthenticator, WithoutAKeyTheTagIsThatOfTheFormat) {
  for (const Message& message : every_message()) {
    EXPECT_EQ(sealed(message, MessageAuthenticator()), retagged(encoded(message)));
  }
}

TEST(MessageAuthenticator, TheKeyedTagIsBlake2bOverMessageAndChannel) {
  const Bytes bytes = sealed(command(), kMemberSeal);
  Bytes hashed = bytes;
  std::fill_n(hashed.begin() + 44, 16, std::byte{0});
  for (const char c : std::string_view("ERGOCAST_COMMAND_2")) hashed.push_back(std::byte(c));
  std::array<unsigned char, 16> tag;
  const MissionKey key = key_of(1);
  crypto_generichash(tag.data(), tag.size(), reinterpret_cast<const unsigned char*>(hashed.data()),
                     hashed.size(), reinterpret_cast<const unsigned char*>(key.shared.data()), 32);
  EXPECT_EQ(std::memcmp(tag.data(), bytes.data() + 44, tag.size()), 0);
}

}  // namespace
}  // namespace ergocast
