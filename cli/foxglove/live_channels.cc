// SPDX-License-Identifier: BSD-3-Clause
// Forgets the oldest message of a channel when it has too many.
#include "cli/foxglove/live_channels.h"

#include <utility>

namespace ergocast::cli {

LiveChannels::Id LiveChannels::add(std::string topic, const foxglove::Schema& schema, Kind kind) {
  channels_.push_back({.topic = std::move(topic), .schema = &schema, .kind = kind});
  return static_cast<Id>(channels_.size());
}

void LiveChannels::publish(Id id, std::uint64_t time_ns, std::string json) {
  Channel& channel = get(id);
  channel.kept.push_back({time_ns, std::move(json)});
  ++channel.count;
  ++published_;
  const std::size_t most = channel.kind == Kind::kLog ? kMostLines : kMostStates;
  if (channel.kept.size() > most) channel.kept.pop_front();
}

}  // namespace ergocast::cli
