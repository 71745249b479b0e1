// SPDX-License-Identifier: BSD-3-Clause
// `ergocast status`: shows the state of a running team from any host on its buses. It only listens.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "cli/commands.h"
#include "cli/report_error.h"
#include "cli/team/team_monitor.h"
#include "cli/team/team_view.h"
#include "cli/watch/client_list.h"
#include "cli/watch/diagnose_silence.h"
#include "cli/watch/find_run.h"
#include "cli/watch/team_screen.h"
#include "runtime/bus/clock.h"
#include "runtime/bus/transport.h"
#include "runtime/process/program_options.h"
#include "runtime/process/signals.h"
#include "scenario/scenario.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

/// Longer than any process may be silent.
constexpr auto kPatience = 3500ms;
constexpr auto kTurn = 50ms;
constexpr auto kLastWord = 1s;
/// Any process on the network can send HELLO under many names.
constexpr std::size_t kMostOtherVersions = 16;

struct StatusOptions : BusOptions {
  bool watch = false, json = false;
};

/// The runs received on one URL.
class Listener {
 public:
  explicit Listener(const StatusOptions& options) : options_(options), since_(now()) {}

  /// Nothing, or why LCM cannot be used.
  std::optional<std::string> open() {
    auto opened = listen_to_teams(options_, receiver(false), receiver(true));
    if (!opened) return opened.error();
    transport_ = *std::move(opened);
    since_ = now();
    return std::nullopt;
  }

  void listen(Instant until, int wake_fd) { transport_->deliver_until(until, wake_fd); }
  /// Call it at intervals: continues to listen after the network interface was replaced.
  void follow_network() { transport_->renew_membership(); }
  /// From now on accepts only the run that was found.
  void stay_with_it() { transport_->set_run(runs_.begin()->first.first); }

  Instant since() const { return since_; }
  /// Runs and replays.
  using Views = std::map<std::pair<RunId, bool>, TeamView>;
  const Views& runs() const { return runs_; }
  /// The state of the first run, with the hosts of agents that cannot join for their version.
  TeamPicture picture() const {
    TeamPicture picture = runs_.begin()->second.picture(now());
    picture.version = version();
    picture.clients = named_clients(picture.run);
    picture.other_versions = other_versions_;
    picture.trouble |= !other_versions_.empty();
    return picture;
  }
  const Transport& transport() const { return *transport_; }

 private:
  OnMessage receiver(bool replay) {
    return [this, replay](const Message& message, Bus bus, AgentId transmitter) {
      if (const auto* hello = std::get_if<Hello>(&message)) return note_version(*hello);
      const RunId run = header_of(message).run;
      const std::pair key(run, replay);
      if (run == 0 || (runs_.size() >= kMostRuns && !runs_.contains(key))) return;
      TeamView& view =
          runs_.try_emplace(key, run, since_, options_.authenticator.keyed(), replay).first->second;
      view.receive(message, bus, transmitter, now());
    };
  }

  void note_version(const Hello& hello) {
    const bool is_agent = hello.header.incarnation != 0 && hello.header.sender >= kUnassigned;
    if (!is_agent) return;
    if (hello.version == version()) {
      other_versions_.erase(hello.host);
    } else if (other_versions_.size() < kMostOtherVersions) {
      other_versions_[hello.host] = hello.version;
    }
  }

  const StatusOptions& options_;
  Instant since_;
  std::unique_ptr<Transport> transport_;
  Views runs_;
  std::map<std::string, std::string> other_versions_;  // by host
};

int choose(const Listener& listener) {
  std::string text = "several runs are on this URL; choose one with --run-id:";
  for (const auto& [key, view] : listener.runs()) {
    const TeamPicture picture = view.picture(now());
    text += "\n  --run-id " + to_hex(key.first) + "  " + (key.second ? "replay of " : "") +
            (picture.scenario.empty() ? "a mission not received yet" : picture.scenario) + ", " +
            std::to_string(picture.agents_alive) + " agents, tick " +
            std::to_string(picture.counted);
  }
  return report_error(kExitBadInput, text);
}

/// Longer than an agent that wants to join is silent, and it may have another version.
constexpr auto kLeast = 300ms;

/// Returns when all expected messages have arrived, or after kPatience. False if a signal arrived.
bool listen_around(Listener& listener, StopSignals& signals) {
  const auto complete = [&] {
    return now() >= listener.since() + kLeast && listener.runs().size() == 1 &&
           listener.runs().begin()->second.complete();
  };
  while (now() < listener.since() + kPatience && !complete()) {
    listener.listen(now() + kTurn, signals.fd());
    if (signals.take() > 0) return false;
  }
  return true;
}

int once(const StatusOptions& options, Listener& listener, StopSignals& signals) {
  if (!listen_around(listener, signals)) return kExitDone;
  if (listener.runs().empty())
    return report_error(kExitFailed, why_nobody(options, listener.transport()));
  if (listener.runs().size() > 1) return choose(listener);
  const TeamPicture picture = listener.picture();
  TeamScreen(options.json).print(picture);
  return picture.trouble ? kExitDiffers : kExitDone;
}

int conclude_watch(const StatusOptions& options, const TeamPicture& picture, TeamScreen& screen) {
  screen.print(picture);
  const bool failed = picture.state == MissionState::kFailed;
  const std::string how = picture.reason.empty() ? "all agents have finished" : picture.reason;
  if (!options.json)
    std::printf("\nthe mission has %s: %s\n", failed ? "failed" : "ended", how.c_str());
  return failed ? kExitFailed : kExitDone;
}

/// Agents may report the end before the coordinator reports its reason.
class End {
 public:
  bool come(const TeamView& view, Instant now) {
    if (!view.over()) return false;
    if (!since_) since_ = now;
    const auto state = view.picture(now).state;
    return (state && is_over(*state)) || now - *since_ >= kLastWord;
  }

 private:
  std::optional<Instant> since_;
};

int watch(const StatusOptions& options, Listener& listener, StopSignals& signals) {
  TeamScreen screen(options.json);
  Instant next_show = now();
  End end;
  while (true) {
    listener.listen(std::min(next_show, now() + kTurn), signals.fd());
    if (signals.take() > 0) return kExitDone;
    if (listener.runs().size() > 1) return choose(listener);
    const TeamView* view = listener.runs().empty() ? nullptr : &listener.runs().begin()->second;
    if (view != nullptr && now() >= listener.since() + kPatience) listener.stay_with_it();
    if (view != nullptr && end.come(*view, now())) {
      return conclude_watch(options, listener.picture(), screen);
    }
    if (now() < next_show) continue;
    next_show = now() + screen.period();
    listener.follow_network();
    if (view != nullptr) screen.show(listener.picture());
    if (view == nullptr && !options.json) {
      screen.show("no message yet on " + options.url.base() + "\n");
    }
  }
}

int status(const StatusOptions& options) {
  StopSignals signals;
  Listener listener(options);
  if (const auto problem = listener.open()) return report_error(kExitUnavailable, *problem);
  return options.watch ? watch(options, listener, signals) : once(options, listener, signals);
}

}  // namespace

void add_status(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("status", "Show the state of a running team; sends nothing");
  auto options = std::make_shared<StatusOptions>();
  add_bus_options(*command, *options);
  describe_search(*command);
  command->add_flag("--watch", options->watch,
                    "Show it repeatedly, until the mission's end or Ctrl-C");
  command->add_flag("--json", options->json, "Print one JSON object; with --watch one each second");
  command->footer(
      "Exit codes: 0 all is well; 1 something is in trouble; 2 several runs are found;\n"
      "3 LCM cannot be used; 4 no team is found, or the watched mission has failed.");
  command->callback([&action, options, command] {
    action = [options, command] {
      if (const auto code = find_run(*command, *options)) return *code;
      return status(*options);
    };
  });
}

}  // namespace ergocast::cli
