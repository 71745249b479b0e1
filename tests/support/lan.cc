// SPDX-License-Identifier: BSD-3-Clause
// Runs `ip`, `nft` and `tc` inside the namespaces, which this process holds open by their
// descriptors.
#include "tests/support/lan.h"

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "tests/support/own_host.h"

namespace ergocast::test {
namespace {

void must(bool fine, const char* what) {
  if (!fine) throw std::runtime_error(std::string(what) + ": " + std::strerror(errno));
}

/// Feeds `input` to a command.
void feed(const std::string& command, const std::string& input) {
  std::FILE* pipe = popen(command.c_str(), "w");
  must(pipe != nullptr, command.c_str());
  std::fwrite(input.data(), 1, input.size(), pipe);
  if (pclose(pipe) != 0) throw std::runtime_error(command + " <<END\n" + input + "END");
}

std::string output_of(const std::string& command) {
  std::FILE* pipe = popen(command.c_str(), "r");
  must(pipe != nullptr, command.c_str());
  std::string text;
  char piece[256];
  while (std::fgets(piece, sizeof piece, pipe) != nullptr) text += piece;
  if (pclose(pipe) != 0) throw std::runtime_error(command);
  return text;
}

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++found;
  return found;
}

constexpr const char* kCounters = R"(
table bridge counted {
  counter ip_packets { }
  counter ip_fragments { }
  chain forward {
    type filter hook forward priority -10
    ether type ip counter name ip_packets
    ip frag-off & 0x3fff != 0 counter name ip_fragments
  }
}
)";

}  // namespace

// ---- namespaces ----

Namespaces Namespaces::of_this_thread() {
  Namespaces here(open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC),
                  open("/proc/thread-self/ns/uts", O_RDONLY | O_CLOEXEC));
  must(here.net_ >= 0 && here.name_ >= 0, "/proc/thread-self/ns");
  return here;
}

Namespaces Namespaces::make(const std::string& host_name) {
  const Namespaces home = of_this_thread();
  must(unshare(CLONE_NEWNET | CLONE_NEWUTS) == 0, "no new network namespace");
  Namespaces made = of_this_thread();
  const bool named = sethostname(host_name.data(), host_name.size()) == 0;
  home.enter();
  must(named, "sethostname");
  return made;
}

Namespaces::~Namespaces() {
  if (net_ >= 0) close(net_);
  if (name_ >= 0) close(name_);
}

void Namespaces::enter() const {
  must(setns(net_, CLONE_NEWNET) == 0 && setns(name_, CLONE_NEWUTS) == 0, "setns");
}

std::string Namespaces::path() const {
  return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(net_);
}

std::string Namespaces::network() const { return std::filesystem::read_symlink(path()); }

// ---- the network ----

Lan::Lan(int count) : home_(Namespaces::of_this_thread()), switch_(Namespaces::make("switch")) {
  std::string cables = "link add br0 type bridge mcast_snooping 0\nlink set br0 up\n";
  for (int host = 0; host < count; ++host) {
    hosts_.push_back(Namespaces::make("host-" + std::to_string(host)));
    cables += "link add " + port(host) + " type veth peer name eth0 netns " + hosts_.back().path() +
              "\nlink set " + port(host) + " master br0 up\n";
  }
  {
    const Visit there(switch_, home_);
    feed("ip -batch -", cables);
    feed("nft -f -", kCounters);
  }
  for (int host = 0; host < count; ++host) {
    const Visit there = visit(host);
    feed("ip -batch -", "link set lo up\naddr add 10.0.0." + std::to_string(host + 1) +
                            "/24 dev eth0\nlink set eth0 up\nroute add 224.0.0.0/4 dev eth0\n");
  }
  wait_for_links();
}

/// The kernel needs some time to use a link that has come up.
void Lan::wait_for_links() const {
  constexpr int kTurns = 1000;
  const auto ready = [this] {
    for (const Namespaces& host : hosts_) {
      const Visit there(host, home_);
      if (count(output_of("ip -brief link show dev eth0"), " UP ") == 0) return false;
    }
    const Visit there(switch_, home_);
    return count(output_of("bridge link"), "state forwarding") == hosts();
  };
  for (int turn = 0; !ready(); ++turn) {
    if (turn == kTurns) throw std::runtime_error("the links do not come up");
    usleep(10000);
  }
}

Lan::Visit Lan::visit(int host) const { return {hosts_.at(static_cast<std::size_t>(host)), home_}; }

void Lan::run_on(const Namespaces& where, const std::string& command) const {
  const Visit there(where, home_);
  if (std::system(command.c_str()) != 0) throw std::runtime_error(command);
}

void Lan::on_host(int host, const std::string& command) const {
  run_on(hosts_.at(static_cast<std::size_t>(host)), command);
}

void Lan::unplug(int host) { run_on(switch_, "ip link set " + port(host) + " down"); }

void Lan::block(int from, int to) {
  blocked_.emplace(from, to);
  apply_rules();
}

void Lan::lose(int percent, std::set<int> spared) {
  loss_percent_ = percent;
  spared_ = std::move(spared);
  apply_rules();
}

bool Lan::delay(std::chrono::milliseconds time) {
  const Visit there(switch_, home_);
  for (int host = 0; host < hosts(); ++host) {
    const std::string command = "tc qdisc replace dev " + port(host) + " root netem delay " +
                                std::to_string(time.count()) + "ms 2>/dev/null";
    if (std::system(command.c_str()) != 0) return false;
    delayed_ = true;
  }
  return true;
}

void Lan::heal() {
  blocked_.clear();
  loss_percent_ = 0;
  apply_rules();
  for (int host = 0; host < hosts(); ++host) {
    run_on(switch_, "ip link set " + port(host) + " up");
    if (delayed_) run_on(switch_, "tc qdisc del dev " + port(host) + " root");
  }
  delayed_ = false;
  wait_for_links();
}

void Lan::apply_rules() const {
  // In one transaction; the first line is for the first call, when there is nothing to delete.
  std::string rules =
      "table bridge faults\ndelete table bridge faults\ntable bridge faults {\n"
      "  chain forward {\n    type filter hook forward priority 0\n";
  for (const auto& [from, to] : blocked_) {
    rules += "    iifname " + port(from) + " oifname " + port(to) + " drop\n";
  }
  for (int host = 0; host < hosts() && loss_percent_ > 0; ++host) {
    if (spared_.count(host) != 0) continue;
    rules += "    oifname " + port(host) + " numgen random mod 100 < " +
             std::to_string(loss_percent_) + " drop\n";
  }
  const Visit there(switch_, home_);
  feed("nft -f -", rules + "  }\n}\n");
}

void Lan::set_mtu(int bytes) {
  const std::string mtu = " mtu " + std::to_string(bytes);
  for (int host = 0; host < hosts(); ++host) {
    run_on(switch_, "ip link set " + port(host) + mtu);
    on_host(host, "ip link set eth0" + mtu);
  }
}

void Lan::add_interface(int host) {
  const Namespaces& where = hosts_.at(static_cast<std::size_t>(host));
  const std::string end = "q" + std::to_string(host);
  run_on(switch_, "ip link add " + end + " type veth peer name eth1 netns " + where.path() +
                      " && ip link set " + end + " up");
  run_on(where,
         "ip addr add 10.0.1." + std::to_string(host + 1) + "/24 dev eth1 && ip link set eth1 up");
}

void Lan::route_multicast(int host, const std::string& interface) {
  const std::string command = interface.empty() ? "ip route del 224.0.0.0/4"
                                                : "ip route replace 224.0.0.0/4 dev " + interface;
  on_host(host, command);
}

std::int64_t Lan::count_of(const std::string& counter) const {
  const Visit there(switch_, home_);
  const std::string text = output_of("nft list counter bridge counted " + counter);
  std::istringstream number(text.substr(text.rfind("packets ") + 8));
  std::int64_t count = -1;
  number >> count;
  return count;
}

std::vector<std::string> Lan::processes() const {
  std::set<std::string> networks;
  for (const Namespaces& host : hosts_) networks.insert(host.network());
  return processes_in(networks);
}

}  // namespace ergocast::test
