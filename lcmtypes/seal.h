// SPDX-License-Identifier: BSD-3-Clause
// What makes a datagram believable: a tag over all its bytes and, on what begins, rules and ends a
// mission, a signature. Both stand at fixed places and are checked before anything is decoded.
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
inline constexpr std::size_t kMaxDatagramBytes = 1220;
/// Where the tag stands in every message.
inline constexpr std::size_t kTagOffset = 44;
inline constexpr std::size_t kTagBytes = 16;
inline constexpr std::size_t kHeaderEnd = kTagOffset + kTagBytes;

/// What the members of a team share and outsiders do not know.
struct MissionKey {
  using Secret = std::array<std::byte, 32>;
  using SigningKey = std::array<std::byte, 64>;

  Secret shared{};                    ///< whoever has it can speak for any agent, world or logger
  Secret coordinator{};               ///< Ed25519 public key: whom to obey
  std::optional<SigningKey> signing;  ///< its secret half: only to coordinators and operators
};

/// Signed messages whose signature has held, by their keyed tags, so that a repeat costs a look and no
/// signature. Only what was verified gets in; a tag that fits binds every byte, signature included.
class KnownSignatures {
 public:
  bool contains(std::span<const std::byte> message) const;
  void add(std::span<const std::byte> message);

  /// Each tag has one place, where a later one replaces it: then that message is checked again.
  static constexpr std::size_t kCapacity = 4096;

 private:
  using Tag = std::array<std::byte, kTagBytes>;
  static Tag tag_of(std::span<const std::byte> message);
  static std::size_t place_of(const Tag& tag);
  std::vector<Tag> tags_;
};

/// Closes datagrams that are sent and looks at those that arrive. Cheap to copy.
///
/// Without a key the tag is XXH3-128 of the message with the tag taken as zero: damage is found,
/// forgery is not. With one it is BLAKE2b-128, keyed with MissionKey::shared, of the same bytes
/// followed by the name of the channel, so that an outsider can at most repeat, word for word and on
/// its own channel, what a member has said. The signature is Ed25519 over the message with tag and
/// signature taken as zero, so that a teammate can repeat a signed message.
class Seal {
 public:
  Seal() = default;
  explicit Seal(const MissionKey& key);

  bool keyed() const { return key_ != nullptr; }
  /// By which two hosts tell whether they have the same key without showing it; 0 without one.
  std::uint64_t fingerprint() const;
  /// Whether it can speak for the coordinator: always, if there is no key.
  bool can_sign() const { return !keyed() || key_->signing; }

  /// Signs, if it can, a message whose signature is zero; then writes the tag.
  /// @param has_signature  whether the header is followed by a place for one
  void close(std::span<std::byte> bytes, bool has_signature, std::string_view channel) const;

  /// Nothing, or kTag, or kUnkeyed: of a sender without a key.
  /// @pre kHeaderEnd to kMaxDatagramBytes bytes
  std::optional<Refusal> check_tag(std::span<const std::byte> bytes, std::string_view channel) const;
  /// Whether who may begin and end missions has signed it; true without a key.
  /// @param known  spares checking again what has held before, and learns; may be null
  /// @pre check_tag() found nothing wrong
  bool signature_holds(std::span<const std::byte> bytes, KnownSignatures* known = nullptr) const;

 private:
  void sign(std::span<std::byte> bytes) const;

  std::shared_ptr<const MissionKey> key_;
};

}  // namespace ergocast
