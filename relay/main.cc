// SPDX-License-Identifier: BSD-3-Clause
// ergocast-relay: a site of a team beyond one network, or the hub of such sites.
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "relay/endpoint.h"
#include "relay/hub.h"
#include "relay/local_group.h"
#include "relay/site.h"
#include "runtime/bus/clock.h"
#include "runtime/bus/random_identity.h"
#include "runtime/process/logging.h"
#include "runtime/process/program_options.h"
#include "runtime/process/signals.h"

namespace ergocast::relay {
namespace {

/// Limit (Network): datagrams of a bus, and packets, that a relay reads in a turn. Beyond it: the
/// next turn reads on.
constexpr std::size_t kMostPerTurn = 256;
constexpr std::chrono::seconds kReportPeriod(60), kLookPeriod(1), kWaitingPeriod(10);

struct Options {
  LcmUrl url;
  MessageAuthenticator authenticator;
  std::vector<HostAndPort> to;
  std::optional<HostAndPort> listen;
  bool hub = false, insecure = false;
  std::int64_t most_kbit_per_s = 0;
  std::string log_level = "info";

  std::int64_t most_bytes_per_s() const { return most_kbit_per_s * 1000 / 8; }
};

/// The sockets and the time around a participant.
class Process {
 public:
  /// @param group  null for a hub without a site of its own
  Process(StopSignals& signals, Endpoint endpoint, std::unique_ptr<LocalGroup> group)
      : signals_(signals), endpoint_(std::move(endpoint)), group_(std::move(group)) {}

  /// Runs until a signal arrives. A participant has take_local(), receive(), advance(),
  /// next_wakeup() and counts().
  /// @param each_turn  called in every turn
  void run(auto& participant, int more_fd, const std::function<void(Instant)>& each_turn);

 private:
  void wait(Instant until, int more_fd) const;
  void send(Outbox& out);
  void read(auto& participant, Outbox& out);

  StopSignals& signals_;
  Endpoint endpoint_;
  std::unique_ptr<LocalGroup> group_;
  std::vector<std::byte> space_;
};

void Process::wait(Instant until, int more_fd) const {
  std::vector<pollfd> ready{{signals_.fd(), POLLIN, 0}, {endpoint_.fd(), POLLIN, 0}};
  if (more_fd >= 0) ready.push_back({more_fd, POLLIN, 0});
  if (group_) {
    for (const int fd : group_->fds()) ready.push_back({fd, POLLIN, 0});
  }
  constexpr std::chrono::nanoseconds kLongestWait(999'999'999);
  const std::chrono::nanoseconds left = until - now();
  const timespec timeout{0, static_cast<long>(std::clamp(left, {}, kLongestWait).count())};
  ppoll(ready.data(), ready.size(), &timeout, nullptr);
}

void Process::send(Outbox& out) {
  for (const Packet& packet : out.packets) endpoint_.send(packet);
  if (group_) {
    for (const GroupDatagram& datagram : out.group) group_->send(datagram);
  }
  out.packets.clear();
  out.group.clear();
}

void Process::read(auto& participant, Outbox& out) {
  if (group_) {
    group_->receive(kMostPerTurn, [&](Bus bus, std::span<const std::byte> datagram) {
      participant.take_local(bus, datagram, now());
    });
  }
  for (std::size_t i = 0; i < kMostPerTurn; ++i) {
    const auto packet = endpoint_.receive(space_);
    if (!packet) break;
    participant.receive(packet->bytes, packet->from, now(), out);
  }
}

void Process::run(auto& participant, int more_fd, const std::function<void(Instant)>& each_turn) {
  Outbox out;
  Instant next_report = now() + kReportPeriod, next_look = now();
  while (signals_.take() == 0) {
    read(participant, out);
    each_turn(now());
    participant.advance(now(), out);
    send(out);
    if (now() >= next_look) {
      next_look = now() + kLookPeriod;
      if (group_ && group_->renew_membership())
        spdlog::warn("listening on another network interface from now on");
    }
    if (now() >= next_report) {
      next_report = now() + kReportPeriod;
      spdlog::info("{}", to_text(participant.counts()));
    }
    wait(std::min({participant.next_wakeup(), next_look, next_report}), more_fd);
  }
  if constexpr (requires { participant.leave(out); }) {
    participant.leave(out);
    send(out);
  }
  spdlog::info("{}", to_text(participant.counts()));
}

int refuse(ExitCode code, const std::string& problem) {
  spdlog::error("{}", problem);
  return code;
}

/// Logs each change of the hub that the site has joined.
class JoinedLog {
 public:
  explicit JoinedLog(const Options& options) : options_(options) {}
  void look(const Site& site, Instant now) {
    if (site.joined() == logged_ && (logged_ || now < next_)) return;
    next_ = now + kWaitingPeriod;
    if (site.joined()) {
      spdlog::info("joined the hub {} at {}", relay::to_text(options_.to[*site.joined()]),
                   relay::to_text(site.flow()->hub()));
    } else if (logged_) {
      spdlog::warn("cut off from the hub: this site goes on alone");
    } else if (begun_) {
      spdlog::warn(
          "no hub answers: none of {} runs, can be reached by UDP, and has this team's key",
          options_.to.size() == 1 ? relay::to_text(options_.to[0])
                                  : std::to_string(options_.to.size()) + " hubs");
    }
    begun_ = true;
    logged_ = site.joined();
  }

 private:
  const Options& options_;
  std::optional<std::size_t> logged_;
  bool begun_ = false;
  Instant next_{};
};

int run_site(const Options& options, std::unique_ptr<LocalGroup> group) {
  auto endpoint = Endpoint::open(std::nullopt);
  if (!endpoint) return refuse(kExitUnavailable, endpoint.error());
  Site site({.hubs = options.to.size(),
             .most_bytes_per_s = options.most_bytes_per_s(),
             .others = options.insecure},
            options.authenticator, random_identity());
  StopSignals signals;  // before the resolver's thread
  Resolver resolver;
  JoinedLog log(options);
  bool asked = false;
  Process process(signals, *std::move(endpoint), std::move(group));
  process.run(site, resolver.fd(), [&](Instant at) {
    if (auto answer = resolver.take(); answer && asked) {
      asked = false;
      if (!*answer) spdlog::warn("{}", answer->error());
      site.found(answer->value_or(std::vector<Address>()), at);
    }
    if (site.wanted_hub() && !asked) {
      asked = true;
      resolver.ask(options.to[*site.wanted_hub()]);
    }
    log.look(site, at);
  });
  return kExitDone;
}

int run_hub(const Options& options, std::unique_ptr<LocalGroup> group) {
  const auto addresses = look_up(*options.listen);
  if (!addresses) return refuse(kExitUnavailable, addresses.error());
  auto endpoint = Endpoint::open(addresses->front());
  if (!endpoint) return refuse(kExitUnavailable, endpoint.error());
  Hub::Settings settings{.has_group = group != nullptr,
                         .most_bytes_per_s = options.most_bytes_per_s(),
                         .others = options.insecure,
                         .secret = {}};
  while (getrandom(settings.secret.data(), settings.secret.size(), 0) < 0) continue;
  Hub hub(settings, options.authenticator);
  spdlog::info("sites may join at UDP {}", to_text(addresses->front()));
  std::size_t sites = 0;
  StopSignals signals;
  Process process(signals, *std::move(endpoint), std::move(group));
  process.run(hub, -1, [&](Instant) {
    if (hub.sites() == sites) return;
    sites = hub.sites();
    spdlog::info("{} joined", sites == 1 ? "1 site has" : std::to_string(sites) + " sites have");
  });
  return kExitDone;
}

std::optional<std::string> problem_of(const Options& options) {
  if (options.to.empty() == !options.listen.has_value()) {
    return "name either a hub to join, --to HOST:PORT, or --listen HOST:PORT, where others join";
  }
  if (options.hub && !options.listen) return "--hub needs --listen HOST:PORT, where sites join";
  if (options.authenticator.keyed() && options.insecure) {
    return "--insecure is for a team without a key; leave it out";
  }
  if (!options.authenticator.keyed() && !options.insecure) {
    return "without a key anybody on the internet can steer the team through a relay: name the "
           "team's --key-file, or add --insecure if no stranger reaches the relays";
  }
  return std::nullopt;
}

int run(const Options& options) {
  if (const auto problem = problem_of(options)) return refuse(kExitBadInput, *problem);
  std::unique_ptr<LocalGroup> group;
  if (!options.hub) {
    auto opened = LocalGroup::open(options.url, options.insecure);
    if (!opened) return refuse(kExitUnavailable, opened.error());
    group = std::make_unique<LocalGroup>(*std::move(opened));
  }
  return options.listen ? run_hub(options, std::move(group)) : run_site(options, std::move(group));
}

/// The place that an option names.
HostAndPort place_of(const std::string& option, Result<HostAndPort> place) {
  if (!place) throw CLI::ValidationError(option, place.error());
  return *std::move(place);
}

void add_place_options(CLI::App& app, Options& options) {
  app.add_option_function<std::vector<std::string>>(
         "--to",
         [&options](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) {
             options.to.push_back(place_of("--to", HostAndPort::parse_hub(text)));
           }
         },
         "The hub or peer to join; give several in the order of preference")
      ->type_name("HOST:PORT");
  app.add_option_function<std::string>(
         "--listen",
         [&options](const std::string& text) {
           options.listen = place_of("--listen", HostAndPort::parse(text));
         },
         "Let sites join here; :PORT takes every address of this host")
      ->type_name("HOST:PORT");
}

}  // namespace
}  // namespace ergocast::relay

int main(int argc, char** argv) {
  using namespace ergocast;
  CLI::App app(
      "A relay: joins sites of a team over the internet. At each site it carries the messages of "
      "the local LCM group over one UDP flow to a hub, which passes them on to the other sites.",
      "ergocast-relay");
  relay::Options options;
  relay::add_place_options(app, options);
  app.add_flag("--hub", options.hub, "With --listen: only a hub, without a local LCM group");
  app.add_option("--max-rate", options.most_kbit_per_s,
                 "Most that a site sends and receives, in each direction, or a hub sends to each "
                 "site; newer messages then replace older ones (default: no limit)")
      ->check(CLI::Range(8, 10000000))
      ->type_name("KBIT/S");
  app.add_flag("--insecure", options.insecure,
               "Carry the messages of a team without a key, and all other messages of LCM");
  add_url_option(app, options.url);
  add_key_option(app, options.authenticator);
  app.add_option("--log-level", options.log_level, "Least severity of the lines in the log")
      ->capture_default_str()
      ->envname("ERGOCAST_LOG_LEVEL")
      ->check(CLI::IsMember(kLogLevels))
      ->type_name("LEVEL");
  app.set_version_flag("--version", version_text());
  app.footer(
      "Exit codes: 0 done; 2 bad arguments; 3 LCM, the port or its host cannot be used here.");
  if (const int code = parse_command_line(app, argc, argv); code >= 0) return code;
  set_up_logging("relay", options.log_level);
  return relay::run(options);
}
