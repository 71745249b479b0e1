// SPDX-License-Identifier: BSD-3-Clause
// Checks sizes, counts and the tag on raw bytes, and only then calls the generated decoder of
// the type.
#include "lcmtypes/codec.h"

#include <algorithm>
#include <cstring>

#include "core/require.h"
#include "lcmtypes/wire.h"

namespace ergocast {
namespace {

constexpr std::size_t kSignatureEnd = kHeaderEnd + sizeof(Signature);
constexpr std::size_t kRosterEntryBytes = 45;
constexpr std::size_t kVehicleBytes = 60;
constexpr std::size_t kDigestEntryBytes = 28;

// ---- numbers on the wire: big-endian --------------------------------------------------------

std::uint64_t read64(const std::byte* at) {
  std::uint64_t raw;
  std::memcpy(&raw, at, sizeof raw);
  return __builtin_bswap64(raw);
}
std::int32_t read32(const std::byte* at) {
  std::uint32_t raw;
  std::memcpy(&raw, at, sizeof raw);
  return static_cast<std::int32_t>(__builtin_bswap32(raw));
}

// ---- sizes: what the counts inside declare must be what arrived ---------------------------------

/// Walks over the variable tail of a message without believing it.
class Tail {
 public:
  Tail(std::span<const std::byte> bytes, std::size_t offset) : bytes_(bytes), at_(offset) {}

  bool skip(std::size_t count) { return ok_ = ok_ && bytes_.size() - at_ >= count && advance(count); }
  bool string(int max_length) {
    if (!ok_ || bytes_.size() - at_ < 4) return ok_ = false;
    const std::int32_t declared = read32(bytes_.data() + at_);  // includes the final NUL
    if (declared < 1 || declared > max_length + 1) return ok_ = false;
    return skip(4 + static_cast<std::size_t>(declared)) && (ok_ = bytes_[at_ - 1] == std::byte{0});
  }
  bool ended() const { return ok_ && at_ == bytes_.size(); }

 private:
  bool advance(std::size_t count) {
    at_ += count;
    return true;
  }
  std::span<const std::byte> bytes_;
  std::size_t at_;
  bool ok_ = true;
};

bool count_at(std::span<const std::byte> bytes, std::size_t offset, int limit, std::size_t& count) {
  if (bytes.size() < offset + 4) return false;
  const std::int32_t declared = read32(bytes.data() + offset);
  if (declared < 0 || declared > limit) return false;
  count = static_cast<std::size_t>(declared);
  return true;
}

bool sizes_match(const hello_t*, std::span<const std::byte> bytes) {
  Tail tail(bytes, kHeaderEnd);
  return tail.skip(4 + 8) && tail.string(kMaxHostLength) && tail.string(kMaxVersionLength) &&
         tail.ended();
}

bool sizes_match(const mission_t*, std::span<const std::byte> bytes) {
  constexpr std::size_t kRosterCountOffset = kSignatureEnd + 8 + 1 + 4 + 4;
  std::size_t roster = 0, plan = 0;
  if (!count_at(bytes, kRosterCountOffset, kMaxRosterEntriesPerMessage, roster) ||
      !count_at(bytes, kRosterCountOffset + 4, kMaxPlanBytesPerMessage, plan)) {
    return false;
  }
  Tail tail(bytes, kRosterCountOffset + 8);
  return tail.skip(roster * kRosterEntryBytes + plan) && tail.string(kMaxReasonLength) &&
         tail.ended();
}

bool sizes_match(const agent_status_t*, std::span<const std::byte> bytes) {
  Tail tail(bytes, kHeaderEnd);
  return tail.skip(1 + 8 + 8 + 4 + 8 * 7 + 8 * kRefusalKinds + 4 + 8 + 8) && tail.string(kMaxHostLength) &&
         tail.ended();
}

bool sizes_match(const team_status_t*, std::span<const std::byte> bytes) {
  Tail tail(bytes, kHeaderEnd);
  return tail.skip(1 + 8 + 4 + 4 + 8 + 4 + 8) && tail.string(kMaxHostLength) && tail.ended();
}

bool sizes_match(const stop_t*, std::span<const std::byte> bytes) {
  Tail tail(bytes, kHeaderEnd);
  return tail.skip(sizeof(Signature) + 2) && tail.string(kMaxReasonLength) && tail.ended();
}

bool sizes_match(const world_state_t*, std::span<const std::byte> bytes) {
  std::size_t vehicles = 0;
  return count_at(bytes, kHeaderEnd + 40, kMaxVehiclesPerState, vehicles) &&
         bytes.size() == kHeaderEnd + 44 + vehicles * kVehicleBytes;
}

bool sizes_match(const digest_t*, std::span<const std::byte> bytes) {
  std::size_t entries = 0;
  return count_at(bytes, kHeaderEnd, kMaxDigestEntriesPerMessage, entries) &&
         bytes.size() == kHeaderEnd + 4 + entries * kDigestEntryBytes;
}

template <class Fixed>
bool sizes_match(const Fixed*, std::span<const std::byte> bytes) {
  static const auto size = static_cast<std::size_t>(Fixed{}.getEncodedSize());
  return bytes.size() == size;
}

// ---- what the bytes say --------------------------------------------------------------------------

/// Who alone says some things; of the others any sender may.
template <class Plain>
AgentId speaker_of(const Plain& m) {
  return m.header.sender;
}
AgentId speaker_of(const WorldState&) { return kWorld; }
AgentId speaker_of(const RecordAck&) { return kLogger; }
AgentId speaker_of(const MissionPart&) { return kCoordinator; }
AgentId speaker_of(const TeamStatus&) { return kCoordinator; }

/// The message is made where it is returned: a contribution is a kilobyte, too much to pass along.
template <class Wire, class Plain>
std::variant<Message, Refusal> decode_as(std::span<const std::byte> bytes) {
  std::variant<Message, Refusal> result(Refusal::kSize);
  if (!sizes_match(static_cast<const Wire*>(nullptr), bytes)) return result;
  Wire wire;
  const int size = static_cast<int>(bytes.size());
  if (wire.decode(bytes.data(), 0, size) != size) return result;
  auto& plain = result.emplace<Message>().emplace<Plain>();
  if (!from_wire(wire, plain) || !plausible(plain.header) ||
      plain.header.sender != speaker_of(plain)) {
    result = Refusal::kRange;
  }
  return result;
}

/// What begins, rules and ends missions: whoever has only the team's shared key cannot say it.
template <class Plain>
constexpr bool kSigned = std::is_same_v<Plain, MissionPart> || std::is_same_v<Plain, Stop>;

struct Decoder {
  std::uint64_t fingerprint;
  bool is_signed;
  std::variant<Message, Refusal> (*decode)(std::span<const std::byte>);
};

template <class Wire, class Plain>
Decoder entry() {
  return {static_cast<std::uint64_t>(Wire::getHash()), kSigned<Plain>, &decode_as<Wire, Plain>};
}

const Decoder* decoder_for(std::uint64_t fingerprint) {
  static const std::array kDecoders = {
      entry<contribution_t, Contribution>(), entry<world_state_t, WorldState>(),
      entry<command_t, Command>(),           entry<agent_status_t, AgentStatus>(),
      entry<record_ack_t, RecordAck>(),      entry<mission_t, MissionPart>(),
      entry<team_status_t, TeamStatus>(),    entry<hello_t, Hello>(),
      entry<stop_t, Stop>(),                 entry<digest_t, Digest>()};
  const auto at = std::find_if(kDecoders.begin(), kDecoders.end(), [&](const Decoder& decoder) {
    return decoder.fingerprint == fingerprint;
  });
  return at == kDecoders.end() ? nullptr : &*at;
}

}  // namespace

void encode(const Message& message, std::vector<std::byte>& out, const Seal& seal,
            std::string_view channel) {
  std::visit(
      [&](const auto& plain) {
        const auto wire = to_wire(plain);
        const int size = wire.getEncodedSize();
        out.resize(static_cast<std::size_t>(size));
        ERGOCAST_REQUIRE(out.size() <= kMaxDatagramBytes);
        ERGOCAST_REQUIRE(wire.encode(out.data(), 0, size) == size);
        seal.close(out, kSigned<std::decay_t<decltype(plain)>>, channel);
      },
      message);
}

std::variant<Message, Refusal> decode(std::span<const std::byte> bytes, RunId run, const Seal& seal,
                                      std::string_view channel, KnownSignatures* known) noexcept {
  if (bytes.size() < kHeaderEnd || bytes.size() > kMaxDatagramBytes) return Refusal::kSize;
  const Decoder* decoder = decoder_for(read64(bytes.data()));
  if (decoder == nullptr) return Refusal::kType;
  if (const auto refusal = seal.check_tag(bytes, channel)) return *refusal;
  if (run != 0 && read64(bytes.data() + 8) != run) return Refusal::kRun;
  try {
    if (decoder->is_signed && !seal.signature_holds(bytes, known)) return Refusal::kUnsigned;
    return decoder->decode(bytes);
  } catch (...) {  // only memory can run out here
    return Refusal::kLimit;
  }
}

}  // namespace ergocast
