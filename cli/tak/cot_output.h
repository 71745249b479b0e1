// SPDX-License-Identifier: BSD-3-Clause
// Sends the picture of a team to clients of TAK, one event a datagram.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "cli/tak/team_events.h"
#include "cli/team/team_display.h"
#include "core/base/result.h"
#include "relay/endpoint.h"
#include "runtime/bus/socket.h"

namespace ergocast::cli {

struct CotOptions {
  std::optional<relay::HostAndPort> to;  ///< nothing: no events are sent
  std::optional<GeoPlace> origin;        ///< nothing: that of the scenario
};

/// --cot.
CLI::Option* add_cot_option(CLI::App& app, CotOptions& options);

/// Never waits for the network. What the kernel does not take is lost and counted.
class CotOutput final : public TeamDisplay {
 public:
  /// An error if the address has no place in this network, or the name is not known. Waits for the
  /// answer of a name server.
  static Result<CotOutput> open(const relay::HostAndPort& to, const GeoPlace& origin);

  /// Sends the events that are due; call it a few times a second. Complains once, about the first
  /// event that is lost.
  void show(const TeamPicture& picture, const MissionFollower& team) override;
  /// "TAK at udp://…": its clients do not answer.
  std::string name() const { return "TAK at " + to_; }
  /// How many events were lost, for people; empty: none.
  std::string losses() const;

 private:
  CotOutput(std::string to, const GeoPlace& origin, Socket socket)
      : to_(std::move(to)), events_(origin), socket_(std::move(socket)) {}
  void send(const std::string& datagram);

  std::string to_;
  TeamEvents events_;
  Socket socket_;
  std::int64_t sent_ = 0, lost_ = 0;
};

}  // namespace ergocast::cli
