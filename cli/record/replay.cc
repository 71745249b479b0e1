// SPDX-License-Identifier: BSD-3-Clause
// `ergocast replay`: sends the messages of a record again, at the speed of mission time, under
// names that only displays listen to.
#include <poll.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/progress_line.h"
#include "cli/record/replay_source.h"
#include "cli/record/run_directory.h"
#include "cli/report_error.h"
#include "cli/team/team_monitor.h"
#include "runtime/bus/bus_writer.h"
#include "runtime/bus/clock.h"
#include "runtime/bus/random_identity.h"
#include "runtime/process/program_options.h"
#include "runtime/process/signals.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

/// A separate multicast group: programs that listen to teams do not even receive the datagrams.
constexpr const char* kReplayGroup = "239.255.76.68";
/// The period with which the newest states are sent again, for displays that start late.
constexpr auto kRepeatPeriod = 1s;
/// Longer than the interval between an agent's messages.
constexpr auto kReplayLookAround = 3 * kAgentStatusPeriod / 2;
constexpr double kSlowest = 0.01;
/// Limit (Commands): rate of a replay [mission seconds a second]. Beyond it: the command is
/// refused.
constexpr double kFastest = 1000;

struct ReplayOptions {
  std::filesystem::path run_dir;
  std::optional<LcmUrl> url;
  MessageAuthenticator authenticator;
  double rate = 1, from_s = 0;
};

/// Whether any process sends on the URL; an error if LCM cannot be used.
Result<bool> is_taken(const LcmUrl& url, StopSignals& signals) {
  BusOptions bus;
  bus.url = url;
  bool heard = false;
  const OnMessage on_message = [&heard](const Message&, Bus, AgentId) { heard = true; };
  auto opened = listen_to_teams(bus, on_message, on_message);
  if (!opened) return failure(opened.error());
  Transport& transport = **opened;
  const Instant until = now() + kReplayLookAround;
  while (!heard && now() < until) transport.deliver_until(until, signals.fd());
  const RefusalCounts& refused = transport.refused();
  return heard || std::any_of(refused.begin(), refused.end(), [](auto count) { return count > 0; });
}

class Player {
 public:
  Player(ReplaySource& source, BusWriter& writer, StopSignals& signals, double end_s,
         const ReplayOptions& options)
      : source_(source), writer_(writer), signals_(signals), end_s_(end_s), options_(options) {}

  /// Runs until the record's end, a problem or a signal. Returns the number of messages sent.
  std::int64_t play() {
    const Instant start = now();
    bool begun = false;
    while (const ReplayedMessage* message = source_.next()) {
      t_s_ = message->t_s;
      if (t_s_ < options_.from_s) continue;
      if (!begun) {
        begun = true;
        next_repeat_ = start;
        if (options_.from_s > 0) repeat(start);
      }
      const std::chrono::duration<double> wait((t_s_ - options_.from_s) / options_.rate);
      if (!wait_until(start + std::chrono::duration_cast<std::chrono::nanoseconds>(wait))) break;
      send(*message);
    }
    writer_.flush();
    line_.end();
    return sent_;
  }
  double t_s() const { return t_s_; }

 private:
  void send(const ReplayedMessage& message) {
    for (const Bus bus : message.buses) writer_.add(bus, message.channel, message.bytes);
    ++sent_;
  }
  void repeat(Instant at) {
    next_repeat_ = at + kRepeatPeriod;
    for (const ReplayedMessage* message : source_.newest()) {
      for (const Bus bus : message->buses) writer_.add(bus, message->channel, message->bytes);
    }
    writer_.flush();
  }
  /// Returns false if a signal arrived.
  bool wait_until(Instant due) {
    while (true) {
      const Instant at = now();
      if (at >= next_repeat_) repeat(at);
      show();
      if (at >= due) return signals_.take() == 0;
      writer_.flush();
      const auto left = std::min(due, next_repeat_) - at;
      pollfd waiting{signals_.fd(), POLLIN, 0};
      const auto ms = std::chrono::ceil<std::chrono::milliseconds>(left).count();
      poll(&waiting, 1, static_cast<int>(ms));
      if (signals_.take() > 0) return false;
    }
  }
  void show() {
    if (!line_.due(ProgressLine::Clock::now())) return;
    line_.show(t_s_ / end_s_, {text_of("t = %.1f s", t_s_), std::to_string(sent_) + " messages"});
  }

  ReplaySource& source_;
  BusWriter& writer_;
  StopSignals& signals_;
  double end_s_;
  const ReplayOptions& options_;
  ProgressLine line_;
  Instant next_repeat_{};
  double t_s_ = 0;
  std::int64_t sent_ = 0;
};

void announce(const LcmUrl& url, const Mission& mission, const ReplayOptions& options) {
  std::printf(
      "replay of %s from %s, %s times as fast as mission time\n"
      "  ergocast status --watch --lcm-url \"%s\"\n"
      "  ergocast watch --lcm-url \"%s\"\n"
      "  ergocast spy --lcm-url \"%s\"\n",
      mission.name.c_str(), printable(options.run_dir.string()).c_str(),
      text_of("%g", options.rate).c_str(), url.base().c_str(), url.base().c_str(),
      url.base().c_str());
  std::fflush(stdout);
}

int play(const ReplayOptions& options, const LcmUrl& url, const Mission& mission,
         StopSignals& signals) {
  auto source = ReplaySource::open(options.run_dir, mission, options.authenticator);
  if (!source) return report_error(kExitBadInput, source.error());
  auto writer = BusWriter::open(url);
  if (!writer) return report_error(kExitUnavailable, writer.error());
  announce(url, mission, options);
  ReplaySource& messages = *source;
  Player player(messages, **writer, signals, recorded_end_s(options.run_dir, mission), options);
  const std::int64_t sent = player.play();
  if (messages.problem()) return report_error(kExitBadInput, *messages.problem());
  if (sent == 0 && options.from_s > player.t_s()) {
    return report_error(kExitBadInput, "--from: the record ends at " + text_of("%g", player.t_s()) +
                                           " s; give an earlier time");
  }
  std::printf("replayed %lld messages, up to t = %.1f s\n", static_cast<long long>(sent),
              player.t_s());
  return kExitDone;
}

int replay(const ReplayOptions& options) {
  const auto mission = recorded_mission_or_complain(options.run_dir);
  if (!mission) return kExitBadInput;
  StopSignals signals;
  LcmUrl url = options.url.value_or(LcmUrl{.group = kReplayGroup});
  if (const auto problem = why_unreachable(url)) return report_error(kExitUnavailable, *problem);
  if (!options.url) {
    const auto ports = PortReservation::take(random_identity());
    if (!ports)
      return report_error(kExitUnavailable, "no free ports in 24000 to 26999; give --lcm-url");
    url.base_port = ports->base_port();
    return play(options, url, *mission, signals);
  }
  const auto taken = is_taken(url, signals);
  if (!taken) return report_error(kExitUnavailable, taken.error());
  if (*taken) {
    return report_error(
        kExitBadInput,
        url.base() +
            ": a team or another replay sends here; leave --lcm-url out, or give another port");
  }
  return play(options, url, *mission, signals);
}

/// A URL of this host only.
LcmUrl replay_url(const std::string& text) {
  auto parsed = LcmUrl::parse(text);
  if (!parsed) throw CLI::ValidationError("--lcm-url", parsed.error());
  if (parsed->ttl != 0) {
    throw CLI::ValidationError("--lcm-url", "a replay stays on this host: write ttl=0");
  }
  return *parsed;
}

}  // namespace

void add_replay(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand(
      "replay", "Send a recorded run again on this host, for status, watch and spy");
  auto options = std::make_shared<ReplayOptions>();
  command->add_option("RUN_DIR", options->run_dir, "Run directory")->required()->type_name("DIR");
  command->add_option("--rate", options->rate, "Mission seconds in a second (default: 1)")
      ->check(CLI::Range(kSlowest, kFastest));
  command->add_option("--from", options->from_s, "Mission time to begin at [s] (default: 0)")
      ->check(CLI::Range(0.0, 1e7));
  command
      ->add_option_function<std::string>(
          "--lcm-url", [options](const std::string& text) { options->url = replay_url(text); },
          "Base URL of the three buses (default: a group and ports of its own)")
      ->type_name("URL");
  add_key_option(*command, options->authenticator);
  command->footer(
      "Only displays receive a replay: no agent joins it, and `ergocast stop` refuses it.\n"
      "Exit codes: 0 done, or ended by Ctrl-C; 2 no record, or it is damaged, or the URL is "
      "in\n"
      "use; 3 LCM cannot be used.");
  command->callback([&action, options] { action = [options] { return replay(*options); }; });
}

}  // namespace ergocast::cli
