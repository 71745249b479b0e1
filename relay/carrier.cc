// SPDX-License-Identifier: BSD-3-Clause
// Admits first and remembers later, so that a forged datagram cannot hide a true one.
#include "relay/carrier.h"

#include <utility>

namespace ergocast::relay {
namespace {

std::string refusals(const RefusalCounts& refused) {
  std::string text;
  for (std::size_t i = 0; i < refused.size(); ++i) {
    if (refused[i] == 0) continue;
    text += std::string(text.empty() ? "" : " ") + to_string(static_cast<Refusal>(i)) + '=' +
            std::to_string(refused[i]);
  }
  return text.empty() ? "none" : text;
}

}  // namespace

std::optional<Admitted> Carrier::from_group(Bus bus, std::span<const std::byte> datagram,
                                            bool has_path, Instant now) {
  const auto admitted = gate_.admit(bus, datagram);
  if (!admitted || echoes_.take(admitted->identity, now)) return std::nullopt;
  ++counts_.from_group;
  stops_.note(*admitted, bus, datagram, now);
  if (!has_path) {
    ++counts_.no_path;
    return std::nullopt;
  }
  if (recent_.note(admitted->identity, now)) return admitted;
  ++counts_.copies;
  return std::nullopt;
}

std::optional<Admitted> Carrier::from_flow(const GroupDatagram& datagram, Instant now, bool& copy) {
  const auto admitted = gate_.admit(datagram.bus, datagram.bytes);
  if (!admitted) return std::nullopt;
  ++counts_.from_flows;
  stops_.note(*admitted, datagram.bus, datagram.bytes, now);
  copy = !recent_.note(admitted->identity, now);
  if (copy) ++counts_.copies;
  return admitted;
}

void Carrier::put(GroupDatagram datagram, const Admitted& admitted, Instant now, Outbox& out) {
  ++counts_.to_group;
  echoes_.sent(admitted.identity, now);
  out.group.push_back(std::move(datagram));
}

void add(const Sender& sender, Counts& counts) {
  const Dropped& dropped = sender.dropped();
  counts.dropped.replaced += dropped.replaced;
  counts.dropped.overtaken += dropped.overtaken;
  counts.dropped.overflow += dropped.overflow;
  counts.to_flows += sender.datagrams_sent();
  counts.bytes_to_flows += sender.bytes_sent();
}

Counts Carrier::counts() const {
  Counts counts = counts_;
  counts.refused = gate_.refused();
  return counts;
}

std::string to_text(const Counts& counts) {
  return "carried " + std::to_string(counts.to_flows) + " datagrams to relays (" +
         std::to_string(counts.bytes_to_flows / 1000) + " kB) and " +
         std::to_string(counts.to_group) +
         " to the local group; dropped: " + std::to_string(counts.dropped.replaced) +
         " replaced by newer, " + std::to_string(counts.dropped.overtaken) + " overtaken, " +
         std::to_string(counts.dropped.overflow) + " beyond the queue, " +
         std::to_string(counts.no_path) + " without a path, " + std::to_string(counts.copies) +
         " copies; refused: " + refusals(counts.refused);
}

}  // namespace ergocast::relay
