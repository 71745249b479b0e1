// SPDX-License-Identifier: BSD-3-Clause
// Moves the test into a new network namespace, and finds the processes in it through /proc.
#include "tests/support/own_host.h"

#include <sched.h>
#include <sys/mount.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace ergocast::test {
namespace {

namespace fs = std::filesystem;

bool root = false;
bool mounts_are_private = false;

void write_text(const char* file, const std::string& text) {
  if (!(std::ofstream(file) << text << std::flush)) throw std::runtime_error(file);
}

void must_run(const char* command) {
  if (std::system(command) != 0) throw std::runtime_error(std::string("failed: ") + command);
}

/// @param kind  "net" or "mnt"
std::string namespace_of(const fs::path& process, const char* kind) {
  std::error_code error;
  return fs::read_symlink(process / "ns" / kind, error).string();
}

/// The state letter and name of a process.
std::pair<char, std::string> state_of(const fs::path& process) {
  std::ifstream in(process / "stat");
  std::string stat;
  std::getline(in, stat);
  const auto open = stat.find('('), close = stat.rfind(')');
  if (open == stat.npos || close == stat.npos || close + 2 >= stat.size()) return {'Z', ""};
  return {stat[close + 2], stat.substr(open + 1, close - open - 1)};
}

std::vector<std::string> processes_in(const std::set<std::string>& namespaces, const char* kind) {
  std::vector<std::string> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc", error)) {
    const std::string pid = entry.path().filename();
    if (pid.find_first_not_of("0123456789") != pid.npos || pid == std::to_string(getpid()))
      continue;
    if (namespaces.count(namespace_of(entry.path(), kind)) == 0) continue;
    const auto [state, name] = state_of(entry.path());
    if (state != 'Z' && state != 'X') found.push_back(name + " (pid " + pid + ")");
  }
  return found;
}

}  // namespace

void enter_own_host() {
  const uid_t user = geteuid();
  const gid_t group = getegid();
  root = user == 0;
  if (unshare((root ? 0 : CLONE_NEWUSER) | CLONE_NEWNET | CLONE_NEWNS | CLONE_NEWUTS) != 0) {
    throw std::runtime_error(std::string("this system allows no network namespaces: ") +
                             std::strerror(errno));
  }
  if (!root) {
    write_text("/proc/self/setgroups", "deny");
    write_text("/proc/self/uid_map", "0 " + std::to_string(user) + " 1");
    write_text("/proc/self/gid_map", "0 " + std::to_string(group) + " 1");
  }
  // Not possible in a chroot, whose root is no mount point.
  mounts_are_private = root && mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0;
  must_run("ip link set lo up");
  must_run("ip link set lo multicast on");
  must_run("ip route add 224.0.0.0/4 dev lo");
}

bool is_root() { return root; }

bool may_mount() { return mounts_are_private; }

std::vector<std::string> processes_in(const std::set<std::string>& networks) {
  return processes_in(networks, "net");
}

std::vector<std::string> processes_on_own_host() {
  return processes_in({namespace_of("/proc/self", "net")});
}

std::vector<std::string> descendants() {
  return processes_in({namespace_of("/proc/self", "mnt")}, "mnt");
}

}  // namespace ergocast::test
