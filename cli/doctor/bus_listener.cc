// SPDX-License-Identifier: BSD-3-Clause
// Parses LCM datagrams without LCM, groups them by run, and describes the runs and the foreign
// senders on the bus.
#include "cli/doctor/bus_listener.h"

#include <poll.h>

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdio>

#include "cli/doctor/group_listener.h"
#include "lcmtypes/codec.h"
#include "runtime/bus/clock.h"
#include "runtime/bus/lcm_datagram.h"

namespace ergocast::doctor {
namespace {

constexpr std::size_t kMostRuns = 8, kMostNames = 8;

void note(std::set<std::string>& names, const std::string& name) {
  if (!name.empty() && names.size() < kMostNames) names.insert(printable(name));
}

std::string listed(const std::set<std::string>& names) {
  return doctor::joined({names.begin(), names.end()});
}

std::string described(RunId id, const HeardRun& run) {
  char text[32];
  std::snprintf(text, sizeof text, "run %016" PRIx64, id);
  return text + (run.state.empty() ? "" : ", " + run.state) +
         (run.agents.empty() ? "" : ", " + counted(static_cast<long>(run.agents.size()), "agent")) +
         (run.hosts.empty() ? "" : " on " + listed(run.hosts)) +
         (run.versions.empty() ? "" : ", version " + listed(run.versions));
}

}  // namespace

void Overheard::take(std::span<const std::byte> datagram) {
  const auto lcm = parse_datagram(datagram);
  if (!lcm || lcm->channel.empty()) return;
  const auto decoded = decode(lcm->message, 0, authenticator_, lcm->channel);
  if (decoded) return take(*decoded);
  if (decoded.error() == Refusal::kUnkeyed) {
    ++unkeyed_;
    return;
  }
  if (decoded.error() == Refusal::kTag) {
    ++other_key_;
    return;
  }
  ++foreign_messages_;
  note(foreign_channels_, std::string(lcm->channel));
}

void Overheard::take(const Message& message) {
  const Header& header = header_of(message);
  if (!runs_.contains(header.run) && runs_.size() == kMostRuns) return;
  HeardRun& run = runs_[header.run];
  ++run.messages;
  if (header.sender >= 0) run.agents.insert(header.sender);
  if (const auto* hello = std::get_if<Hello>(&message)) {
    note(run.hosts, hello->host);
    note(run.versions, hello->version);
  } else if (const auto* status = std::get_if<AgentStatus>(&message)) {
    note(run.hosts, status->host);
  } else if (const auto* team = std::get_if<TeamStatus>(&message)) {
    run.state = to_string(team->state);
  }
}

std::optional<Finding> Overheard::key_finding() const {
  if (unkeyed_ > 0) {
    return Finding{"swarm bus", Level::kWarning, "a team without a mission key",
                   "Processes with a key refuse all its messages.",
                   "--key-file FILE   # for every process, or for none"};
  }
  if (other_key_ > 0 && authenticator_.keyed()) {
    return Finding{"swarm bus", Level::kWarning, "messages that this key does not open",
                   "They are damaged, or their senders have another key and refuse all messages "
                   "of this host.",
                   "head -n 3 FILE | sha256sum   # of --key-file, on every host: what both files "
                   "of a key share"};
  }
  if (other_key_ > 0) {
    return Finding{"swarm bus", Level::kNote, "a team with a mission key, or damage",
                   "This host can join it with that key.", "ergocast doctor --key-file FILE"};
  }
  return std::nullopt;
}

Finding authentication_finding(bool keyed) {
  if (keyed) return {"mission key", Level::kOk, "messages are checked with it", "", ""};
  return {"mission key", Level::kNote, "none: unauthenticated",
          "Any program that reaches these ports can send as the team. Read docs/security.md.",
          "ergocast keygen"};
}

Finding Overheard::finding(const LcmUrl& url, std::optional<int> free_port) const {
  LcmUrl other = url;
  other.base_port = free_port.value_or(kFirstBasePort);
  const std::string where = url.group + ":" + std::to_string(url.base_port);
  if (!runs_.empty()) {
    std::vector<std::string> texts;
    for (const auto& [id, run] : runs_) texts.push_back(described(id, run));
    return {
        "swarm bus", Level::kNote, doctor::joined(texts, "; "),
        "A team is at work here and this host receives it. A second run needs ports of its own.",
        ""};
  }
  if (const auto keys = key_finding()) return *keys;
  if (foreign_messages_ > 0) {
    return {"swarm bus", Level::kWarning, "other LCM traffic: " + listed(foreign_channels_),
            "Every process of a team would parse all of it and refuse it.",
            "--lcm-url '" + other.base() + "'   # on every host"};
  }
  return {"swarm bus", Level::kOk, "no messages on " + where, "", ""};
}

Overheard listen_to_swarm(const LcmUrl& url, const MessageAuthenticator& authenticator,
                          std::chrono::milliseconds duration, std::string& error) {
  Overheard overheard(authenticator);
  const Socket socket = group_listener(url.group, url.base_port, error);
  if (!error.empty()) return overheard;
  std::array<std::byte, 65536> buffer;
  const Instant end = now() + duration;
  for (Instant at = now(); at < end; at = now()) {
    pollfd ready{socket.fd(), POLLIN, 0};
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - at);
    if (poll(&ready, 1, static_cast<int>(left.count())) <= 0) continue;
    const ssize_t size = recv(socket.fd(), buffer.data(), buffer.size(), 0);
    if (size > 0) overheard.take({buffer.data(), static_cast<std::size_t>(size)});
  }
  return overheard;
}

}  // namespace ergocast::doctor
