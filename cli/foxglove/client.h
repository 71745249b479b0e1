// SPDX-License-Identifier: BSD-3-Clause
// One client of the Foxglove WebSocket protocol: its bytes in, ours out. No socket, no clock.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "cli/foxglove/live_channels.h"
#include "cli/foxglove/websocket.h"
#include "cli/watch/connections.h"

namespace ergocast::cli {

/// The subprotocols. The second one is that of Foxglove's SDK; what we use of both is the same.
inline constexpr const char* kFoxgloveProtocols[] = {"foxglove.websocket.v1", "foxglove.sdk.v1"};

/// Takes bounded memory, whatever the client sends or does not read. A client that has not taken
/// our previous bytes gets no more, and loses the messages that LiveChannels forgets meanwhile.
class FoxgloveClient final : public Connections::Dialogue {
 public:
  /// Limit (Page): answers that wait for a Foxglove client. Beyond it: further ones are left out.
  static constexpr int kMostAnswers = 16;

  /// Gets sentences for people about this client.
  using Note = std::function<void(const std::string&)>;

  /// @param channels  outlives this object
  /// @param run       names the team, so that clients know another one
  FoxgloveClient(LiveChannels& channels, std::string run, Note note);
  ~FoxgloveClient() override;
  FoxgloveClient(const FoxgloveClient&) = delete;
  FoxgloveClient& operator=(const FoxgloveClient&) = delete;

  void begin(const std::string& peer) override;
  void receive(std::string_view bytes) override;
  std::optional<std::string> next() override;

 private:
  using Json = nlohmann::json;
  enum class Level { kInfo, kWarning, kError };
  struct Subscription {
    std::uint32_t id = 0;    // as the client numbers it
    std::uint64_t next = 0;  // the number of its next message
  };
  using ByChannel = std::map<LiveChannels::Id, Subscription>;

  void handle(const FrameReader::Message& message);
  void obey(const std::string& text);
  void subscribe(const Json& request);
  void subscribe(std::uint32_t id, std::uint64_t channel);
  void unsubscribe(const Json& request);
  void status(Level level, const std::string& text);
  void reply(const Json& json);
  void advertise(std::string& out);
  void add_messages(std::string& out);
  bool add_message(ByChannel::value_type& one, std::string& out);
  void notice_losses();
  void report_losses();
  void end(std::string last_frame);

  LiveChannels& channels_;
  std::string run_;
  Note note_;
  std::string name_;
  FrameReader reader_;
  std::string replies_;  // frames that wait
  int waiting_ = 0;      // how many of them are answers
  std::string pong_;     // the newest
  bool over_ = false;
  std::size_t advertised_ = 0;
  std::map<std::uint32_t, LiveChannels::Id> channel_of_;  // by the client's numbers
  ByChannel subscriptions_;
  LiveChannels::Id turn_ = 0;      // the channel that was served last
  std::uint64_t seen_ = 0;         // LiveChannels::published(), when all was sent
  bool has_new_channels_ = false;  // subscriptions since then
  std::uint64_t lost_ = 0, reported_ = 0;
  bool is_slow_ = false;  // it has lost messages, and people know
};

}  // namespace ergocast::cli
