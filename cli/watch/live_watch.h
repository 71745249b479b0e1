// SPDX-License-Identifier: BSD-3-Clause
// Shows a running team on a page, and its record afterwards.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/team/team_display.h"
#include "cli/watch/page_server.h"
#include "core/base/result.h"
#include "core/mission/mission.h"
#include "report/target_density.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {

/// Only listens to the buses. Uses one thread: the owner calls listen() and serves the page in
/// turn.
class LiveWatch {
 public:
  struct Source {
    BusOptions bus;                  ///< run 0: the first run that is received
    std::filesystem::path run_dir;   ///< its logs and record are shown; empty: there is none
    std::optional<Mission> mission;  ///< with its target density, if already known
    Field density = {};
    std::vector<TeamDisplay*> displays = {};  ///< get the same; outlive the watch
  };

  /// Returns an error if LCM cannot be used.
  static Result<std::unique_ptr<LiveWatch>> open(Source source);
  virtual ~LiveWatch() = default;

  /// The content for a server; valid as long as this object.
  virtual PageServer::Content content() = 0;
  /// Listens until messages arrive, `wake_fd` is readable, or 0.05 s have passed.
  virtual void listen(int wake_fd) = 0;
  /// Shows a line of this process in the page's log, if a team was received.
  virtual void log(const std::string& line) = 0;
  /// The run that is shown; 0: none was received yet.
  virtual RunId run() const = 0;
  /// Whether the mission's end has been received.
  virtual bool over() const = 0;
  /// Makes the page show the record of `run_dir`, or the received data if there is none. A separate
  /// thread reads the record, because a long one takes a while.
  virtual void finish() = 0;
};

/// The data of a record's page, {"record", "log"}; or the error.
Result<nlohmann::ordered_json> recorded_page_data(const std::filesystem::path& run_dir,
                                                  const Mission& mission);

/// The page with these data.
Connections::Text recorded_page(const nlohmann::ordered_json& data);

}  // namespace ergocast::cli
