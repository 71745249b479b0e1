// SPDX-License-Identifier: BSD-3-Clause
// Names the values of the enumerations in logs and records.
#include "team/messages.h"

namespace ergocast {

const char* to_string(Refusal refusal) {
  constexpr const char* kNames[kRefusalKinds] = {"size",     "type", "tag",   "unkeyed",
                                                 "unsigned", "run",  "range", "limit",
                                                 "encoding", "rate", "late"};
  return kNames[static_cast<int>(refusal)];
}

const char* to_string(MissionState state) {
  constexpr const char* kNames[] = {"waiting", "running", "ended", "failed"};
  return kNames[static_cast<int>(state)];
}

const char* to_string(AgentPhase phase) {
  constexpr const char* kNames[] = {"joining",  "waiting",   "running",
                                    "finished", "returning", "resting"};
  return kNames[static_cast<int>(phase)];
}

}  // namespace ergocast
