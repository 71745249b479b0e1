// SPDX-License-Identifier: BSD-3-Clause
// The bytes of one connection: as they are, or over TLS (cli/watch/tls_server.h).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "core/base/result.h"
#include "runtime/bus/socket.h"

namespace ergocast::cli {

/// No call waits. Each takes bounded time and memory, whatever the client sends.
class ByteStream {
 public:
  enum class Over {
    kClosed,  ///< the client sends nothing more; it may still read
    kBroken,  ///< the connection cannot be used any more
  };

  virtual ~ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  int fd() const { return socket_.fd(); }
  /// The number of bytes read; 0: there are none now.
  virtual Result<std::size_t, Over> read(std::span<char> to) = 0;
  /// The number of bytes that the kernel has taken; 0: none now. Then the next call must begin with
  /// the same bytes.
  virtual Result<std::size_t, Over> write(std::string_view from) = 0;
  /// Says that nothing more will be written. Does not wait for the client's answer.
  virtual void finish() = 0;
  /// Whether the stream has bytes of its own to send. Until they are sent, it reads nothing: call
  /// read() as soon as the socket takes bytes.
  virtual bool owes() const = 0;

 protected:
  explicit ByteStream(Socket socket) : socket_(std::move(socket)) {}

 private:
  Socket socket_;
};

/// Bytes as they are.
/// @param socket  non-blocking
std::unique_ptr<ByteStream> plain_stream(Socket socket);

/// recv() and send() on a non-blocking socket, without SIGPIPE. 0: none now.
Result<std::size_t, ByteStream::Over> receive_some(int fd, std::span<char> to);
Result<std::size_t, ByteStream::Over> send_some(int fd, std::string_view from);

}  // namespace ergocast::cli
