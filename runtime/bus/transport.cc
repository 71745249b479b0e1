// SPDX-License-Identifier: BSD-3-Clause
// Opens a reader for each bus with subscriptions and one writer, decodes datagrams without
// throwing, and waits with one poll.
#include "runtime/bus/transport.h"

#include <poll.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>
#include <vector>

#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "runtime/bus/bus_reader.h"
#include "runtime/bus/bus_writer.h"
#include "runtime/bus/clock.h"
#include "runtime/bus/group_membership.h"
#include "runtime/bus/repeat_guard.h"
#include "runtime/bus/self_test.h"

namespace ergocast {
namespace {

/// Limit (Network): datagrams of a bus that a process reads in a turn. Beyond it: the next turn
/// reads on.
constexpr std::size_t kMaxDatagramsPerTurn = 256;
/// A bus with more than kCrowd times the expected datagrams is flooded: statuses and digests of a
/// team are fewer. For the time kCrowded, messages then do not gather.
constexpr std::size_t kCrowd = 4;
constexpr auto kCrowded = std::chrono::seconds(10);
constexpr std::string_view kPrefix = "ERGOCAST_";

class BusTransport final : public Transport {
 public:
  BusTransport(RunId run, const MessageAuthenticator& authenticator, Handlers handlers)
      : run_(run), authenticator_(authenticator), handlers_(std::move(handlers)) {}

  std::optional<std::string> connect(const LcmUrl& url, const Subscriptions& subscriptions);

  void set_run(RunId run) override { run_ = run; }
  void publish(std::span<const Outgoing> outgoing) override;
  void limit_agents(const RateBudget& rate_budget, Tick tick) override {
    rates_.allow(rate_budget, tick);
  }
  void let_gather(const Gathering& gathering) override { gathering_ = gathering; }
  Instant deliver_until(Instant deadline, int wake_fd) override;
  bool keyed() const override { return authenticator_.keyed(); }
  bool filtered() const override;
  std::int64_t kernel_drops() override;
  bool renew_membership() override { return membership_->renew(); }

 private:
  /// A bus with subscriptions.
  struct Line {
    std::unique_ptr<BusReader> reader;
    MessageTypes subscriptions = 0;
    RepeatGuard guard;
    bool is_cut = false;  // the kernel drops repeats
  };

  void refuse(Refusal refusal) noexcept {
    ++refused_[static_cast<std::size_t>(refusal)];
    if (handlers_.on_refused) handlers_.on_refused(refusal);
  }
  void note_unknown_format(std::string_view channel) {
    ++unknown_format_.count;
    // An unknown channel name must not enter our log with arbitrary bytes.
    const bool plain = std::all_of(channel.begin(), channel.end(), [](char c) {
      return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
    unknown_format_.channel = plain ? channel : std::string(kPrefix) + "…";
  }
  bool wait(Instant until);
  std::size_t read(Line& line);
  bool may_gather(const Line& line) const;
  void take(Line& line, std::span<const std::byte> bytes) noexcept;
  void take(Line& line, const LcmDatagram& datagram, bool is_replay);
  void cut_repeats(Line& line);
  void count_cut(Line& line) noexcept;

  RunId run_;
  MessageAuthenticator authenticator_;
  Handlers handlers_;
  RateLimit rates_;
  Gathering gathering_;
  Instant gather_until_{};   // on all buses but the world's
  Instant crowded_until_{};  // nothing gathers
  KnownSignatures signatures_;
  std::unique_ptr<BusWriter> writer_;
  std::vector<Line> lines_;
  std::vector<pollfd> ready_;  // the lines, then the caller's descriptor
  std::optional<GroupMembership> membership_;
  std::vector<std::byte> bytes_;
};

std::optional<std::string> BusTransport::connect(const LcmUrl& url,
                                                 const Subscriptions& subscriptions) {
  auto writer = BusWriter::open(url);
  if (!writer) return writer.error();
  writer_ = *std::move(writer);
  std::vector<int> sockets;
  for (const Bus bus : {Bus::kSwarm, Bus::kWorld, Bus::kCommand}) {
    const MessageTypes types = subscriptions[static_cast<std::size_t>(bus)];
    if (types == 0) continue;
    auto opened = BusReader::open(url, bus, types, handlers_.on_replayed != nullptr);
    if (!opened) return opened.error();
    if (auto problem = why_deaf(url, bus)) return problem;
    lines_.push_back({*std::move(opened), types, RepeatGuard(bus)});
    sockets.push_back(lines_.back().reader->fd());
    ready_.push_back({sockets.back(), POLLIN, 0});
  }
  ready_.push_back({-1, POLLIN, 0});
  membership_.emplace(url, std::move(sockets));
  return std::nullopt;
}

void BusTransport::publish(std::span<const Outgoing> outgoing) {
  for (const Outgoing& one : outgoing) {
    const std::string& channel = channel_of(one.message, one.relayer);
    encode(one.message, bytes_, authenticator_, channel);
    writer_->add(one.bus, channel, bytes_);
  }
  writer_->flush();
}

bool BusTransport::filtered() const {
  return std::all_of(lines_.begin(), lines_.end(),
                     [](const Line& line) { return line.reader->filtered(); });
}

std::int64_t BusTransport::kernel_drops() {
  std::int64_t drops = 0;
  for (Line& line : lines_) drops += line.reader->lost();
  return drops;
}

/// While repeats are dropped, everything that the kernel's filter drops counts as a refused repeat.
void BusTransport::count_cut(Line& line) noexcept {
  for (auto repeats = line.reader->take_rejected(); repeats > 0; --repeats) refuse(Refusal::kRate);
}

/// Gives the kernel the guard's list.
void BusTransport::cut_repeats(Line& line) {
  if (line.is_cut) {
    count_cut(line);
  } else {
    line.reader->take_rejected();  // these were no repeats
  }
  line.reader->drop_repeats(line.guard.flooded());
  if (line.is_cut) count_cut(line);
  line.is_cut = !line.guard.flooded().empty();
}

void BusTransport::take(Line& line, const LcmDatagram& datagram, bool is_replay) {
  const auto& [channel, bytes] = datagram;
  const auto decoded = decode(bytes, run_, authenticator_, channel, &signatures_);
  if (!decoded) {
    if (decoded.error() == Refusal::kType) note_unknown_format(channel);
    return refuse(decoded.error());
  }
  const Message& message = *decoded;
  const auto transmitter = transmitter_of(message, channel);
  if (!transmitter) return refuse(Refusal::kType);
  const Instant received_at = now();
  const bool is_new = line.guard.is_new(header_of(message), received_at);
  if (line.guard.count(header_of(message), is_new, received_at)) cut_repeats(line);
  if (!rates_.admit(*transmitter, is_new, received_at)) {
    if (is_new) rate_offender_ = *transmitter, ++over_rate_;
    return refuse(Refusal::kRate);
  }
  const Bus bus = line.reader->bus();
  if (is_replay) return handlers_.on_replayed(message, bus, *transmitter);
  if (handlers_.on_accepted) handlers_.on_accepted(bus, channel, bytes);
  handlers_.on_message(message, bus, *transmitter);
}

/// Without filters in the kernel, any datagram arrives. One that is not LCM's, or not subscribed
/// to, is ignored and not counted as refused.
void BusTransport::take(Line& line, std::span<const std::byte> bytes) noexcept {
  try {
    auto datagram = parse_datagram(bytes);
    if (!datagram) return;
    const auto original =
        handlers_.on_replayed ? without_replay(datagram->channel) : std::optional<std::string>();
    if (original) datagram->channel = *original;
    if (is_channel_of(line.subscriptions, datagram->channel))
      take(line, *datagram, original.has_value());
  } catch (...) {  // out of memory
    refuse(Refusal::kLimit);
  }
}

/// Returns how many datagrams there were.
std::size_t BusTransport::read(Line& line) {
  BusReader& reader = *line.reader;
  std::size_t taken = 0;
  while (taken < kMaxDatagramsPerTurn) {
    const std::size_t count = reader.receive();
    for (std::size_t i = 0; i < count; ++i) take(line, reader.datagram(i));
    taken += count;
    if (count < reader.batch()) break;
  }
  return taken;
}

bool BusTransport::may_gather(const Line& line) const {
  return line.reader->bus() != Bus::kWorld && line.reader->has_room_for(gathering_.datagrams);
}

/// Returns whether there may be something to read.
bool BusTransport::wait(Instant until) {
  const Instant start = now();
  const bool gathers = gather_until_ > start && crowded_until_ <= start;
  if (gathers) until = std::min(until, gather_until_);
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    ready_[i].events = gathers && may_gather(lines_[i]) ? 0 : POLLIN;
  }
  const auto wait = std::clamp<std::chrono::nanoseconds>(until - start, {}, kLongestWait);
  const timespec timeout{static_cast<time_t>(wait.count() / 1000000000),
                         static_cast<long>(wait.count() % 1000000000)};
  return ppoll(ready_.data(), ready_.size(), &timeout, nullptr) > 0 || gathers;
}

Instant BusTransport::deliver_until(Instant deadline, int wake_fd) {
  ready_.back().fd = wake_fd;
  const bool something = wait(deadline);
  const Instant woke = now();
  if (!something) return woke;
  std::size_t most = 0;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (ready_[i].revents != 0 || ready_[i].events == 0) most = std::max(most, read(lines_[i]));
  }
  for (Line& line : lines_) {
    if (line.is_cut) count_cut(line);
  }
  if (most == 0 || gathering_.at_most.count() == 0) return woke;
  gather_until_ = woke + gathering_.at_most;
  if (most > kCrowd * gathering_.datagrams) crowded_until_ = woke + kCrowded;
  return woke;
}

}  // namespace

Result<std::unique_ptr<Transport>> Transport::open(const LcmUrl& url, RunId run,
                                                   const MessageAuthenticator& authenticator,
                                                   const Subscriptions& subscriptions,
                                                   Handlers handlers) {
  if (const auto problem = why_unreachable(url)) return failure(*problem);
  auto transport = std::make_unique<BusTransport>(run, authenticator, std::move(handlers));
  if (const auto problem = transport->connect(url, subscriptions)) return failure(*problem);
  return std::unique_ptr<Transport>(std::move(transport));
}

}  // namespace ergocast
