#include "tests/doctor/bridged_hosts.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <variant>

namespace ergocast::doctor {
namespace {

namespace fs = std::filesystem;

void must(int exit_code, const std::string& command) {
  if (exit_code != 0) throw std::runtime_error("failed: " + command);
}

std::string network_of(const std::string& pid) {
  std::error_code gone;
  return fs::read_symlink("/proc/" + pid + "/ns/net", gone).string();
}

/// A process with a network and a host name of its own.
Child new_host(int number) {
  const std::string life = "hostname host" + std::to_string(number) + "; exec sleep infinity";
  auto started = Child::start(
      {{"/usr/bin/unshare", "--net", "--uts", "sh", "-c", life}, "/dev/null", SIGKILL});
  if (const auto* problem = std::get_if<std::string>(&started)) throw std::runtime_error(*problem);
  Child host = std::get<Child>(std::move(started));
  const std::string pid = std::to_string(host.pid());
  const auto sleeping = [&pid] {
    std::error_code gone;
    return fs::read_symlink("/proc/" + pid + "/exe", gone).filename() == "sleep";
  };
  while (host.running() && !sleeping()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  if (!host.running() || network_of(pid) == network_of("self")) {
    throw std::runtime_error("unshare made no host");
  }
  return host;
}

}  // namespace

BridgedHosts::BridgedHosts(int count) {
  must(on_switch("ip link add br0 type bridge mcast_snooping 0 && ip link set br0 up"), "bridge");
  for (int i = 1; i <= count; ++i) {
    hosts_.push_back(new_host(i));
    const std::string n = std::to_string(i), pid = std::to_string(hosts_.back().pid());
    const std::string port = "ip link add p" + n + " type veth peer name eth0 netns " + pid +
                             " && ip link set p" + n + " master br0 up";
    const std::string network = "ip link set lo up && ip link set eth0 up && ip addr add 10.9.0." +
                                n + "/24 dev eth0 && ip route add 224.0.0.0/4 dev eth0";
    must(on_switch(port), port);
    must(on_host(i, network), network);
  }
}

BridgedHosts::~BridgedHosts() {
  for (std::size_t i = 0; i < hosts_.size(); ++i) {
    Child& host = hosts_[i];
    on_switch("ip link del p" + std::to_string(i + 1));  // its network would go some time later
    host.send(SIGKILL);
    while (host.running()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  on_switch("ip link del br0; nft flush ruleset 2>/dev/null");
}

std::vector<std::string> BridgedHosts::inside(int host) const {
  const std::string pid = std::to_string(hosts_.at(static_cast<std::size_t>(host - 1)).pid());
  return {"/usr/bin/nsenter", "--target", pid, "--net", "--uts"};
}

int BridgedHosts::on_switch(const std::string& command) const {
  return std::system(command.c_str());
}

int BridgedHosts::on_host(int host, const std::string& command) const {
  std::string prefix;
  for (const std::string& word : inside(host)) prefix += word + " ";
  return std::system((prefix + "sh -c '" + command + "'").c_str());
}

Child BridgedHosts::start(int host, std::vector<std::string> command, const fs::path& log) const {
  const auto prefix = inside(host);
  command.insert(command.begin(), prefix.begin(), prefix.end());
  auto started = Child::start({command, log, SIGKILL});
  if (const auto* problem = std::get_if<std::string>(&started)) throw std::runtime_error(*problem);
  return std::get<Child>(std::move(started));
}

}  // namespace ergocast::doctor
