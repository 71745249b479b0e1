// SPDX-License-Identifier: BSD-3-Clause
// ergocast-agent: one agent of the team as a process.
#include <spdlog/spdlog.h>

#include <chrono>
#include <string>
#include <utility>

#include "agent/agent.h"
#include "runtime/bus/random_identity.h"
#include "runtime/process/event_loop.h"
#include "runtime/process/logging.h"
#include "runtime/process/program_options.h"
#include "runtime/process/traffic_watch.h"

namespace ergocast {
namespace {

/// Logs now and then why an agent cannot take part.
class WaitingLog {
 public:
  void look(const Agent& agent, Instant now) {
    const std::string reason = agent.blocked_reason();
    if (reason.empty() || next_ == Instant{}) next_ = now + kFirst;
    if (reason.empty() || now < next_) return;
    next_ = now + kPeriod;
    spdlog::warn("{}", reason);
  }

 private:
  static constexpr auto kFirst = std::chrono::seconds(3), kPeriod = std::chrono::seconds(10);
  Instant next_{};
};

/// Logs once that coverage arrived in another encoding than the plan's.
class EncodingLog {
 public:
  void look(const Agent& agent) {
    const auto refused = agent.refused()[static_cast<std::size_t>(Refusal::kEncoding)];
    if (refused == 0 || reported_) return;
    reported_ = true;
    spdlog::warn(
        "coverage with another contribution_encoding than the plan's was refused: all agents of a "
        "run must use the plan's");
  }

 private:
  bool reported_ = false;
};

/// Logs once each reason for which beacons of teammates were refused.
class BeaconLog {
 public:
  void look(const Agent& agent) {
    const BeaconBook* const beacons = agent.beacons();
    if (beacons == nullptr) return;
    if (beacons->late() > 0 && !std::exchange(late_reported_, true))
      spdlog::info("beacons of teammates arrive out of order: those that arrive late are ignored");
    if (beacons->from_the_future() > 0 && !std::exchange(future_reported_, true))
      spdlog::warn(
          "a teammate's beacon was refused, because it answers one that this agent has not sent "
          "yet: does another process send beacons under this agent's id?");
  }

 private:
  bool late_reported_ = false, future_reported_ = false;
};

int run(const NodeOptions& node, AgentId requested_id, const std::string& kind) {
  StopSignals signals;
  Agent agent({node.run, requested_id, random_identity(), host_name(), version(), kind});
  const auto connected = connect(
      agent, node, {.on_refused = [&agent](Refusal refusal) { agent.count_refused(refusal); }});
  if (!connected) return kExitUnavailable;
  Transport& transport = *connected;
  TrafficWatch watch(transport);
  WaitingLog waiting;
  EncodingLog encodings;
  BeaconLog beacons;
  LoopLag lag;
  AgentPhase logged = AgentPhase::kJoining;
  spdlog::info("joining on {}", node.url.base());

  run_core(
      agent, transport, signals, [&] { agent.leave("stopped by a signal"); },
      [&] {
        transport.set_run(agent.run());
        agent.note_loop_lag(lag.take_s());
        if (const auto& mission = agent.follower().mission()) {
          const std::size_t members = agent.follower().roster().size();
          transport.limit_agents(rate_budget_of(*mission, members), agent.tick());
          transport.let_gather(gathering_of(*mission, members));
        }
        if (watch.look(now(), agent.refused()[static_cast<std::size_t>(Refusal::kLate)])) {
          agent.set_kernel_drops(watch.kernel_drops());
          agent.note_rate_offender(transport.rate_offender());
          waiting.look(agent, now());
          encodings.look(agent);
          beacons.look(agent);
        }
        if (agent.phase() == logged) return;
        logged = agent.phase();
        if (!agent.finished()) {
          spdlog::info("agent {} of run {}: {}", agent.id(), to_hex(agent.run()),
                       to_string(logged));
        }
      },
      lag);
  spdlog::log(agent.failed() ? spdlog::level::err : spdlog::level::info, "finished at tick {}: {}",
              agent.tick(), agent.reason());
  return agent.failed() ? kExitFailed : kExitDone;
}

}  // namespace
}  // namespace ergocast

int main(int argc, char** argv) {
  using namespace ergocast;
  CLI::App app(
      "One agent: joins the team on the URL, receives the mission and commands its vehicle.",
      "ergocast-agent");
  NodeOptions node;
  std::string id = "auto", kind;
  add_node_options(app, node);
  app.add_option(
         "--id", id,
         "Number of the agent, 0 to " + std::to_string(kMaxAgents - 1) + "; auto: any free number")
      ->capture_default_str()
      ->check((CLI::Range(0, kMaxAgents - 1) | CLI::IsMember({"auto"})).description(""))
      ->type_name("N");
  app.add_option("--kind", kind,
                 "Name of a kind in the scenario's agents { kind } (default: the one that the "
                 "scenario plans for the number)")
      ->type_name("NAME");
  if (const int code = parse_command_line(app, argc, argv); code >= 0) return code;
  const AgentId requested_id = id == "auto" ? kUnassigned : std::stoi(id, nullptr, 0);
  set_up_logging(requested_id == kUnassigned ? "agent" : "agent-" + std::to_string(requested_id),
                 node.log_level);
  return run(node, requested_id, kind);
}
