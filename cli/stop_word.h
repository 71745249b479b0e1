// SPDX-License-Identifier: BSD-3-Clause
// STOP, said again and again: by `ergocast run` to its mission, by `ergocast stop` to anybody's.
#pragma once

#include <string>

#include "core/ids.h"
#include "team/messages.h"
#include "runtime/transport.h"

namespace ergocast::cli {

class StopWord {
 public:
  /// @param failed  whether the mission is to count as failed
  StopWord(RunId run, bool failed, std::string reason);

  /// Says it on every bus where somebody listens for it, if the last time is long enough ago.
  /// @param at_once  to everybody, who then stand still; otherwise to the coordinator, who ends the
  ///                 mission in order
  void repeat(Transport& transport, Instant now, bool at_once);

 private:
  Stop stop_;
  Instant next_{};
};

}  // namespace ergocast::cli
