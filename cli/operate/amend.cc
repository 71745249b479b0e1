// SPDX-License-Identifier: BSD-3-Clause
// `ergocast amend`: gives a running team a new target, a sighting, another end or another law,
// sends it out of a zone, dismisses a contact, cancels an amendment, or lists what has changed.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/operate/amend_options.h"
#include "cli/operate/amend_order.h"
#include "cli/operate/team_command.h"
#include "cli/record/new_law.h"
#include "cli/record/new_target.h"
#include "cli/record/sighting.h"
#include "cli/watch/find_run.h"
#include "core/motion/zones.h"
#include "plan/amendment_list.h"
#include "scenario/zone_file.h"

namespace ergocast::cli {
namespace {

/// How long `--dismiss` waits for the logger, which knows the contacts.
constexpr std::chrono::seconds kRecordPatience{10};

class Amending : public TeamCommand {
 public:
  explicit Amending(const AmendOptions& options) : TeamCommand(options), options_(options) {}

 private:
  int act() override {
    if (const auto code = choose_run()) return *code;
    if (const auto code = know_mission()) return *code;
    if (options_.list) return list();
    if (options_.end) return order_end();
    if (options_.cancel) return cancel(*options_.cancel);
    if (!options_.zone.empty()) return zone();
    if (!options_.law.empty()) return order_law();
    if (options_.sighting) return order_sighting();
    if (options_.dismissal) return dismiss();
    const auto compiled = compile();
    if (!compiled) return kExitBadInput;
    const TargetChange change = target_change_of(*compiled);
    // What has arrived meanwhile.
    if (!listen()) return interrupted();
    return order_target(wish_of(change), change);
  }

  int order_target(AmendmentWish wish, const TargetChange& change) {
    if (!options_.dry_run) return order(std::move(wish), delay());
    const auto problem = why_impossible(team(), wish, delay());
    return problem ? report_error(kExitFailed, *problem) : describe(change);
  }

  int order_sighting() {
    if (!listen()) return interrupted();
    const Mission& mission = team().mission();
    const TargetChange holds = target_now(mission, team().amendments(), team().tick());
    const auto sighted = target_with(mission, holds, *options_.sighting);
    if (!sighted) return report_error(kExitBadInput, sighted.error());
    for (const Problem& warning : sighted->warnings)
      print_message("warning: " + to_string(warning));
    return order_target(wish_of_sighting(sighted->target, sighted->sighting), sighted->target);
  }

  int dismiss() {
    const Mission& mission = team().mission();
    const Instant since = now();
    while (mission.wait_for_logger && !team().recorded() && now() - since < kRecordPatience)
      if (!listen()) return interrupted();
    auto problem = why_not_dismissed(mission, *options_.dismissal);
    if (!problem && team().recorded())
      problem = why_no_contact(mission, *options_.dismissal, *team().recorded());
    if (problem) return report_error(kExitBadInput, std::vector{*problem});
    if (team().recorded()) {
      const auto warning = why_perhaps_no_contact(mission, *options_.dismissal, *team().recorded());
      if (warning) print_message("warning: " + to_string(*warning));
    }
    return order(wish_of_dismissal(*options_.dismissal), 0);
  }

  const MonitoredRun& team() const { return runs_.begin()->second; }

  /// Waits for the mission. If there is none, prints an error and returns the exit code.
  std::optional<int> know_mission() {
    const Instant since = now();
    while (!team().is_running()) {
      const OrderReport report = waiting_for_mission(team(), now() - since);
      if (report.state == OrderReport::State::kFailed)
        return report_error(kExitFailed, report.text);
      if (!listen()) return interrupted();
    }
    return std::nullopt;
  }

  /// The new target; nothing if it has problems, which are printed.
  std::optional<Scenario> compile() const {
    const std::filesystem::path recorded = recorded_scenario();
    if (options_.target.empty() && recorded.empty()) {
      report_error(kExitBadInput,
                   "--set changes the scenario in the run's directory, and that of run " +
                       to_hex(team().run()) +
                       " is not known on this host: name a scenario with --target");
      return std::nullopt;
    }
    const auto& file = options_.target.empty() ? recorded : options_.target;
    auto loaded = load_new_target(team().mission(), file, options_.overrides, recorded);
    if (!loaded) {
      report_error(kExitBadInput, loaded.error());
      return std::nullopt;
    }
    for (const Problem& warning : loaded->warnings())
      print_message("warning: " + to_string(warning));
    return *std::move(loaded);
  }

  /// The scenario in the directory of this run; empty if this host does not know it.
  std::filesystem::path recorded_scenario() const {
    const std::vector<LiveRun> live = live_runs_named(team().run());
    if (live.empty() || live.front().run_dir.empty()) return {};
    return live.front().run_dir / "scenario.textproto";
  }

  Tick delay() const { return ticks(options_.delay_s.value_or(0)); }

  Tick ticks(double time_s) const {
    return static_cast<Tick>(std::llround(time_s / team().mission().timing.dt_s));
  }

  int order_end() {
    // What has arrived meanwhile: the places of vehicles.
    if (!listen()) return interrupted();
    const auto tick_count = options_.end->tick_count(team().mission().timing, team().tick_count());
    if (!tick_count) return report_error(kExitBadInput, "--end: " + tick_count.error());
    return order(wish_of_end(*tick_count), delay());
  }

  /// Orders what held before amendment `number`.
  int cancel(std::int32_t number) {
    const auto wish = wish_to_cancel(team(), number);
    return wish ? order(*wish, delay()) : report_error(kExitFailed, "--cancel: " + wish.error());
  }

  int order_law() {
    if (!listen()) return interrupted();
    const Mission& mission = team().mission();
    const auto law = law_with(mission, newest_law(mission, team().amendments().laws), options_.law);
    if (!law) return report_error(kExitBadInput, "--law: " + law.error());
    return options_.dry_run ? describe(*law) : order(wish_of(*law), delay());
  }

  int describe(const LawChange& law) const {
    const Amendments& list = team().amendments();
    const LawChange* const now = law_at(list.laws, team().tick());
    std::printf("no problems: law %s, %s\n", to_hex(law_hash(law)).c_str(),
                law_text(law, team().mission()).c_str());
    std::printf("now the law is %s\n",
                now == nullptr ? "as planned" : law_text(*now, team().mission()).c_str());
    print_when(delay());
    return kExitDone;
  }

  void print_when(Tick delay) const {
    std::printf("it would be amendment %d, at the earliest from %s on\n", team().amendments().named,
                team().mission_time(earliest_tick(team(), delay)).c_str());
    std::printf("nothing was sent\n");
  }

  /// A zone from the file. Prints what is wrong with it.
  int zone() {
    const Mission& mission = team().mission();
    auto loaded = load_zone(options_.zone, zone_context(mission, recorded_scenario()));
    if (!loaded) return report_error(kExitBadInput, loaded.error());
    Zone zone = *std::move(loaded);
    zone.until = std::max<Tick>(1, ticks(options_.zone_lasts_s));
    const std::vector<Zone> others = not_ended(team().amendments().zones, team().tick());
    if (const auto problem = zone_problem(mission, zone, others))
      return report_error(kExitBadInput, std::vector{Problem{options_.zone.string(), problem->what,
                                                             problem->remedy}});
    const Tick least = least_notice_ticks(mission, zone, others);
    const Tick notice = options_.delay_s ? delay() : least;
    if (notice < least && !options_.force)
      return report_error(
          kExitBadInput,
          "--at: the agents may need " + seconds_text(least, mission) +
              " to leave the zone: name a later time, leave --at out, or add --force and see "
              "which agents are inside then");
    if (!listen()) return interrupted();
    if (options_.dry_run) {
      const auto problem = why_impossible(team(), wish_of(zone), notice);
      return problem ? report_error(kExitFailed, *problem) : describe(zone, notice);
    }
    const int code = order(wish_of(zone), notice);
    return code == kExitDone ? who_is_inside(zone) : code;
  }

  /// Prints which agents are still in the zone.
  int who_is_inside(const Zone& zone) const {
    const std::string inside = inside_text(team(), zone);
    if (inside.empty()) {
      std::printf("nobody is in it\n");
      return kExitDone;
    }
    return report_error(kExitFailed, inside);
  }

  int describe(const Zone& zone, Tick notice) const {
    const Mission& mission = team().mission();
    const std::string inside = inside_text(team(), zone);
    std::printf("no problems: zone %s, %zu corners, for %s of the world's time\n",
                to_hex(zone_hash(zone)).c_str(), zone.corners_m.size(),
                seconds_text(zone.until, mission).c_str());
    std::printf("now %s\n", inside.empty() ? "nobody is in it" : inside.c_str());
    std::printf(
        "it would be amendment %d, closed at the earliest from %s on, and free %s of the "
        "world's time later\n",
        team().amendments().named, team().mission_time(earliest_tick(team(), 0)).c_str(),
        seconds_text(notice, mission).c_str());
    std::printf("nothing was sent\n");
    return kExitDone;
  }

  /// Repeats an order until it is obeyed.
  int order(AmendmentWish wish, Tick delay) {
    const std::string by =
        options_.by.empty() ? own_operator_name() : operator_name_of(options_.by);
    AmendOrder order(std::move(wish), delay, now(), by);
    const auto report = obeyed(order);
    if (!report) return interrupted();
    if (report->state == OrderReport::State::kFailed)
      return report_error(kExitFailed, report->text);
    std::printf("%s\n", report->text.c_str());
    return kExitDone;
  }

  /// Prints what the target would change.
  int describe(const TargetChange& change) const {
    const Amendments& list = team().amendments();
    const double differs = share_that_differs(
        team().mission(), target_now(team().mission(), list, team().tick()), change);
    std::printf("no problems: target %s, %lld modes, %zu bytes\n",
                to_hex(target_hash(change)).c_str(), static_cast<long long>(change.target.size()),
                encode_target(change).size());
    std::printf("about %.0f %% of its mass is elsewhere than in the target that holds now\n",
                100 * differs);
    print_when(delay());
    return kExitDone;
  }

  int list() const {
    const Amendments& list = team().amendments();
    if (list.named == 0) std::printf("no amendments: the mission is as its plan has it\n");
    const auto hidden = list.named - static_cast<std::int32_t>(list.recent.size());
    if (hidden > 0) std::printf("%d older amendments are not listed\n", hidden);
    for (const Amendment& one : list.recent)
      std::printf("%s%s\n", amendment_text(team(), one).c_str(),
                  wish_to_cancel(team(), one.number) ? " (--cancel undoes it)" : "");
    return kExitDone;
  }

  const AmendOptions& options_;
};

}  // namespace

void add_amend(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("amend",
                                     "Give a running team a new target, a sighting, another end or "
                                     "speed, or send it out of a zone");
  auto options = std::make_shared<AmendOptions>();
  add_amend_options(*command, *options);
  add_bus_options(*command, *options);
  describe_search(*command);
  command->footer(
      "From a tick that the coordinator names, all agents cover the new target. What they covered\n"
      "before counts against the target of its time. A zone is closed at once: nobody enters it.\n"
      "An agent inside leaves it by the shortest way, until nobody is inside at the named tick.\n"
      "A later end must be named 10 s of mission time before the end that holds; an earlier one\n"
      "is possible if each agent can be at its station in time.\n"
      "Another law binds only agents that cover: they go home and leave zones as fast as planned.\n"
      "Exit codes: 0 it holds, or nobody is in the zone; 2 an option, the target, the zone or the\n"
      "law has problems, or several runs are found; 3 LCM cannot be used; 4 no team is found, the\n"
      "mission as it is now cannot get this amendment, the team was not seen to obey, another\n"
      "amendment took its place, or agents are in the zone.");
  command->callback([&action, options, command] {
    if (names_nothing(*options))
      throw CLI::RequiredError(
          "--target, --set, --zone, --law, --sighting, --dismiss, --end, --cancel or --list");
    action = [options, command] {
      if (const auto code = find_run(*command, *options)) return *code;
      return Amending(*options).carry_out();
    };
  });
}

}  // namespace ergocast::cli
