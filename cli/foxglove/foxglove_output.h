// SPDX-License-Identifier: BSD-3-Clause
// Serves a running team to Foxglove and other clients of its WebSocket protocol.
//
// Any page in a browser may open a WebSocket to this host. So without a token only Foxglove's own
// pages, pages of this host, and programs that are no browser get an answer. Other hosts need the
// token in the address, as for the page (cli/watch/page_server.h).
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/foxglove/live_channels.h"
#include "cli/foxglove/live_topics.h"
#include "cli/team/team_display.h"
#include "cli/watch/connections.h"
#include "cli/watch/page_socket.h"
#include "core/base/result.h"

namespace ergocast::cli {

/// --foxglove; `port` stays 0 without it.
CLI::Option* add_foxglove_option(CLI::App& app, int& port);

/// The address that a person gives Foxglove, with the token if there is one.
std::string foxglove_url(const PageSocket& socket);

/// Serves only in serve(), and never waits for a client.
class FoxgloveOutput final : public TeamDisplay {
 public:
  struct Setup {
    std::optional<GeoPlace> origin;  ///< nothing: there are no locations
    DensityCells target;             ///< the plan's; empty: not known here
    /// Gets a sentence when a client is too slow.
    std::function<void(const std::string&)> note;
  };

  FoxgloveOutput(Setup setup, PageSocket socket);

  /// Call it at least ten times a second.
  void serve(Instant now);
  /// A name for each client that is connected now.
  std::vector<std::string> clients() const;

  void show(const WorldState& world, const MissionFollower& team) override;
  void show(const std::vector<std::string>& lines) override;
  void show(const TeamPicture& picture, const MissionFollower& team) override;

 private:
  Connections::Answer answer(const std::string& head);
  void note(const std::string& sentence);

  Setup setup_;
  PageSocket socket_;
  std::string session_;
  LiveChannels channels_;
  LiveTopics topics_;
  Instant second_{};
  int notes_ = 0;  // since `second_`
  Connections connections_;
};

}  // namespace ergocast::cli
