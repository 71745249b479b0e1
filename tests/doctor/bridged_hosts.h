// Hosts on a bridge: network namespaces of processes that this one starts, so that nothing of them
// outlives it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/child.h"

namespace ergocast::doctor {

/// The calling process's own network (enter_own_host()) is the switch. Host i, from 1, is at
/// 10.9.0.i on its eth0, has the multicast route there and hangs on the switch's port pI. Bridge,
/// ports and what nft was told there go with this object, or at the latest with the process. Needs
/// root, `ip` and `nsenter`.
class BridgedHosts {
 public:
  /// @throws std::runtime_error with the command that failed
  explicit BridgedHosts(int count);
  BridgedHosts(const BridgedHosts&) = delete;
  BridgedHosts& operator=(const BridgedHosts&) = delete;
  ~BridgedHosts();

  /// The shell's exit code.
  int on_switch(const std::string& command) const;
  int on_host(int host, const std::string& command) const;
  Child start(int host, std::vector<std::string> command, const std::filesystem::path& log) const;

 private:
  std::vector<std::string> inside(int host) const;
  std::vector<Child> hosts_;
};

}  // namespace ergocast::doctor
