// SPDX-License-Identifier: BSD-3-Clause
// The messages of a record in order, each with its mission time and its buses. No clock.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/result.h"
#include "core/mission/mission.h"
#include "lcmtypes/message_authenticator.h"
#include "runtime/record/event_log_reader.h"
#include "team/messages.h"

namespace ergocast::cli {

struct ReplayedMessage {
  double t_s = 0;  ///< mission time
  std::vector<Bus> buses;
  std::string channel;  ///< the channel's name in the replay
  std::vector<std::byte> bytes;
};

class ReplaySource {
 public:
  /// @param authenticator  has the team's key, if the run had one
  static Result<ReplaySource> open(const std::filesystem::path& run_dir, const Mission& mission,
                                   const MessageAuthenticator& authenticator);

  /// Valid until the next call; null at the end and after a problem.
  const ReplayedMessage* next();
  const std::optional<std::string>& problem() const { return problem_; }
  RunId run() const { return run_; }

  /// The messages for a display that starts now: the mission, and the newest state message of each
  /// process.
  std::vector<const ReplayedMessage*> newest() const;

 private:
  ReplaySource(EventLogReader reader, const Mission& mission,
               const MessageAuthenticator& authenticator)
      : reader_(std::move(reader)), dt_s_(mission.timing.dt_s), authenticator_(authenticator) {}
  const ReplayedMessage* refuse(Refusal why);
  void keep(const Message& message);

  EventLogReader reader_;
  double dt_s_;
  MessageAuthenticator authenticator_;
  KnownSignatures signatures_;
  RunId run_ = 0;
  ReplayedMessage message_;
  std::int64_t revision_ = -1;
  std::map<std::pair<std::string, int>, ReplayedMessage> newest_;  // by channel and part
  std::optional<std::string> problem_;
};

}  // namespace ergocast::cli
