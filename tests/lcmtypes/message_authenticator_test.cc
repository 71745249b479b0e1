// SPDX-License-Identifier: BSD-3-Clause
// The guarantees of a mission key. An outsider can at most repeat a member's message, unchanged and
// on its own channel. A member cannot send as the coordinator.
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

const MessageAuthenticator kCoordinatorAuthenticator{key_of(1)};
const MessageAuthenticator kMemberAuthenticator{member_of(key_of(1))};
const MessageAuthenticator kOtherTeam{key_of(2)};

Message unsigned_copy(Message message) {
  if (auto* part = std::get_if<MissionPart>(&message)) part->signature = {};
  if (auto* stop = std::get_if<Stop>(&message)) stop->signature = {};
  if (auto* amend = std::get_if<Amend>(&message)) amend->signature = {};
  if (auto* recall = std::get_if<Recall>(&message)) recall->signature = {};
  return message;
}
bool is_signed(const Message& message) {
  return std::holds_alternative<MissionPart>(message) || std::holds_alternative<Stop>(message) ||
         std::holds_alternative<Amend>(message) || std::holds_alternative<Recall>(message);
}

Bytes authenticated(const Message& message, const MessageAuthenticator& authenticator,
                    AgentId relayer = kUnassigned) {
  Bytes bytes;
  encode(message, bytes, authenticator, channel_of(message, relayer));
  return bytes;
}
std::string opened(const Bytes& bytes, const MessageAuthenticator& authenticator,
                   std::string_view channel) {
  return verdict(decode(bytes, kRun, authenticator, channel));
}

TEST(MessageAuthenticator, EveryMessageOfTheTeamIsOpenedByEveryMember) {
  for (const Message& message : every_message()) {
    const Bytes bytes = authenticated(unsigned_copy(message), kCoordinatorAuthenticator);
    EXPECT_EQ(opened(bytes, kMemberAuthenticator, channel_of(message)), "accepted")
        << message.index();
    EXPECT_EQ(opened(bytes, kCoordinatorAuthenticator, channel_of(message)), "accepted")
        << message.index();
  }
}

TEST(MessageAuthenticator, FingerprintsAreEqualForEqualKeysOnly) {
  EXPECT_EQ(kMemberAuthenticator.fingerprint(), kCoordinatorAuthenticator.fingerprint());
  EXPECT_NE(kMemberAuthenticator.fingerprint(), kOtherTeam.fingerprint());
  EXPECT_NE(kMemberAuthenticator.fingerprint(), 0u);
  EXPECT_EQ(MessageAuthenticator().fingerprint(), 0u);
  MissionKey half = key_of(1);
  half.coordinator = key_of(2).coordinator;
  EXPECT_NE(MessageAuthenticator(half).fingerprint(), kMemberAuthenticator.fingerprint())
      << "obeys another sender";
}

TEST(MessageAuthenticator, WhatHasNoKeyOrAnotherIsRefusedByName) {
  for (const Message& message : every_message()) {
    const std::string& channel = channel_of(message);
    EXPECT_EQ(opened(authenticated(message, MessageAuthenticator()), kMemberAuthenticator, channel),
              "unkeyed");
    EXPECT_EQ(
        opened(authenticated(unsigned_copy(message), kOtherTeam), kMemberAuthenticator, channel),
        "tag");
    EXPECT_EQ(opened(authenticated(unsigned_copy(message), kCoordinatorAuthenticator),
                     MessageAuthenticator(), channel),
              "tag");
  }
}

TEST(MessageAuthenticator, NoChangedBitIsAccepted) {
  for (const Message& message : every_message()) {
    const Bytes good = authenticated(unsigned_copy(message), kCoordinatorAuthenticator);
    for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
      Bytes bad = good;
      bad[bit / 8] ^= static_cast<std::byte>(1 << (bit % 8));
      EXPECT_NE(opened(bad, kMemberAuthenticator, channel_of(message)), "accepted") << bit;
      // Knowledge of the format without the key does not help.
      ASSERT_NE(opened(retagged(bad), kMemberAuthenticator, channel_of(message)), "accepted")
          << bit;
    }
  }
}

TEST(MessageAuthenticator, ARepeatUnderAnotherNameIsRefused) {
  const Bytes bytes = authenticated(contribution(), kMemberAuthenticator);
  EXPECT_EQ(opened(bytes, kMemberAuthenticator, "ERGOCAST_CONTRIBUTION_3"), "accepted");
  for (const char* channel : {"ERGOCAST_CONTRIBUTION_4", "ERGOCAST_CONTRIBUTION", ""}) {
    EXPECT_EQ(opened(bytes, kMemberAuthenticator, channel), "tag") << channel;
  }
  // A teammate relays it under its own name, which needs the key.
  EXPECT_EQ(opened(authenticated(contribution(), kMemberAuthenticator, 4), kMemberAuthenticator,
                   "ERGOCAST_CONTRIBUTION_4"),
            "accepted");
}

TEST(MessageAuthenticator, AMemberCannotSendInTheNameOfTheCoordinator) {
  for (const Message& message : every_message()) {
    if (!is_signed(message)) continue;
    const std::string& channel = channel_of(message);
    EXPECT_EQ(opened(authenticated(unsigned_copy(message), kMemberAuthenticator),
                     kMemberAuthenticator, channel),
              "unsigned");
    EXPECT_EQ(opened(authenticated(message, kMemberAuthenticator), kMemberAuthenticator, channel),
              "unsigned");
  }
}

TEST(MessageAuthenticator, AMemberRepeatsWhatTheCoordinatorSignedButCannotChangeIt) {
  const Message sent = unsigned_copy(mission_part());
  const Bytes bytes = authenticated(sent, kCoordinatorAuthenticator);
  const auto decoded = decode(bytes, kRun, kMemberAuthenticator, channel_of(sent));
  auto part = std::get<MissionPart>(decoded.value());
  EXPECT_EQ(authenticated(part, kMemberAuthenticator), bytes);
  part.revision += 1;
  EXPECT_EQ(
      opened(authenticated(part, kMemberAuthenticator), kMemberAuthenticator, channel_of(sent)),
      "unsigned");
}

TEST(MessageAuthenticator, ASignatureIsOfOneMessageOfOneRun) {
  Stop stop;
  stop.header = header_of_sender(kOperator);
  const auto decoded = decode(authenticated(stop, kCoordinatorAuthenticator), kRun,
                              kMemberAuthenticator, channel_of(stop));
  Stop again = std::get<Stop>(decoded.value());
  again.header.run = kRun + 1;
  EXPECT_EQ(verdict(decode(authenticated(again, kMemberAuthenticator), 0, kMemberAuthenticator,
                           channel_of(stop))),
            "unsigned");
}

/// The same team with another coordinator's public key, for which the first one's signatures are
/// invalid.
MessageAuthenticator obeying_another() {
  MissionKey key = member_of(key_of(1));
  key.coordinator = key_of(2).coordinator;
  return MessageAuthenticator(key);
}

TEST(KnownSignatures, ASignatureThatHasHeldIsNotCheckedAgain) {
  const Message sent = unsigned_copy(mission_part());
  const Bytes bytes = authenticated(sent, kCoordinatorAuthenticator);
  const std::string& channel = channel_of(sent);
  KnownSignatures known;
  EXPECT_EQ(verdict(decode(bytes, kRun, obeying_another(), channel, &known)), "unsigned");
  EXPECT_EQ(verdict(decode(bytes, kRun, kMemberAuthenticator, channel, &known)), "accepted");
  // A check of the signature would refuse it.
  EXPECT_EQ(verdict(decode(bytes, kRun, obeying_another(), channel, &known)), "accepted");
}

TEST(KnownSignatures, WhatIsRefusedIsNotRemembered) {
  const Message sent = unsigned_copy(mission_part());
  const std::string& channel = channel_of(sent);
  const Bytes forged = authenticated(sent, kMemberAuthenticator);
  KnownSignatures known;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(verdict(decode(forged, kRun, kMemberAuthenticator, channel, &known)), "unsigned");
  }
  const Bytes good = authenticated(sent, kCoordinatorAuthenticator);
  EXPECT_EQ(verdict(decode(good, kRun, kMemberAuthenticator, channel, &known)), "accepted");
}

TEST(KnownSignatures, AKnownTagMakesNoOtherBytesAcceptable) {
  const Message sent = unsigned_copy(mission_part());
  const std::string& channel = channel_of(sent);
  const Bytes good = authenticated(sent, kCoordinatorAuthenticator);
  KnownSignatures known;
  ASSERT_EQ(verdict(decode(good, kRun, kMemberAuthenticator, channel, &known)), "accepted");
  for (std::size_t at = 0; at < good.size(); ++at) {
    Bytes bad = good;
    bad[at] ^= std::byte{1};
    EXPECT_NE(verdict(decode(bad, kRun, kMemberAuthenticator, channel, &known)), "accepted") << at;
  }
  // The message of a former run is still refused.
  EXPECT_EQ(verdict(decode(good, kRun + 1, kMemberAuthenticator, channel, &known)), "run");
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
  Bytes bytes = authenticated(stop(), kCoordinatorAuthenticator);
  bytes.resize(kHeaderBytes + 63);
  kMemberAuthenticator.close(bytes, false, channel_of(stop()));
  EXPECT_EQ(opened(bytes, kMemberAuthenticator, channel_of(stop())), "unsigned");
}

TEST(MessageAuthenticator, WithoutAKeyTheTagIsThatOfTheFormat) {
  for (const Message& message : every_message()) {
    EXPECT_EQ(authenticated(message, MessageAuthenticator()), retagged(encoded(message)));
  }
}

TEST(MessageAuthenticator, TheKeyedTagIsBlake2bOverMessageAndChannel) {
  const Bytes bytes = authenticated(command(), kMemberAuthenticator);
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
