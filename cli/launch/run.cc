// SPDX-License-Identifier: BSD-3-Clause
// `ergocast run`: prepares the run directory and the key, starts all processes, watches the
// mission, and completes the summary.
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <future>
#include <memory>
#include <span>
#include <utility>

#include "cli/commands.h"
#include "cli/launch/launcher.h"
#include "cli/launch/mission_watch.h"
#include "cli/mission_options.h"
#include "cli/operate/controlled_page.h"
#include "cli/operate/live_displays.h"
#include "cli/record/run_directory.h"
#include "cli/report_error.h"
#include "cli/watch/progress.h"
#include "cli/watch/run_registry.h"
#include "cli/watch/serve_page.h"
#include "core/mission/sites.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "modes/table_file.h"
#include "plan/mission_limits.h"
#include "plan/plan.h"
#include "runtime/bus/clock.h"
#include "runtime/bus/random_identity.h"
#include "runtime/bus/transport.h"
#include "runtime/process/key_file.h"
#include "runtime/process/program_options.h"
#include "runtime/process/sealed_file.h"
#include "runtime/process/signals.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

struct RunOptions : MissionOptions {
  std::optional<LcmUrl> url;  ///< nothing: this host only, on ports that the run reserves
  MessageAuthenticator authenticator;
  std::string key_file;  ///< the file of the key in `authenticator`; empty: none
  std::int64_t event_log_mib = kEventLogMib;
  bool event_log_zstd = false;
  fs::path world;                            ///< empty: ergocast-sim
  std::vector<std::string> world_arguments;  ///< of that program
  bool watch = false;                        ///< serves a page
  bool control = false;                      ///< on which operators give orders
  PageOptions page;
  DisplayOptions displays;  ///< of other programs, which the page's process serves
};

constexpr auto kNoteAfter = 500ms;
constexpr auto kAttendPeriod = 50ms, kAttendPeriodAtEnd = 5ms;

/// Returns when all processes have ended.
/// @param page  may be null
void supervise(Launcher& launcher, MissionWatch& mission, Transport& transport,
               ControlledPage* page, StopSignals& signals, ProgressDisplay& display) {
  int asked = 0;
  while (!launcher.all_ended()) {
    const bool over = mission.stage() == Stage::kOver;
    transport.deliver_until(now() + (over ? kAttendPeriodAtEnd : kAttendPeriod), signals.fd());
    if (const int count = signals.take(); count > 0) {
      asked += count;
      if (asked == 1)
        display.print("ending the mission in order; a second Ctrl-C or SIGTERM ends it at once");
      if (asked == 2) launcher.escalate(1);
      if (asked > 2) launcher.escalate(2);
      mission.stop(false, "Ctrl-C or SIGTERM");
    }
    if (mission.stopping()) launcher.expect_end(now());
    for (const AgentId id : mission.sent_out()) launcher.expect_departure(id);
    launcher.attend(now(), mission.stage());
    if (page != nullptr) page->attend(now());
    // Without a coordinator no other process detects an overdue tick.
    if (const auto overdue = mission.overdue(now()); overdue && launcher.leaderless()) {
      launcher.fail(*overdue + ", and no coordinator is left to end the mission");
    }
    if (mission.deserted(now()) && launcher.leaderless()) {
      launcher.fail("no agent runs any more, and no coordinator is left to admit one");
    }
    if (launcher.failure()) mission.stop(true, *launcher.failure());
    mission.repeat(transport, now(), launcher.led());
    mission.answer(transport, now());
  }
  launcher.attend(now(), mission.stage());
}

/// The summary of a run whose logger left none.
nlohmann::ordered_json makeshift_summary(const Scenario& scenario, RunId run) {
  const Timing& timing = scenario.mission().timing;
  return {{"run_id", to_hex(run)},
          {"result", "failed"},
          {"reason", "the logger left no summary"},
          {"version", version()},
          {"build", build_text()},
          {"scenario", scenario.name()},
          {"scenario_hash", plan_hash(encode_plan(scenario.mission()))},
          {"seed", scenario.mission().seed},
          {"mode", timing.pace == Pace::kLockstep ? "lockstep" : "realtime"},
          {"dt_s", timing.dt_s},
          {"tick_count", timing.tick_count}};
}

/// The summary that this run's logger has written. Any other file of that name does not count.
std::optional<nlohmann::ordered_json> loggers_summary(const Launcher::Setup& setup) {
  auto read = read_summary(setup.run_dir);
  if (!read || !read->is_object()) return std::nullopt;
  for (const char* key : {"run_id", "result", "reason"}) {
    if (!read->contains(key) || !(*read)[key].is_string()) return std::nullopt;
  }
  if ((*read)["run_id"] != to_hex(setup.run)) return std::nullopt;
  return *std::move(read);
}

/// The logger's summary with the values that only the launcher knows.
nlohmann::ordered_json amended_summary(const Scenario& scenario, const Launcher::Setup& setup,
                                       const Launcher& launcher, const MissionWatch& mission) {
  const auto written = loggers_summary(setup);
  auto summary = written ? *written : makeshift_summary(scenario, setup.run);
  const auto fail = [&summary](const std::string& reason) {
    summary["result"] = "failed";
    summary["reason"] = reason;
  };
  const bool complete = mission.complete() && !mission.failed() && !mission.stopping();
  const bool cut_short = complete && (!written || summary["result"] == "stopped");
  if (cut_short) {
    const char* why = launcher.record_broken() ? "" : ": the logger fell behind";
    fail(std::string("the mission is complete, but its record is not") + why);
  }
  if (launcher.failure()) fail(*launcher.failure());
  if (mission.failed()) fail(mission.reason());
  summary["reason"] = summary.value("reason", "") + launcher.losses();
  summary["authenticated"] = !setup.key_file.empty();
  summary["restarts"] = launcher.restarts();
  summary["record_complete"] = !launcher.record_broken() && !cut_short;
  auto processes = nlohmann::ordered_json::array();
  for (const ProcessFate& process : launcher.fates()) {
    processes.push_back(
        {{"name", process.name}, {"restarts", process.restarts}, {"end", process.fate}});
  }
  summary["processes"] = std::move(processes);
  return summary;
}

void announce(const Launcher::Setup& setup, const Scenario& scenario, ProgressDisplay& display) {
  display.print("run " + to_hex(setup.run) + " of " + scenario.name() + " into " +
                setup.run_dir.string());
  display.print("  swarm    " + setup.url.of(Bus::kSwarm));
  display.print("  world    " + setup.url.of(Bus::kWorld));
  display.print("  command  " + setup.url.of(Bus::kCommand));
  display.print("  key      " +
                (setup.key_file.empty() ? "none: unauthenticated" : setup.key_file.string()));
}

/// The registry's entry of this run, for other commands of this user.
LiveRun live_run(const Launcher::Setup& setup, const Scenario& scenario) {
  return {.run = setup.run,
          .scenario = scenario.name(),
          .version = version(),
          .started = wall_clock_text(),
          .url = setup.url,
          .run_dir = fs::absolute(setup.run_dir),
          .key_file = setup.key_file,
          .pid = getpid()};
}

/// The page of the mission, if it is wanted. If it cannot be served, prints why and returns the
/// exit code.
Result<std::unique_ptr<ControlledPage>, int> begin_page(const RunOptions& options,
                                                        const Launcher::Setup& setup,
                                                        ProgressDisplay& display) {
  if (!options.watch) return std::unique_ptr<ControlledPage>();
  const BusOptions team{setup.url, setup.run, options.authenticator, options.key_file};
  auto displays = LiveDisplays::open(options.displays, options.page, setup.run_dir);
  if (!displays) return failure(displays.error());
  auto started = ControlledPage::start(team, setup.run_dir, options.page, options.control,
                                       (*displays)->handed(), display);
  if (!started) return failure(report_error(kExitUnavailable, started.error()));
  PageProcess& page = (*started)->page();
  display.print("  page     " + page.url());
  if (const std::string url = (*displays)->foxglove_url(); !url.empty())
    display.print("  foxglove " + url);
  display.also_to([&page](const std::string& line) { page.print(line); });
  return *std::move(started);
}

/// Shows the record on the page until Ctrl-C.
void show_record(PageProcess& page, StopSignals& signals) {
  constexpr int kAttend_ms = 100;
  page.finish();
  std::printf("  page      %s, until Ctrl-C\n", page.url().c_str());
  std::fflush(stdout);
  for (pollfd stop{signals.fd(), POLLIN, 0}; poll(&stop, 1, kAttend_ms) <= 0;) page.attend(now());
}

/// The program that replaces the world; an error if it does not exist.
Result<fs::path> world_program(const fs::path& wanted, const fs::path& programs) {
  if (wanted.empty()) return programs / "ergocast-sim";
  const fs::path program = wanted.has_parent_path() ? fs::absolute(wanted) : programs / wanted;
  if (access(program.c_str(), X_OK) == 0 && fs::is_regular_file(program)) return program;
  return failure("--world " + wanted.string() + ": there is no program " + program.string() +
                 " (name one that takes --lcm-url and --run-id, with its folder)");
}

/// Makes the sealed files that the processes inherit, from the data in this process. An error if
/// memory is missing.
/// @pre options.authenticator can sign
std::optional<std::string> seal_files(const RunOptions& options, const Mission& mission,
                                      Launcher::Setup& setup) {
  std::optional<std::string> problem;
  const auto keep = [&problem](const std::string& name, std::span<const std::byte> bytes,
                               std::optional<SealedFile>& file) {
    auto made = SealedFile::make(name, bytes);
    if (made) file = *made;
    if (!made) problem = made.error();
  };
  keep(kPlanFile, encode_plan(mission), setup.plan);
  if (const auto& table = mission.basis.table)
    keep(table_file_name(table->hash), table->file, setup.modes);
  if (const MissionKey* key = options.authenticator.key()) {
    const std::string text = key_text(*key, true);
    keep("key", std::as_bytes(std::span(text)), setup.key);
  }
  return problem;
}

/// Runs the mission. LCM works and the run directory is ready.
/// @param entry  of the registry, from before there was a mission; may be null
int run_mission(const RunOptions& options, const Scenario& scenario, const Launcher::Setup& setup,
                std::unique_ptr<RunEntry> entry, StopSignals& signals) {
  const MessageAuthenticator& authenticator = options.authenticator;
  ProgressDisplay display;
  MissionWatch mission(setup.run, scenario.mission().timing, display,
                       scenario.mission().basis.free_domain);
  const auto transport = Transport::open(
      setup.url, setup.run, authenticator, subscriptions_of(MissionWatch::kRole),
      {.on_message = [&mission](const Message& message, Bus bus, AgentId transmitter) {
        mission.receive(message, bus, transmitter, now());
      }});
  if (!transport) return report_error(kExitUnavailable, transport.error());
  announce(setup, scenario, display);
  const auto watching = begin_page(options, setup, display);
  if (!watching) return watching.error();
  ControlledPage* const page = watching->get();
  if (page != nullptr) page->page().wait_until_it_listens(signals.fd());
  entry.reset();
  auto registered = RunEntry::write(live_run(setup, scenario));
  if (!registered) {
    display.print("warning: " + registered.error() + "; give the other commands --lcm-url");
  }
  Launcher launcher(setup, display);
  if (const auto problem = launcher.start()) {
    launcher.escalate(2);
    return report_error(kExitFailed, *problem);
  }
  supervise(launcher, mission, **transport, page, signals, display);
  if (registered) registered->reset();
  if (page != nullptr) page->end_control(now());  // the report may take longer than a page waits
  display.end();

  const auto summary = amended_summary(scenario, setup, launcher, mission);
  const auto unwritten = write_file(setup.run_dir / kSummaryFile, to_text(summary));
  conclude(setup.run_dir, summary, scenario);
  if (page != nullptr) show_record(page->page(), signals);
  if (unwritten) return report_error(kExitFailed, *unwritten);
  return summary.value("result", "") == "failed" || launcher.record_broken() ? kExitFailed
                                                                             : kExitDone;
}

/// Registers this run before its scenario is read, so that other commands can show and end it. Null
/// if that is not possible, which is reported when the mission begins.
std::unique_ptr<RunEntry> register_early(const RunOptions& options, RunId run) {
  const std::string name = options.scenario.stem();
  LiveRun preparing;
  preparing.run = run;
  preparing.scenario = is_name(name) ? name : "scenario";
  preparing.version = version();
  preparing.started = wall_clock_text();
  preparing.pid = getpid();
  preparing.preparing = true;
  return RunEntry::write(preparing).value_or(nullptr);
}

/// Reads the scenario; if that takes long, a line says why nothing happens.
std::optional<Scenario> load_with_a_note(const RunOptions& options) {
  auto loading =
      std::async(std::launch::async, load_or_complain, options.scenario, options.overrides);
  if (loading.wait_for(kNoteAfter) == std::future_status::timeout)
    print_message("reading " + options.scenario.string() +
                  ": the modes of a free domain, or large maps, take some seconds");
  return loading.get();
}

int run(const RunOptions& options) {
  Launcher::Setup setup;
  setup.run = random_identity();
  auto entry = register_early(options, setup.run);
  const auto scenario = load_with_a_note(options);
  if (!scenario) return kExitBadInput;
  if (scenario->mission().sites.any()) return report_error(kExitBadInput, kSitesAreSimulated);
  if (!options.authenticator.can_sign())
    return report_error(kExitBadInput, cannot_sign(options.key_file));
  if (const auto problem = why_key_is_needed(scenario->mission(), options.authenticator))
    return report_error(kExitBadInput, *problem);
  StopSignals signals;
  setup.programs = fs::read_symlink("/proc/self/exe").parent_path();
  const auto world = world_program(options.world, setup.programs);
  if (!world) return report_error(kExitBadInput, world.error());
  setup.world = *world;
  setup.world_arguments = options.world_arguments;
  setup.agents = static_cast<int>(scenario->mission().starts_m.size());
  for (const AgentKind& kind : scenario->mission().kinds)
    setup.kinds.insert(setup.kinds.end(), static_cast<std::size_t>(kind.count), kind.name);
  if (!options.key_file.empty()) setup.key_file = fs::absolute(options.key_file);
  setup.event_log_mib = options.event_log_mib;
  setup.event_log_zstd = options.event_log_zstd;
  setup.url = options.url.value_or(LcmUrl{});
  if (const auto problem = why_unreachable(setup.url))
    return report_error(kExitUnavailable, *problem);
  const auto ports = options.url ? std::nullopt : PortReservation::take(setup.run);
  if (!options.url) {
    if (!ports)
      return report_error(kExitUnavailable, "no free ports in 24000 to 26999; give --lcm-url");
    setup.url.base_port = ports->base_port();
  }
  const auto prepared = prepare_run_directory(options.out, *scenario);
  if (!prepared) return report_error(kExitBadInput, prepared.error());
  setup.run_dir = *prepared;
  if (const auto problem = seal_files(options, scenario->mission(), setup))
    return report_error(kExitFailed, *problem);
  return run_mission(options, *scenario, setup, std::move(entry), signals);
}

void add_run_url_option(CLI::App& command, RunOptions& options) {
  command
      .add_option_function<std::string>(
          "--lcm-url",
          [&options](const std::string& text) {
            auto parsed = LcmUrl::parse(text);
            if (!parsed) throw CLI::ValidationError("--lcm-url", parsed.error());
            options.url = *parsed;
          },
          "Base URL of the three buses (default: this host, free ports of the run's own)")
      ->type_name("URL");
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("run", "Run a mission as processes over LCM on this host");
  auto options = std::make_shared<RunOptions>();
  add_mission_options(*command, *options);
  add_run_url_option(*command, *options);
  add_key_option(*command, options->authenticator, &options->key_file);
  add_event_log_options(*command, options->event_log_mib, options->event_log_zstd);
  command
      ->add_option(
          "--world", options->world,
          "Program that replaces ergocast-sim: a driver of robots or another simulation; a "
          "name without '/' is in the folder of ergocast")
      ->type_name("PROGRAM");
  command
      ->add_option("--world-arg", options->world_arguments,
                   "Argument of that program, as in --world-arg=--robots --world-arg=quadrotors; "
                   "once for each argument")
      ->type_name("ARG")
      ->allow_extra_args(false)
      ->needs("--world");
  command->add_flag("--watch", options->watch,
                    "Show the mission in a browser, and afterwards its record, until Ctrl-C");
  add_page_options(*command, options->page);
  add_control_option(*command, options->control);
  add_display_options(*command, options->displays);
  for (const char* option : {"--port", "--listen", "--tls-cert", "--tls-key", "--control",
                             "--foxglove", "--cot", "--origin"})
    command->get_option(option)->needs("--watch");
  command->callback([&action, options] {
    action = [options]() -> int {
      if (const auto problem = read_certificate(options->page, options->control))
        return report_error(kExitBadInput, *problem);
      if (const auto problem = why_refused(options->displays, options->page))
        return report_error(kExitBadInput, *problem);
      return run(*options);
    };
  });
}

}  // namespace ergocast::cli
