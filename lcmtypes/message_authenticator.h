// SPDX-License-Identifier: BSD-3-Clause
// Authenticates datagrams: by a tag over all bytes, and by a signature on messages that begin,
// control or end a mission. Both have fixed places and are checked before anything is decoded.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "team/messages.h"

namespace ergocast {

/// Longest datagram we send: one Ethernet frame on any path with an MTU of 1280.
/// Limit (Messages): length of a message [bytes]. Beyond it: the kernel drops it, or it is refused
/// with `size`.
inline constexpr std::size_t kMaxDatagramBytes = 1220;
/// The offset of the tag in every message.
inline constexpr std::size_t kTagOffset = 44;
inline constexpr std::size_t kTagBytes = 16;
inline constexpr std::size_t kHeaderEnd = kTagOffset + kTagBytes;

/// The secrets that the members of a team share.
struct MissionKey {
  using Secret = std::array<std::byte, 32>;
  using SigningKey = std::array<std::byte, 64>;

  Secret shared{};                    ///< its holder can send as any agent, world or logger
  Secret coordinator{};               ///< Ed25519 public key of the coordinators and operators
  std::optional<SigningKey> signing;  ///< its secret half: only for coordinators and operators
};

/// Signed messages with a valid signature, by their keyed tags, so that a repeat needs no second
/// check of the signature. Only verified messages are stored; a valid tag covers every byte,
/// signature included.
class KnownSignatures {
 public:
  bool contains(std::span<const std::byte> message) const;
  void add(std::span<const std::byte> message);

  /// A later message may replace a tag with the same place; the replaced message is then checked
  /// again.
  /// Limit (Messages): signatures that a process remembers. Beyond it: one is checked again.
  static constexpr std::size_t kCapacity = 4096;

 private:
  using Tag = std::array<std::byte, kTagBytes>;
  static Tag tag_of(std::span<const std::byte> message);
  static std::size_t place_of(const Tag& tag);
  std::vector<Tag> tags_;
};

/// Protects outgoing datagrams and verifies incoming ones. Cheap to copy.
///
/// Without a key the tag is XXH3-128 of the message with zeros in place of the tag. It detects
/// damage, but no forgery. With a key it is BLAKE2b-128, keyed with MissionKey::shared, of the same
/// bytes and the name of the channel. An outsider can then only repeat a member's message
/// unchanged, on its own channel. The signature is Ed25519 over the message with zeros in place of
/// tag and signature. So a teammate can repeat a signed message.
class MessageAuthenticator {
 public:
  MessageAuthenticator() = default;
  explicit MessageAuthenticator(const MissionKey& key);

  bool keyed() const { return key_ != nullptr; }
  /// The secret itself, for a process that hands it to others; null without a key.
  const MissionKey* key() const { return key_.get(); }
  /// Lets two hosts compare their keys without revealing them; 0 without a key.
  std::uint64_t fingerprint() const;
  /// Whether it can sign as a coordinator or operator: always, if there is no key.
  bool can_sign() const { return !keyed() || key_->signing; }

  /// Signs a message whose signature is zero, if it has the signing key; then writes the tag.
  /// @param has_signature  whether the message has a signature field after the header
  void close(std::span<std::byte> bytes, bool has_signature, std::string_view channel) const;

  /// Nothing if the tag is valid, or kTag, or kUnkeyed for a sender without a key. Only with a key
  /// the comparison takes the same time for every tag.
  /// @pre kHeaderEnd to kMaxDatagramBytes bytes
  std::optional<Refusal> check_tag(std::span<const std::byte> bytes,
                                   std::string_view channel) const;
  /// Whether the holder of the signing key has signed it; true without a key.
  /// @param known  valid signatures, to skip the check and to extend; may be null
  /// @pre check_tag() found nothing wrong
  bool signature_holds(std::span<const std::byte> bytes, KnownSignatures* known = nullptr) const;

 private:
  void sign(std::span<std::byte> bytes) const;

  std::shared_ptr<const MissionKey> key_;
};

}  // namespace ergocast
