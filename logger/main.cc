// ergocast-logger: the run record as a process. Watches all three buses, never takes part.
#include <spdlog/spdlog.h>

#include <chrono>

#include "logger/recorder.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "runtime/event_log.h"
#include "runtime/event_loop.h"
#include "runtime/node.h"
#include "runtime/traffic_watch.h"
#include "scenario/scenario.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

/// Whether a message is worth a place in the event log: what a bus repeats of another is not.
bool is_original(Bus bus, std::string_view channel) {
  return bus != Bus::kCommand || !(channel.ends_with("_MISSION") || channel.ends_with("_STOP"));
}

/// A recorder with the files it fills. The first write error ends the record.
class RunLogger {
 public:
  RunLogger(RunId run, RunRecord& record)
      : record_(record),
        events_(record.folder()),
        recorder_(run, random_identity(), decode_plan, record.trajectory(), record.metrics()) {}

  Recorder& recorder() { return recorder_; }
  bool failed() const { return failed_; }

  void keep_event(Bus bus, std::string_view channel, std::span<const std::byte> bytes) {
    if (is_original(bus, channel)) events_.write(channel, bytes);
  }

  /// What is done every turn: times for the summary, and the plan once it is known.
  void attend(Instant now) {
    if (recorder_.next_row() != seen_row_) {
      seen_row_ = recorder_.next_row();
      last_row_ = now;
      if (!first_row_) first_row_ = now;
    }
    if (plan_written_ || !recorder_.follower().mission()) return;
    plan_written_ = true;
    check(write_plan());
  }

  void flush() {
    check(record_.flush());
    check(events_.flush());
  }

  void write_summary(const Transport& transport) {
    RunContext context;
    context.run = recorder_.run();
    context.started = started_;
    context.version = version();
    context.build = build_text();
    context.scenario_hash = plan_hash(recorder_.follower().plan());
    if (first_row_) {
      context.wall_time_s = std::chrono::duration<double>(*last_row_ - *first_row_).count();
    }
    context.refused = transport.refused();
    context.kernel_drops = transport.kernel_drops();
    context.cpu_has_fma = cpu_has_fma();
    check(write_file(record_.folder() / kSummaryFile, to_text(summarize(recorder_, context))));
  }

 private:
  void check(const std::optional<std::string>& problem) {
    if (!problem || failed_) return;
    failed_ = true;
    spdlog::error("{}; the record ends here", *problem);
    recorder_.stop("the record cannot be written: " + *problem);
  }

  /// The plan as it was sent, and as people read it, unless a launcher has already written that.
  std::optional<std::string> write_plan() const {
    const std::vector<std::byte>& plan = recorder_.follower().plan();
    const std::string_view bytes(reinterpret_cast<const char*>(plan.data()), plan.size());
    if (auto problem = write_file(record_.folder() / kPlanFile, bytes)) return problem;
    std::error_code ignored;
    if (fs::exists(record_.folder() / kScenarioFile, ignored)) return std::nullopt;
    return write_file(record_.folder() / kScenarioFile, Scenario::from_plan(plan)->print());
  }

  const std::string started_ = wall_clock_text();
  RunRecord& record_;
  EventLog events_;
  Recorder recorder_;
  bool failed_ = false, plan_written_ = false;
  Tick seen_row_ = 0;
  std::optional<Instant> first_row_, last_row_;
};

int run(const NodeOptions& node, const fs::path& folder) {
  StopSignals signals;
  auto created = RunRecord::create(folder);
  if (const auto* problem = std::get_if<std::string>(&created)) {
    spdlog::error("{}", *problem);
    return kExitBadInput;
  }
  RunLogger logger(node.run, *std::get<0>(created));
  Recorder& recorder = logger.recorder();
  auto opened = Transport::open(
      node.url, node.run, {{Bus::kSwarm, ".*"}, {Bus::kWorld, ".*"}, {Bus::kCommand, ".*"}},
      {.on_message = [&](const Message& message, AgentId) { recorder.receive(message, now()); },
       .on_accepted = [&](Bus bus, std::string_view channel, std::span<const std::byte> bytes) {
         logger.keep_event(bus, channel, bytes);
       }});
  if (const auto* problem = std::get_if<std::string>(&opened)) {
    spdlog::error("{}", *problem);
    return kExitUnavailable;
  }
  Transport& transport = *std::get<0>(opened);
  TrafficWatch watch(transport);
  spdlog::info("recording {} into {}", node.url.base(), folder.string());

  const auto stop = [&] { recorder.stop("the logger was told to stop"); };
  live(recorder, transport, signals, stop, [&] {
    transport.set_run(recorder.run());
    logger.attend(now());
    if (watch.look(now())) logger.flush();
  });
  logger.flush();
  logger.write_summary(transport);
  spdlog::info("{} ticks recorded: {} ({})", recorder.facts().ticks, recorder.result(),
               recorder.reason());
  return logger.failed() ? kExitFailed : kExitDone;
}

}  // namespace
}  // namespace ergocast

int main(int argc, char** argv) {
  using namespace ergocast;
  CLI::App app("Records everything that is said into a run directory.", "ergocast-logger");
  NodeOptions node;
  std::filesystem::path folder;
  add_node_options(app, node);
  app.add_option("--out", folder, "Existing folder without a record")
      ->required()
      ->check(CLI::ExistingDirectory);
  if (const int code = parse_command_line(app, argc, argv); code >= 0) return code;
  set_up_logging("logger");
  return run(node, folder);
}
