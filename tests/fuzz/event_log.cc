// SPDX-License-Identifier: BSD-3-Clause
// A segment of an event log, plain and as a compressed one: events within the limits of any
// message, and then an end or a problem.
#include "lcmtypes/message_authenticator.h"
#include "runtime/bus/lcm_datagram.h"
#include "runtime/record/event_log_reader.h"
#include "tests/fuzz/files.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(event_log) {
  static const Folder plain, compressed;
  plain.write("events-000.lcm", text_of(input));
  compressed.write("events-000.lcm.zst", text_of(input));
  for (const Folder* folder : {&plain, &compressed}) {
    auto opened = EventLogReader::open(folder->path());
    auto& reader = *opened;
    while (const LoggedEvent* event = reader.next()) {
      ERGOCAST_REQUIRE(event->channel.size() < kMaxChannelBytes);
      ERGOCAST_REQUIRE(event->bytes.size() <= kMaxDatagramBytes);
      ERGOCAST_REQUIRE(!reader.problem());
    }
    if (reader.problem()) ERGOCAST_REQUIRE(reader.problem()->find(", byte ") != std::string::npos);
  }
}

}  // namespace ergocast::fuzz
