// SPDX-License-Identifier: BSD-3-Clause
// Calls of the kernel on a non-blocking socket.
#include "cli/watch/byte_stream.h"

#include <sys/socket.h>
#include <sys/types.h>

#include <cerrno>
#include <utility>

namespace ergocast::cli {
namespace {

using Over = ByteStream::Over;

/// Whether the last call failed because it would have blocked.
bool nothing_yet() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

class PlainStream final : public ByteStream {
 public:
  explicit PlainStream(Socket socket) : ByteStream(std::move(socket)) {}

  Result<std::size_t, Over> read(std::span<char> to) override { return receive_some(fd(), to); }
  Result<std::size_t, Over> write(std::string_view from) override { return send_some(fd(), from); }
  void finish() override { shutdown(fd(), SHUT_WR); }
  bool owes() const override { return false; }
};

}  // namespace

std::unique_ptr<ByteStream> plain_stream(Socket socket) {
  return std::make_unique<PlainStream>(std::move(socket));
}

Result<std::size_t, Over> receive_some(int fd, std::span<char> to) {
  const ssize_t count = recv(fd, to.data(), to.size(), 0);
  if (count == 0) return failure(Over::kClosed);
  if (count < 0 && !nothing_yet()) return failure(Over::kBroken);
  return count < 0 ? 0 : static_cast<std::size_t>(count);
}

Result<std::size_t, Over> send_some(int fd, std::string_view from) {
  const ssize_t count = send(fd, from.data(), from.size(), MSG_NOSIGNAL);
  if (count < 0 && !nothing_yet()) return failure(Over::kBroken);
  return count < 0 ? 0 : static_cast<std::size_t>(count);
}

}  // namespace ergocast::cli
