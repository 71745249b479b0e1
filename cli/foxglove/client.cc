// SPDX-License-Identifier: BSD-3-Clause
// Serves the subscriptions in turn, in portions, so that no channel delays another for long.
#include "cli/foxglove/client.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace ergocast::cli {
namespace {

/// A portion ends after the message with which it has as many bytes.
constexpr std::size_t kPortion = 128 << 10;
/// Channels in one message.
constexpr std::size_t kAdvertised = 64;
/// Bytes of a client's text that an answer repeats.
constexpr std::size_t kRepeated = 40;

/// Nothing if the value is no integer from 0 to 2³² − 1.
std::optional<std::uint32_t> number_in(const nlohmann::json& object, const char* key) {
  if (!object.is_object()) return std::nullopt;
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_unsigned()) return std::nullopt;
  const auto value = found->get<std::uint64_t>();
  if (value > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return static_cast<std::uint32_t>(value);
}

/// The list under a key; empty if there is none.
const nlohmann::json& list_in(const nlohmann::json& object, const char* key) {
  static const nlohmann::json kNone = nlohmann::json::array();
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : kNone;
}

/// Binary: 1, the client's number of the subscription, the time, the message.
std::string message_frame(std::uint32_t subscription, const LiveChannels::Message& message) {
  constexpr std::size_t kHead = 1 + 4 + 8;
  std::string bytes = frame_head(Opcode::kBinary, kHead + message.json.size());
  bytes += '\1';
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(subscription >> shift);
  for (int shift = 0; shift < 64; shift += 8) bytes += static_cast<char>(message.time_ns >> shift);
  return bytes += message.json;
}

}  // namespace

FoxgloveClient::FoxgloveClient(LiveChannels& channels, std::string run, Note note)
    : channels_(channels), run_(std::move(run)), note_(std::move(note)) {}

FoxgloveClient::~FoxgloveClient() {
  for (const auto& [channel, one] : subscriptions_) --channels_.get(channel).subscribers;
}

void FoxgloveClient::begin(const std::string& peer) {
  name_ = "Foxglove client " + peer;
  reply({{"op", "serverInfo"},
         {"name", "ergocast"},
         {"capabilities", Json::array()},
         {"metadata", {{"frame_id", "ergocast"}}},
         {"sessionId", run_}});
}

void FoxgloveClient::receive(std::string_view bytes) {
  if (over_) return;
  notice_losses();
  if (bytes.empty()) return;
  reader_.add(bytes);
  while (const auto message = reader_.next()) {
    handle(*message);
    if (over_) return;
  }
  if (reader_.violation()) end(close_frame(*reader_.violation()));
}

void FoxgloveClient::handle(const FrameReader::Message& message) {
  switch (message.opcode) {
    case Opcode::kText:
      return obey(message.payload);
    case Opcode::kPing:
      pong_ = frame(Opcode::kPong, message.payload);
      return;
    case Opcode::kPong:
    case Opcode::kContinuation:
      return;
    case Opcode::kClose:
      return end(frame(Opcode::kClose, std::string_view(message.payload).substr(0, 2)));
    case Opcode::kBinary:
      return status(Level::kError, "this server takes no binary messages: it only shows a team");
  }
}

void FoxgloveClient::obey(const std::string& text) {
  const Json request = Json::parse(text, nullptr, false);
  if (!request.is_object()) return status(Level::kError, "a message is no JSON object");
  const auto op = request.find("op");
  if (op == request.end() || !op->is_string())
    return status(Level::kError, "a message has no \"op\"");
  const auto name = op->get<std::string>();
  if (name == "subscribe") return subscribe(request);
  if (name == "unsubscribe") return unsubscribe(request);
  status(Level::kWarning,
         "\"" + name.substr(0, kRepeated) + "\" is not supported: this server only shows a team");
}

void FoxgloveClient::subscribe(const Json& request) {
  for (const Json& one : list_in(request, "subscriptions")) {
    const auto id = number_in(one, "id"), channel = number_in(one, "channelId");
    if (id && channel) {
      subscribe(*id, *channel);
    } else {
      status(Level::kError, "a subscription needs \"id\" and \"channelId\", numbers from 0");
    }
  }
}

void FoxgloveClient::subscribe(std::uint32_t id, std::uint64_t channel) {
  if (!channels_.has(channel))
    return status(Level::kError, "there is no channel " + std::to_string(channel));
  const auto at = static_cast<LiveChannels::Id>(channel);
  if (channel_of_.contains(id))
    return status(Level::kError, "subscription " + std::to_string(id) + " exists already");
  auto& found = channels_.get(at);
  if (!subscriptions_.try_emplace(at, Subscription{id, found.begin()}).second)
    return status(Level::kError, "channel " + std::to_string(channel) + " is subscribed already");
  channel_of_[id] = at;
  ++found.subscribers;
  has_new_channels_ = true;
}

void FoxgloveClient::unsubscribe(const Json& request) {
  for (const Json& one : list_in(request, "subscriptionIds")) {
    const auto id = number_in({{"id", one}}, "id");
    const auto found = id ? channel_of_.find(*id) : channel_of_.end();
    if (found == channel_of_.end()) {
      status(Level::kError, "there is no such subscription");
      continue;
    }
    --channels_.get(found->second).subscribers;
    subscriptions_.erase(found->second);
    channel_of_.erase(found);
  }
}

void FoxgloveClient::status(Level level, const std::string& text) {
  if (waiting_ >= kMostAnswers) return;
  ++waiting_;
  reply({{"op", "status"}, {"level", static_cast<int>(level)}, {"message", text}});
}

void FoxgloveClient::reply(const Json& json) {
  replies_ += frame(Opcode::kText, json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void FoxgloveClient::end(std::string last_frame) {
  over_ = true;
  replies_ = std::move(last_frame);
}

std::optional<std::string> FoxgloveClient::next() {
  if (over_ && replies_.empty()) return std::nullopt;
  std::string out = std::exchange(replies_, {});
  waiting_ = 0;
  if (over_) return out;
  notice_losses();
  out += std::exchange(pong_, {});
  advertise(out);
  add_messages(out);
  report_losses();
  return out;
}

/// At least one message, as the protocol demands: some channels are there from the beginning.
void FoxgloveClient::advertise(std::string& out) {
  while (advertised_ < channels_.size() && out.size() < kPortion) {
    Json list = Json::array();
    const std::size_t end = std::min(channels_.size(), advertised_ + kAdvertised);
    while (advertised_ < end) {
      const auto id = static_cast<LiveChannels::Id>(++advertised_);
      const LiveChannels::Channel& channel = channels_.get(id);
      list.push_back({{"id", id},
                      {"topic", channel.topic},
                      {"encoding", "json"},
                      {"schemaName", channel.schema->name},
                      {"schema", channel.schema->text},
                      {"schemaEncoding", "jsonschema"}});
    }
    out += frame(Opcode::kText, Json{{"op", "advertise"}, {"channels", std::move(list)}}.dump());
  }
}

void FoxgloveClient::add_messages(std::string& out) {
  if (seen_ == channels_.published() && !has_new_channels_) return;
  const std::uint64_t published = channels_.published();
  for (std::size_t idle = 0; idle < subscriptions_.size();) {
    if (out.size() >= kPortion) return;
    auto one = subscriptions_.upper_bound(turn_);
    if (one == subscriptions_.end()) one = subscriptions_.begin();
    turn_ = one->first;
    idle = add_message(*one, out) ? 0 : idle + 1;
  }
  seen_ = published;
  has_new_channels_ = false;
}

/// The next message of one channel; false if there is none.
bool FoxgloveClient::add_message(ByChannel::value_type& one, std::string& out) {
  auto& [id, subscription] = one;
  const LiveChannels::Channel& channel = channels_.get(id);
  if (subscription.next < channel.first()) {
    lost_ += channel.first() - subscription.next;
    subscription.next = channel.first();
  }
  if (subscription.next == channel.count) return false;
  const auto at = static_cast<std::size_t>(subscription.next - channel.first());
  out += message_frame(subscription.id, channel.kept[at]);
  ++subscription.next;
  return true;
}

/// Also while the client takes nothing.
void FoxgloveClient::notice_losses() {
  if (is_slow_) return;
  is_slow_ = std::ranges::any_of(subscriptions_, [this](const auto& one) {
    return one.second.next < channels_.get(one.first).first();
  });
  if (is_slow_) note_(name_ + " is too slow, and loses messages; nothing waits for it");
}

/// The first time, and whenever the losses have doubled.
void FoxgloveClient::report_losses() {
  if (lost_ == 0 || lost_ < 2 * reported_) return;
  reported_ = lost_;
  status(Level::kWarning, std::to_string(lost_) +
                              " messages were left out: the connection or the client is too slow");
}

}  // namespace ergocast::cli
