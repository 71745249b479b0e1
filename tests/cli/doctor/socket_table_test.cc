// SPDX-License-Identifier: BSD-3-Clause
// Well-formed lines of the kernel's table are read, all others are skipped.
#include "cli/doctor/socket_table.h"

#include <gtest/gtest.h>

namespace ergocast::doctor {
namespace {

// As /proc/net/udp has them; 5DC0 is 24000.
constexpr const char* kTable =
    "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout "
    "inode ref pointer drops\n"
    " 1028: 00000000:5DC0 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 "
    "111 2 0000000000000000 0\n"
    " 1029: 434CFFEF:5DC2 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 "
    "222 2 0000000000000000 4711\n"
    " 1030: 00000000000000000000000000000000:5DC3 00000000000000000000000000000000:0000 07 "
    "00000000:00000000 00:00000000 00000000     0        0 333 2 0000000000000000 5\n"
    " torn\n"
    " 1031: nonsense 00000000:0000 07 0 0 0 0 0 x 2 0 0\n"
    " 1033: 00000000:15DC0 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 "
    "555 2 0000000000000000 0\n"
    " 1035: 00000000:5DC0 00000000:0000 07 00000000:00000000 00:00000000 00000000     0        0 "
    "777&8 2 0000000000000000 0\n";

TEST(SocketTable, WhatIsWellFormedIsRead) {
  const std::vector<UdpSocket> expected = {{24000, 111}, {24002, 222}, {24003, 333}};
  EXPECT_EQ(parse_socket_table(kTable), expected);
  EXPECT_TRUE(parse_socket_table("").empty());
}

}  // namespace
}  // namespace ergocast::doctor
