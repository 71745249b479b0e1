// SPDX-License-Identifier: BSD-3-Clause
// The connections of browsers to a page: sockets in, whole request heads out, answers back.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/watch/byte_stream.h"
#include "core/base/ids.h"
#include "runtime/bus/socket.h"

namespace ergocast::cli {

/// Serves all connections in one thread without blocking. A connection uses bounded memory and
/// delays no other connection.
///
/// No client can lock out another. Incomplete requests, answers in progress and event streams have
/// separate places. If all places of one sort are taken, a new connection replaces an old one. The
/// old one is chosen at the address with the most places: its connection that has been stuck or
/// open for longest. (If new connections were refused instead, 16 idle streams would close the page
/// to everybody.)
///
/// A handshake of TLS is a part of the request's head: it has the same places and the same time.
class Connections {
 public:
  /// Limit (Page): unfinished requests to a page. Beyond it: the next gets the place of the oldest,
  /// which gets 503.
  static constexpr int kMostHeads = 32;
  /// Limit (Page): answers of a page that are being sent. Beyond it: the next gets the place of the
  /// one that has taken nothing for longest.
  static constexpr int kMostAnswers = 32;
  /// Limit (Page): browsers that watch one page. Beyond it: the next gets the place of one that is
  /// stuck, or has watched longest.
  static constexpr int kMostStreams = 16;
  /// The longest request line with all its headers. A longer one gets 431.
  /// Limit (Page): length of the head of a request [bytes]. Beyond it: the answer is 431.
  static constexpr std::size_t kLongestHead = 16 << 10;
  /// Limit (Page): time in which the head of a request must arrive [s]. Beyond it: the answer is
  /// 408.
  static constexpr auto kHeadPatience = std::chrono::seconds(5);
  /// For a client that takes nothing of what waits for it.
  /// Limit (Page): time for which a browser may take nothing [s]. Beyond it: the connection ends,
  /// and the browser connects again.
  static constexpr auto kTakePatience = std::chrono::seconds(5);

  using Text = std::shared_ptr<const std::string>;
  /// Returns the next text of an event stream: empty if there is nothing new, nullopt at its end.
  using Stream = std::function<std::optional<std::string>()>;
  /// Both directions of a connection after the answer's head, such as a WebSocket. It has a place
  /// of a stream. A client that takes nothing keeps its place until a new one needs it.
  class Dialogue {
   public:
    virtual ~Dialogue() = default;
    /// Called once, and first. @param peer  the client's address and port, for people
    virtual void begin(const std::string& peer) = 0;
    /// What the client has sent since the last call; often nothing.
    virtual void receive(std::string_view bytes) = 0;
    /// The next bytes for a client that has taken the previous ones: empty if there is nothing new,
    /// nullopt at the end.
    virtual std::optional<std::string> next() = 0;
  };
  struct Answer {
    std::string head;                      ///< up to the empty line, or with a short body
    Text body;                             ///< the rest, one copy for all clients; may be null
    Stream stream;                         ///< texts that follow `body`; null: there are none
    std::unique_ptr<Dialogue> dialogue{};  ///< follows `head` in the place of a stream; may be null
  };
  /// Answers the head of a request, which ends with the empty line.
  using Handler = std::function<Answer(const std::string& head)>;
  /// Makes the stream of a new connection, whose socket is non-blocking.
  using Opener = std::function<std::unique_ptr<ByteStream>(Socket)>;

  /// @param listener  a non-blocking listening socket, which the caller owns
  Connections(int listener, Handler handler, Opener opener = plain_stream);
  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  /// Readable as soon as serve() has something to do. For streams and deadlines, also call serve()
  /// ten times a second.
  int fd() const { return epoll_.fd(); }
  void serve(Instant now);
  /// The addresses and ports of all clients with an event stream or a dialogue.
  std::vector<std::string> peers() const;

 private:
  enum class Phase { kHead, kAnswer, kStream, kLeaving };
  /// A client's address. Only the network half of an IPv6 address counts, because one host may have
  /// all addresses of a network.
  using Address = std::array<unsigned char, 16>;

  struct Connection {
    Connection(std::unique_ptr<ByteStream> owned, const Address& from)
        : bytes(std::move(owned)), address(from) {}
    int fd() const { return bytes->fd(); }
    /// The bytes that wait to be sent.
    std::string_view unsent() const;

    std::unique_ptr<ByteStream> bytes;
    Address address;
    std::string peer;  ///< its address and port, of a stream or a dialogue
    Phase phase = Phase::kHead;
    Instant since{};   ///< in this phase
    Instant moved{};   ///< when bytes were last sent, or the phase began
    std::string head;  ///< as far as it was received
    std::string out;   ///< the answer's head, or a stream's text
    Text body;         ///< follows `out`
    std::size_t sent = 0;
    Stream stream;
    std::unique_ptr<Dialogue> dialogue;
    Instant next_text{}, next_sign{};
    bool deaf = false;  ///< the client has closed its side
    std::uint32_t watched = 0;
  };

  void accept_some(Instant now);
  void react(Connection& one, std::uint32_t events, Instant now);
  void read_head(Connection& one, Instant now);
  void discard(Connection& one);
  void converse(Connection& one, Instant now);
  void answer(Connection& one, Answer answer, Instant now);
  void push(Connection& one, Instant now);
  void tend(Connection& one, Instant now);
  void take_text(Connection& one, Instant now);
  void end_stream(Connection& one, Instant now);
  void enter(Connection& one, Phase phase, Instant now);
  void make_room(Phase phase);
  void let_go(Connection& one);
  void drop(Connection& one);
  void watch(Connection& one);
  Connection* find(int fd);

  int listener_;
  Handler handler_;
  Opener opener_;
  Socket epoll_;
  std::map<int, Connection> open_;  // by descriptor
};

}  // namespace ergocast::cli
