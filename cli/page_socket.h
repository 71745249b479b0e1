// SPDX-License-Identifier: BSD-3-Clause
// Where a page is served: its socket, the address that a person opens, and the token.
#pragma once

#include <string>
#include <variant>

#include "runtime/socket.h"

namespace ergocast::cli {

struct PageOptions {
  std::string listen;  ///< an address of this host; empty: 127.0.0.1, without a token
  int port = 0;        ///< 0: kUsualPort, or any
};

class PageSocket {
 public:
  /// Taken if it is free and no other is asked for.
  static constexpr int kUsualPort = 8765;

  /// A new socket that listens, with a new token. An error tells why it cannot.
  static std::variant<PageSocket, std::string> open(const PageOptions& options);

  /// A socket that another process has opened for `listen`, with its token. An error if `fd` is
  /// none.
  static std::variant<PageSocket, std::string> inherited(int fd, const std::string& listen,
                                                         std::string token);

  int fd() const { return socket_.fd(); }  ///< non-blocking
  const std::string& address() const { return address_; }
  int port() const { return port_; }
  /// Empty: none is needed, because only this host reaches the page.
  const std::string& token() const { return token_; }
  /// What a person opens, with the token if there is one.
  std::string url() const;
  /// Whether a Host header means this server. Where only this host reaches the page, no name of the
  /// network does: another host may answer for that name, and lead a browser here.
  bool is_called(const std::string& host) const;

 private:
  PageSocket(Socket socket, const std::string& listen, std::string token);

  Socket socket_;
  std::string address_, token_;
  int port_;
};

}  // namespace ergocast::cli
