// SPDX-License-Identifier: BSD-3-Clause
// The amendments and recalls that MISSION names anew. With it a page shows what was ordered
// elsewhere: on another page, or by a command.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/team/team_monitor.h"
#include "core/base/ids.h"

namespace ergocast::cli {

struct NamedChange {
  std::string act;              ///< as to_string(ControlAct), where a page has such an act
  AgentId agent = kUnassigned;  ///< of a recall
  std::string what;             ///< "pause", "agent 2 home"
  std::string text;             ///< "from tick 65, t = 6.5 s"
  std::string by{};             ///< its operator; empty: not known
};

class NamedChanges {
 public:
  /// The changes that are new since the last call. Those before the first call, or before the
  /// mission was known, are old.
  std::vector<NamedChange> take(const MonitoredRun& team);

 private:
  void take_amendments(const MonitoredRun& team, std::vector<NamedChange>& changes) const;
  void take_recalls(const MonitoredRun& team, std::vector<NamedChange>& changes);

  std::optional<std::int32_t> named_;  // how many amendments had been named
  /// The agent's number, and whether it leaves.
  std::set<std::pair<AgentId, bool>> recalled_;
};

}  // namespace ergocast::cli
