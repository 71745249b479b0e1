// SPDX-License-Identifier: BSD-3-Clause
// A running team that also receives an attacker's messages: no process crashes or sends a message
// that others would refuse. The first byte of the input is Features.
#include "tests/fuzz/support/small_team.h"
#include "tests/fuzz/support/turns.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET_WITH(team, &mutate_turns) {
  if (input.size() < kPrefixBytes) return;
  SmallTeam team(input[0]);
  team.pass(std::chrono::nanoseconds(0));
  play(
      input, [&team](std::chrono::nanoseconds time) { team.pass(time); },
      [&team](std::span<const std::byte> datagram, AgentId transmitter) {
        team.receive(datagram, transmitter);
      });
  team.check();
}

}  // namespace ergocast::fuzz
