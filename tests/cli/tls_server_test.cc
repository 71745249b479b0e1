// SPDX-License-Identifier: BSD-3-Clause
// A page's connections over TLS, on a clock that the test sets: handshakes that do not end, clients
// that take nothing, and messages of TLS without content.
#include "cli/watch/tls_server.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/watch/connections.h"
#include "tests/support/temp_folder.h"
#include "tests/support/tls.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kClientPatience = std::chrono::seconds(60);
constexpr int kClientBuffer = 64 << 10;
constexpr std::size_t kLongPage = 2 << 20;
constexpr const char* kPageRequest = "GET / HTTP/1.1\r\n\r\n";
constexpr const char* kEventsRequest = "GET /events HTTP/1.1\r\n\r\n";

/// A client that never waits.
class TlsClient {
 public:
  TlsClient(SSL_CTX* context, const sockaddr_in& server)
      : socket_(AF_INET, SOCK_STREAM), session_(SSL_new(context)) {
    setsockopt(socket_.fd(), SOL_SOCKET, SO_RCVBUF, &kClientBuffer, sizeof kClientBuffer);
    connect(socket_.fd(), reinterpret_cast<const sockaddr*>(&server), sizeof server);
    const int flags = fcntl(socket_.fd(), F_GETFL);
    fcntl(socket_.fd(), F_SETFL, flags | O_NONBLOCK);
    SSL_set_fd(session_, socket_.fd());
    SSL_set_connect_state(session_);
  }
  ~TlsClient() { SSL_free(session_); }
  TlsClient(const TlsClient&) = delete;
  TlsClient& operator=(const TlsClient&) = delete;

  /// Goes on with the handshake, then with the request, then reads.
  void look(const std::string& request) {
    if (!SSL_is_init_finished(session_) && SSL_do_handshake(session_) != 1) return note_end();
    if (!asked_ && SSL_write(session_, request.data(), static_cast<int>(request.size())) > 0)
      asked_ = true;
    char bytes[16384];
    for (int count = 0; (count = SSL_read(session_, bytes, sizeof bytes)) > 0;)
      text_.append(bytes, static_cast<std::size_t>(count));
    note_end();
  }
  SSL* session() { return session_; }
  const std::string& text() const { return text_; }
  bool got(const std::string& part) const { return text_.find(part) != text_.npos; }
  bool ready() const { return SSL_is_init_finished(session_) == 1; }
  bool ended() const { return ended_; }
  bool in_order() const { return (SSL_get_shutdown(session_) & SSL_RECEIVED_SHUTDOWN) != 0; }

 private:
  void note_end() {
    pollfd one{socket_.fd(), POLLRDHUP, 0};
    ended_ = ended_ || in_order() || poll(&one, 1, 0) > 0;
  }

  Socket socket_;
  SSL* session_;
  std::string text_;
  bool asked_ = false, ended_ = false;
};

class EncryptedConnections : public ::testing::Test {
 protected:
  EncryptedConnections()
      : listener_(AF_INET, SOCK_STREAM | SOCK_NONBLOCK),
        context_(SSL_CTX_new(TLS_client_method())) {
    std::signal(SIGPIPE, SIG_IGN);  // of the clients
    const auto [certificate, key] = test::make_certificate(folder_.path(), "page");
    tls_ = TlsServer::read({certificate, key}).value();
    place_.sin_family = AF_INET;
    place_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof place_;
    setsockopt(listener_.fd(), SOL_SOCKET, SO_SNDBUF, &kClientBuffer, sizeof kClientBuffer);
    bind(listener_.fd(), reinterpret_cast<const sockaddr*>(&place_), sizeof place_);
    listen(listener_.fd(), 256);
    getsockname(listener_.fd(), reinterpret_cast<sockaddr*>(&place_), &length);
    connections_.emplace(
        listener_.fd(),
        [this](const std::string& head) {
          Connections::Answer answer{
              .head = "HTTP/1.1 200 OK\r\n\r\n", .body = page_, .stream = {}};
          if (head.starts_with("GET /events")) {
            answer.body = nullptr;
            answer.stream = [this] { return stream_; };
          }
          return answer;
        },
        [this](Socket socket) { return tls_->open(std::move(socket)); });
  }
  ~EncryptedConnections() override {
    clients_.clear();
    SSL_CTX_free(context_);
  }

  TlsClient& client() { return clients_.emplace_back(context_, place_); }
  template <class Condition>
  bool comes(Condition condition, std::chrono::milliseconds step = 0ms) {
    const auto patience = std::chrono::steady_clock::now() + kClientPatience;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > patience) return false;
      now_ += step;
      connections_->serve(now_);
      pollfd waiting{connections_->fd(), POLLIN, 0};
      poll(&waiting, 1, 1);
    }
    return true;
  }
  bool gets(TlsClient& one, const std::string& request, const std::string& part,
            std::chrono::milliseconds step = 0ms) {
    return comes([&] { return one.look(request), one.got(part); }, step);
  }
  /// A raw connection, on which no TLS runs.
  Socket& raw(const std::string& bytes) {
    Socket& one = raw_.emplace_back(AF_INET, SOCK_STREAM);
    connect(one.fd(), reinterpret_cast<const sockaddr*>(&place_), sizeof place_);
    ::send(one.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    return one;
  }
  static bool closed(const Socket& one) {
    pollfd end{one.fd(), POLLRDHUP, 0};
    return poll(&end, 1, 0) > 0;
  }

  test::TempFolder folder_;
  std::shared_ptr<const TlsServer> tls_;
  Connections::Text page_ = std::make_shared<const std::string>("the page");
  std::optional<std::string> stream_ = "news\n";
  Instant now_{1h};
  sockaddr_in place_{};
  Socket listener_;
  SSL_CTX* context_;
  std::deque<TlsClient> clients_;
  std::deque<Socket> raw_;
  std::optional<Connections> connections_;
};

TEST_F(EncryptedConnections, AnAnswerIsWholeAndEndsInOrder) {
  page_ = std::make_shared<const std::string>(std::string(kLongPage, 'x') + "the page");
  TlsClient& user = client();
  EXPECT_TRUE(comes([&] { return user.look(kPageRequest), user.ended(); }));
  EXPECT_TRUE(user.got("xthe page"));
  EXPECT_EQ(user.text().size(), std::string("HTTP/1.1 200 OK\r\n\r\n").size() + page_->size());
  EXPECT_TRUE(user.in_order());
  TlsClient& watching = client();
  EXPECT_TRUE(gets(watching, kEventsRequest, "news\n"));
  stream_ = {};
  EXPECT_TRUE(comes([&] { return watching.look(kEventsRequest), watching.ended(); }, 100ms));
  EXPECT_TRUE(watching.in_order());
}

TEST_F(EncryptedConnections, AHandshakeHasTheTimeOfAHead) {
  Socket& half = raw(std::string("\x16\x03\x01\x10\x00\x01\x00\x0f\xfc\x03\x03", 11));
  Socket& silent = raw("");
  EXPECT_TRUE(comes(
      [&] {
        ::send(half.fd(), "x", 1, MSG_NOSIGNAL);
        return closed(half) && closed(silent);
      },
      100ms));
  EXPECT_GT(now_ - Instant(1h), Connections::kHeadPatience);
  EXPECT_LT(now_ - Instant(1h), 2 * Connections::kHeadPatience);
}

TEST_F(EncryptedConnections, HalfOpenHandshakesDoNotLockOutOthers) {
  for (int i = 0; i < 191; ++i)
    raw(std::string("\x16\x03\x01\x10\x00\x01\x00\x0f\xfc\x03\x03", 11));
  EXPECT_TRUE(comes([this] {
    return std::count_if(raw_.begin(), raw_.end(), closed) == 191 - Connections::kMostHeads;
  }));
  EXPECT_TRUE(gets(client(), kPageRequest, "the page"));
}

TEST_F(EncryptedConnections, AClientThatTakesNothingIsLetGo) {
  page_ = std::make_shared<const std::string>(kLongPage, 'x');
  TlsClient& slow = client();
  EXPECT_TRUE(comes([&] { return slow.look(kPageRequest), slow.ready(); }));
  EXPECT_TRUE(comes([&] { return now_ > Instant(1h) + 20s; }, 100ms));
  EXPECT_TRUE(comes([&] { return slow.look(kPageRequest), slow.ended(); }));
  EXPECT_LT(slow.text().size(), page_->size());
  EXPECT_FALSE(slow.in_order());
}

/// A stream and its client after the handshake, without a network between them.
class EncryptedStream : public EncryptedConnections {
 protected:
  EncryptedStream() {
    int ends[2] = {-1, -1};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends), 0);
    server_stream_ = tls_->open(Socket(ends[0]));
    other_.emplace(ends[1]);
    SSL_CTX_set_min_proto_version(context_, TLS1_3_VERSION);
    client_.reset(SSL_new(context_));
    SSL_set_fd(client_.get(), other_->fd());
    SSL_set_connect_state(client_.get());
    std::array<char, 100> bytes;
    for (int i = 0; i < 20 && SSL_do_handshake(client_.get()) != 1; ++i)
      (void)server_stream_->read(bytes);
    EXPECT_EQ(SSL_is_init_finished(client_.get()), 1);
    EXPECT_EQ(server_stream_->read(bytes).value(), 0U);
  }

  std::unique_ptr<ByteStream> server_stream_;
  std::optional<Socket> other_;
  std::unique_ptr<SSL, void (*)(SSL*)> client_{nullptr, &SSL_free};
};

// OpenSSL handles messages that renew the keys for as long as they come, and none has content.
TEST_F(EncryptedStream, OneCallHandlesOnlyAPortionOfWhatAClientSends) {
  constexpr int kPortion = 4096;
  do {
    SSL_key_update(client_.get(), SSL_KEY_UPDATE_NOT_REQUESTED);
  } while (SSL_do_handshake(client_.get()) == 1);
  const auto unread = [this] {
    int count = 0;
    ioctl(server_stream_->fd(), FIONREAD, &count);
    return count;
  };
  const int before = unread();
  ASSERT_GT(before, kPortion + 1000);
  std::array<char, 100> bytes;
  EXPECT_EQ(server_stream_->read(bytes).value(), 0U);
  EXPECT_EQ(before - unread(), kPortion);
}

TEST_F(EncryptedStream, KeepsOneRecordForAClientThatTakesNothing) {
  const std::string text(kLongPage, 'x');
  std::size_t sent = 0;
  for (std::size_t count = 1; count > 0 && sent < text.size();) {
    count = server_stream_->write(std::string_view(text).substr(sent)).value();
    sent += count;
  }
  ASSERT_LT(sent, text.size());  // what the kernel holds is less
  EXPECT_TRUE(server_stream_->owes());
  std::string received;
  std::vector<char> bytes(100'000);
  while (received.size() < text.size()) {
    const int count = SSL_read(client_.get(), bytes.data(), static_cast<int>(bytes.size()));
    if (count > 0) received.append(bytes.data(), static_cast<std::size_t>(count));
    if (sent < text.size())
      sent += server_stream_->write(std::string_view(text).substr(sent)).value();
  }
  EXPECT_EQ(received, text);
}

TEST_F(EncryptedConnections, NothingElseThanTlsIsAnswered) {
  Socket& plain = raw(kPageRequest);
  EXPECT_TRUE(comes([&] { return closed(plain); }));
  char bytes[1000];
  const ssize_t count = recv(plain.fd(), bytes, sizeof bytes, 0);
  ASSERT_GT(count, 0);
  const std::string text(bytes, static_cast<std::size_t>(count));
  EXPECT_TRUE(text.starts_with("HTTP/1.1 400 ")) << text;
  EXPECT_EQ(text.find("the page"), text.npos);
  Socket& noise = raw(std::string(100'000, '\0'));
  EXPECT_TRUE(comes([&] { return closed(noise); }));
  EXPECT_TRUE(gets(client(), kPageRequest, "the page"));
}

}  // namespace
}  // namespace ergocast::cli
