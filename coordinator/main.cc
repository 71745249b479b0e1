// SPDX-License-Identifier: BSD-3-Clause
// ergocast-coordinator: runs the coordinator as a process and logs changes of the roster.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "coordinator/coordinator.h"
#include "plan/plan.h"
#include "runtime/bus/random_identity.h"
#include "runtime/process/event_loop.h"
#include "runtime/process/logging.h"
#include "runtime/process/program_options.h"
#include "runtime/process/shipped_scenarios.h"
#include "runtime/process/traffic_watch.h"
#include "scenario/parse/override_options.h"
#include "scenario/scenario.h"

namespace ergocast {
namespace {

/// Logs one line for each member that joins, falls silent, returns, leaves, is forgotten or counts
/// again.
class RosterLog {
 public:
  void look(const Coordinator& coordinator, Instant now) {
    for (const RosterEntry& entry : coordinator.roster()) {
      look_at_coverage(entry);
      const MemberState member_state = coordinator.member_state(entry, now);
      const auto [known, is_new] = seen_.try_emplace(entry.author, member_state);
      if (!is_new && known->second == member_state) continue;
      known->second = member_state;
      spdlog::log(member_state == MemberState::kAlive ? spdlog::level::info : spdlog::level::warn,
                  "agent {} ({}) is {} at tick {}", entry.author.agent,
                  to_hex(entry.author.incarnation), to_string(member_state), coordinator.tick());
    }
  }

 private:
  void look_at_coverage(const RosterEntry& entry) {
    if (forgotten_.contains(entry.author) == entry.forgotten) return;
    entry.forgotten ? void(forgotten_.insert(entry.author)) : void(forgotten_.erase(entry.author));
    spdlog::warn("coverage of agent {} ({}) {} from tick {} on", entry.author.agent,
                 to_hex(entry.author.incarnation),
                 entry.forgotten ? "is forgotten" : "counts again", entry.since_tick);
  }

  std::map<Author, MemberState> seen_;
  std::set<Author> forgotten_;
};

/// Logs one line for each host and version whose agents are refused.
class VersionMismatchLog {
 public:
  void look(const Coordinator& coordinator) {
    if (coordinator.version_mismatches().size() == seen_.size()) return;
    for (const auto& mismatch : coordinator.version_mismatches()) {
      if (!seen_.insert(mismatch).second) continue;
      const auto& [host, theirs] = mismatch;
      spdlog::warn("agent on {} runs version {}, this mission is run with {}: install {} there",
                   host, theirs, version(), version());
    }
  }

 private:
  std::set<std::pair<std::string, std::string>> seen_;
};

/// The same for kinds that the mission does not have.
class UnknownKindLog {
 public:
  void look(const Coordinator& coordinator) {
    if (coordinator.unknown_kinds().size() == seen_.size()) return;
    for (const auto& unknown : coordinator.unknown_kinds()) {
      if (!seen_.insert(unknown).second) continue;
      const auto& [host, why] = unknown;
      spdlog::warn("an agent on {} is not admitted: {}", host, why);
    }
  }

 private:
  std::set<std::pair<std::string, std::string>> seen_;
};

class MissionLog {
 public:
  void look(const Coordinator& coordinator) {
    const Mission* mission = coordinator.mission();
    if (mission != nullptr && !coordinator.looking() && !announced_) {
      announced_ = true;
      spdlog::info("run {} of scenario {}{}: quorum of {} agents", to_hex(coordinator.run()),
                   mission->name, coordinator.took_over() ? ", taken over" : "", mission->quorum);
    }
    look_at_amendments(coordinator);
    if (coordinator.state() == state_) return;
    state_ = coordinator.state();
    const std::string& reason = coordinator.reason();
    if (coordinator.left()) return spdlog::error("{}", reason);
    spdlog::log(state_ == MissionState::kFailed ? spdlog::level::err : spdlog::level::info,
                "mission {} at tick {}{}{}", to_string(state_), coordinator.tick(),
                reason.empty() ? "" : ": ", reason);
  }

 private:
  void look_at_amendments(const Coordinator& coordinator) {
    for (const Amendment& one : coordinator.amendments().recent) {
      if (one.number < logged_amendments_) continue;
      if (one.kind == AmendmentKind::kZone) {
        log_zone(one, coordinator.amendments().zones);
      } else if (one.kind == AmendmentKind::kReopen) {
        spdlog::info("the zone of amendment {} is cancelled: it ends at tick {} (amendment {})",
                     one.hash, one.from, named_text(one));
      } else if (const SearchNote* note = note_of(one, coordinator.amendments().notes)) {
        spdlog::info("{} from tick {} on (amendment {})", to_text(*note), one.from,
                     named_text(one));
      } else {
        spdlog::info("mission {} from tick {} on (amendment {})", effect_of(one.kind), one.from,
                     named_text(one));
      }
    }
    logged_amendments_ = coordinator.amendments().named;
  }

  /// A coordinator that has taken over may not know an older zone.
  static void log_zone(const Amendment& amendment, std::span<const Zone> zones) {
    const auto zone = std::ranges::find(zones, amendment.number, &Zone::number);
    if (zone == zones.end())
      return spdlog::info("zone {} has ended (amendment {})", to_hex(amendment.hash),
                          named_text(amendment));
    spdlog::info(
        "vehicles leave zone {} from tick {} on, and keep out from tick {} to tick {} (amendment "
        "{})",
        to_hex(amendment.hash), zone->closed, zone->from, zone->end(), named_text(amendment));
  }

  /// Null if the amendment is no sighting and no dismissal.
  static const SearchNote* note_of(const Amendment& one, std::span<const SearchNote> notes) {
    const auto note = std::ranges::find(notes, one.number, &SearchNote::number);
    return note == notes.end() ? nullptr : &*note;
  }

  /// "3, by anna@base"
  static std::string named_text(const Amendment& amendment) {
    return std::to_string(amendment.number) + (amendment.by.empty() ? "" : ", by " + amendment.by);
  }

  MissionState state_ = MissionState::kWaiting;
  static const char* effect_of(AmendmentKind kind) {
    constexpr const char* kEffects[] = {
        "is paused",       "counts", "has another target", "has another end", "",
        "has another law", "",       "forgets a contact"};
    return kEffects[static_cast<int>(kind)];
  }

  std::int32_t logged_amendments_ = 0;
  bool announced_ = false;
};

int run(const NodeOptions& node, std::vector<std::byte> plan, Takeover takeover) {
  if (const auto mission = decode_plan(plan); mission && !plan.empty()) {
    if (const auto problem = why_key_is_needed(*mission, node.authenticator)) {
      spdlog::error("{}", *problem);
      return kExitBadInput;
    }
  }
  StopSignals signals;
  Coordinator coordinator({node.run, random_identity(), host_name(), version()}, std::move(plan),
                          takeover);
  const auto connected = connect(coordinator, node);
  if (!connected) return kExitUnavailable;
  Transport& transport = *connected;
  TrafficWatch watch(transport);
  if (takeover != Takeover::kNever) spdlog::info("looking for a mission on {}", node.url.base());

  RosterLog roster;
  VersionMismatchLog version_mismatches;
  UnknownKindLog unknown_kinds;
  MissionLog mission;
  const auto stop = [&] { coordinator.end(false, "a signal stopped the coordinator", now()); };
  run_core(coordinator, transport, signals, stop, [&] {
    transport.set_run(coordinator.run());
    if (const Mission* flown = coordinator.mission()) {
      transport.limit_agents(rate_budget_of(*flown, coordinator.roster().size()),
                             coordinator.tick());
    }
    watch.look(now(), coordinator.late_commands());
    roster.look(coordinator, now());
    version_mismatches.look(coordinator);
    unknown_kinds.look(coordinator);
    mission.look(coordinator);
  });
  return coordinator.state() == MissionState::kFailed ? kExitFailed : kExitDone;
}

/// With a run id the coordinator starts that run. Otherwise the mission may already be under way.
Takeover takeover_of(const NodeOptions& node, bool resume) {
  if (resume) return Takeover::kMust;
  return node.run != 0 ? Takeover::kNever : Takeover::kIfRunning;
}

}  // namespace
}  // namespace ergocast

int main(int argc, char** argv) {
  using namespace ergocast;
  CLI::App app("The coordinator: admits agents, sends them the mission, starts and ends it.",
               "ergocast-coordinator");
  NodeOptions node;
  std::string file;
  bool resume = false;
  add_node_options(app, node);
  auto* scenario =
      app.add_option("SCENARIO", file,
                     "Scenario file, or the name of a shipped one; not needed with --resume")
          ->transform(shipped_scenario())
          ->type_name("FILE");
  std::vector<std::byte> plan;
  add_plan_option(app, plan)->excludes(scenario);
  Overrides overrides;
  add_override_options(app, overrides);
  app.add_flag("--resume", resume,
               "Take over the mission of the agents, also from a running coordinator, or fail");
  app.footer(
      "Without --run-id and --resume: takes over this scenario's mission if it runs on the URL "
      "without a coordinator, else starts a new one.\n"
      "Exit codes: 0 done; 2 bad scenario or arguments; 3 LCM cannot be used on this machine; 4 "
      "the mission failed, another coordinator leads a mission on the URL, or there is none to "
      "take over.");
  if (const int code = parse_command_line(app, argc, argv); code >= 0) return code;
  set_up_logging("coordinator", node.log_level);
  if (!node.authenticator.can_sign()) {
    spdlog::error("{}", cannot_sign(node.key_file));
    return kExitBadInput;
  }
  if (scenario->count() == 0) {
    if (resume || !plan.empty()) return run(node, std::move(plan), takeover_of(node, resume));
    spdlog::error("no SCENARIO: name a scenario file, or take a mission over with --resume");
    return kExitBadInput;
  }
  const auto loaded = Scenario::load(file, overrides);
  if (!loaded) {
    for (const Problem& problem : loaded.error()) spdlog::error("{}", to_string(problem));
    return kExitBadInput;
  }
  return run(node, encode_plan(loaded->mission()), takeover_of(node, resume));
}
