// SPDX-License-Identifier: BSD-3-Clause
// A Foxglove client in memory: what it gets, what it loses, and what it cannot do.
#include "cli/foxglove/client.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/cli/foxglove/client_frames.h"

namespace ergocast::cli {
namespace {

using nlohmann::json;
using test::client_frame;

class FoxgloveClients : public ::testing::Test {
 protected:
  FoxgloveClients()
      : target_(channels_.add("/target", foxglove::grid_schema())),
        log_(channels_.add("/log", foxglove::log_schema(), LiveChannels::Kind::kLog)) {
    connect();
  }
  void connect() {
    client_ = std::make_unique<FoxgloveClient>(
        channels_, "run 1", [this](const std::string& note) { notes_.push_back(note); });
    client_->begin("127.0.0.1:50000");
  }
  void send(const json& message) { client_->receive(client_frame(1, message.dump())); }
  void subscribe(int id, LiveChannels::Id channel) {
    send({{"op", "subscribe"}, {"subscriptions", {{{"id", id}, {"channelId", channel}}}}});
  }
  /// Takes all that waits. False: the connection ends.
  bool take() {
    for (;;) {
      auto bytes = client_->next();
      if (!bytes) return false;
      longest_ = std::max(longest_, bytes->size());
      if (bytes->empty()) return true;
      for (const auto& [opcode, payload] : test::take_frames(*bytes)) {
        if (opcode == 1) texts_.push_back(json::parse(payload));
        if (opcode == 2)
          data_[static_cast<unsigned char>(payload[1])].push_back(payload.substr(13));
        others_.push_back(opcode == 1 || opcode == 2 ? "" : payload);
      }
      EXPECT_TRUE(bytes->empty());
    }
  }
  std::vector<std::string> statuses() {
    std::vector<std::string> list;
    for (const json& text : texts_)
      if (text["op"] == "status") list.push_back(text["message"]);
    return list;
  }

  LiveChannels channels_;
  std::vector<std::string> notes_;
  LiveChannels::Id target_, log_;
  std::unique_ptr<FoxgloveClient> client_;
  std::vector<json> texts_;
  std::map<int, std::vector<std::string>> data_;  // by the client's number of the subscription
  std::vector<std::string> others_;
  std::size_t longest_ = 0;
};

TEST_F(FoxgloveClients, FirstLearnOfTheServerAndItsChannels) {
  ASSERT_TRUE(take());
  ASSERT_EQ(texts_.size(), 2U);
  EXPECT_EQ(texts_[0]["op"], "serverInfo");
  EXPECT_EQ(texts_[0]["sessionId"], "run 1");
  EXPECT_EQ(texts_[1]["op"], "advertise");
  EXPECT_EQ(texts_[1]["channels"][0]["topic"], "/target");
  EXPECT_EQ(texts_[1]["channels"][0]["schemaName"], "foxglove.Grid");
  EXPECT_EQ(texts_[1]["channels"][0]["schema"], foxglove::grid_schema().text);
  texts_.clear();
  channels_.add("/agents/7/pose", foxglove::pose_schema());
  ASSERT_TRUE(take());
  ASSERT_EQ(texts_.size(), 1U);
  EXPECT_EQ(texts_[0]["channels"].size(), 1U);
  EXPECT_EQ(texts_[0]["channels"][0]["id"], 3);
}

TEST_F(FoxgloveClients, GetTheNewestStateAndAllLinesThatAreKept) {
  for (const char* text : {"a", "b", "c"}) {
    channels_.publish(target_, 5, text);
    channels_.publish(log_, 5, text);
  }
  subscribe(8, target_);
  subscribe(9, log_);
  ASSERT_TRUE(take());
  EXPECT_EQ(data_[8], std::vector<std::string>{"c"});
  EXPECT_EQ(data_[9], (std::vector<std::string>{"a", "b", "c"}));
  channels_.publish(target_, 6, "d");
  ASSERT_TRUE(take());
  EXPECT_EQ(data_[8].back(), "d");
  send({{"op", "unsubscribe"}, {"subscriptionIds", {8}}});
  channels_.publish(target_, 7, "e");
  ASSERT_TRUE(take());
  EXPECT_EQ(data_[8].back(), "d");
  EXPECT_FALSE(channels_.is_wanted(target_));
  EXPECT_TRUE(channels_.is_wanted(log_));
  EXPECT_TRUE(statuses().empty());
}

TEST_F(FoxgloveClients, GetNumbersOfTheProtocolInLittleEndian) {
  channels_.publish(target_, 0x0102030405060708, "{}");
  subscribe(0x01020304, target_);
  std::string bytes;
  for (std::optional<std::string> more; (more = client_->next()) && !more->empty();) bytes += *more;
  const auto frames = test::take_frames(bytes);
  ASSERT_FALSE(frames.empty());
  EXPECT_EQ(frames.back().payload,
            std::string("\x01\x04\x03\x02\x01\x08\x07\x06\x05\x04\x03\x02\x01{}", 15));
}

TEST_F(FoxgloveClients, ThatAreSlowLoseTheOldestAndLearnOfIt) {
  subscribe(8, target_);
  ASSERT_TRUE(take());
  for (int i = 0; i < 1000; ++i) channels_.publish(target_, 5, std::to_string(i));
  ASSERT_TRUE(take());
  ASSERT_EQ(data_[8].size(), LiveChannels::kMostStates);
  EXPECT_EQ(data_[8].back(), "999");
  ASSERT_EQ(statuses().size(), 1U);
  EXPECT_EQ(statuses()[0], "984 messages were left out: the connection or the client is too slow");
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_NE(notes_[0].find("Foxglove client 127.0.0.1:50000 is too slow"), std::string::npos);
  for (int i = 0; i < 1000; ++i) channels_.publish(target_, 5, std::to_string(i));
  ASSERT_TRUE(take());
  EXPECT_EQ(statuses().size(), 2U);
  EXPECT_EQ(notes_.size(), 1U);  // people read it once
}

TEST_F(FoxgloveClients, ThatTakeNothingAreNamedOnce) {
  subscribe(8, target_);
  ASSERT_TRUE(take());
  for (std::size_t i = 0; i < LiveChannels::kMostStates; ++i) channels_.publish(target_, 5, "{}");
  client_->receive("");
  EXPECT_EQ(notes_.size(), 0U);
  for (int i = 0; i < 9; ++i) {
    channels_.publish(target_, 5, "{}");
    client_->receive("");
  }
  EXPECT_EQ(notes_.size(), 1U);
}

TEST_F(FoxgloveClients, GetPortionsInWhichNoChannelWaitsForLong) {
  constexpr std::size_t kLarge = 100'000;
  subscribe(8, target_);
  subscribe(9, log_);
  ASSERT_TRUE(take());
  for (int i = 0; i < 12; ++i) channels_.publish(target_, 5, std::string(kLarge, 'x'));
  channels_.publish(log_, 5, "line");
  longest_ = 0;
  auto first = client_->next();
  ASSERT_TRUE(first);
  EXPECT_LT(first->size(), 3 * kLarge);
  EXPECT_NE(first->find("line"), std::string::npos);
  ASSERT_TRUE(take());
  EXPECT_EQ(data_[8].size(), 12U - test::take_frames(*first).size() + 1);
}

TEST_F(FoxgloveClients, LearnWhatIsWrong) {
  subscribe(1, target_);
  subscribe(1, log_);
  subscribe(2, target_);
  subscribe(3, 99);
  send(
      {{"op", "subscribe"}, {"subscriptions", {{{"id", -1}, {"channelId", target_}}, 5, nullptr}}});
  send({{"op", "unsubscribe"}, {"subscriptionIds", {77, "x"}}});
  send({{"op", "setParameters"}, {"parameters", json::array()}});
  send(json::array());
  client_->receive(client_frame(1, "no JSON \xff"));
  client_->receive(client_frame(2, "\x01\x00"));
  ASSERT_TRUE(take());
  const std::vector<std::string> expected{
      "subscription 1 exists already",
      "channel 1 is subscribed already",
      "there is no channel 99",
      "a subscription needs \"id\" and \"channelId\", numbers from 0",
      "a subscription needs \"id\" and \"channelId\", numbers from 0",
      "a subscription needs \"id\" and \"channelId\", numbers from 0",
      "there is no such subscription",
      "there is no such subscription",
      "\"setParameters\" is not supported: this server only shows a team",
      "a message is no JSON object",
      "a message is no JSON object",
      "this server takes no binary messages: it only shows a team"};
  EXPECT_EQ(statuses(), expected);
}

TEST_F(FoxgloveClients, CostBoundedMemoryWhateverTheySend) {
  std::string brackets(60000, '[');
  json many = {{"op", "subscribe"}};
  for (int i = 0; i < 2000; ++i) many["subscriptions"].push_back({{"id", i}, {"channelId", i}});
  for (int i = 0; i < 5; ++i) {
    client_->receive(client_frame(1, brackets));
    send(many);
    client_->receive(client_frame(9, "ping"));
  }
  ASSERT_TRUE(take());
  EXPECT_EQ(statuses().size(), std::size_t{FoxgloveClient::kMostAnswers});
  EXPECT_EQ(std::count(others_.begin(), others_.end(), "ping"), 1);
  EXPECT_LT(longest_, 16384U);
}

TEST_F(FoxgloveClients, EndInOrder) {
  ASSERT_TRUE(take());
  client_->receive(client_frame(8, "\x03\xe8 bye") + client_frame(1, "{}"));
  EXPECT_FALSE(take());
  EXPECT_EQ(others_.back(), "\x03\xe8");
  subscribe(1, target_);
  EXPECT_FALSE(take());
  connect();
  client_->receive("\x81\x03 no mask");
  EXPECT_FALSE(take());
  EXPECT_EQ(others_.back(), "\x03\xea");
  connect();
  subscribe(1, target_);
  ASSERT_TRUE(channels_.is_wanted(target_));
  client_.reset();
  EXPECT_FALSE(channels_.is_wanted(target_));
}

}  // namespace
}  // namespace ergocast::cli
