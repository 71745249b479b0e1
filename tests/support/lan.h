// SPDX-License-Identifier: BSD-3-Clause
// Hosts on a network of the test: network namespaces whose cables end in a bridge, which is in
// another namespace as the switch. None of them has a name outside this process, so all are removed
// when it and the programs it started have ended, in any way.
//
// Needs iproute2, nftables and root, or a process in its own user namespace (own_host.h) if the
// kernel allows that. Every function throws std::runtime_error with the command that failed.
#pragma once

#include <chrono>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace ergocast::test {

/// A network and a host name, kept open by this process.
class Namespaces {
 public:
  static Namespaces of_this_thread();
  /// New namespaces with a loopback; this thread stays in its own.
  static Namespaces make(const std::string& host_name);
  Namespaces(Namespaces&& other) noexcept
      : net_(std::exchange(other.net_, -1)), name_(std::exchange(other.name_, -1)) {}
  ~Namespaces();

  void enter() const;
  /// As a path that `ip link … netns` takes.
  std::string path() const;
  /// As /proc/PID/ns/net shows it.
  std::string network() const;

 private:
  Namespaces(int net, int name) : net_(net), name_(name) {}
  int net_, name_;  // file descriptors
};

class Lan {
 public:
  /// Hosts 0 … count − 1, called "host-0" and so on, at 10.0.0.1 and so on; each sends multicast to
  /// its eth0.
  explicit Lan(int count);
  int hosts() const { return static_cast<int>(hosts_.size()); }

  /// While it exists, this thread is on that host: sockets and processes that it starts stay there.
  class Visit {
   public:
    Visit(const Namespaces& host, const Namespaces& home) : home_(home) { host.enter(); }
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;
    ~Visit() { home_.enter(); }

   private:
    const Namespaces& home_;
  };
  [[nodiscard]] Visit visit(int host) const;

  /// Pulls a host's cable out of the switch. The host itself sees its interface without a carrier.
  void unplug(int host);
  /// From now on the switch carries nothing from one host to the other.
  void block(int from, int to);
  /// From now on the switch loses `percent` of the frames, each copy of a broadcast separately.
  /// @param spared  hosts without losses, such as an observer's
  void lose(int percent, std::set<int> spared = {});
  /// From now on every frame is delayed by `time`. False if this kernel cannot do it (no netem).
  bool delay(std::chrono::milliseconds time);
  /// Connects all cables and removes blocks, losses and delays.
  void heal();

  /// Sets the MTU of all links.
  void set_mtu(int bytes);
  /// A second interface, eth1, into a network without other hosts.
  void add_interface(int host);
  /// Sends that host's multicast to one of its interfaces; "": to none.
  void route_multicast(int host, const std::string& interface);

  /// A shell's command on the switch, whose port to host i is pI; or on a host.
  void on_switch(const std::string& command) const { run_on(switch_, command); }
  void on_host(int host, const std::string& command) const;

  /// IP packets that the switch received since the start, and fragments of packets among them.
  std::int64_t packets() const { return count_of("ip_packets"); }
  std::int64_t fragments() const { return count_of("ip_fragments"); }

  /// "agent (pid 12)" of every process on these hosts, zombies left out.
  std::vector<std::string> processes() const;

 private:
  void run_on(const Namespaces& where, const std::string& command) const;
  std::string port(int host) const { return "p" + std::to_string(host); }
  void wait_for_links() const;
  void apply_rules() const;
  std::int64_t count_of(const std::string& counter) const;

  Namespaces home_, switch_;
  std::vector<Namespaces> hosts_;
  std::set<std::pair<int, int>> blocked_;  // from, to
  int loss_percent_ = 0;
  std::set<int> spared_;
  bool delayed_ = false;
};

}  // namespace ergocast::test
