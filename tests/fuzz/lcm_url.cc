// SPDX-License-Identifier: BSD-3-Clause
// A bus's URL: an accepted one prints as text that reads back the same.
#include "runtime/bus/lcm_url.h"

#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(lcm_url) {
  const auto parsed = LcmUrl::parse(text_of(input));
  if (!parsed) {
    ERGOCAST_REQUIRE(!parsed.error().empty());
    return;
  }
  const LcmUrl& url = *parsed;
  ERGOCAST_REQUIRE(url.base_port >= 1 && url.base_port + kBusCount - 1 <= 65535);
  const auto again = LcmUrl::parse(url.base());
  ERGOCAST_REQUIRE(again.has_value());
  ERGOCAST_REQUIRE(again->of(Bus::kCommand) == url.of(Bus::kCommand));
}

}  // namespace ergocast::fuzz
