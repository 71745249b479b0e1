// SPDX-License-Identifier: BSD-3-Clause
// A Foxglove client: a request's head, then frames in pieces. What waits for it stays small.
#include <algorithm>
#include <string>

#include "cli/foxglove/client.h"
#include "cli/foxglove/websocket.h"
#include "tests/cli/foxglove/client_frames.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

/// The first byte is the length of the pieces.
FUZZ_TARGET(foxglove) {
  if (input.empty()) return;
  const std::size_t piece = std::max<std::size_t>(1, input[0]);
  std::string_view text = text_of(input).substr(1);
  const auto end = std::min(text.size(), text.find("\r\n\r\n"));
  if (const auto head = cli::RequestHead::parse(text.substr(0, end))) {
    (void)cli::websocket_accept(head->value("sec-websocket-key"));
    (void)head->lists("sec-websocket-protocol", cli::kFoxgloveProtocols[0]);
  }
  text.remove_prefix(std::min(text.size(), end + 4));

  cli::LiveChannels channels;
  const auto grid = channels.add("/target", foxglove::grid_schema());
  const auto log = channels.add("/log", foxglove::log_schema(), cli::LiveChannels::Kind::kLog);
  cli::FoxgloveClient client(channels, "run", [](const std::string&) {});
  client.begin("peer");
  for (int turn = 0; !text.empty(); ++turn) {
    client.receive(text.substr(0, piece));
    text.remove_prefix(std::min(text.size(), piece));
    channels.publish(turn % 2 == 0 ? grid : log, 1, "{}");
    if (turn % 8 != 0) continue;  // it takes what waits only now and then
    auto bytes = client.next();
    if (!bytes) return;
    constexpr std::size_t kMost = 128 << 10;
    ERGOCAST_REQUIRE(bytes->size() < kMost);
    (void)test::take_frames(*bytes);
    ERGOCAST_REQUIRE(bytes->empty());
  }
  ERGOCAST_REQUIRE(channels.get(grid).subscribers <= 1 && channels.get(log).subscribers <= 1);
}

}  // namespace ergocast::fuzz
