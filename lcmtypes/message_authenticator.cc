// SPDX-License-Identifier: BSD-3-Clause
// Hashes a message with its tag and signature masked by zeros, and stores which signatures were
// valid.
#include "lcmtypes/message_authenticator.h"

#include <sodium.h>
#include <xxhash.h>

#include <algorithm>
#include <cstring>

#include "core/base/require.h"

namespace ergocast {
namespace {

using Tag = std::array<std::byte, kTagBytes>;

static_assert(sizeof(MissionKey::Secret) == crypto_generichash_KEYBYTES);
static_assert(sizeof(MissionKey::Secret) == crypto_sign_PUBLICKEYBYTES);
static_assert(sizeof(MissionKey::SigningKey) == crypto_sign_SECRETKEYBYTES);
static_assert(sizeof(Signature) == crypto_sign_BYTES);

template <class Bytes>
auto raw(Bytes& bytes) {
  using Byte = std::conditional_t<std::is_const_v<std::remove_pointer_t<decltype(bytes.data())>>,
                                  const unsigned char, unsigned char>;
  return reinterpret_cast<Byte*>(bytes.data());
}

/// A message with `count` bytes, from the tag on, masked by zeros.
class MaskedBytes {
 public:
  MaskedBytes(std::span<const std::byte> bytes, std::size_t count) : size_(bytes.size()) {
    ERGOCAST_REQUIRE(bytes.size() >= kTagOffset + count && bytes.size() <= bytes_.size());
    std::copy(bytes.begin(), bytes.end(), bytes_.begin());
    std::fill_n(bytes_.begin() + kTagOffset, count, std::byte{0});
  }
  const unsigned char* data() const { return raw(bytes_); }
  std::size_t size() const { return size_; }

 private:
  std::array<std::byte, kMaxDatagramBytes> bytes_;
  std::size_t size_;
};

constexpr std::size_t kUnsignedBytes = kTagBytes + sizeof(Signature);

Tag hash_of(const unsigned char* message, std::size_t size) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(message, size));
  Tag tag;
  std::memcpy(tag.data(), canonical.digest, kTagBytes);
  return tag;
}

/// The tag without a key. It hashes a copy, because XXH3 takes longer over three parts.
Tag hash_of(std::span<const std::byte> bytes) {
  const MaskedBytes message(bytes, kTagBytes);
  return hash_of(message.data(), message.size());
}

/// The tag with a key, of the bytes before the tag, zeros and the bytes after it.
Tag keyed_hash_of(std::span<const std::byte> bytes, std::string_view channel,
                  const MissionKey& key) {
  static constexpr unsigned char kNoTag[kTagBytes] = {};
  crypto_generichash_state state;
  crypto_generichash_init(&state, raw(key.shared), key.shared.size(), kTagBytes);
  crypto_generichash_update(&state, raw(bytes), kTagOffset);
  crypto_generichash_update(&state, kNoTag, kTagBytes);
  crypto_generichash_update(&state, raw(bytes) + kHeaderEnd, bytes.size() - kHeaderEnd);
  crypto_generichash_update(&state, raw(channel), channel.size());
  Tag tag;
  crypto_generichash_final(&state, raw(tag), tag.size());
  return tag;
}

}  // namespace

MessageAuthenticator::MessageAuthenticator(const MissionKey& key)
    : key_(std::make_shared<const MissionKey>(key)) {
  ERGOCAST_REQUIRE(sodium_init() >= 0);
}

std::uint64_t MessageAuthenticator::fingerprint() const {
  if (!keyed()) return 0;
  Tag hash;
  crypto_generichash(raw(hash), hash.size(), raw(key_->coordinator), key_->coordinator.size(),
                     raw(key_->shared), key_->shared.size());
  std::uint64_t fingerprint = 0;
  std::memcpy(&fingerprint, hash.data(), sizeof fingerprint);
  return fingerprint;
}

void MessageAuthenticator::close(std::span<std::byte> bytes, bool has_signature,
                                 std::string_view channel) const {
  if (has_signature && keyed() && key_->signing) sign(bytes);
  std::fill_n(bytes.begin() + kTagOffset, kTagBytes, std::byte{0});
  const Tag tag =
      keyed() ? keyed_hash_of(bytes, channel, *key_) : hash_of(raw(bytes), bytes.size());
  std::copy(tag.begin(), tag.end(), bytes.begin() + kTagOffset);
}

void MessageAuthenticator::sign(std::span<std::byte> bytes) const {
  const std::span<std::byte> signature = bytes.subspan(kHeaderEnd, sizeof(Signature));
  const bool is_empty = std::all_of(signature.begin(), signature.end(),
                                    [](std::byte b) { return b == std::byte{0}; });
  if (!is_empty) return;  // a repeated message keeps its signature
  const MaskedBytes message(bytes, kUnsignedBytes);
  crypto_sign_detached(raw(signature), nullptr, message.data(), message.size(),
                       raw(*key_->signing));
}

std::optional<Refusal> MessageAuthenticator::check_tag(std::span<const std::byte> bytes,
                                                       std::string_view channel) const {
  const std::byte* const theirs = bytes.data() + kTagOffset;
  const auto looks_unkeyed = [&] {
    return std::memcmp(hash_of(bytes).data(), theirs, kTagBytes) == 0;
  };
  if (!keyed()) return looks_unkeyed() ? std::nullopt : std::optional(Refusal::kTag);
  const Tag tag = keyed_hash_of(bytes, channel, *key_);
  if (sodium_memcmp(tag.data(), theirs, kTagBytes) == 0) return std::nullopt;
  return looks_unkeyed() ? Refusal::kUnkeyed : Refusal::kTag;
}

bool MessageAuthenticator::signature_holds(std::span<const std::byte> bytes,
                                           KnownSignatures* known) const {
  if (!keyed()) return true;
  if (bytes.size() < kHeaderEnd + sizeof(Signature)) return false;
  if (known != nullptr && known->contains(bytes)) return true;
  const MaskedBytes message(bytes, kUnsignedBytes);
  const bool holds = crypto_sign_verify_detached(raw(bytes) + kHeaderEnd, message.data(),
                                                 message.size(), raw(key_->coordinator)) == 0;
  if (holds && known != nullptr) known->add(bytes);
  return holds;
}

KnownSignatures::Tag KnownSignatures::tag_of(std::span<const std::byte> message) {
  Tag tag;
  std::copy_n(message.begin() + kTagOffset, kTagBytes, tag.begin());
  return tag;
}

std::size_t KnownSignatures::place_of(const Tag& tag) {
  std::size_t place;
  std::memcpy(&place, tag.data(), sizeof place);
  return place % kCapacity;
}

bool KnownSignatures::contains(std::span<const std::byte> message) const {
  const Tag tag = tag_of(message);
  return !tags_.empty() && tags_[place_of(tag)] == tag;
}

void KnownSignatures::add(std::span<const std::byte> message) {
  tags_.resize(kCapacity);
  const Tag tag = tag_of(message);
  tags_[place_of(tag)] = tag;
}

}  // namespace ergocast
