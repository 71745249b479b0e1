// SPDX-License-Identifier: BSD-3-Clause
// The channels of a live team, and the newest messages of each, once for all clients.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

#include "report/export/foxglove.h"

namespace ergocast::cli {

/// Each client has a place in each channel that it subscribes to. A slow client takes no memory
/// here: what is no longer kept is lost to it.
class LiveChannels {
 public:
  using Id = std::uint32_t;  ///< from 1
  enum class Kind {
    kState,  ///< a client that subscribes gets the newest message first
    kLog,    ///< it gets all that are kept
  };
  /// Limit (Page): messages of a topic that wait for a slow Foxglove client. Beyond it: it does not
  /// get the oldest.
  static constexpr std::size_t kMostStates = 16;
  /// Limit (Page): log lines that wait for a slow Foxglove client. Beyond it: it does not get the
  /// oldest.
  static constexpr std::size_t kMostLines = 200;

  struct Message {
    std::uint64_t time_ns = 0;
    std::string json;
  };
  struct Channel {
    std::string topic;
    const foxglove::Schema* schema;
    Kind kind;
    std::deque<Message> kept{};
    std::uint64_t count = 0;  ///< of all messages so far; the last of `kept` has count − 1
    int subscribers = 0;

    /// The number of the oldest message that is kept.
    std::uint64_t first() const { return count - kept.size(); }
    /// Where a new subscription begins.
    std::uint64_t begin() const { return kind == Kind::kLog || kept.empty() ? first() : count - 1; }
  };

  /// @param schema  outlives this object
  Id add(std::string topic, const foxglove::Schema& schema, Kind kind = Kind::kState);
  void publish(Id id, std::uint64_t time_ns, std::string json);
  bool is_wanted(Id id) const { return get(id).subscribers > 0; }

  std::size_t size() const { return channels_.size(); }
  bool has(std::uint64_t id) const { return id >= 1 && id <= channels_.size(); }
  /// @pre has(id)
  const Channel& get(Id id) const { return channels_[id - 1]; }
  Channel& get(Id id) { return channels_[id - 1]; }
  /// Grows with each message.
  std::uint64_t published() const { return published_; }

 private:
  std::deque<Channel> channels_;
  std::uint64_t published_ = 0;
};

}  // namespace ergocast::cli
