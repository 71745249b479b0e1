// SPDX-License-Identifier: BSD-3-Clause
// Reads settings below /proc and /sys, compares each with the needs of our datagrams, and composes
// the commands.
#include "cli/doctor/kernel_limits.h"

#include <algorithm>
#include <fstream>
#include <optional>

#include "runtime/bus/socket.h"

namespace ergocast::doctor {
namespace {

/// The size to set for fragments, which only datagrams of other programs have.
constexpr int kFragmentBytes = 4194304;
/// The space that one of our datagrams of 900 to 1250 bytes takes in a receive buffer. The default
/// of 212992 bytes holds 92 (Linux 6, x86-64).
constexpr int kBytesPerDatagram = 2304;

std::optional<long> number_in(const std::filesystem::path& file) {
  long number = 0;
  if (std::ifstream in(file); in >> number) return number;
  return std::nullopt;
}

std::string sysctl_commands(const std::string& setting) {
  return "sysctl -w " + setting + "\necho " + setting + " >> /etc/sysctl.d/60-ergocast.conf";
}

}  // namespace

ReceiveBuffer measure_receive_buffer(const LcmUrl& url) {
  const auto with = [](int asked_bytes) {
    const Socket socket(AF_INET, SOCK_DGRAM);
    setsockopt(socket.fd(), SOL_SOCKET, SO_RCVBUF, &asked_bytes, sizeof asked_bytes);
    int bytes = 0;
    socklen_t length = sizeof bytes;
    getsockopt(socket.fd(), SOL_SOCKET, SO_RCVBUF, &bytes, &length);
    return bytes;
  };
  return {with(url.receive_buffer()), with(1 << 30)};
}

Finding receive_buffer_finding(const LcmUrl& url, const ReceiveBuffer& buffer) {
  const std::string holds =
      "holds about " + std::to_string(buffer.granted_bytes / kBytesPerDatagram) + " datagrams";
  const long asked = url.receive_buffer_bytes;
  // The kernel grants twice the requested size, to cover its own bookkeeping.
  if (asked > 0 && buffer.granted_bytes < 2 * asked) {
    return {"receive buffer", Level::kWarning,
            "the URL asks for " + std::to_string(asked) + " bytes, the kernel grants " +
                std::to_string(buffer.granted_bytes / 2) + ": " + holds,
            "What arrives in a burst longer than that is lost in silence.",
            sysctl_commands("net.core.rmem_max=" + std::to_string(asked))};
  }
  if (buffer.granted_bytes >= 2 * kReceiveBufferBytes) {
    return {"receive buffer", Level::kOk, holds, "", ""};
  }
  Finding finding{
      "receive buffer", Level::kNote, holds,
      "Enough for small teams. What arrives in a longer burst is lost in silence: of 256 "
      "datagrams every 0.1 s, half.",
      ""};
  if (buffer.most_bytes < 2 * kReceiveBufferBytes) {
    finding.remedy = sysctl_commands("net.core.rmem_max=" + std::to_string(kReceiveBufferBytes));
  }
  if (asked > 0) {
    LcmUrl without = url;
    without.receive_buffer_bytes = 0;
    finding.remedy += (finding.remedy.empty() ? "" : "\n") + ("--lcm-url '" + without.base() + "'");
  }
  return finding;
}

Finding fragments_finding(const std::filesystem::path& proc) {
  const auto bytes = number_in(proc / "sys/net/ipv4/ipfrag_high_thresh");
  if (!bytes) return {"fragments", Level::kOk, "the kernel does not report its limit", "", ""};
  const std::string found = std::to_string(*bytes) + " bytes for fragments that wait";
  if (*bytes >= kFragmentBytes) return {"fragments", Level::kOk, found, "", ""};
  return {
      "fragments", Level::kNote, found,
      "Messages of Ergocast are never fragmented. Other LCM programs' messages above the MTU are "
      "all lost while the fragments of broken ones fill this room.",
      sysctl_commands("net.ipv4.ipfrag_high_thresh=" + std::to_string(kFragmentBytes))};
}

Finding reverse_path_finding(const std::filesystem::path& proc, const std::string& interface) {
  const auto setting = [&proc](const std::string& name) {
    return number_in(proc / "sys/net/ipv4/conf" / name / "rp_filter").value_or(0);
  };
  // The kernel uses the larger of the two; 1 is strict, 2 is loose.
  const long value = std::max(setting("all"), setting(interface));
  const std::string found = interface + ": rp_filter=" + std::to_string(value);
  if (value != 1) return {"source check", Level::kOk, found, "", ""};
  return {"source check", Level::kNote, found + " (strict)",
          "Datagrams whose source this host would not answer over " + interface +
              " are dropped in silence: for example when a host sends from another network's "
              "address.",
          "sysctl -w net.ipv4.conf." + interface + ".rp_filter=2"};
}

Finding bridges_finding(const std::filesystem::path& sys, const std::vector<std::string>& own) {
  std::vector<std::string> forgetful;
  for (const std::string& name : own) {
    const auto bridge = sys / "class/net" / name / "bridge";
    if (number_in(bridge / "multicast_snooping") == 1 &&
        number_in(bridge / "multicast_querier") == 0) {
      forgetful.push_back(name);
    }
  }
  if (forgetful.empty()) return {"bridges", Level::kOk, "none that forgets its listeners", "", ""};
  std::vector<std::string> commands;
  for (const std::string& name : forgetful) {
    commands.push_back("ip link set " + name + " type bridge mcast_querier 1");
  }
  return {
      "bridges", Level::kNote, joined(forgetful) + ": snooping without a querier",
      "Such a bridge passes multicast on to all while it receives no querier at all. Switches that "
      "also snoop do not: with no querier on the network they forget the listeners, and a team "
      "falls silent some 4 minutes after its start. Only for bridges that a team uses:",
      joined(commands, "\n")};
}

}  // namespace ergocast::doctor
