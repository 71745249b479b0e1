// SPDX-License-Identifier: BSD-3-Clause
// An epoll of non-blocking sockets; each connection is in one phase, which has its own deadline.
#include "cli/watch/connections.h"

#include <netdb.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kTextPeriod = 100ms;  // of a stream
constexpr auto kSignPeriod = 2s;     // between keep-alive texts of an idle stream
/// How long to read what a client still sends after its answer. Closing a socket with unread data
/// resets the connection, and the client may lose the answer.
constexpr auto kGoodbye = 1s;
constexpr int kAccepted = 64;    // at most in one call of serve()
constexpr int kReactions = 128;  // the same; above the number of places

Connections::Answer refusal(const char* status, const char* why) {
  const std::string text = std::string(why) + '\n';
  return {.head = std::string("HTTP/1.1 ") + status +
                  "\r\nContent-Type: text/plain; charset=utf-8\r\nConnection: close\r\n"
                  "Content-Length: " +
                  std::to_string(text.size()) + "\r\n\r\n" + text,
          .body = {},
          .stream = {}};
}

std::array<unsigned char, 16> address_in(const sockaddr_storage& from) {
  std::array<unsigned char, 16> address{};
  if (from.ss_family == AF_INET6) {
    const auto& six = reinterpret_cast<const sockaddr_in6&>(from).sin6_addr;
    // On a dual-stack socket, the addresses of IPv4 clients differ in the second half.
    const std::size_t size = IN6_IS_ADDR_V4MAPPED(&six) ? 16 : 8;
    std::memcpy(address.data(), &six, size);
  } else {
    std::memcpy(address.data(), &reinterpret_cast<const sockaddr_in&>(from).sin_addr, 4);
  }
  return address;
}

/// "127.0.0.1:50412" or "[::1]:50412".
std::string peer_of(int fd) {
  sockaddr_storage from{};
  socklen_t length = sizeof from;
  char host[NI_MAXHOST], port[NI_MAXSERV];
  const bool known = getpeername(fd, reinterpret_cast<sockaddr*>(&from), &length) == 0 &&
                     getnameinfo(reinterpret_cast<sockaddr*>(&from), length, host, sizeof host,
                                 port, sizeof port, NI_NUMERICHOST | NI_NUMERICSERV) == 0;
  if (!known) return "unknown";
  const std::string address = host;
  return (address.find(':') == address.npos ? address : '[' + address + ']') + ':' + port;
}

}  // namespace

std::string_view Connections::Connection::unsent() const {
  if (sent < out.size()) return std::string_view(out).substr(sent);
  return body ? std::string_view(*body).substr(sent - out.size()) : std::string_view();
}

Connections::Connections(int listener, Handler handler, Opener opener)
    : listener_(listener),
      handler_(std::move(handler)),
      opener_(std::move(opener)),
      epoll_(epoll_create1(EPOLL_CLOEXEC)) {
  epoll_event wanted{};
  wanted.events = EPOLLIN;
  wanted.data.fd = listener_;
  if (epoll_ctl(epoll_.fd(), EPOLL_CTL_ADD, listener_, &wanted) != 0) {
    throw std::runtime_error(std::string("no page: ") + std::strerror(errno));
  }
}

void Connections::serve(Instant now) {
  std::array<epoll_event, kReactions> events{};
  const int count = epoll_wait(epoll_.fd(), events.data(), kReactions, 0);
  // Existing connections come before new ones: a complete request frees its place.
  for (int i = 0; i < count; ++i) {
    const auto& event = events[static_cast<std::size_t>(i)];
    if (Connection* one = find(event.data.fd)) react(*one, event.events, now);
  }
  accept_some(now);
  std::vector<int> all;
  for (const auto& [fd, one] : open_) all.push_back(fd);
  for (const int fd : all) {
    if (Connection* one = find(fd)) tend(*one, now);
  }
}

std::vector<std::string> Connections::peers() const {
  std::vector<std::string> peers;
  for (const auto& [fd, one] : open_)
    if (one.phase == Phase::kStream) peers.push_back(one.peer);
  return peers;
}

void Connections::accept_some(Instant now) {
  for (int i = 0; i < kAccepted; ++i) {
    sockaddr_storage from{};
    socklen_t length = sizeof from;
    const int fd = accept4(listener_, reinterpret_cast<sockaddr*>(&from), &length,
                           SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (fd < 0) return;
    const int yes = 1;
    setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    make_room(Phase::kHead);
    Connection& one = open_.try_emplace(fd, opener_(Socket(fd)), address_in(from)).first->second;
    one.since = one.moved = now;
    epoll_event none{};
    none.data.fd = fd;
    if (epoll_ctl(epoll_.fd(), EPOLL_CTL_ADD, fd, &none) != 0) return drop(one);
    watch(one);
    read_head(one, now);
  }
}

void Connections::react(Connection& one, std::uint32_t events, Instant now) {
  const int fd = one.fd();
  if ((events & EPOLLERR) != 0 || (one.deaf && (events & EPOLLHUP) != 0)) return drop(one);
  if ((events & (EPOLLIN | EPOLLHUP)) != 0 || one.bytes->owes()) {
    if (one.phase == Phase::kHead) {
      read_head(one, now);
    } else {
      one.dialogue ? converse(one, now) : discard(one);
    }
  }
  Connection* still = find(fd);
  if (still != nullptr && (events & EPOLLOUT) != 0) push(*still, now);
}

void Connections::read_head(Connection& one, Instant now) {
  std::array<char, 4096> bytes;
  for (;;) {
    const auto count = one.bytes->read(bytes);
    if (!count) return drop(one);
    if (*count == 0) return watch(one);
    const std::size_t known = one.head.size();
    one.head.append(bytes.data(), *count);
    const std::size_t end = one.head.find("\r\n\r\n", known < 3 ? 0 : known - 3);
    if (end != one.head.npos && end + 4 <= kLongestHead) {
      const std::string rest = one.head.substr(end + 4);
      one.head.resize(end + 4);
      const int fd = one.fd();
      answer(one, handler_(one.head), now);
      Connection* still = rest.empty() ? nullptr : find(fd);
      if (still != nullptr && still->dialogue) still->dialogue->receive(rest);
      return;
    }
    if (one.head.size() >= kLongestHead) {
      return answer(one, refusal("431 Request Header Fields Too Large", "too long"), now);
    }
  }
}

/// Reads and discards everything after the request.
void Connections::discard(Connection& one) {
  std::array<char, 16384> bytes;
  const auto count = one.bytes->read(bytes);
  if (count) return watch(one);
  if (count.error() == ByteStream::Over::kBroken || one.phase != Phase::kAnswer) return drop(one);
  one.deaf = true;  // it may still take its answer
  watch(one);
}

/// One portion in a call, so that no client delays another.
void Connections::converse(Connection& one, Instant now) {
  std::array<char, 16384> bytes;
  const auto count = one.bytes->read(bytes);
  if (!count) return drop(one);
  one.dialogue->receive({bytes.data(), *count});
  if (one.unsent().empty()) return take_text(one, now);
  watch(one);
}

void Connections::answer(Connection& one, Answer answer, Instant now) {
  enter(one, answer.stream || answer.dialogue ? Phase::kStream : Phase::kAnswer, now);
  one.head.clear();
  one.out = std::move(answer.head);
  one.body = std::move(answer.body);
  one.stream = std::move(answer.stream);
  one.dialogue = std::move(answer.dialogue);
  if (one.phase == Phase::kStream) one.peer = peer_of(one.fd());
  if (one.dialogue) one.dialogue->begin(one.peer);
  one.next_text = now;
  one.next_sign = now + kSignPeriod;
  push(one, now);
}

/// Sends as much as the socket takes.
void Connections::push(Connection& one, Instant now) {
  while (!one.unsent().empty()) {
    const auto count = one.bytes->write(one.unsent());
    if (!count) return drop(one);
    if (*count == 0) return watch(one);
    one.sent += *count;
    one.moved = now;
  }
  one.out.clear();
  one.body.reset();
  one.sent = 0;
  if (one.phase == Phase::kAnswer) {
    one.bytes->finish();
    if (one.deaf) return drop(one);
    enter(one, Phase::kLeaving, now);
  }
  watch(one);
}

/// Handles deadlines and due stream texts.
void Connections::tend(Connection& one, Instant now) {
  const bool stuck = !one.unsent().empty() && now - one.moved > kTakePatience;
  switch (one.phase) {
    case Phase::kHead:
      if (now - one.since <= kHeadPatience) return;
      // Browsers open some connections in advance and send nothing on them.
      if (one.head.empty()) return drop(one);
      return answer(one, refusal("408 Request Timeout", "the request did not come in time"), now);
    case Phase::kAnswer:
      if (stuck) drop(one);
      return;
    case Phase::kStream:
      if (one.dialogue) return converse(one, now);
      if (stuck) return drop(one);
      if (one.unsent().empty() && now >= one.next_text) take_text(one, now);
      return;
    case Phase::kLeaving:
      if (now - one.since > kGoodbye) drop(one);
  }
}

/// Asks the stream only when the client has taken the previous text. A slow client gets a longer
/// text less often.
void Connections::take_text(Connection& one, Instant now) {
  auto text = one.dialogue ? one.dialogue->next() : one.stream();
  one.next_text = now + kTextPeriod;
  if (!text) return end_stream(one, now);
  if (text->empty() && now >= one.next_sign && one.stream) *text = ":\n\n";
  if (text->empty()) return watch(one);
  one.next_sign = now + kSignPeriod;
  one.moved = now;
  one.out = std::move(*text);
  push(one, now);
}

void Connections::end_stream(Connection& one, Instant now) {
  one.stream = nullptr;
  one.dialogue.reset();
  one.bytes->finish();
  enter(one, Phase::kLeaving, now);
  watch(one);
}

void Connections::enter(Connection& one, Phase phase, Instant now) {
  make_room(phase);
  one.phase = phase;
  one.since = one.moved = now;
}

/// Closes a connection if all places of that phase are taken.
void Connections::make_room(Phase phase) {
  const int most = phase == Phase::kHead     ? kMostHeads
                   : phase == Phase::kStream ? kMostStreams
                                             : kMostAnswers;
  std::map<Address, int> held;
  std::vector<Connection*> all;
  for (auto& [fd, one] : open_) {
    if (one.phase != phase) continue;
    ++held[one.address];
    all.push_back(&one);
  }
  if (std::ssize(all) < most) return;
  const auto worth = [&held, phase](const Connection* one) {
    const bool stuck = !one->unsent().empty();
    return std::tuple(-held[one->address], !stuck,
                      phase == Phase::kStream ? one->since : one->moved);
  };
  let_go(**std::min_element(all.begin(), all.end(), [&](const Connection* a, const Connection* b) {
    return worth(a) < worth(b);
  }));
}

void Connections::let_go(Connection& one) {
  if (one.phase == Phase::kHead && !one.head.empty()) {
    const Answer busy = refusal("503 Service Unavailable", "too many requests at once");
    (void)one.bytes->write(busy.head);
  }
  drop(one);
}

void Connections::drop(Connection& one) { open_.erase(one.fd()); }

void Connections::watch(Connection& one) {
  const std::uint32_t events = one.bytes->owes()
                                   ? std::uint32_t{EPOLLOUT}
                                   : (one.deaf ? 0U : std::uint32_t{EPOLLIN}) |
                                         (one.unsent().empty() ? 0U : std::uint32_t{EPOLLOUT});
  if (events == one.watched) return;
  epoll_event wanted{};
  wanted.events = one.watched = events;
  wanted.data.fd = one.fd();
  epoll_ctl(epoll_.fd(), EPOLL_CTL_MOD, one.fd(), &wanted);
}

Connections::Connection* Connections::find(int fd) {
  const auto found = open_.find(fd);
  return found == open_.end() ? nullptr : &found->second;
}

}  // namespace ergocast::cli
