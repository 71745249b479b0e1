// SPDX-License-Identifier: BSD-3-Clause
// Members by address: a packet of any other address changes nothing, unless it is a Join with a
// cookie.
#include "relay/hub.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>
#include <utility>

namespace ergocast::relay {
namespace {

/// The lower of two rates, of which 0 has no limit.
std::int64_t lower(std::int64_t one, std::int64_t other) {
  if (one == 0 || other == 0) return std::max(one, other);
  return std::min(one, other);
}

double percent_lost(std::int64_t sent, std::int64_t received) {
  if (sent <= 0 || received >= sent) return 0;
  return 100.0 * static_cast<double>(sent - received) / static_cast<double>(sent);
}

}  // namespace

Hub::Hub(const Settings& settings, const MessageAuthenticator& authenticator)
    : settings_(settings),
      seal_(authenticator.key()),
      jar_(settings.secret),
      carrier_(authenticator, settings.others) {}

void Hub::take_local(Bus bus, std::span<const std::byte> datagram, Instant now) {
  const auto admitted = carrier_.from_group(bus, datagram, !members_.empty(), now);
  if (admitted) queue(*admitted, {bus, {datagram.begin(), datagram.end()}}, nullptr, now);
}

void Hub::receive(std::span<const std::byte> packet, const Address& from, Instant now,
                  Outbox& out) {
  if (packet.empty()) return;
  if (packet[0] == kDataKind) {
    const auto member = members_.find(from);
    if (member != members_.end()) on_data(member->second, packet, now, out);
    return;
  }
  const auto control = seal_.read(packet);
  if (control) std::visit([&](const auto& message) { on(message, from, now, out); }, *control);
}

void Hub::on_data(Member& member, std::span<const std::byte> packet, Instant now, Outbox& out) {
  bool counted = false;
  for (GroupDatagram& datagram : frames_of(packet)) {
    bool copy = false;
    const auto admitted = carrier_.from_flow(datagram, now, copy);
    if (!admitted) break;  // no relay sends it
    if (!std::exchange(counted, true)) ++member.ours.packets_received;
    if (copy) {
      // This site has it: another relay there has carried it, or a VPN.
      member.sender.remove(*admitted);
      continue;
    }
    queue(*admitted, datagram, &member, now);
    if (settings_.has_group) carrier_.put(std::move(datagram), *admitted, now, out);
  }
}

/// Commands go only where a process receives them, if it is known where that is.
void Hub::queue(const Admitted& admitted, const GroupDatagram& datagram, Member* from,
                Instant now) {
  if (admitted.commanded) {
    commanded_until_ = now + kCommanded;
    if (from != nullptr) from->commanded_until = commanded_until_;
  }
  const bool to_few = admitted.urgency == Urgency::kCommand && now < commanded_until_;
  for (auto& [address, member] : members_) {
    if (&member == from || (to_few && now >= member.commanded_until)) continue;
    member.sender.add(admitted, datagram.bus, datagram.bytes);
  }
}

// ---- joining ----

void Hub::send(const Control& control, const Address& to, Outbox& out) const {
  out.packets.push_back({to, seal_.write(control)});
}

void Hub::on(const Ask& ask, const Address& from, Instant now, Outbox& out) {
  send(Cookie{ask.nonce, jar_.make(from, ask.site, now)}, from, out);
}

/// Whether a member with that identity has sent a later packet.
bool Hub::is_replay(SiteId site, std::int64_t count) const {
  return std::any_of(members_.begin(), members_.end(), [&](const auto& one) {
    return one.second.site == site && one.second.count > count;
  });
}

void Hub::on(const Join& join, const Address& from, Instant now, Outbox& out) {
  if (!jar_.holds(join.cookie, from, join.site, now) || is_replay(join.site, join.count)) return;
  // The same site may have another address now, and another site may have this address.
  for (auto at = members_.begin(); at != members_.end();) {
    const auto next = std::next(at);
    const bool repeated = at->first == from && at->second.site == join.site;
    if (!repeated && (at->first == from || at->second.site == join.site)) remove(at);
    at = next;
  }
  const auto known = members_.find(from);
  if (known == members_.end()) {
    if (members_.size() >= kMostSites) return;
    const auto rate = lower(settings_.most_bytes_per_s, join.most_bytes_per_s);
    const auto joined = members_.emplace(from, Member(join, rate, now)).first;
    carrier_.give_stops(joined->second.sender, now, now);
  } else if (join.count > known->second.count) {
    Member& member = known->second;  // the site did not get our answers
    member.count = join.count;
    member.last_received = member.joined = now;
    carrier_.give_stops(member.sender, now, now);
    member.ours = member.theirs = {};
    member.received_by_ping = member.sent_by_pong = member.sent_by_last_pong = 0;
  }
  send(Welcome{join.count}, from, out);
}

void Hub::on(const Ping& ping, const Address& from, Instant now, Outbox& out) {
  const auto at = members_.find(from);
  if (at == members_.end() || at->second.site != ping.site) {
    return send(Unknown{ping.count}, from, out);
  }
  Member& member = at->second;
  if (ping.count <= member.count) return;
  member.count = ping.count;
  member.last_received = now;
  member.theirs = ping.counts;
  member.received_by_ping = member.ours.packets_received;
  member.round_trip_s = ping.round_trip_s;
  member.ours.dropped = member.sender.dropped().total();
  member.sent_by_last_pong = std::exchange(member.sent_by_pong, member.ours.packets_sent);
  send(Pong{ping.count, member.ours}, from, out);
  if (now < member.joined + kGivesStops) carrier_.give_stops(member.sender, member.joined, now);
}

void Hub::on(const Leave& leave, const Address& from, Instant, Outbox&) {
  const auto at = members_.find(from);
  if (at == members_.end() || at->second.site != leave.site) return;
  if (leave.count > at->second.count) remove(at);
}

void Hub::on(const Question& question, const Address& from, Instant now, Outbox& out) {
  if (!jar_.holds(question.cookie, from, question.nonce, now)) return;
  send(Report{question.nonce, report(now)}, from, out);
}

void Hub::remove(Members::iterator member) {
  carrier_.end(member->second.sender);
  members_.erase(member);
}

// ---- time ----

void Hub::advance(Instant now, Outbox& out) {
  for (auto at = members_.begin(); at != members_.end();) {
    const auto next = std::next(at);
    Member& member = at->second;
    if (now >= member.last_received + kSilence) {
      remove(at);
    } else {
      while (auto packet = member.sender.next_packet(now)) {
        ++member.ours.packets_sent;
        out.packets.push_back({at->first, *std::move(packet)});
      }
    }
    at = next;
  }
}

Instant Hub::next_wakeup() const {
  Instant next = Instant::max();
  for (const auto& [address, member] : members_) {
    next = std::min({next, member.last_received + kSilence, member.sender.next_wakeup()});
  }
  return next;
}

Counts Hub::counts() const {
  Counts counts = carrier_.counts();
  for (const auto& [address, member] : members_) add(member.sender, counts);
  return counts;
}

std::string Hub::report(Instant now) const {
  constexpr std::string_view kMore = "; and 999 more";
  std::string text = std::to_string(members_.size()) + (members_.size() == 1 ? " site" : " sites");
  std::size_t left = members_.size();
  for (const auto& [address, member] : members_) {
    std::array<char, 256> line{};
    std::snprintf(
        line.data(), line.size(),
        "%s: for %.0f s, round trip %.0f ms, lost %.1f %% to the hub and %.1f %% from it, dropped "
        "%lld there and %lld here",
        to_text(address).c_str(), std::chrono::duration<double>(now - member.joined).count(),
        1e3 * member.round_trip_s,
        percent_lost(member.theirs.packets_sent, member.received_by_ping),
        percent_lost(member.sent_by_last_pong, member.theirs.packets_received),
        static_cast<long long>(member.theirs.dropped),
        static_cast<long long>(member.sender.dropped().total()));
    const std::string more = (left == members_.size() ? ". " : "; ") + std::string(line.data());
    if (text.size() + more.size() + kMore.size() > kMaxReportLength) break;
    text += more;
    --left;
  }
  return left == 0 ? text : text + "; and " + std::to_string(left) + " more";
}

}  // namespace ergocast::relay
