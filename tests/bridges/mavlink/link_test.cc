// SPDX-License-Identifier: BSD-3-Clause
// What links do that the programs' tests cannot see.
#include "bridges/mavlink/link.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/tcp.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>

namespace ergocast::mavlink {
namespace {

/// A socket at a port of this host that was free.
class Here {
 public:
  explicit Here(int kind, int receive_buffer_bytes = 0) : fd_(socket(AF_INET, kind, 0)) {
    if (receive_buffer_bytes > 0)
      setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer_bytes, sizeof receive_buffer_bytes);
    sockaddr_in at{AF_INET, 0, {htonl(INADDR_LOOPBACK)}, {}};
    EXPECT_EQ(bind(fd_, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
    socklen_t size = sizeof at;
    EXPECT_EQ(getsockname(fd_, reinterpret_cast<sockaddr*>(&at), &size), 0);
    port = ntohs(at.sin_port);
  }
  Here(const Here&) = delete;
  Here& operator=(const Here&) = delete;
  ~Here() { close(fd_); }
  int fd() const { return fd_; }
  void send(int to_port, char what) const {
    const sockaddr_in to{
        AF_INET, htons(static_cast<in_port_t>(to_port)), {htonl(INADDR_LOOPBACK)}, {}};
    sendto(fd_, &what, 1, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }
  int port = 0;

 private:
  int fd_;
};

std::unique_ptr<Link> link_at(const std::string& text) {
  auto link = Link::open(text);
  EXPECT_TRUE(link) << (link ? "" : link.error());
  (*link)->mend(Instant(std::chrono::seconds(100)));
  return *std::move(link);
}

int option_of(const Link& link, int option) {
  int value = 0;
  socklen_t size = sizeof value;
  EXPECT_EQ(getsockopt(link.fd(), IPPROTO_TCP, option, &value, &size), 0);
  return value;
}

TEST(MavlinkLink, SkipsOnlySoManyDatagramsOfOthersInATurn) {
  const Here peer(SOCK_DGRAM), stranger(SOCK_DGRAM);
  int port = 0;
  {
    const Here free(SOCK_DGRAM);
    port = free.port;
  }
  const auto link = link_at("udpin:127.0.0.1:" + std::to_string(port));
  const Instant now(std::chrono::seconds(100));
  peer.send(port, 'a');
  EXPECT_EQ(link->read(now).size(), 1U);
  for (int i = 0; i < 100; ++i) stranger.send(port, 's');
  peer.send(port, 'b');
  EXPECT_TRUE(link->read(now).empty());
  int left_bytes = 0;
  ioctl(link->fd(), FIONREAD, &left_bytes);
  EXPECT_GT(left_bytes, 0) << "a flood would stop the setpoints";
  EXPECT_EQ(link->read(now), std::vector{std::byte{'b'}});
}

TEST(MavlinkLink, OfTcpDelaysNothingAndEndsIfNothingIsAcknowledged) {
  const Here listener(SOCK_STREAM);
  ASSERT_EQ(listen(listener.fd(), 1), 0);
  const auto link = link_at("tcp:127.0.0.1:" + std::to_string(listener.port));
  EXPECT_NE(option_of(*link, TCP_NODELAY), 0);
  EXPECT_EQ(option_of(*link, TCP_USER_TIMEOUT), 3000);
}

TEST(MavlinkLink, QueuesNoFramesForAnAutopilotThatReadsNothing) {
  const Here listener(SOCK_STREAM, 4096);
  ASSERT_EQ(listen(listener.fd(), 1), 0);
  auto link = link_at("tcp:127.0.0.1:" + std::to_string(listener.port));
  const int autopilot = accept(listener.fd(), nullptr, nullptr);
  const std::array<std::byte, 50> frame{};
  for (int i = 0; i < 20'000; ++i) link->write(frame);
  link.reset();
  std::array<char, 4096> in;
  std::size_t received_bytes = 0;
  for (ssize_t size = 0; (size = read(autopilot, in.data(), in.size())) > 0;)
    received_bytes += static_cast<std::size_t>(size);
  close(autopilot);
  EXPECT_GT(received_bytes, 0U);
  EXPECT_LT(received_bytes, 50'000U) << "old setpoints, which nobody wants any more";
}

TEST(MavlinkLink, OfASerialLineHasItAlone) {
  int device = -1, end = -1;
  std::array<char, 256> name;
  ASSERT_EQ(openpty(&device, &end, name.data(), nullptr, nullptr), 0);
  const auto link = link_at(std::string("serial:") + name.data() + ":57600");
  int alone = 0;
  EXPECT_EQ(ioctl(end, TIOCGEXCL, &alone), 0);
  EXPECT_NE(alone, 0);
  close(device);
  close(end);
}

}  // namespace
}  // namespace ergocast::mavlink
