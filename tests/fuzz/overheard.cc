// SPDX-License-Identifier: BSD-3-Clause
// LCM datagrams that `ergocast doctor` receives: "LC02", a number, a channel, a message.
//
// Input: a length of 2 bytes, high one first, then a datagram, and so on. Tags are made valid.
#include "cli/doctor/bus_listener.h"
#include "cli/doctor/print.h"
#include "tests/fuzz/support/datagrams.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {
namespace {

void make_tag_right(std::span<std::uint8_t> packet) {
  constexpr std::size_t kChannelOffset = 8;
  if (packet.size() < kChannelOffset) return;
  const auto end = std::find(packet.begin() + kChannelOffset, packet.end(), std::uint8_t{0});
  if (packet.end() - end > static_cast<std::ptrdiff_t>(kHeaderBytes))
    retag({end + 1, packet.end()});
}

}  // namespace

FUZZ_TARGET(overheard) {
  doctor::Overheard overheard;
  for (Input rest = input; rest.size() > 2;) {
    const std::size_t length = std::min<std::size_t>(rest[0] * 256U + rest[1], rest.size() - 2);
    std::vector<std::uint8_t> packet(rest.begin() + 2,
                                     rest.begin() + 2 + static_cast<std::ptrdiff_t>(length));
    rest = rest.subspan(2 + length);
    make_tag_right(packet);
    overheard.take(bytes_of(packet));
  }
  const doctor::Finding finding = overheard.finding({}, 24000);
  for (const std::string& text : {finding.found, finding.why}) {
    for (const char c : text) ERGOCAST_REQUIRE(c == '\n' || (c & 0xE0) != 0);
  }
  doctor::json_of({}, {finding}, {});
}

}  // namespace ergocast::fuzz
