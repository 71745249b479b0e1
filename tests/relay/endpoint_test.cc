// SPDX-License-Identifier: BSD-3-Clause
// Places as people write them.
#include "relay/endpoint.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>

#include <string>
#include <vector>

namespace ergocast::relay {
namespace {

TEST(APlace, IsReadAndWrittenAlike) {
  for (const char* text : {"hub.example.org:7700", "10.0.0.1:1", "[2001:db8::1]:65535", ":7700"}) {
    const auto place = HostAndPort::parse(text);
    ASSERT_TRUE(place) << text;
    EXPECT_EQ(to_text(*place), text);
  }
  for (const char* text : {"", "hub", "hub:", "hub:0", "hub:65536", "2001:db8::1:7700"}) {
    EXPECT_FALSE(HostAndPort::parse(text)) << text;
  }
}

TEST(APlace, ToSendToHasAHost) {
  EXPECT_TRUE(HostAndPort::parse_hub("hub:7700"));
  for (const char* text : {":7700", "[]:7700"}) EXPECT_FALSE(HostAndPort::parse_hub(text)) << text;
}

/// Also on a host that has such addresses on its loopback only.
TEST(APlace, MayBeALiteralOfEitherKind) {
  EXPECT_EQ(to_text(look_up({"127.0.0.1", 7700}).value().at(0)), "127.0.0.1:7700");
  EXPECT_EQ(to_text(look_up({"::1", 7700}).value().at(0)), "[0:0:0:0:0:0:0:1]:7700");
  EXPECT_EQ(to_text(look_up({"", 7700}).value().at(0)), "[0:0:0:0:0:0:0:0]:7700");
}

/// The port that the system has chosen for a socket.
std::uint16_t port_of(const Endpoint& endpoint) {
  sockaddr_in6 at{};
  socklen_t length = sizeof at;
  EXPECT_EQ(getsockname(endpoint.fd(), reinterpret_cast<sockaddr*>(&at), &length), 0);
  return ntohs(at.sin6_port);
}

TEST(AnEndpointAtEveryAddress, AnswersFromTheOneThatWasAsked) {
  constexpr int kPatience_ms = 300'000;
  auto hub = Endpoint::open(Address()), site = Endpoint::open(std::nullopt);
  ASSERT_TRUE(hub && site);
  const std::string other = "127.0.0.2";
  const Address asked = look_up({other, port_of(*hub)}).value().at(0);
  const std::vector<std::byte> bytes(3, std::byte{7});
  std::vector<std::byte> space;
  const auto next = [&space](Endpoint& endpoint) {
    pollfd ready{endpoint.fd(), POLLIN, 0};
    poll(&ready, 1, kPatience_ms);
    return endpoint.receive(space).value();
  };
  site->send({asked, bytes});
  hub->send({next(*hub).from, bytes});
  EXPECT_EQ(to_text(next(*site).from), to_text(asked));
}

// Also for the thread sanitizer.
TEST(Threads, LookUpNamesBesideARelay) {
  Resolver resolver;
  for (int i = 1; i < 20; ++i) {
    resolver.ask({"127.0.0." + std::to_string(i), 7700});
    pollfd answer{resolver.fd(), POLLIN, 0};
    ASSERT_EQ(poll(&answer, 1, -1), 1);
    const auto found = resolver.take();
    ASSERT_TRUE(found);
    EXPECT_EQ(to_text(found->value().at(0)), "127.0.0." + std::to_string(i) + ":7700");
  }
}

TEST(Threads, EndAfterTheRelayThatAskedThem) {
  for (int i = 0; i < 20; ++i) Resolver().ask({"127.0.0.1", 7700});
}

}  // namespace
}  // namespace ergocast::relay
