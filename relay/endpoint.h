// SPDX-License-Identifier: BSD-3-Clause
// A UDP socket for packets of relays, and the addresses of names.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/base/result.h"
#include "relay/address.h"
#include "runtime/bus/socket.h"

namespace ergocast::relay {

/// "HOST:PORT" or "[IPv6]:PORT", as people write it.
struct HostAndPort {
  std::string host;  ///< a name or an address; empty: every address of this host
  std::uint16_t port = 0;

  /// Or what is wrong with the text.
  static Result<HostAndPort> parse(std::string_view text);
  /// The same for a place to send to, which has a host.
  static Result<HostAndPort> parse_hub(std::string_view text);
};
std::string to_text(const HostAndPort& place);

/// Its addresses, or why there are none. Waits for the answer of a name server.
Result<std::vector<Address>> look_up(const HostAndPort& name);

/// One socket for IPv6 and IPv4, or for IPv4 alone where the kernel has no IPv6.
class Endpoint {
 public:
  /// @param at  where to receive; without it, at any free port. If it is every address of this
  ///            host, receive() tells which one a packet came to.
  static Result<Endpoint> open(const std::optional<Address>& at);

  int fd() const { return socket_.fd(); }
  /// The next waiting packet in `space`; nothing if none waits. Its bytes are valid until the next
  /// call.
  struct Received {
    std::span<const std::byte> bytes;
    Address from;
  };
  std::optional<Received> receive(std::vector<std::byte>& space);
  /// Never waits: what the kernel does not take is lost, like any packet on the way.
  void send(const Packet& packet);
  /// Packets that the kernel did not take.
  std::int64_t not_sent() const { return not_sent_; }

 private:
  Endpoint(Socket socket, bool ipv6) : socket_(std::move(socket)), ipv6_(ipv6) {}

  Socket socket_;
  bool ipv6_;
  std::int64_t not_sent_ = 0;
};

/// Looks up names on a thread of its own, because a name server may take many seconds.
class Resolver {
 public:
  Resolver();
  Resolver(const Resolver&) = delete;
  Resolver& operator=(const Resolver&) = delete;
  /// Does not wait for a look-up that is under way.
  ~Resolver();

  /// @pre the answer to the last question was taken
  void ask(const HostAndPort& name);
  /// Readable when there is an answer.
  int fd() const { return shared_->wake.fd(); }
  /// Nothing if there is no answer yet.
  std::optional<Result<std::vector<Address>>> take();

 private:
  struct Shared {
    std::mutex mutex;
    std::condition_variable asked;
    std::optional<HostAndPort> question;
    std::optional<Result<std::vector<Address>>> answer;
    bool ends = false;
    Socket wake;  // an eventfd
    explicit Shared(int fd) : wake(fd) {}
  };
  static void work(const std::shared_ptr<Shared>& shared);

  std::shared_ptr<Shared> shared_;
};

}  // namespace ergocast::relay
