// SPDX-License-Identifier: BSD-3-Clause
// The socket of a page, the address that a person opens, and the token.
#pragma once

#include <memory>
#include <string>

#include "cli/watch/byte_stream.h"
#include "cli/watch/tls_server.h"
#include "core/base/result.h"
#include "runtime/bus/socket.h"

namespace ergocast::cli {

struct PageOptions {
  std::string listen;  ///< an address of this host; empty: 127.0.0.1, without a token
  int port = 0;        ///< 0: kUsualPort, or any
  TlsFiles tls_files = {};
  std::shared_ptr<const TlsServer> tls = {};  ///< of these files; null: not encrypted
  const char* port_option = "--port";         ///< what a person changes if the port is taken
};

/// 128 random bits in hexadecimal digits. Throws std::runtime_error if the system has none.
std::string random_token();
/// Takes equal time for every text of one length, right or wrong.
bool same_secret(const std::string& a, const std::string& b);

class PageSocket {
 public:
  /// The default port, if it is free.
  static constexpr int kUsualPort = 8765;

  /// A new listening socket with a new token; an error if it cannot listen.
  static Result<PageSocket> open(const PageOptions& options);

  /// A socket that another process has opened for `options.listen`, with its token. An error if
  /// `fd` is no such socket.
  static Result<PageSocket> inherited(int fd, const PageOptions& options, std::string token);

  int fd() const { return socket_.fd(); }  ///< non-blocking
  const std::string& address() const { return address_; }
  int port() const { return port_; }
  /// The token; empty if only this host reaches the page, which then needs none.
  const std::string& token() const { return token_; }
  /// The address that a person opens, with the token if there is one.
  std::string url() const;
  /// What a browser sends as the origin of this page's requests, if it calls the server `host`.
  std::string origin(const std::string& host) const;
  bool encrypted() const { return tls_ != nullptr; }
  /// The stream of a connection that the socket has accepted.
  std::unique_ptr<ByteStream> stream(Socket accepted) const;
  /// Whether a Host header names this server. If only this host reaches the page, no network name
  /// is accepted: another host could resolve that name to this address.
  bool is_called(const std::string& host) const;

 private:
  PageSocket(Socket socket, const PageOptions& options, std::string token);

  Socket socket_;
  std::string address_, token_;
  int port_;
  std::shared_ptr<const TlsServer> tls_;  // null: not encrypted
};

}  // namespace ergocast::cli
