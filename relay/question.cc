// SPDX-License-Identifier: BSD-3-Clause
// Gets a cookie as a site does, and asks with it. Lost packets are sent again.
#include "relay/question.h"

#include <poll.h>

#include <chrono>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "relay/packets.h"
#include "runtime/bus/clock.h"
#include "runtime/bus/random_identity.h"

namespace ergocast::relay {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::nanoseconds kQuestionPatience = 3s, kRepeat = 300ms;

/// Sends `control` until an A of that number comes from there, or the time is over.
template <class A>
std::optional<A> answer_to(const Control& control, std::uint64_t nonce, const Seal& seal,
                           Endpoint& endpoint, const Address& hub, Instant until) {
  std::vector<std::byte> space;
  for (Instant repeat{}; now() < until;) {
    if (now() >= repeat) {
      endpoint.send({hub, seal.write(control)});
      repeat = now() + kRepeat;
    }
    pollfd ready{endpoint.fd(), POLLIN, 0};
    poll(&ready, 1, 50);
    const auto packet = endpoint.receive(space);
    if (!packet || packet->from != hub) continue;
    const auto read = seal.read(packet->bytes);
    const A* const answer = read ? std::get_if<A>(&*read) : nullptr;
    if (answer != nullptr && answer->nonce == nonce) return *answer;
  }
  return std::nullopt;
}

}  // namespace

Result<std::string> ask_hub(const HostAndPort& hub, const MessageAuthenticator& authenticator) {
  const auto addresses = look_up(hub);
  if (!addresses) return failure(addresses.error());
  auto endpoint = Endpoint::open(std::nullopt);
  if (!endpoint) return failure(endpoint.error());
  const Seal seal(authenticator.key());
  const std::uint64_t nonce = random_identity();
  const Instant end = now() + kQuestionPatience;
  for (std::size_t i = 0; i < addresses->size(); ++i) {
    const Instant until = now() + (end - now()) / static_cast<int>(addresses->size() - i);
    const Address& address = (*addresses)[i];
    const auto cookie =
        answer_to<Cookie>(Ask{nonce, nonce}, nonce, seal, *endpoint, address, until);
    if (!cookie) continue;
    const Question question{nonce, cookie->cookie};
    const auto report = answer_to<Report>(question, nonce, seal, *endpoint, address, until);
    if (report) return report->text;
  }
  return failure("no answer: it does not run there, UDP does not reach it, or it has another key");
}

}  // namespace ergocast::relay
