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

/// The plan as it was sent, and as people read it. A launcher may have written the latter already.
std::optional<std::string> write_plan(const fs::path& folder, const std::vector<std::byte>& plan) {
  const std::string_view bytes(reinterpret_cast<const char*>(plan.data()), plan.size());
  if (const auto error = write_file(folder / kPlanFile, bytes)) return error;
  std::error_code ignored;
  if (fs::exists(folder / kScenarioFile, ignored)) return std::nullopt;
  return write_file(folder / kScenarioFile, Scenario::from_plan(plan)->print());
}

int run(const NodeOptions& node, const fs::path& folder) {
  StopSignals signals;
  auto created = RunRecord::create(folder);
  if (const auto* problem = std::get_if<std::string>(&created)) {
    spdlog::error("{}", *problem);
    return kExitBadInput;
  }
  RunRecord& record = *std::get<0>(created);
  EventLog events(folder);
  Recorder recorder(node.run, random_identity(), decode_plan, record.trajectory(),
                    record.metrics());
  auto opened = Transport::open(
      node.url, node.run, {{Bus::kSwarm, ".*"}, {Bus::kWorld, ".*"}, {Bus::kCommand, ".*"}},
      {.on_message = [&](const Message& message) { recorder.receive(message, now()); },
       .on_accepted = [&](Bus bus, std::string_view channel, std::span<const std::byte> bytes) {
         if (is_original(bus, channel)) events.write(channel, bytes);
       }});
  if (const auto* problem = std::get_if<std::string>(&opened)) {
    spdlog::error("{}", *problem);
    return kExitUnavailable;
  }
  Transport& transport = *std::get<0>(opened);
  TrafficWatch watch(transport);
  spdlog::info("recording {} into {}", node.url.base(), folder.string());

  std::optional<std::string> error;
  bool plan_written = false;
  std::optional<Instant> first_row, last_row;
  Tick seen_row = 0;
  const auto keep = [&](std::optional<std::string> problem) {
    if (!problem || error) return;
    error = std::move(problem);
    spdlog::error("{}; the record ends here", *error);
    recorder.stop("the record cannot be written: " + *error);
  };
  const auto stop = [&] { recorder.stop("the logger was told to stop"); };
  live(recorder, transport, signals, stop, [&] {
    transport.set_run(recorder.run());
    if (recorder.next_row() != seen_row) {
      seen_row = recorder.next_row();
      last_row = now();
      if (!first_row) first_row = last_row;
    }
    const MissionFollower& follower = recorder.follower();
    if (follower.mission() && !plan_written) {
      plan_written = true;
      keep(write_plan(folder, follower.plan()));
    }
    if (!watch.look(now())) return;
    keep(record.flush());
    keep(events.flush());
  });
  keep(record.flush());
  keep(events.flush());

  RunContext context;
  context.run = recorder.run();
  context.version = version();
  context.build = build_text();
  context.scenario_hash = plan_hash(recorder.follower().plan());
  if (first_row) context.wall_time_s = std::chrono::duration<double>(*last_row - *first_row).count();
  context.refused = transport.refused();
  context.kernel_drops = transport.kernel_drops();
  context.cpu_has_fma = cpu_has_fma();
  keep(write_file(folder / kSummaryFile, summarize(recorder, context).dump(2) + '\n'));
  spdlog::info("{} ticks recorded: {} ({})", recorder.facts().ticks, recorder.result(),
               recorder.reason());
  return error ? kExitFailed : kExitDone;
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
