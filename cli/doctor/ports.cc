// SPDX-License-Identifier: BSD-3-Clause
// Finds the inodes of the sockets at our ports, and then the processes whose descriptors link to
// them.
#include "cli/doctor/ports.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <tuple>

#include "cli/doctor/socket_table.h"
#include "text/read_number.h"

namespace ergocast::doctor {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// "socket:[123]" → 123.
unsigned long inode_of(const std::string& link) {
  constexpr std::string_view kPrefix = "socket:[";
  const std::string_view text = link;
  if (!text.starts_with(kPrefix) || !text.ends_with(']')) return 0;
  return read_number<unsigned long>(text.substr(kPrefix.size(), text.size() - kPrefix.size() - 1))
      .value_or(0);
}

/// The ports of the sockets at the ports of `url`, by inode.
std::map<unsigned long, int> sockets_at(const fs::path& proc, const LcmUrl& url) {
  std::map<unsigned long, int> sockets;
  for (const char* table : {"net/udp", "net/udp6"}) {
    for (const UdpSocket& socket : parse_socket_table(text_of(proc / table))) {
      if (socket.port < url.base_port || socket.port >= url.base_port + kBusCount) continue;
      sockets[socket.inode] = socket.port;
    }
  }
  return sockets;
}

std::string program_of(const fs::path& process) {
  const std::string command = text_of(process / "cmdline");
  const std::string name = fs::path(command.substr(0, command.find('\0'))).filename();
  if (!name.empty()) return printable(name);
  const std::string comm = text_of(process / "comm");
  return printable(comm.substr(0, comm.find('\n')));
}

/// Adds `process` once for each port if it holds one of `wanted`, and records the inodes in
/// `found`.
void look_into(const fs::path& process, long pid, const std::map<unsigned long, int>& wanted,
               std::set<unsigned long>& found, std::vector<SocketOwner>& holders) {
  std::set<int> ports;
  std::error_code error;
  for (fs::directory_iterator at(process / "fd", error), end; !error && at != end;
       at.increment(error)) {
    std::error_code gone;
    const auto socket = wanted.find(inode_of(fs::read_symlink(at->path(), gone).string()));
    if (socket == wanted.end()) continue;
    found.insert(socket->first);
    if (ports.insert(socket->second).second) {
      holders.push_back({socket->second, program_of(process), pid});
    }
  }
}

std::string described(const SocketOwner& holder) {
  const std::string who = holder.program.empty()
                              ? "another user's program"
                              : holder.program + " (pid " + std::to_string(holder.pid) + ")";
  return std::to_string(holder.port) + ": " + who;
}

bool is_ours(const SocketOwner& holder) { return holder.program.starts_with("ergocast"); }

/// "24000: a (pid 1), 24000: b (pid 2) and 7 more".
std::string described(const std::vector<SocketOwner>& holders) {
  constexpr std::size_t kShown = 4;
  std::vector<std::string> texts;
  for (const SocketOwner& holder : holders) {
    if (texts.size() < kShown) texts.push_back(described(holder));
  }
  const std::size_t more = holders.size() - texts.size();
  return joined(texts) + (more > 0 ? " and " + std::to_string(more) + " more" : "");
}

}  // namespace

std::vector<SocketOwner> holders(const fs::path& proc, const LcmUrl& url) {
  const std::map<unsigned long, int> wanted = sockets_at(proc, url);
  std::vector<SocketOwner> all;
  if (wanted.empty()) return all;
  std::set<unsigned long> found;
  std::error_code error;
  for (fs::directory_iterator at(proc, error), end; !error && at != end; at.increment(error)) {
    const auto pid = read_number<long>(at->path().filename().string());
    if (pid) look_into(at->path(), *pid, wanted, found, all);
  }
  // A socket without a known holder may have been closed while we looked.
  const std::map<unsigned long, int> present = sockets_at(proc, url);
  for (const auto& [inode, port] : wanted) {
    if (!found.contains(inode) && present.contains(inode)) all.push_back({port, "", 0});
  }
  std::sort(all.begin(), all.end(), [](const SocketOwner& a, const SocketOwner& b) {
    return std::tie(a.port, a.pid) < std::tie(b.port, b.pid);
  });
  return all;
}

Finding ports_finding(const LcmUrl& url, const std::vector<SocketOwner>& holders,
                      const std::string& refusal, std::optional<int> free_port) {
  const std::string range =
      std::to_string(url.base_port) + " to " + std::to_string(url.base_port + kBusCount - 1);
  if (holders.empty() && refusal.empty()) {
    return {"ports", Level::kOk, range + " are free on this host", "", ""};
  }
  LcmUrl other = url;
  if (free_port) other.base_port = *free_port;
  const std::string elsewhere = free_port ? "--lcm-url '" + other.base() + "'   # on every host"
                                          : "ss -ulpn   # which program is it?";
  if (!refusal.empty()) {
    return {
        "ports", Level::kProblem, refusal + (holders.empty() ? "" : "; " + described(holders)),
        "The program that has it does not share it, so no program of Ergocast can listen there.",
        elsewhere};
  }
  std::vector<SocketOwner> strangers = holders;
  std::erase_if(strangers, is_ours);
  if (strangers.empty()) {
    return {"ports", Level::kNote, described(holders),
            "Programs of Ergocast are at work on these ports. Another run needs ports of its own.",
            elsewhere};
  }
  return {
      "ports", Level::kWarning, described(strangers),
      "A program that shares a port with a team receives its messages, and the team receives those "
      "of the program: with LCM 1.3 even if the group is another one. Each parses them all.",
      elsewhere};
}

}  // namespace ergocast::doctor
