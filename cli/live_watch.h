// SPDX-License-Identifier: BSD-3-Clause
// A team on a page while it flies, and its record afterwards.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <variant>

#include "cli/page_server.h"
#include "core/mission.h"
#include "report/target_density.h"
#include "runtime/node.h"

namespace ergocast::cli {

/// Only listens to the buses. In one thread: the owner calls listen() and serves the page in turn.
class LiveWatch {
 public:
  struct Source {
    BusOptions bus;                  ///< run 0: the first run that is heard
    std::filesystem::path run_dir;   ///< whose logs and record are shown; empty: none is here
    std::optional<Mission> mission;  ///< if it is known already, with its target density
    Field density = {};
  };

  /// An error tells why LCM cannot be used.
  static std::variant<std::unique_ptr<LiveWatch>, std::string> open(Source source);
  virtual ~LiveWatch() = default;

  /// What a server shows; valid as long as this object.
  virtual PageServer::Content content() = 0;
  /// Listens until messages come, `wake_fd` is readable, or a twentieth of a second is over.
  virtual void listen(int wake_fd) = 0;
  /// Whether the mission's end has been heard.
  virtual bool over() const = 0;
  /// The page comes to show the record of `run_dir`, or what it has heard if there is none. The
  /// record is read in a thread of its own, because a long one takes a while.
  virtual void finish() = 0;
};

/// What the page of a record has: {"record", "log"}; or the error.
std::variant<nlohmann::ordered_json, std::string> recorded_page_data(
    const std::filesystem::path& run_dir, const Mission& mission);

/// The page itself, of these data.
Connections::Text recorded_page(const nlohmann::ordered_json& data);

}  // namespace ergocast::cli
