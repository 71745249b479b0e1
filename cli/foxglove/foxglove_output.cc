// SPDX-License-Identifier: BSD-3-Clause
// Answers each handshake, and gives the team to all clients that it has let in.
#include "cli/foxglove/foxglove_output.h"

#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "cli/foxglove/client.h"
#include "cli/foxglove/websocket.h"
#include "runtime/bus/clock.h"

namespace ergocast::cli {
namespace {

/// The kernel keeps about this much for a client that reads nothing, so that what a slow client
/// gets is not old.
constexpr int kKernelBuffer = 64 << 10;
/// Sentences about clients in a second; a program that connects again and again must not fill the
/// log.
constexpr int kMostNotes = 4;

std::uint64_t wall_time_ns() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        std::chrono::system_clock::now().time_since_epoch())
                                        .count());
}

Connections::Answer refusal(const char* status, const std::string& why, const char* more = "") {
  const std::string text = why + '\n';
  return {.head = std::string("HTTP/1.1 ") + status +
                  "\r\nContent-Type: text/plain; charset=utf-8\r\nConnection: close\r\n" + more +
                  "Content-Length: " + std::to_string(text.size()) + "\r\n\r\n" + text,
          .body = {},
          .stream = {}};
}

/// Whether a page of this origin may read the team without a token: Foxglove's own, as web page or
/// as program (a page from a file), and pages of this host's own servers.
bool is_known(const std::string& origin) {
  if (origin.empty() || origin == "https://app.foxglove.dev" || origin == "file://") return true;
  for (const std::string scheme : {"http://", "https://"})
    for (const std::string host : {"localhost", "127.0.0.1"})
      if (origin == scheme + host || origin.starts_with(scheme + host + ':')) return true;
  return false;
}

/// The kernel notices a client whose host has vanished. The connections inherit it.
void set_up(int listener) {
  const int yes = 1, idle_s = 15, period_s = 5, tries = 3;
  setsockopt(listener, SOL_SOCKET, SO_SNDBUF, &kKernelBuffer, sizeof kKernelBuffer);
  setsockopt(listener, SOL_SOCKET, SO_KEEPALIVE, &yes, sizeof yes);
  setsockopt(listener, IPPROTO_TCP, TCP_KEEPIDLE, &idle_s, sizeof idle_s);
  setsockopt(listener, IPPROTO_TCP, TCP_KEEPINTVL, &period_s, sizeof period_s);
  setsockopt(listener, IPPROTO_TCP, TCP_KEEPCNT, &tries, sizeof tries);
}

/// "/?token=…"
std::string token_in(const std::string& target) {
  constexpr std::string_view kBegin = "/?token=";
  return target.starts_with(kBegin) ? target.substr(kBegin.size()) : "";
}

}  // namespace

CLI::Option* add_foxglove_option(CLI::App& app, int& port) {
  return app
      .add_option("--foxglove", port,
                  "Also serve the team to Foxglove on this port, with the topics of `ergocast "
                  "export --to mcap`: open a Foxglove WebSocket connection to the printed address. "
                  "--listen and --tls-cert apply to it, too")
      ->type_name("PORT")
      ->check(CLI::Range(1, 65535));
}

std::string foxglove_url(const PageSocket& socket) {
  return "ws" + socket.url().substr(4);  // that begins with http or https
}

FoxgloveOutput::FoxgloveOutput(Setup setup, PageSocket socket)
    : setup_(std::move(setup)),
      socket_(std::move(socket)),
      session_(random_token()),
      topics_(channels_, setup_.origin, std::move(setup_.target)),
      connections_(
          socket_.fd(), [this](const std::string& head) { return answer(head); },
          [this](Socket accepted) { return socket_.stream(std::move(accepted)); }) {
  set_up(socket_.fd());
}

Connections::Answer FoxgloveOutput::answer(const std::string& head) {
  const auto request = RequestHead::parse(head);
  if (!request) return refusal("400 Bad Request", "this is no request of HTTP/1.1");
  if (!socket_.is_called(request->value("host")))
    return refusal("421 Misdirected Request", "this server does not have that name");
  if (!socket_.token().empty()) {
    if (!same_secret(token_in(request->target), socket_.token()))
      return refusal("403 Forbidden", "give Foxglove the address that was printed, with its token");
  } else if (request->headers.count("origin") > 1 || !is_known(request->value("origin"))) {
    return refusal("403 Forbidden", "not for other sites");
  }
  const auto accept = websocket_accept(request->value("sec-websocket-key"));
  if (request->method != "GET" || !request->lists("connection", "upgrade") ||
      !request->lists("upgrade", "websocket") || !accept)
    return refusal("426 Upgrade Required",
                   "this port serves Foxglove: open a Foxglove WebSocket connection to it",
                   "Upgrade: websocket\r\n");
  if (request->value("sec-websocket-version") != "13")
    return refusal("426 Upgrade Required", "only version 13 of WebSocket",
                   "Sec-WebSocket-Version: 13\r\n");
  const auto* const protocol = std::ranges::find_if(kFoxgloveProtocols, [&](const char* one) {
    return request->lists("sec-websocket-protocol", one);
  });
  if (protocol == std::end(kFoxgloveProtocols))
    return refusal("400 Bad Request", "the subprotocol is none of Foxglove's");
  return {.head =
              "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
              "Sec-WebSocket-Accept: " +
              *accept + "\r\nSec-WebSocket-Protocol: " + *protocol + "\r\n\r\n",
          .body = {},
          .stream = {},
          .dialogue = std::make_unique<FoxgloveClient>(
              channels_, session_, [this](const std::string& sentence) { note(sentence); })};
}

void FoxgloveOutput::note(const std::string& sentence) {
  if (notes_++ < kMostNotes) setup_.note(sentence);
}

void FoxgloveOutput::serve(Instant now) {
  if (now - second_ >= std::chrono::seconds(1)) {
    second_ = now;
    notes_ = 0;
  }
  topics_.show_places(wall_time_ns());
  connections_.serve(now);
}

std::vector<std::string> FoxgloveOutput::clients() const {
  std::vector<std::string> names;
  for (const std::string& peer : connections_.peers()) names.push_back("Foxglove client " + peer);
  return names;
}

void FoxgloveOutput::show(const WorldState& world, const MissionFollower& team) {
  topics_.take(world, team);
}

void FoxgloveOutput::show(const std::vector<std::string>& lines) {
  const std::uint64_t time_ns = wall_time_ns();
  for (const std::string& line : lines) topics_.show_line(time_ns, line);
}

void FoxgloveOutput::show(const TeamPicture& picture, const MissionFollower& team) {
  topics_.show(wall_time_ns(), picture, team);
}

}  // namespace ergocast::cli
