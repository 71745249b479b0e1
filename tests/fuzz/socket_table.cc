// SPDX-License-Identifier: BSD-3-Clause
// The kernel's table of UDP sockets.
#include "cli/doctor/socket_table.h"

#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(socket_table) {
  for (const doctor::UdpSocket& socket : doctor::parse_socket_table(text_of(input))) {
    ERGOCAST_REQUIRE(socket.port >= 0 && socket.port <= 65535);
  }
}

}  // namespace ergocast::fuzz
