// SPDX-License-Identifier: BSD-3-Clause
// The output of nft and iptables.
#include "cli/doctor/host_conditions.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(firewall) {
  const auto finding = doctor::firewall_finding(text_of(input), "239.255.76.67");
  ERGOCAST_REQUIRE(!finding || !finding->found.empty());
}

}  // namespace ergocast::fuzz
