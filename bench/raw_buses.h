// The three buses without our transport: LCM, and bytes that mean nothing.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/ids.h"
#include "core/messages.h"
#include "runtime/lcm_url.h"

namespace lcm {
class LCM;
}

namespace ergocast::bench {

/// The first bytes of every message; the rest is padding.
struct Stamp {
  Tick tick;
  AgentId sender;
  std::int32_t block;
};

class RawBuses {
 public:
  using Handler = std::function<void(Bus, const Stamp&)>;

  /// @param listening  buses to hear, and which of their channels
  RawBuses(const LcmUrl& url, const std::vector<std::pair<Bus, std::string>>& listening,
           Handler handler);
  ~RawBuses();

  void publish(Bus bus, const std::string& channel, const Stamp& stamp, std::size_t bytes);
  /// Handles all that is there, once something is. False if nothing came for so long.
  bool wait(int timeout_ms);

 private:
  struct Line;
  Handler handler_;
  std::vector<std::unique_ptr<lcm::LCM>> buses_;
  std::vector<std::unique_ptr<Line>> lines_;  // the buses we listen to
};

}  // namespace ergocast::bench
