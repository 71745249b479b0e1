// SPDX-License-Identifier: BSD-3-Clause
// Describes the peers that this host received, and those that only other hosts received.
#include <algorithm>

#include "cli/doctor/peer_exchange.h"
#include "cli/doctor/routing.h"
#include "text/versions.h"

namespace ergocast::doctor {
namespace {

/// A healthy network loses less than this.
constexpr double kMuchLost_percent = 1.0;
constexpr double kAlmostAll_percent = 90.0;

std::string here_again(const LcmUrl& url) {
  return "ergocast doctor --peer --lcm-url '" + url.base() + "'";
}

bool only_large_are_lost(const Loss& loss) {
  return loss.expected.large > 0 && loss.large_percent() >= kAlmostAll_percent &&
         loss.small_percent() < kAlmostAll_percent / 2;
}

Finding one_way(const LcmUrl& url, const Peer& peer) {
  return {"peer " + peer.host, Level::kProblem,
          "one-way: its probes arrive here, but this host's do not arrive there",
          "What this host sends is lost on the way to " + peer.address +
              ": a wrong route here, a "
              "firewall there, or a switch between that does not pass the group on.",
          "ip route get " + url.group + "   # here: the interface that leads there?\n" +
              here_again(url) +
              "   # there: what does it report?\n"
              "nft list ruleset   # there, as root: what drops udp to " +
              url.group + "?"};
}

Finding mtu_too_small(const Peer& peer) {
  return {"peer " + peer.host, Level::kProblem, "only short datagrams arrive",
          "Datagrams as long as our longest messages (packets of " +
              std::to_string(kLongestPacketBytes) +
              " bytes) are lost and short ones are not: the "
              "MTU somewhere on the way is smaller.",
          "ip link   # on both hosts and whatever is between: every mtu at least " +
              std::to_string(kLongestPacketBytes) +
              "\n"
              "ping -M do -s " +
              std::to_string(kLongestPacketBytes - 28) + " " + peer.address};
}

std::string losses(const Peer& peer) {
  return fixed(peer.from_it.percent(), 1) + " % from it, " + fixed(peer.to_it->percent(), 1) +
         " % to it";
}

std::string other_key(const Peer& peer, std::uint64_t key) {
  if (peer.key == 0) return "it has no mission key and this host has one";
  return key == 0 ? "it has a mission key and this host has none" : "it has another mission key";
}

Finding peer_finding(const LcmUrl& url, const Peer& peer, const std::string& version,
                     std::uint64_t key) {
  Finding finding{"peer " + peer.host, Level::kOk, "", "", ""};
  if (!peer.to_it) {
    if (peer.judged()) return one_way(url, peer);
    finding.level = Level::kNote;
    finding.found = "received too briefly to know whether it receives this host";
    finding.why = "The tests on the two hosts hardly overlapped.";
    finding.remedy = here_again(url) + "   # on both, at about the same time";
    return finding;
  }
  if (only_large_are_lost(peer.from_it) || only_large_are_lost(*peer.to_it)) {
    return mtu_too_small(peer);
  }
  const double worst = std::max(peer.from_it.percent(), peer.to_it->percent());
  finding.found = "each receives the other";
  if (peer.version != version) {
    finding.level = Level::kWarning;
    finding.found += ", but it has version " + peer.version + " and this host " + version;
    finding.why = "The programs of a team must be of one version.";
    finding.remedy =
        "ergocast --version   # " + update_of_hosts(peer.host, peer.version, "this host", version);
  } else if (peer.key != key) {
    finding.level = Level::kWarning;
    finding.found += ", but " + other_key(peer, key);
    finding.why = "All programs of a team need the same mission key, or none.";
    finding.remedy = here_again(url) + " --key-file FILE   # on every host, with the team's file";
  } else if (worst > kMuchLost_percent) {
    finding.level = Level::kWarning;
    finding.found += ", lost: " + losses(peer);
    finding.why =
        "Teams bear loss, but lockstep gets slow and coverage stale. Cable networks lose "
        "nothing; on Wi-Fi, multicast is sent at the lowest rate and never repeated.";
    finding.remedy = "ip -s link   # on both hosts: errors, dropped?";
  } else if (peer.duplicates > 0) {
    finding.level = Level::kNote;
    finding.found += ", " + std::to_string(peer.duplicates) + " probes came twice";
    finding.why = "Harmless for a team; a loop in the network, or two paths between the hosts.";
  }
  return finding;
}

Finding nobody(const LcmUrl& url, const PeerTest& test) {
  return {"peers", Level::kProblem,
          "no probe of another host arrived (" + std::to_string(test.sent) + " sent)",
          "Either no other host ran this test at the same time with the same group and port, or "
          "what it sent did not arrive. Only the other host knows whether it received this one.",
          here_again(url) +
              "   # on every host, at about the same time\n"
              "tcpdump -ni any udp port " +
              std::to_string(url.base_port) + "   # here: what arrives?"};
}

}  // namespace

Findings peer_findings(const LcmUrl& url, const PeerTest& test, const std::string& version,
                       std::uint64_t key) {
  if (!test.error.empty()) {
    return {
        {"peers", Level::kProblem, test.error,
         "This host could not send probes or listen for them: no route, or a firewall.",
         "ip route get " + url.group + "\nnft list ruleset   # as root: what drops outgoing udp?"}};
  }
  if (test.peers.empty()) return {nobody(url, test)};
  Findings findings;
  for (const Peer& peer : test.peers) findings.push_back(peer_finding(url, peer, version, key));
  if (test.only_received_by_others > 0) {
    findings.push_back(
        {"peers", Level::kProblem,
         std::to_string(test.only_received_by_others) +
             " more whose probes reach others, but not this host",
         "One-way towards this host: other hosts receive probes of a host that this host does not "
         "receive.",
         "tcpdump -ni any udp port " + std::to_string(url.base_port) + "   # here: what arrives?"});
  }
  return findings;
}

}  // namespace ergocast::doctor
