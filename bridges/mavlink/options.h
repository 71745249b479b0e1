// SPDX-License-Identifier: BSD-3-Clause
// The command line of ergocast-driver-mavlink, and the files that it names.
#pragma once

#include <ergocast/lcmtypes/message_authenticator.h>

#include <optional>
#include <string>

#include "bridges/mavlink/buses.h"
#include "bridges/mavlink/signing.h"
#include "bridges/mavlink/vehicle.h"

namespace ergocast::mavlink {

struct Options {
  BusUrl url;
  RunId run = 0;
  MessageAuthenticator authenticator;
  AgentId id = 0;
  std::string link;
  std::optional<SigningKey> signing_key;
  VehicleOptions vehicle;
};

/// The exit code if the program must end here (0 after --help), −1 if it continues.
int read_command_line(int argc, char** argv, Options& options);

}  // namespace ergocast::mavlink
