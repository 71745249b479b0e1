// SPDX-License-Identifier: BSD-3-Clause
// Checks sizes, counts and the tag on raw bytes, and only then decodes the fields.
#include "lcmtypes/codec.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "lcmtypes/fields.h"
#include "lcmtypes/wire.h"

namespace ergocast {
namespace {

std::uint64_t read64(const std::byte* at) {
  std::uint64_t raw;
  std::memcpy(&raw, at, sizeof raw);
  return swapped(raw);
}

template <class M>
std::uint64_t fingerprint() {
  static const auto hash = static_cast<std::uint64_t>(Fields<M>::Generated::getHash());
  return hash;
}

template <class Plain>
bool may_send(AgentId sender) {
  if constexpr (requires { Fields<Plain>::kSender; }) {
    return sender == Fields<Plain>::kSender;
  } else {
    return true;
  }
}

/// Decodes the message into the return value: a contribution is a kilobyte and should not be
/// copied.
/// @tparam Form  whose fields the bytes are
template <class Plain, class Form>
Decoded decode_as(std::span<const std::byte> bytes) {
  Decoded result;
  auto& plain = result->emplace<Plain>();
  Reader reader(bytes.subspan(sizeof(std::uint64_t)));
  Fields<Header>::list(reader, plain.header);
  Fields<Form>::list(reader, plain);
  if constexpr (std::is_same_v<Form, Averages> || std::is_same_v<Form, LowAverages>)
    plain.encoding = ContributionEncoding::kFixed16;
  const bool can_be_true = reader.plausible() && may_send<Plain>(plain.header.sender);
  if (!reader.complete()) {
    result = failure(Refusal::kSize);
  } else if (!can_be_true) {
    result = failure(Refusal::kRange);
  }
  return result;
}

/// Messages that begin, control or end missions need a signature: the team's shared key is not
/// enough.
template <class Plain>
constexpr bool kSigned = requires(Plain message) {
  message.signature;
};

struct Decoder {
  std::uint64_t fingerprint;
  bool is_signed;
  Decoded (*decode)(std::span<const std::byte>);
};

template <class Plain, class Form = Plain>
Decoder entry() {
  return {fingerprint<Form>(), kSigned<Plain>, &decode_as<Plain, Form>};
}

/// A contribution has three more forms.
template <class... M>
auto decoders_of(std::type_identity<std::variant<M...>>) {
  return std::array{entry<M>()..., entry<Contribution, Averages>(), entry<Contribution, LowSums>(),
                    entry<Contribution, LowAverages>()};
}

const Decoder* decoder_for(std::uint64_t wanted) {
  static const auto kDecoders = decoders_of(std::type_identity<Message>());
  const auto at = std::find_if(kDecoders.begin(), kDecoders.end(), [&](const Decoder& decoder) {
    return decoder.fingerprint == wanted;
  });
  return at == kDecoders.end() ? nullptr : &*at;
}

template <class Form, class Plain>
void write(const Plain& plain, std::vector<std::byte>& out) {
  Writer writer(out);
  writer.number(fingerprint<Form>());
  Fields<Header>::list(writer, plain.header);
  Fields<Form>::list(writer, plain);
  out.resize(writer.size());
}

void write_block(const Contribution& block, std::vector<std::byte>& out) {
  const bool rounds = block.encoding == ContributionEncoding::kFixed16;
  if (block.sums.size() == kLowModes) {
    rounds ? write<LowAverages>(block, out) : write<LowSums>(block, out);
  } else {
    rounds ? write<Averages>(block, out) : write<Contribution>(block, out);
  }
}

}  // namespace

void encode(const Message& message, std::vector<std::byte>& out,
            const MessageAuthenticator& authenticator, std::string_view channel) {
  std::visit(
      [&](const auto& plain) {
        using Plain = std::decay_t<decltype(plain)>;
        if constexpr (std::is_same_v<Plain, Contribution>) {
          write_block(plain, out);
        } else {
          write<Plain>(plain, out);
        }
        authenticator.close(out, kSigned<Plain>, channel);
      },
      message);
}

Decoded decode(std::span<const std::byte> bytes, RunId run,
               const MessageAuthenticator& authenticator, std::string_view channel,
               KnownSignatures* known) noexcept {
  if (bytes.size() < kHeaderEnd || bytes.size() > kMaxDatagramBytes) return failure(Refusal::kSize);
  const Decoder* decoder = decoder_for(read64(bytes.data()));
  if (decoder == nullptr) return failure(Refusal::kType);
  if (const auto refusal = authenticator.check_tag(bytes, channel)) return failure(*refusal);
  if (run != 0 && read64(bytes.data() + 8) != run) return failure(Refusal::kRun);
  try {
    if (decoder->is_signed && !authenticator.signature_holds(bytes, known))
      return failure(Refusal::kUnsigned);
    return decoder->decode(bytes);
  } catch (...) {  // only memory exhaustion can throw here
    return failure(Refusal::kLimit);
  }
}

}  // namespace ergocast
