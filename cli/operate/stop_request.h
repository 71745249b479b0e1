// SPDX-License-Identifier: BSD-3-Clause
// Repeats STOP. `ergocast run` sends it to its own mission, `ergocast stop` and a page with control
// to any mission.
#pragma once

#include <string>

#include "core/base/ids.h"
#include "team/messages.h"

namespace ergocast::cli {

class StopRequest {
 public:
  /// @param failed  whether the mission counts as failed
  StopRequest(RunId run, bool failed, std::string reason);

  /// Appends STOP for each bus on which a process receives it, if the last one was long enough ago.
  /// @param at_once  all processes stop at once and the vehicles stand still; otherwise only the
  ///                 coordinator obeys and ends the mission in order
  /// @param newest   the newest known tick of the mission; 0 if none is known. A team with a key
  ///                 ignores a request that names an old tick
  /// @param keyed    whether the team has a key
  void repeat(Instant now, bool at_once, Tick newest, bool keyed, Outbox& out);

 private:
  Stop stop_;
  Instant next_{};
};

}  // namespace ergocast::cli
