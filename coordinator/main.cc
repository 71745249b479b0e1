// ergocast-coordinator: admits agents, hands out the mission, starts, watches and ends it.
#include <spdlog/spdlog.h>

#include "coordinator/coordinator.h"
#include "runtime/event_loop.h"
#include "runtime/node.h"
#include "runtime/traffic_watch.h"
#include "scenario/scenario.h"

namespace ergocast {
namespace {

int run(const NodeOptions& node, const Scenario& scenario) {
  StopSignals signals;
  const RunId run_id = node.run != 0 ? node.run : random_identity();
  Coordinator coordinator(run_id, random_identity(), scenario.mission(), scenario.plan());
  auto opened = Transport::open(
      node.url, run_id,
      {{Bus::kSwarm, "HELLO|AGENT_STATUS_.*|STOP"}, {Bus::kWorld, "WORLD_STATE"}},
      {.on_message = [&](const Message& message) { coordinator.receive(message, now()); }});
  if (const auto* problem = std::get_if<std::string>(&opened)) {
    spdlog::error("{}", *problem);
    return kExitUnavailable;
  }
  Transport& transport = *std::get<0>(opened);
  TrafficWatch watch(transport);
  spdlog::info("run {} of scenario {} on {}: waiting for {} of {} agents", to_hex(run_id),
               scenario.name(), node.url.base(), scenario.mission().quorum,
               scenario.mission().starts_m.size());

  MissionState logged = MissionState::kWaiting;
  std::size_t admitted = 0;
  const auto stop = [&] { coordinator.end(false, "the coordinator was told to stop", now()); };
  live(coordinator, transport, signals, stop, [&] {
    watch.look(now());
    if (coordinator.roster().size() != admitted) {
      admitted = coordinator.roster().size();
      spdlog::info("agents admitted so far: {}", admitted);
    }
    if (coordinator.state() == logged) return;
    logged = coordinator.state();
    const std::string& reason = coordinator.reason();
    spdlog::log(logged == MissionState::kFailed ? spdlog::level::err : spdlog::level::info,
                "mission {} at tick {}{}{}", to_string(logged), coordinator.tick(),
                reason.empty() ? "" : ": ", reason);
  });
  return coordinator.state() == MissionState::kFailed ? kExitFailed : kExitDone;
}

}  // namespace
}  // namespace ergocast

int main(int argc, char** argv) {
  using namespace ergocast;
  CLI::App app("Admits agents, hands out the mission, starts, watches and ends it. Never steers.",
               "ergocast-coordinator");
  NodeOptions node;
  std::string file;
  add_node_options(app, node);
  app.add_option("SCENARIO", file, "Scenario file")->required();
  if (const int code = parse_command_line(app, argc, argv); code >= 0) return code;
  set_up_logging("coordinator");
  const auto loaded = Scenario::load(file);
  if (const auto* problems = std::get_if<std::vector<Problem>>(&loaded)) {
    for (const Problem& problem : *problems) spdlog::error("{}", to_string(problem));
    return kExitBadInput;
  }
  return run(node, std::get<Scenario>(loaded));
}
