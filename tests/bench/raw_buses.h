// SPDX-License-Identifier: BSD-3-Clause
// The three buses without our transport, with meaningless bytes: over LCM, or directly over UDP.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "runtime/bus/lcm_url.h"
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
  kUdp,  ///< one multicast socket for each bus, many datagrams a read: no thread, queue or names
};

class RawBuses {
 public:
  using Handler = std::function<void(Bus, const Stamp&)>;

  /// @param listening  buses to receive from
  static std::unique_ptr<RawBuses> open(Carrier carrier, const LcmUrl& url,
                                        const std::vector<Bus>& listening, Handler handler);
  virtual ~RawBuses() = default;

  /// Sends a datagram of one size by any carrier: a name and `bytes` bytes.
  virtual void publish(Bus bus, const std::string& channel, const Stamp& stamp,
                       std::size_t bytes) = 0;
  /// Waits for a datagram and handles all waiting ones. Returns false after a timeout.
  virtual bool wait(int timeout_ms) = 0;
};

}  // namespace ergocast::bench
