// SPDX-License-Identifier: BSD-3-Clause
// The page's connections on a clock that the test sets: the cost of a client, and the connection
// that a new one replaces.
#include "cli/watch/connections.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <deque>
#include <string>

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

sockaddr_in at(const char* address, std::uint16_t port = 0) {
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(port);
  inet_pton(AF_INET, address, &place.sin_addr);
  return place;
}

/// The kernel buffers less than this for a client that reads nothing.
constexpr int kBuffer = 64 << 10;
constexpr std::size_t kLong = 2 << 20;

/// A client, which records all received data.
class Client {
 public:
  Client(std::uint16_t port, const char* from) : socket_(AF_INET, SOCK_STREAM | SOCK_NONBLOCK) {
    const sockaddr_in own = at(from), server = at("127.0.0.1", port);
    setsockopt(socket_.fd(), SOL_SOCKET, SO_RCVBUF, &kBuffer, sizeof kBuffer);
    bind(socket_.fd(), reinterpret_cast<const sockaddr*>(&own), sizeof own);
    connect(socket_.fd(), reinterpret_cast<const sockaddr*>(&server), sizeof server);
    pollfd connected{socket_.fd(), POLLOUT, 0};
    poll(&connected, 1, -1);
  }
  /// Whether the connection is still open.
  bool send(const std::string& bytes) const {
    return ::send(socket_.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL) >= 0;
  }
  void look() {
    char bytes[65536];
    for (;;) {
      const ssize_t count = recv(socket_.fd(), bytes, sizeof bytes, 0);
      if (count > 0) {
        text_.append(bytes, static_cast<std::size_t>(count));
      } else {
        was_reset_ = was_reset_ || (count < 0 && errno == ECONNRESET);
        ended_ = ended_ || count == 0 || errno != EAGAIN;
        return;
      }
    }
  }
  bool got(const std::string& part) const { return text_.find(part) != text_.npos; }
  const std::string& text() const { return text_; }
  bool ended() const { return ended_; }
  bool was_reset() const { return was_reset_; }

 private:
  Socket socket_;
  std::string text_;
  bool ended_ = false, was_reset_ = false;
};

constexpr auto kPatience = std::chrono::seconds(60);
constexpr const char* kHalf = "GET / HTTP/1.1\r\nX";
constexpr const char* kPage = "GET / HTTP/1.1\r\n\r\n";
constexpr const char* kEvents = "GET /events HTTP/1.1\r\n\r\n";
constexpr const char* kTalk = "GET /talk HTTP/1.1\r\n\r\n";

/// Repeats what the client sends, and has more of its own. It ends after a dot.
class Echo final : public Connections::Dialogue {
 public:
  Echo(std::string more, int& open) : more_(std::move(more)), open_(open) { ++open_; }
  ~Echo() override { --open_; }
  void begin(const std::string& peer) override { out_ = peer.substr(0, peer.find(':')) + '\n'; }
  void receive(std::string_view bytes) override { out_ += bytes; }
  std::optional<std::string> next() override {
    if (std::exchange(over_, out_.ends_with('.'))) return std::nullopt;
    return std::exchange(out_, more_);
  }

 private:
  std::string more_, out_;
  int& open_;
  bool over_ = false;
};

class PageConnections : public ::testing::Test {
 protected:
  PageConnections() : listener_(AF_INET, SOCK_STREAM | SOCK_NONBLOCK) {
    sockaddr_in own = at("127.0.0.1");
    socklen_t length = sizeof own;
    setsockopt(listener_.fd(), SOL_SOCKET, SO_SNDBUF, &kBuffer, sizeof kBuffer);
    bind(listener_.fd(), reinterpret_cast<const sockaddr*>(&own), sizeof own);
    listen(listener_.fd(), 256);
    getsockname(listener_.fd(), reinterpret_cast<sockaddr*>(&own), &length);
    port_ = ntohs(own.sin_port);
    connections_.emplace(listener_.fd(), [this](const std::string& head) {
      Connections::Answer answer{.head = "HTTP/1.1 200 OK\r\n\r\n", .body = page_, .stream = {}};
      if (head.starts_with("GET /events")) {
        answer.body = nullptr;
        answer.stream = [this] { return stream_; };
      } else if (head.starts_with("GET /talk")) {
        answer.body = nullptr;
        answer.dialogue = std::make_unique<Echo>(more_, dialogues_);
      }
      return answer;
    });
  }

  Client& client(const std::string& request = "", const char* from = "127.0.0.1") {
    Client& one = clients_.emplace_back(port_, from);
    one.send(request);
    return one;
  }
  /// Serves until `condition` holds. The wait decides no result: the expected event needs only the
  /// server's time.
  template <class Condition>
  bool comes(Condition condition, std::chrono::milliseconds step = 0ms) {
    const auto patience = std::chrono::steady_clock::now() + kPatience;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > patience) return false;
      now_ += step;
      connections_->serve(now_);
      pollfd waiting{connections_->fd(), POLLIN, 0};
      poll(&waiting, 1, 1);
    }
    return true;
  }
  bool gets(Client& one, const std::string& part, std::chrono::milliseconds step = 0ms) {
    return comes([&] { return one.look(), one.got(part); }, step);
  }
  bool ends(Client& one, std::chrono::milliseconds step = 0ms) {
    return comes([&] { return one.look(), one.ended(); }, step);
  }
  std::ptrdiff_t ended() {
    for (Client& one : clients_) one.look();
    return std::count_if(clients_.begin(), clients_.end(),
                         [](const Client& one) { return one.ended(); });
  }

  Connections::Text page_ = std::make_shared<const std::string>("the page");
  std::optional<std::string> stream_ = "news\n";
  std::string more_;  // of each dialogue
  int dialogues_ = 0;
  Instant now_{1h};
  std::uint16_t port_ = 0;
  Socket listener_;
  std::deque<Client> clients_;
  std::optional<Connections> connections_;
};

TEST_F(PageConnections, ADialogueGoesBothWaysUntilItEnds) {
  Client& user = client(std::string(kTalk) + "at once ");  // also what follows the request
  ASSERT_TRUE(gets(user, "127.0.0.1\nat once "));
  user.send("later");
  ASSERT_TRUE(gets(user, "later"));
  user.send(" end.");
  ASSERT_TRUE(ends(user));
  EXPECT_TRUE(user.got(" end."));
  EXPECT_FALSE(user.was_reset());
  EXPECT_EQ(dialogues_, 0);
}

// The next bytes wait until it has taken the previous ones, and no time limit ends it.
TEST_F(PageConnections, ADialogueWithAClientThatTakesNothingDelaysNobody) {
  more_ = std::string(kLong, 'x');
  Client& stuck = client(kTalk);
  ASSERT_TRUE(gets(stuck, "\n"));
  more_.clear();
  for (int i = 0; i < 100; ++i) {
    now_ += 1min;
    connections_->serve(now_);
  }
  EXPECT_EQ(dialogues_, 1);
  Client& user = client(std::string(kTalk) + "hello");
  EXPECT_TRUE(gets(user, "hello"));
  // A stuck one is the first to leave its place.
  std::deque<Client*> others;
  for (int i = 1; i < Connections::kMostStreams; ++i) {
    others.push_back(&client(std::string(kTalk) + "hello"));
    ASSERT_TRUE(gets(*others.back(), "hello"));
  }
  EXPECT_TRUE(ends(stuck));
  EXPECT_FALSE(user.ended());
  EXPECT_EQ(dialogues_, Connections::kMostStreams);
}

TEST_F(PageConnections, ADialogueEndsWithItsClient) {
  client(kTalk);
  ASSERT_TRUE(gets(clients_.back(), "\n"));
  clients_.clear();
  EXPECT_TRUE(comes([&] { return dialogues_ == 0; }));
}

TEST_F(PageConnections, AWholeRequestIsAnsweredAndTheConnectionEnds) {
  Client& user = client();
  for (const char byte : std::string(kPage)) user.send({byte});
  EXPECT_TRUE(ends(user));
  EXPECT_EQ(user.text(), "HTTP/1.1 200 OK\r\n\r\nthe page");
}

TEST_F(PageConnections, WhatFollowsARequestDoesNotCostTheAnswer) {
  Client& user = client(kPage + std::string(100'000, 'x'));
  EXPECT_TRUE(ends(user));
  EXPECT_TRUE(user.got("the page"));
  EXPECT_FALSE(user.was_reset());  // then a slower client would lose it
}

TEST_F(PageConnections, ALongHeadIsRefused) {
  Client& longest = client("GET / HTTP/1.1\r\nX: ");
  longest.send(std::string(Connections::kLongestHead - 23, 'x') + "\r\n\r\n");
  EXPECT_TRUE(gets(longest, "the page"));
  Client& longer = client("GET / HTTP/1.1\r\nX: ");
  longer.send(std::string(Connections::kLongestHead - 22, 'x') + "\r\n\r\n");
  EXPECT_TRUE(gets(longer, "HTTP/1.1 431 "));
  EXPECT_TRUE(ends(longer));
  EXPECT_TRUE(comes([&] { return !longer.send("x"); }, 100ms));  // the server stops reading
}

TEST_F(PageConnections, AHeadThatTricklesInIsNotWaitedFor) {
  Client& slow = client(kHalf);
  EXPECT_TRUE(comes([&] { return slow.send("x"), slow.look(), slow.got("HTTP/1.1 408 "); }, 100ms));
  EXPECT_GT(now_ - Instant(1h), Connections::kHeadPatience);
  Client& silent = client();
  EXPECT_TRUE(ends(silent, 100ms));
  EXPECT_EQ(silent.text(), "");
}

TEST_F(PageConnections, HalfSentRequestsDoNotLockOutOthers) {
  Client& elsewhere = client(kHalf, "127.0.0.2");
  for (int i = 0; i < 191; ++i) client(kHalf);
  EXPECT_TRUE(comes([this] { return ended() == 192 - Connections::kMostHeads; }));
  EXPECT_TRUE(clients_[1].got("HTTP/1.1 503 "));
  EXPECT_FALSE(elsewhere.ended());
  EXPECT_FALSE(clients_.back().ended());
  EXPECT_TRUE(gets(client(kPage), "the page"));
  elsewhere.send("\r\n\r\n");
  EXPECT_TRUE(gets(elsewhere, "the page"));
}

TEST_F(PageConnections, AnswersThatAreNotTakenDoNotLockOutOthers) {
  page_ = std::make_shared<const std::string>(std::string(kLong, 'x') + "the page");
  for (int i = 0; i < 100; ++i) {
    client(kPage);
    connections_->serve(now_ += 1ms);
  }
  Client& user = client(kPage);
  EXPECT_TRUE(gets(user, "the page", 1ms));
}

TEST_F(PageConnections, AClientThatTakesNothingIsLetGo) {
  page_ = std::make_shared<const std::string>(kLong, 'x');
  stream_ = std::string(kLong, 'x');
  Client& page = client(kPage);
  Client& events = client(kEvents);
  const auto closed = [this](Client& one) {
    // It was not read before, because this client takes nothing.
    return comes([&] { return now_ > Instant(1h) + 20s; }, 100ms) && (one.look(), ends(one, 100ms));
  };
  EXPECT_TRUE(closed(page));
  EXPECT_LT(page.text().size(), page_->size());
  EXPECT_TRUE(closed(events));
}

TEST_F(PageConnections, ANewStreamGetsThePlaceOfTheOldestOfTheAddressWithMost) {
  Client& elsewhere = client(kEvents, "127.0.0.2");
  EXPECT_TRUE(gets(elsewhere, "news"));
  for (int i = 0; i < Connections::kMostStreams + 2; ++i) {
    now_ += 1ms;
    EXPECT_TRUE(gets(client(kEvents), "news"));
  }
  EXPECT_TRUE(comes([this] { return ended() == 3; }));
  for (std::size_t i = 0; i < clients_.size(); ++i) {
    EXPECT_EQ(clients_[i].ended(), i >= 1 && i <= 3) << i;
  }
  EXPECT_TRUE(gets(client(kPage), "the page"));  // streams take no other places
}

TEST_F(PageConnections, AStreamThatIsStuckGoesBeforeOlderOnes) {
  std::deque<Client*> taking;
  for (int i = 0; i < Connections::kMostStreams - 1; ++i) {
    taking.push_back(&client(kEvents));
    EXPECT_TRUE(gets(*taking.back(), "news"));
  }
  stream_ = std::string(kLong, 'x') + "end";
  Client& stuck = client(kEvents);
  const auto all_others_got = [&](const std::string& end) {
    return std::all_of(taking.begin(), taking.end(), [&](Client* one) {
      one->look();
      return one->text().ends_with(end);
    });
  };
  now_ += 200ms;  // less than the patience with one that takes nothing
  EXPECT_TRUE(comes([&] { return all_others_got("xend"); }));
  stream_ = "more news\n";
  now_ += 200ms;
  EXPECT_TRUE(comes([&] { return all_others_got("more news\n"); }));
  EXPECT_TRUE(gets(client(kEvents), "more news"));
  EXPECT_TRUE(ends(stuck));
  for (Client* one : taking) EXPECT_FALSE((one->look(), one->ended()));
}

TEST_F(PageConnections, AStreamWithoutNewDataShowsSignsOfLifeAndEndsInOrder) {
  Client& user = client(kEvents);
  EXPECT_TRUE(gets(user, "news"));
  stream_ = "";
  const Instant quiet = now_;
  EXPECT_TRUE(gets(user, ":\n\n", 100ms));
  EXPECT_GT(now_ - quiet, 1s);
  stream_ = {};
  EXPECT_TRUE(ends(user, 100ms));
}

}  // namespace
}  // namespace ergocast::cli
