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
#include "report/raster.h"
#include "runtime/node.h"

namespace ergocast::cli {

/// Listens to the buses in a thread of its own, so that no browser keeps anybody waiting; sends
/// nothing.
class LiveWatch {
 public:
  struct Source {
    BusOptions bus;                  ///< run 0: the first run that is heard
    std::filesystem::path run_dir;   ///< whose logs and record are shown; empty: none is here
    std::optional<Mission> mission;  ///< if it is known already, with its target density
    Field density = {};
  };

  /// An error tells why LCM or the address cannot be used.
  static std::variant<std::unique_ptr<LiveWatch>, std::string> start(
      Source source, const PageServer::Options& options);
  virtual ~LiveWatch() = default;

  virtual std::string url() const = 0;
  /// A line for the page's log.
  virtual void say(const std::string& line) = 0;
  /// Whether the mission's end has been heard.
  virtual bool over() const = 0;
  /// From now on the page shows the record of `run_dir`, or what it has heard if there is none.
  virtual void finish() = 0;
};

/// What the page of a record has: {"record", "log"}; or the error.
std::variant<nlohmann::ordered_json, std::string> recorded_page_data(
    const std::filesystem::path& run_dir, const Mission& mission);

}  // namespace ergocast::cli
