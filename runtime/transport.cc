// SPDX-License-Identifier: BSD-3-Clause
// Opens one LCM instance for each bus, installs filters, decodes datagrams without throwing, and
// waits with one poll.
#include "runtime/transport.h"

#include <linux/sock_diag.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "runtime/clock.h"
#include "runtime/datagram_filter.h"
#include "runtime/group_membership.h"
#include "runtime/repeat_guard.h"
#include "runtime/socket.h"

namespace ergocast {
namespace {

constexpr int kMaxDatagramsPerTurn = 256;
/// Messages that may wait on a bus, 5 MB of them: a flood costs messages, but no more memory.
constexpr int kQueueCapacity = 4096;
/// For each socket, unless the URL sets another size or the machine allows less. It holds what
/// arrives while this process waits for a processor, for example the beginning of a flood.
constexpr int kReceiveBufferBytes = 1 << 20;
constexpr std::string_view kPrefix = "ERGOCAST_";
constexpr const char* kFirewall =
    "A firewall drops UDP at this port, in or out. As root:\n  nft list ruleset";
/// More descriptors than LCM opens for three buses and their self tests: pipes, timers, sockets.
constexpr int kDescriptors = 32;

/// The system's error if it cannot give so many descriptors; nothing if it can. LCM does not report
/// such errors; only its self test fails.
std::optional<std::string> why_no_descriptors() {
  std::vector<Socket> probes;
  for (int i = 0; i < kDescriptors; ++i) {
    if (probes.emplace_back(AF_INET, SOCK_DGRAM).fd() < 0) return no_socket(errno);
  }
  return std::nullopt;
}

/// The kernel's drops at these sockets. /proc/net/udp has the same counts, but reading it takes
/// longer the more sockets exist.
std::int64_t drops_of(const std::vector<int>& sockets) {
  std::int64_t drops = 0;
  for (const int socket : sockets) {
    std::array<std::uint32_t, SK_MEMINFO_VARS> memory{};
    socklen_t bytes = sizeof memory;
    if (getsockopt(socket, SOL_SOCKET, SO_MEMINFO, memory.data(), &bytes) == 0) {
      drops += memory[SK_MEMINFO_DROPS];
    }
  }
  return drops;
}

class LcmTransport final : public Transport {
 public:
  LcmTransport(RunId run, const MessageAuthenticator& seal, Handlers handlers)
      : run_(run), seal_(seal), handlers_(std::move(handlers)) {}

  std::optional<std::string> connect(const LcmUrl& url, const Subscriptions& hears);

  void set_run(RunId run) override { run_ = run; }
  void publish(const Outgoing& outgoing) override;
  void limit_agents(const RateBudget& allowance, Tick tick) override {
    rates_.allow(allowance, tick);
  }
  Instant deliver_until(Instant deadline, int wake_fd) override;
  bool keyed() const override { return seal_.keyed(); }
  bool filtered() const override { return filtered_; }
  std::int64_t kernel_drops() const override;
  bool renew_membership() override { return membership_->renew(); }

 private:
  /// A bus with subscriptions.
  struct Line {
    LcmTransport* transport = nullptr;
    Bus bus{};
    std::vector<int> sockets;
    RepeatGuard guard{Bus::kSwarm};
    bool is_cut = false;             // the kernel drops repeats
    std::int64_t drops_counted = 0;  // the kernel's drops at the last count
    void on_datagram(const lcm::ReceiveBuffer* buffer, const std::string& channel) noexcept {
      transport->take(*this, buffer, channel);
    }
  };

  void refuse(Refusal refusal) noexcept {
    ++refused_[static_cast<std::size_t>(refusal)];
    if (handlers_.on_refused) handlers_.on_refused(refusal);
  }
  void note_unknown_format(const std::string& channel) {
    ++unknown_format_.count;
    // An unknown channel name must not enter our log with arbitrary bytes.
    const bool plain = std::all_of(channel.begin(), channel.end(), [](char c) {
      return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
    unknown_format_.channel = plain ? channel : std::string(kPrefix) + "…";
  }
  void take(Line& line, const lcm::ReceiveBuffer* buffer, const std::string& channel) noexcept;
  void cut_repeats(Line& line);
  void count_cut(Line& line) noexcept;

  RunId run_;
  MessageAuthenticator seal_;
  Handlers handlers_;
  RateLimit rates_;
  bool filtered_ = true;
  std::int64_t cut_ = 0;  // repeats that the kernel has dropped
  KnownSignatures signatures_;
  std::array<std::unique_ptr<lcm::LCM>, kBusCount> buses_;
  std::array<Line, kBusCount> lines_{};
  std::vector<pollfd> ready_;  // the listened buses, then the caller's descriptor
  std::vector<lcm::LCM*> listened_;
  std::optional<GroupMembership> membership_;
  std::vector<std::byte> bytes_;
};

std::optional<std::string> LcmTransport::connect(const LcmUrl& url, const Subscriptions& hears) {
  const auto scarce = why_no_descriptors();
  for (int b = 0; b < kBusCount; ++b) {
    const auto at = static_cast<std::size_t>(b);
    buses_[at] = std::make_unique<lcm::LCM>(url.of(static_cast<Bus>(b)));
    if (buses_[at]->good()) continue;
    return url.of(static_cast<Bus>(b)) + ": " + scarce.value_or("LCM cannot use it");
  }
  for (int b = 0; b < kBusCount; ++b) {
    const auto at = static_cast<std::size_t>(b);
    const Bus bus = static_cast<Bus>(b);
    if (hears[at] == 0) continue;
    // Runs LCM's self test: a subscription after a failed test would abort the process later.
    const int fd = buses_[at]->getFileno();
    if (fd < 0) {
      return url.of(bus) + ": " +
             scarce.value_or(std::string("LCM's self test failed\n") + kFirewall);
    }
    const auto sockets = sockets_at(url.base_port + b, 1);
    for (const int socket : sockets) {
      if (url.receive_buffer_bytes > 0) break;
      setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &kReceiveBufferBytes, sizeof kReceiveBufferBytes);
    }
    filtered_ = filtered_ && !sockets.empty() &&
                std::all_of(sockets.begin(), sockets.end(),
                            [](int socket) { return admit_only_our_channels(socket); });
    lines_[at].transport = this;
    lines_[at].bus = bus;
    lines_[at].guard = RepeatGuard(bus);
    lines_[at].sockets = sockets;
    buses_[at]
        ->subscribe(channels_of(hears[at]), &Line::on_datagram, &lines_[at])
        ->setQueueCapacity(kQueueCapacity);
    ready_.push_back({fd, POLLIN, 0});
    listened_.push_back(buses_[at].get());
  }
  ready_.push_back({-1, POLLIN, 0});
  membership_.emplace(url);
  return std::nullopt;
}

void LcmTransport::publish(const Outgoing& outgoing) {
  const std::string& channel = channel_of(outgoing.message, outgoing.relayer);
  encode(outgoing.message, bytes_, seal_, channel);
  buses_[static_cast<std::size_t>(outgoing.bus)]->publish(channel, bytes_.data(),
                                                          static_cast<unsigned>(bytes_.size()));
}

/// Datagrams that the repeat filter dropped count as refused, and not as lost for want of buffer
/// space.
std::int64_t LcmTransport::kernel_drops() const {
  std::int64_t drops = -cut_;
  for (const Line& line : lines_) {
    drops += line.is_cut ? line.drops_counted : drops_of(line.sockets);
  }
  return drops;
}

void LcmTransport::count_cut(Line& line) noexcept {
  const std::int64_t drops = drops_of(line.sockets);
  cut_ += drops - line.drops_counted;
  for (; line.drops_counted < drops; ++line.drops_counted) refuse(Refusal::kRate);
}

/// Gives the kernel the guard's list, or as much of it as there is room for.
void LcmTransport::cut_repeats(Line& line) {
  if (line.is_cut) {
    count_cut(line);
  } else {
    line.drops_counted = drops_of(line.sockets);
  }
  for (const int socket : line.sockets) {
    std::span<const Repeated> flooded = line.guard.flooded();
    while (!admit_only_our_channels(socket, flooded) && !flooded.empty()) {
      flooded = flooded.first(flooded.size() / 2);
    }
  }
  if (line.is_cut) count_cut(line);
  line.is_cut = !line.guard.flooded().empty();
}

void LcmTransport::take(Line& line, const lcm::ReceiveBuffer* buffer,
                        const std::string& channel) noexcept {
  const std::span<const std::byte> bytes(static_cast<const std::byte*>(buffer->data),
                                         buffer->data_size);
  try {
    const auto decoded = decode(bytes, run_, seal_, channel, &signatures_);
    if (const auto* refusal = std::get_if<Refusal>(&decoded)) {
      if (*refusal == Refusal::kType) note_unknown_format(channel);
      return refuse(*refusal);
    }
    const Message& message = std::get<Message>(decoded);
    const auto transmitter = transmitter_of(message, channel);
    if (!transmitter) return refuse(Refusal::kType);
    const Instant heard = now();
    const bool is_news = line.guard.is_news(header_of(message), heard);
    if (line.guard.count(header_of(message), is_news, heard)) cut_repeats(line);
    if (!rates_.admit(*transmitter, is_news, heard)) {
      if (is_news) rate_offender_ = *transmitter, ++over_rate_;
      return refuse(Refusal::kRate);
    }
    if (handlers_.on_accepted) handlers_.on_accepted(line.bus, channel, bytes);
    handlers_.on_message(message, line.bus, *transmitter);
  } catch (...) {  // an exception must not pass through LCM's C frames: the next call would abort
    refuse(Refusal::kLimit);
  }
}

Instant LcmTransport::deliver_until(Instant deadline, int wake_fd) {
  using std::chrono::nanoseconds;
  const Instant start = now();
  const nanoseconds wait =
      deadline <= start ? nanoseconds(0) : std::min<nanoseconds>(deadline - start, kLongestWait);
  ready_.back().fd = wake_fd;
  const timespec timeout{static_cast<time_t>(wait.count() / 1000000000),
                         static_cast<long>(wait.count() % 1000000000)};
  const int ready = ppoll(ready_.data(), ready_.size(), &timeout, nullptr);
  const Instant woke = now();
  if (ready <= 0) return woke;
  for (std::size_t i = 0; i < listened_.size(); ++i) {
    if ((ready_[i].revents & POLLIN) == 0) continue;
    for (int n = 0; n < kMaxDatagramsPerTurn && listened_[i]->handleTimeout(0) > 0; ++n) {
    }
  }
  for (Line& line : lines_) {
    if (line.is_cut) count_cut(line);
  }
  return woke;
}

}  // namespace

std::variant<std::unique_ptr<Transport>, std::string> Transport::open(
    const LcmUrl& url, RunId run, const MessageAuthenticator& seal, const Subscriptions& hears,
    Handlers handlers) {
  if (const auto problem = why_unreachable(url)) return *problem;
  auto transport = std::make_unique<LcmTransport>(run, seal, std::move(handlers));
  if (const auto problem = transport->connect(url, hears)) return *problem;
  return std::unique_ptr<Transport>(std::move(transport));
}

}  // namespace ergocast
