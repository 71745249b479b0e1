// SPDX-License-Identifier: BSD-3-Clause
// Writes header, payload, checksum and signature.
#include "bridges/mavlink/frame_writer.h"

#include <sodium.h>

#include <algorithm>

#include "bridges/mavlink/checksum.h"

namespace ergocast::mavlink {

SignatureBlock sign(const SigningKey& key, std::span<const std::byte> frame, std::uint8_t link,
                    std::uint64_t time) {
  SignatureBlock block{std::byte{link}};
  for (int i = 0; i < 6; ++i) block.at(1 + i) = static_cast<std::byte>(time >> (8 * i) & 0xFF);
  const auto bytes = [](const std::byte* data) {
    return reinterpret_cast<const unsigned char*>(data);
  };
  crypto_hash_sha256_state state;
  crypto_hash_sha256_init(&state);
  crypto_hash_sha256_update(&state, bytes(key.data()), key.size());
  crypto_hash_sha256_update(&state, bytes(frame.data()), frame.size());
  crypto_hash_sha256_update(&state, bytes(block.data()), 7);
  std::array<std::byte, crypto_hash_sha256_BYTES> hash{};
  crypto_hash_sha256_final(&state, reinterpret_cast<unsigned char*>(hash.data()));
  std::copy_n(hash.begin(), 6, block.begin() + 7);
  return block;
}

std::uint64_t time_of(std::span<const std::byte, kSignatureBytes> block) {
  std::uint64_t time = 0;
  for (std::size_t i = 0; i < 6; ++i)
    time |= std::to_integer<std::uint64_t>(block[1 + i]) << (8 * i);
  return time;
}

std::vector<std::byte> FrameWriter::frame_of(const Packet& packet, const Source& from) {
  const Type type = std::visit([](const auto& m) { return *type_of(m.kId); }, packet);
  const std::vector<std::byte> payload = payload_of(packet);
  std::vector<std::byte> out;
  const std::uint8_t signed_flag = key_ ? 1 : 0;
  for (const std::uint32_t byte :
       {0xFDU, static_cast<std::uint32_t>(payload.size()), std::uint32_t{signed_flag}, 0U,
        std::uint32_t{sequence_++}, std::uint32_t{from.system}, std::uint32_t{from.component},
        type.id & 0xFF, type.id >> 8 & 0xFF, type.id >> 16})
    out.push_back(static_cast<std::byte>(byte));
  out.insert(out.end(), payload.begin(), payload.end());
  Checksum sum;
  sum.add(std::span(out).subspan(1));
  sum.add(std::byte{type.crc_extra});
  out.push_back(static_cast<std::byte>(sum.value() & 0xFF));
  out.push_back(static_cast<std::byte>(sum.value() >> 8));
  if (key_) {
    const SignatureBlock block = sign(*key_, out, 0, time_++);
    out.insert(out.end(), block.begin(), block.end());
  }
  return out;
}

}  // namespace ergocast::mavlink
