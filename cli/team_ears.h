// SPDX-License-Identifier: BSD-3-Clause
// The runs that speak on one URL: what `ergocast status` and `ergocast stop` listen to, and whether
// they still speak, which `stop` goes by.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/ids.h"
#include "team/messages.h"
#include "team/participant.h"
#include "runtime/node.h"
#include "runtime/transport.h"

namespace ergocast::cli {

/// Runs on one URL that are told apart.
inline constexpr std::size_t kMostRuns = 16;

/// Told what is heard, on which bus and from whom.
using Hear = std::function<void(const Message&, Bus, AgentId transmitter)>;

/// Hears all that tells how teams are. An error says why LCM cannot be used.
std::variant<std::unique_ptr<Transport>, std::string> listen_to_teams(
    const BusOptions& options, Hear hear);

/// What was heard of one run.
class RunHeard {
 public:
  static constexpr Role kRole = Role::kMonitor;

  explicit RunHeard(RunId run);

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);

  /// Whether the coordinator, or who repeats its words, says that the mission is over.
  bool over() const { return over_; }
  const std::string& reason() const { return reason_; }
  Tick tick() const { return tick_; }
  bool unheard() const;
  bool coordinator_heard() const { return heard(kCoordinator); }
  bool world_heard() const { return world_tick_ >= 0; }
  /// Whether no vehicle moved in the newest state of the world; true if none was heard.
  bool stands_still() const;

  /// Who has spoken lately and not said that it has finished: "agent 2", "world".
  std::vector<std::string> still_there(Instant now) const;
  /// Members that are silent and have not said that they have finished.
  std::vector<std::string> lost(Instant now) const;
  int agents() const { return static_cast<int>(agents_.size()); }

 private:
  template <class M>
  void on(const M&, const Arrival&) {}  // nothing follows from the other types
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const AgentStatus& status, const Arrival& arrival);
  void on(const WorldState& world, const Arrival& arrival);
  bool heard(AgentId process) const {
    return me_.liveness().last_sign_of_kind(process).has_value();
  }

  Participant me_;
  std::map<Author, bool> agents_;  // whether it has said that it has finished
  std::map<AgentId, Eigen::Vector3d> velocities_mps_;  // in the newest state
  Tick tick_ = 0, world_tick_ = -1;
  bool over_ = false;  // says the coordinator
  std::string reason_;
};

/// "a, b and c".
std::string listed(const std::vector<std::string>& names);

}  // namespace ergocast::cli
