// SPDX-License-Identifier: BSD-3-Clause
// The server's side of WebSocket (RFC 6455): the handshake's parts, and frames. No socket, no
// clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace ergocast::cli {

/// The head of an HTTP request.
struct RequestHead {
  std::string method, target;
  std::multimap<std::string, std::string> headers;  ///< the names in lower case

  /// Nothing if the text is no head of HTTP/1.1.
  static std::optional<RequestHead> parse(std::string_view text);
  /// The value of a header that comes once; empty: it does not, or comes several times.
  std::string value(const std::string& name) const;
  /// Whether a header that is a list, such as "keep-alive, Upgrade", has a word, in any case.
  bool lists(const std::string& name, std::string_view word) const;
};

/// Sec-WebSocket-Accept for a Sec-WebSocket-Key; nothing if the key is not 16 bytes in base64.
std::optional<std::string> websocket_accept(const std::string& key);

enum class Opcode : std::uint8_t {
  kContinuation = 0,
  kText = 1,
  kBinary = 2,
  kClose = 8,
  kPing = 9,
  kPong = 10,
};

/// The beginning of a whole frame of the server, which `size` bytes follow.
std::string frame_head(Opcode opcode, std::size_t size);
/// A whole frame of the server.
std::string frame(Opcode opcode, std::string_view payload);
/// A frame that ends the connection for a reason, such as 1009.
std::string close_frame(std::uint16_t code);

/// Puts the frames of a client together. It keeps at most two of the longest messages.
class FrameReader {
 public:
  /// Limit (Page): length of a message from a Foxglove client [bytes]. Beyond it: the connection
  /// ends with code 1009.
  static constexpr std::size_t kLongestMessage = 64 << 10;

  struct Message {
    Opcode opcode;  ///< never kContinuation
    std::string payload;
  };

  void add(std::string_view bytes);
  /// The next whole message. Nothing if there is none yet, or after a violation.
  std::optional<Message> next();
  /// The close code for what the client has done wrong: 1002 or 1009; nothing: nothing.
  std::optional<std::uint16_t> violation() const { return violation_; }

 private:
  struct Frame {
    Opcode opcode;
    bool is_last;
    std::string payload;
  };
  std::optional<Frame> take_frame();
  std::optional<Message> join(Frame frame);
  std::nullopt_t violate(std::uint16_t code);

  std::string bytes_;
  std::size_t used_ = 0;               // of bytes_
  std::optional<Message> unfinished_;  // of several frames
  std::optional<std::uint16_t> violation_;
};

}  // namespace ergocast::cli
