// SPDX-License-Identifier: BSD-3-Clause
// Compares the transport's counters with those of the last check, and logs each kind of growth at a
// limited rate.
#include "runtime/process/traffic_watch.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <string>

#include "runtime/process/program_options.h"

namespace ergocast {

using namespace std::chrono_literals;

namespace {

/// Limit (Time): time between two warnings of one kind in a log, at least [s]. Below it: the
/// warning is left out.
constexpr auto kLogPeriod = 10s;

/// Explains refusals caused by keys, with the likely fault in the hosts of a team.
std::string key_advice(const RefusalCounts& refused, bool keyed) {
  const auto some = [&refused](Refusal kind) {
    return refused[static_cast<std::size_t>(kind)] > 0;
  };
  std::string advice;
  if (some(Refusal::kUnkeyed)) advice += "; unkeyed: a process sends without our --key-file";
  if (some(Refusal::kUnsigned)) {
    advice +=
        "; unsigned: a process without the coordinator's --key-file tries to begin or end missions";
  }
  if (some(Refusal::kTag)) {
    advice += keyed ? "; tag: damaged, or the sender has another --key-file"
                    : "; tag: damaged, or a team with a --key-file is on this URL";
  }
  return advice;
}

}  // namespace

TrafficWatch::TrafficWatch(Transport& transport) : transport_(transport) {
  if (!transport.filtered()) {
    spdlog::warn(
        "this kernel has no socket filters: every datagram on our ports wakes this process, and a "
        "flood of repeats is not dropped");
  }
}

bool TrafficWatch::look(Instant now, std::int64_t late_commands) {
  if (now < next_look_) return false;
  next_look_ = now + 1s;
  if (transport_.renew_membership())
    spdlog::warn("listening on another network interface from now on");
  kernel_drops_ = transport_.kernel_drops();
  warn_of_unknown_format(now);
  warn_of_late_commands(late_commands, now);
  const RefusalCounts& refused = transport_.refused();
  if (now < next_log_ || (refused == logged_ && kernel_drops_ == logged_drops_)) return true;
  next_log_ = now + kLogPeriod;
  std::string reasons;
  for (std::size_t i = 0; i < refused.size(); ++i) {
    if (refused[i] == 0) continue;
    reasons +=
        std::string(" ") + to_string(static_cast<Refusal>(i)) + '=' + std::to_string(refused[i]);
  }
  if (refused != logged_) {
    spdlog::warn("messages refused since the start:{}{}", reasons,
                 key_advice(refused, transport_.keyed()));
  }
  constexpr auto kRate = static_cast<std::size_t>(Refusal::kRate);
  const std::int64_t repeated = refused[kRate] - transport_.over_rate();
  if (transport_.over_rate() != logged_over_rate_) {
    spdlog::warn(
        "agent {} sends more than eight times what the mission asks of an agent, and the rest is "
        "refused; stop it, or repair its program",
        transport_.rate_offender());
  }
  if (repeated != logged_repeats_) {
    spdlog::warn(
        "messages of the team are repeated far more often than the team would, and the rest is "
        "refused: look for a program on this network that replays a recording");
  }
  logged_over_rate_ = transport_.over_rate();
  logged_repeats_ = repeated;
  if (kernel_drops_ != logged_drops_) {
    spdlog::warn(
        "the kernel dropped {} datagrams since the start for want of buffer space: raise "
        "net.core.rmem_max",
        kernel_drops_);
  }
  logged_ = refused;
  logged_drops_ = kernel_drops_;
  return true;
}

void TrafficWatch::warn_of_late_commands(std::int64_t count, Instant now) {
  if (count == warned_late_ || now < next_late_warning_) return;
  warned_late_ = count;
  next_late_warning_ = now + kLogPeriod;
  spdlog::warn(
      "late={}: a command to stop, pause or resume names a tick that has passed long ago, and is "
      "ignored: it was delayed, or repeated from a recording; send it again if it is still wanted",
      count);
}

void TrafficWatch::warn_of_unknown_format(Instant now) {
  const Transport::UnknownFormat& unknown = transport_.unknown_format();
  if (unknown.count == warned_unknown_ || now < next_warning_) return;
  warned_unknown_ = unknown.count;
  next_warning_ = now + kLogPeriod;
  spdlog::warn(
      "{} arrives in a format that version {} does not know: another version of Ergocast is "
      "on this URL",
      unknown.channel, version());
}

}  // namespace ergocast
