// SPDX-License-Identifier: BSD-3-Clause
// Writes fixed fields in big-endian order and accepts only bytes that this program could have
// written.
#include "cli/doctor/probe.h"

#include <algorithm>
#include <concepts>
#include <string_view>

#include "cli/doctor/finding.h"

namespace ergocast::doctor {
namespace {

constexpr std::string_view kMagic = "ergocast-doctor2";
constexpr std::size_t kHostBytes = 32, kVersionBytes = 16;
constexpr std::size_t kEchoBytes = 8 + 4 * 4 + 8;
constexpr std::size_t kHeaderBytes = kMagic.size() + 8 + 4 + kHostBytes + kVersionBytes + 8 + 4;
constexpr std::uint64_t kLongestHold_ns = 60'000'000'000;

/// Big-endian, like LCM.
template <std::unsigned_integral Number>
void put(Number number, std::vector<std::byte>& out) {
  for (int shift = 8 * (sizeof number - 1); shift >= 0; shift -= 8) {
    out.push_back(static_cast<std::byte>(number >> shift));
  }
}

void put_text(std::string_view text, std::size_t bytes, std::vector<std::byte>& out) {
  for (std::size_t i = 0; i < bytes; ++i) {
    out.push_back(static_cast<std::byte>(i < text.size() ? text[i] : '\0'));
  }
}

template <std::unsigned_integral Number>
Number take(std::span<const std::byte>& bytes) {
  Number number = 0;
  for (std::size_t i = 0; i < sizeof number; ++i) {
    number = static_cast<Number>(number << 8) | static_cast<Number>(bytes[i]);
  }
  bytes = bytes.subspan(sizeof number);
  return number;
}

std::string take_text(std::size_t size, std::span<const std::byte>& bytes) {
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  bytes = bytes.subspan(size);
  return printable(std::string(text, std::find(text, text + size, '\0')));
}

bool possible(const Echo& echo) {
  if (echo.first > echo.last || echo.last >= kMaxProbes || echo.held_ns > kLongestHold_ns) {
    return false;
  }
  const ProbeCount most = probes_between(echo.first, echo.last);
  return echo.received.small <= most.small && echo.received.large <= most.large &&
         echo.received.all() > 0;
}

}  // namespace

ProbeCount probes_between(std::uint32_t first, std::uint32_t last) {
  const std::uint32_t large = (last + 1) / 4 - first / 4;
  return {last - first + 1 - large, large};
}

void write(const Probe& probe, std::vector<std::byte>& out) {
  out.clear();
  put_text(kMagic, kMagic.size(), out);
  put(probe.nonce, out);
  put(probe.sequence, out);
  put_text(probe.host, kHostBytes, out);
  put_text(probe.version, kVersionBytes, out);
  put(probe.key, out);
  const std::size_t count = std::min(probe.echoes.size(), kMaxPeers);
  put(static_cast<std::uint32_t>(count), out);
  for (std::size_t i = 0; i < count; ++i) {
    const Echo& echo = probe.echoes[i];
    put(echo.nonce, out);
    for (const auto number : {echo.first, echo.last, echo.received.small, echo.received.large}) {
      put(number, out);
    }
    put(echo.held_ns, out);
  }
  if (is_large(probe.sequence)) out.resize(kLargeProbeBytes);
}

std::optional<Probe> read(std::span<const std::byte> bytes) {
  const std::size_t size = bytes.size();
  if (size < kHeaderBytes ||
      std::string_view(reinterpret_cast<const char*>(bytes.data()), kMagic.size()) != kMagic) {
    return std::nullopt;
  }
  bytes = bytes.subspan(kMagic.size());
  Probe probe;
  probe.nonce = take<std::uint64_t>(bytes);
  probe.sequence = take<std::uint32_t>(bytes);
  probe.host = take_text(kHostBytes, bytes);
  probe.version = take_text(kVersionBytes, bytes);
  probe.key = take<std::uint64_t>(bytes);
  const std::size_t count = take<std::uint32_t>(bytes);
  if (probe.sequence >= kMaxProbes || count > kMaxPeers) return std::nullopt;
  const std::size_t filled = kHeaderBytes + count * kEchoBytes;
  if (size != (is_large(probe.sequence) ? kLargeProbeBytes : filled)) return std::nullopt;
  for (std::size_t i = 0; i < count; ++i) {
    Echo echo;
    echo.nonce = take<std::uint64_t>(bytes);
    for (auto* number : {&echo.first, &echo.last, &echo.received.small, &echo.received.large}) {
      *number = take<std::uint32_t>(bytes);
    }
    echo.held_ns = take<std::uint64_t>(bytes);
    if (!possible(echo)) return std::nullopt;
    probe.echoes.push_back(echo);
  }
  return probe;
}

}  // namespace ergocast::doctor
