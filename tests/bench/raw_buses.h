// SPDX-License-Identifier: BSD-3-Clause
// The three buses without our transport, with meaningless bytes: over LCM, or straight over UDP.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/ids.h"
#include "runtime/lcm_url.h"
#include "team/messages.h"

namespace ergocast::bench {

/// The first bytes of every message; the rest is padding.
struct Stamp {
  Tick tick;
  AgentId sender;
  std::int32_t block;
};

enum class Carrier {
  kLcm,  ///< liblcm, as any program uses it
  kUdp,  ///< one multicast socket a bus, read many datagrams at a time: no thread, no queue, no
         ///< names
};

class RawBuses {
 public:
  using Handler = std::function<void(Bus, const Stamp&)>;

  /// @param listening  buses to hear
  static std::unique_ptr<RawBuses> open(Carrier carrier, const LcmUrl& url,
                                        const std::vector<Bus>& listening, Handler handler);
  virtual ~RawBuses() = default;

  /// Sends a datagram of one size by any carrier: a name and `bytes` bytes.
  virtual void publish(Bus bus, const std::string& channel, const Stamp& stamp,
                       std::size_t bytes) = 0;
  /// Handles all waiting datagrams, once there is one. False if none came for so long.
  virtual bool wait(int timeout_ms) = 0;
};

}  // namespace ergocast::bench
