// SPDX-License-Identifier: BSD-3-Clause
// The probes that `ergocast doctor` on two hosts exchange, one after the other.
//
// Input: a length of 2 bytes, high one first, then a datagram, and so on.
#include "cli/doctor/probe.h"

#include "cli/doctor/peer_exchange.h"
#include "cli/doctor/print.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(probe) {
  doctor::PeerLedger ledger(7, "here", "1");
  Instant now{std::chrono::seconds(1)};
  for (Input rest = input; rest.size() > 2;) {
    const std::size_t length = std::min<std::size_t>(rest[0] * 256U + rest[1], rest.size() - 2);
    const std::vector<std::uint8_t> datagram(
        rest.begin() + 2, rest.begin() + 2 + static_cast<std::ptrdiff_t>(length));
    rest = rest.subspan(2 + length);
    std::vector<std::byte> answer;
    doctor::write(ledger.next(now), answer);
    ERGOCAST_REQUIRE(doctor::read(answer));
    now += std::chrono::milliseconds(50);
    if (const auto probe = doctor::read(bytes_of(datagram))) ledger.take(*probe, "10.0.0.2", now);
  }
  const std::string table = doctor::text_of(ledger.peers());
  for (const char c : table) ERGOCAST_REQUIRE(c == '\n' || (c & 0xE0) != 0);
  doctor::peer_findings({}, {ledger.peers(), ledger.only_received_by_others(), ledger.sent(), ""},
                        "1");
}

}  // namespace ergocast::fuzz
