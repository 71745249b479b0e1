// SPDX-License-Identifier: BSD-3-Clause
// ergocast-logger: records a run as a process. It listens on all three buses and only sends
// acknowledgements.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>
#include <vector>

#include "logger/amendments_file.h"
#include "logger/mission_text.h"
#include "logger/recorder.h"
#include "logger/run_data.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "modes/table_file.h"
#include "plan/plan.h"
#include "runtime/bus/random_identity.h"
#include "runtime/process/event_loop.h"
#include "runtime/process/logging.h"
#include "runtime/process/program_options.h"
#include "runtime/process/traffic_watch.h"
#include "runtime/record/event_log.h"
#include "text/input_file.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

/// Whether the event log keeps a message: MISSION and STOP on the command bus only repeat another
/// bus.
bool is_original(Bus bus, std::string_view channel) {
  return bus != Bus::kCommand || !(channel.ends_with("_MISSION") || channel.ends_with("_STOP"));
}

/// The data that a former process left in the run directory.
struct Past {
  RunData rows;
  std::vector<std::byte> plan;  ///< empty: not known
};

/// The readable rows of the record. An error if the mission of the record is unknown.
/// @param plan  of the record, in place of the folder's; empty: the folder's
Result<Past> read_past(const fs::path& folder, std::vector<std::byte> plan) {
  Past past;
  past.plan = std::move(plan);
  if (segment_count(folder) == 0) return past;
  const auto damage = read_up_to_damage(folder, past.rows);
  if (past.plan.empty()) {
    const auto file = read_whole(folder / kPlanFile, kMaxPlanBytes);
    if (file) {
      const auto all = std::as_bytes(std::span(*file));
      past.plan.assign(all.begin(), all.end());
    }
  }
  const auto summary = read_summary(folder).value_or(nlohmann::ordered_json());
  past.rows.recalls = recorded_recalls(folder, summary);
  const bool begun = damage || !past.rows.empty() || !past.rows.metrics.empty();
  const auto mission = decode_plan(past.plan);
  if (!mission && (begun || !past.plan.empty())) {
    return failure(
        (folder / kPlanFile).string() +
        ": missing or not readable, so it is not known which mission's record this is; copy it "
        "back, or choose another folder with --out");
  }
  if (damage)
    spdlog::warn("{}; the record goes on in a new segment, and the rows before the damage are kept",
                 *damage);
  if (!mission) return past;
  auto amendments = recorded_amendments(folder, summary, *mission);
  if (amendments) {
    past.rows.amendments = *std::move(amendments);
  } else {
    spdlog::warn("{}; only the amendments that are received from now on are kept",
                 amendments.error());
  }
  return past;
}

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// After a write error, waits until this much space is free before the next try.
constexpr std::uintmax_t kRoomBytes = 1 << 20;

/// A recorder with its files. While they cannot be written, the team continues without the
/// recorder.
class RunLogger {
 public:
  /// @param past  the record to continue, if any
  RunLogger(RunId run, RunRecord& record, std::optional<Past> past, EventLogLimits limits)
      : record_(record),
        events_(record.folder(), limits),
        resumed_(past.has_value()),
        recorder_(run, random_identity(), record.trajectory(), record.metrics()) {
    if (!past) return;
    plan_of_record_ = past->plan;
    recorder_.resume(std::move(past->rows), std::move(past->plan));
  }

  Recorder& recorder() { return recorder_; }
  /// Whether data is missing in the files.
  bool failed() const { return stuck_; }
  /// Whether the received mission differs from that of the record.
  bool wrong_mission() const {
    const std::vector<std::byte>& heard = recorder_.follower().plan();
    return !plan_of_record_.empty() && !heard.empty() && heard != plan_of_record_;
  }
  /// Whether it resumed a record and received no mission, so that it has nothing to add.
  bool idle() const { return resumed_ && !recorder_.follower().mission(); }

  void keep_event(Bus bus, std::string_view channel, std::span<const std::byte> bytes) {
    if (is_original(bus, channel)) events_.write(channel, bytes);
  }

  /// To be called every turn: notes times for the summary, and writes what is new of the mission.
  void attend(Instant now) {
    const Tick rows = recorder_.facts().ticks - recorder_.facts().former_ticks;
    if (rows != seen_rows_) {
      seen_rows_ = rows;
      last_row_ = now;
      if (!first_row_) first_row_ = now;
    }
    tell_finds();
    if (!stuck_ && !record_.good()) flush(now);
    if (!stuck_) note(write_mission());
  }

  /// Passes all data to the operating system, also data that it refused before.
  /// @param last  whether there will be no other try
  void flush(Instant now, bool last = false) {
    if (stuck_ && !last && !has_room()) return;
    const bool held_up = !record_.good();
    std::optional<std::string> problem = record_.flush();
    if (held_up && !problem) recorder_.go_on(now);
    if (auto lost = events_.flush(); !problem) problem = lost;
    if (!problem) problem = write_mission();
    note(problem);
    if (events_.removed() > 0 && !removal_reported_) {
      removal_reported_ = true;
      spdlog::warn(
          "the event log has reached its limit: from now on each new segment replaces the oldest");
    }
  }

  /// Removes all files of this process.
  void discard() {
    record_.discard();
    events_.discard();
  }

  void write_summary(Transport& transport) {
    RunContext context;
    context.run = recorder_.run();
    context.started = started_;
    context.version = version();
    context.build = build_text();
    context.scenario_hash = plan_hash(recorder_.follower().plan());
    if (first_row_) {
      context.wall_time_s = std::chrono::duration<double>(*last_row_ - *first_row_).count();
    }
    context.segments = record_.segment() + 1;
    context.interruptions = interruptions_;
    context.events_removed = events_.removed();
    context.refused = transport.refused();
    context.kernel_drops = transport.kernel_drops();
    context.cpu_has_fma = cpu_has_fma();
    auto problem =
        write_file(record_.folder() / kSummaryFile, to_text(summarize(recorder_, context)));
    if (!problem && !recorder_.amendments().empty()) problem = write_amendments();
    if (problem) note(problem);
    std::error_code ignored;
    if (!problem) fs::remove(record_.folder() / kRecallsFile, ignored);
  }

 private:
  /// Logs each find once, and each contact that is confirmed and wrong, also those that a former
  /// logger has recorded.
  void tell_finds() {
    const std::vector<Find>& finds = recorder_.facts().finds.list();
    for (; finds_told_ < finds.size(); ++finds_told_)
      spdlog::info("{}", to_text(finds[finds_told_]));
    const int wrong = recorder_.facts().wrong_confirmations.value_or(0);
    if (wrong > wrong_told_) spdlog::warn("{}", wrong_confirmations_text(wrong));
    wrong_told_ = wrong;
  }

  bool has_room() const {
    std::error_code error;
    const auto space = fs::space(record_.folder(), error);
    return error || space.available >= kRoomBytes;
  }

  void note(const std::optional<std::string>& problem) {
    if (problem.has_value() == stuck_) return;
    stuck_ = problem.has_value();
    if (stuck_) {
      ++interruptions_;
      spdlog::error("{}; the team goes on, and the record goes on once it can be written again",
                    *problem);
    } else {
      spdlog::warn("the record can be written again and goes on at tick {}", recorder_.next_row());
    }
  }

  /// Writes the plan once it is known, and each amendment and recall once it is known. No other
  /// file has the targets. Without a summary, none shows which ticks count, and which agents rest.
  std::optional<std::string> write_mission() {
    const MissionFollower& heard = recorder_.follower();
    if (!heard.mission()) return std::nullopt;
    if (!plan_written_) {
      if (auto problem = write_plan()) return problem;
    }
    if (heard.amendments() != amendments_written_) {
      auto problem = write_amendments();
      if (problem) return problem;
      amendments_written_ = heard.amendments();
    }
    const auto recalls = recalls_json(recorder_);
    if (recalls.size() == recalls_written_) return std::nullopt;
    auto problem = write_file(record_.folder() / kRecallsFile, to_text(recalls));
    if (!problem) recalls_written_ = recalls.size();
    return problem;
  }

  std::optional<std::string> write_amendments() {
    const double dt_s = recorder_.follower().mission()->timing.dt_s;
    return write_file(record_.folder() / kAmendmentsFile,
                      amendments_text(recorder_.amendments(), dt_s));
  }

  /// Writes the plan as it was sent. It also writes the scenario's text and the table of its modes,
  /// unless a launcher has done so. Without the table, another computer may be unable to read the
  /// record.
  std::optional<std::string> write_plan() {
    const std::vector<std::byte>& plan = recorder_.follower().plan();
    if (auto problem = write_file(record_.folder() / kPlanFile, text_of(plan))) return problem;
    std::error_code ignored;
    if (!fs::exists(record_.folder() / kScenarioFile, ignored)) {
      const std::string text = mission_text(*recorder_.follower().mission());
      if (auto problem = write_file(record_.folder() / kScenarioFile, text)) return problem;
    }
    if (const auto& table = recorder_.follower().mission()->basis.table) {
      if (auto problem = save_table(*table, record_.folder())) return problem;
    }
    plan_written_ = true;
    return std::nullopt;
  }

  const std::string started_ = wall_clock_text();
  RunRecord& record_;
  EventLog events_;
  const bool resumed_;
  bool stuck_ = false, plan_written_ = false, removal_reported_ = false;
  int interruptions_ = 0;
  Amendments amendments_written_;
  std::size_t recalls_written_ = 0, finds_told_ = 0;
  int wrong_told_ = 0;
  std::vector<std::byte> plan_of_record_;  // of the record that it continues; empty: any
  Recorder recorder_;
  Tick seen_rows_ = 0;
  std::optional<Instant> first_row_, last_row_;
};

int refuse(ExitCode code, const std::string& problem) {
  spdlog::error("{}", problem);
  return code;
}

int run(const NodeOptions& node, const fs::path& folder, bool resume, std::vector<std::byte> plan,
        EventLogLimits limits) {
  StopSignals signals;
  std::optional<Past> past;
  if (resume) {
    auto read = read_past(folder, std::move(plan));
    if (!read) return refuse(kExitBadInput, read.error());
    past = *std::move(read);
  }
  auto created = resume ? RunRecord::go_on(folder) : RunRecord::create(folder);
  if (!created) return refuse(kExitBadInput, created.error());
  RunLogger logger(node.run, **created, std::move(past), limits);
  Recorder& recorder = logger.recorder();
  const auto connected = connect(
      recorder, node,
      {.on_accepted = [&](Bus bus, std::string_view channel, std::span<const std::byte> bytes) {
        logger.keep_event(bus, channel, bytes);
      }});
  if (!connected) {
    logger.discard();
    return kExitUnavailable;
  }
  Transport& transport = *connected;
  TrafficWatch watch(transport);
  spdlog::info("recording {} into {}", node.url.base(), folder.string());

  const auto stop = [&] { recorder.stop("a signal stopped the logger"); };
  run_core(recorder, transport, signals, stop, [&] {
    transport.set_run(recorder.run());
    if (const auto& mission = recorder.follower().mission()) {
      transport.limit_agents(rate_budget_of(*mission, recorder.follower().roster().size()),
                             recorder.newest());
    }
    logger.attend(now());
    if (watch.look(now())) logger.flush(now());
  });
  if (logger.wrong_mission()) {
    logger.discard();
    return refuse(kExitBadInput, folder.string() +
                                     ": the record here is of another mission than the one "
                                     "received; choose another folder with --out");
  }
  if (const auto& problem = recorder.follower().plan_problem()) {
    logger.discard();
    return refuse(kExitFailed, *problem);
  }
  logger.flush(now(), true);
  if (logger.idle()) {
    logger.discard();
    spdlog::info("no mission was received; the record stays as it was");
    return kExitDone;
  }
  logger.write_summary(transport);
  if (const Finds& finds = recorder.facts().finds; finds.objects() > 0)
    spdlog::info("found {} of {} objects", finds.list().size(), finds.objects());
  if (const std::int64_t missing = recorder.facts().missing_positions; missing > 0)
    spdlog::warn(
        "{} positions of vehicles did not arrive, and the record's phi^2 lacks them; for the "
        "agents' own see `agents` in summary.json",
        missing);
  spdlog::info("{} ticks recorded: {} ({})", recorder.facts().ticks, recorder.result(),
               recorder.reason());
  return logger.failed() ? kExitFailed : kExitDone;
}

}  // namespace
}  // namespace ergocast

int main(int argc, char** argv) {
  using namespace ergocast;
  CLI::App app("The logger: records all messages in a run directory.", "ergocast-logger");
  NodeOptions node;
  std::filesystem::path folder;
  add_node_options(app, node);
  bool resume = false;
  app.add_option("--out", folder, "Existing folder, without a record unless --resume is given")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_flag("--resume", resume,
               "Continue the record of this mission in the folder, if there is one");
  std::vector<std::byte> plan;
  add_plan_option(app, plan);
  EventLogLimits limits;
  std::int64_t event_log_mib = kEventLogMib;
  add_event_log_options(app, event_log_mib, limits.compressed);
  if (const int code = parse_command_line(app, argc, argv); code >= 0) return code;
  set_up_logging("logger", node.log_level);
  limits.total_bytes = event_log_mib << 20;
  return run(node, folder, resume, std::move(plan), limits);
}
