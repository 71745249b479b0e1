// SPDX-License-Identifier: BSD-3-Clause
// The server's side of WebSocket: the handshake's answer, frames in any pieces, and violations.
#include "cli/foxglove/websocket.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/cli/foxglove/client_frames.h"

namespace ergocast::cli {
namespace {

using test::client_frame;

TEST(WebSocketHead, IsReadWithItsLists) {
  const auto head = RequestHead::parse(
      "GET /?token=a HTTP/1.1\r\nHost: 127.0.0.1:8765\r\nConnection: keep-alive, uPgrade\r\n"
      "Sec-WebSocket-Protocol: x\r\nSec-WebSocket-Protocol:  y ,z\r\n\r\n");
  ASSERT_TRUE(head);
  EXPECT_EQ(head->target, "/?token=a");
  EXPECT_EQ(head->value("host"), "127.0.0.1:8765");
  EXPECT_EQ(head->value("sec-websocket-protocol"), "");  // it comes twice
  EXPECT_TRUE(head->lists("connection", "Upgrade"));
  EXPECT_FALSE(head->lists("connection", "grade"));
  for (const char* word : {"x", "y", "z"}) EXPECT_TRUE(head->lists("sec-websocket-protocol", word));
}

TEST(WebSocketHead, IsRefusedInOtherForms) {
  for (const char* text :
       {"", "\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/1.0\r\n\r\n", "GET  HTTP/1.1\r\n\r\n",
        "GET x HTTP/1.1\r\n\r\n", "GET / HTTP/1.1\r\nno colon\r\n\r\n",
        "GET / HTTP/1.1\r\n: x\r\n\r\n", "\xff\xfe"})
    EXPECT_FALSE(RequestHead::parse(text)) << text;
}

TEST(WebSocketHandshake, HasTheAnswerOfTheStandard) {
  EXPECT_EQ(websocket_accept("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
  for (const char* key : {"", "dGhlIHNhbXBsZSBub25jZQ=", "dGhlIHNhbXBsZSBub25jZQAA",
                          "dGhlIHNhbXBs\r\nZSBub25jZ==", "========================"})
    EXPECT_FALSE(websocket_accept(key)) << key;
}

TEST(WebSocketFrame, HasALengthOfAnySize) {
  EXPECT_EQ(frame(Opcode::kText, "abc"),
            "\x81\x03"
            "abc");
  EXPECT_EQ(frame_head(Opcode::kBinary, 125), "\x82\x7d");
  EXPECT_EQ(frame_head(Opcode::kBinary, 126), std::string("\x82\x7e\x00\x7e", 4));
  EXPECT_EQ(frame_head(Opcode::kBinary, 65535), "\x82\x7e\xff\xff");
  EXPECT_EQ(frame_head(Opcode::kBinary, 65536),
            std::string("\x82\x7f\x00\x00\x00\x00\x00\x01\x00\x00", 10));
  EXPECT_EQ(close_frame(1009), "\x88\x02\x03\xf1");
}

TEST(WebSocketReader, JoinsFramesThatComeInAnyPieces) {
  const std::string longest(FrameReader::kLongestMessage, 'x');
  const std::string bytes = client_frame(1, "abc") + client_frame(0x01, "in ", false) +
                            client_frame(9, "ping") + client_frame(0, "three ", false) +
                            client_frame(0, "frames") + client_frame(2, longest);
  for (const std::size_t piece :
       {std::size_t{1}, std::size_t{7}, std::size_t{4096}, bytes.size()}) {
    FrameReader reader;
    std::vector<std::string> read;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      reader.add(std::string_view(bytes).substr(at, piece));
      while (const auto message = reader.next()) read.push_back(message->payload);
    }
    EXPECT_EQ(read, (std::vector<std::string>{"abc", "ping", "in three frames", longest})) << piece;
    EXPECT_FALSE(reader.violation());
  }
}

TEST(WebSocketReader, EndsWithTheFirstViolation) {
  const struct {
    const char* what;
    std::string bytes;
    std::uint16_t code;
  } kCases[] = {
      {"a frame without a mask", std::string("\x81\x03", 2) + "abc", 1002},
      {"an unknown opcode", client_frame(3, "abc"), 1002},
      {"a reserved bit", std::string("\xc1\x80\0\0\0\0", 6), 1002},
      {"a ping in parts", client_frame(9, "abc", false), 1002},
      {"a long ping", client_frame(9, std::string(126, 'x')), 1002},
      {"a continuation of nothing", client_frame(0, "abc"), 1002},
      {"a message within another", client_frame(1, "abc", false) + client_frame(1, "abc"), 1002},
      {"a long frame", std::string("\x82\xff\0\0\0\0\0\1\0\1\0\0\0\0", 14), 1009},
      {"the longest frame", std::string("\x82\xff\xff\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14),
       1009},
      {"a message too long in parts",
       client_frame(1, std::string(40000, 'x'), false) + client_frame(0, std::string(40000, 'x')),
       1009},
  };
  for (const auto& [what, bytes, code] : kCases) {
    FrameReader reader;
    reader.add(bytes);
    EXPECT_FALSE(reader.next()) << what;
    EXPECT_EQ(reader.violation(), code) << what;
    reader.add(client_frame(1, "abc"));
    EXPECT_FALSE(reader.next()) << what;
  }
}

}  // namespace
}  // namespace ergocast::cli
