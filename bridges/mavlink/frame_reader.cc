// SPDX-License-Identifier: BSD-3-Clause
// Looks for a first byte, waits for as many bytes as the header says, and skips one byte where no
// frame begins.
#include "bridges/mavlink/frame_reader.h"

#include <algorithm>
#include <ranges>

#include "bridges/mavlink/checksum.h"

namespace ergocast::mavlink {
namespace {

constexpr std::byte kVersion1{0xFE}, kVersion2{0xFD};
constexpr std::uint8_t kSigned = 1;

/// Where the parts of a frame are.
struct Header {
  bool second_version;
  std::size_t header_bytes, payload_bytes, whole_bytes;
  std::uint32_t id;
  Source from;
  bool has_signature;
};

std::uint8_t at(std::span<const std::byte> bytes, std::size_t place) {
  return std::to_integer<std::uint8_t>(bytes[place]);
}

/// @pre `bytes` begin with a first byte and have the whole header
Header header_of(std::span<const std::byte> bytes) {
  const std::size_t payload = at(bytes, 1);
  if (bytes[0] == kVersion1) {
    const Source from{at(bytes, 3), at(bytes, 4)};
    return {false, 6, payload, 6 + payload + 2, at(bytes, 5), from, false};
  }
  const bool has_signature = (at(bytes, 2) & kSigned) != 0;
  const std::uint32_t id = at(bytes, 7) | at(bytes, 8) << 8 | at(bytes, 9) << 16;
  const std::size_t whole = 10 + payload + 2 + (has_signature ? kSignatureBytes : 0);
  return {true, 10, payload, whole, id, {at(bytes, 5), at(bytes, 6)}, has_signature};
}

std::size_t header_bytes(std::byte first) { return first == kVersion1 ? 6 : 10; }

bool intact(std::span<const std::byte> frame, const Header& header, const Type& type) {
  const std::size_t end = header.header_bytes + header.payload_bytes;
  Checksum sum;
  sum.add(frame.subspan(1, end - 1));
  sum.add(std::byte{type.crc_extra});
  return at(frame, end) == (sum.value() & 0xFF) && at(frame, end + 1) == sum.value() >> 8;
}

/// A receiver refuses frames with flags that it does not know. Version 1 cuts no zeros. Some
/// senders give it extensions, too.
bool possible(std::span<const std::byte> frame, const Header& header, const Type& type) {
  if (!header.second_version) return header.payload_bytes >= type.base_bytes;
  return (at(frame, 2) & ~kSigned) == 0;
}

}  // namespace

void FrameReader::read(std::span<const std::byte> bytes, std::vector<Received>& out) {
  // Never holds more than a frame and the new bytes.
  held_.insert(held_.end(), bytes.begin(), bytes.end());
  std::size_t done = 0;
  for (;;) {
    const auto begin = std::find_if(held_.begin() + static_cast<std::ptrdiff_t>(done), held_.end(),
                                    [](std::byte b) { return b == kVersion1 || b == kVersion2; });
    done = static_cast<std::size_t>(begin - held_.begin());
    const std::size_t left = held_.size() - done;
    const auto rest = std::span(held_).subspan(done);
    if (left == 0 || left < header_bytes(rest[0])) break;
    const Header header = header_of(rest);
    if (left < header.whole_bytes) break;
    const auto frame = rest.first(header.whole_bytes);
    const Type* type = type_of(header.id);
    if (type == nullptr) {
      ++counts_.unknown;  // its checksum cannot be verified
      done += header.whole_bytes;
      continue;
    }
    if (!possible(frame, header, *type) || !intact(frame, header, *type)) {
      ++counts_.damaged;
      done += 1;
      continue;
    }
    done += header.whole_bytes;
    if (key_ && !counts_as_signed(frame, header.from)) continue;
    ++counts_.read;
    out.push_back({header.from, *packet_of(header.id, frame.subspan(header.header_bytes,
                                                                    header.payload_bytes))});
  }
  held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(done));
}

/// Counts why not.
bool FrameReader::counts_as_signed(std::span<const std::byte> frame, const Source& from) {
  if (frame[0] == kVersion1 || (at(frame, 2) & kSigned) == 0) return ++counts_.unsigned_, false;
  const auto block = frame.last<kSignatureBytes>();
  const std::uint8_t link = at(block, 0);
  const std::uint64_t time = time_of(block);
  const SignatureBlock expected =
      sign(*key_, frame.first(frame.size() - kSignatureBytes), link, time);
  if (!std::ranges::equal(block, expected)) return ++counts_.wrong_key, false;
  const std::array<std::uint8_t, 3> signer{from.system, from.component, link};
  const auto last = times_.find(signer);
  const bool old = last != times_.end()
                       ? time <= last->second
                       : times_.size() >= kMaxSigners || time + kSigningSlack < newest_time_;
  if (old) return ++counts_.repeated, false;
  times_[signer] = time;
  newest_time_ = std::max(newest_time_, time);
  return true;
}

}  // namespace ergocast::mavlink
