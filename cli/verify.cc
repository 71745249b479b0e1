#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>

#include "cli/commands.h"
#include "cli/run_directory.h"
#include "lab/swarm.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "runtime/node.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kTurnsBetweenComparisons = 256;

/// Why a run has more in it than a simulation of its plan could know; empty if it has not.
std::string what_cannot_be_repeated(const nlohmann::ordered_json& summary, std::size_t agents) {
  if (summary.value("mode", "") == "realtime") {
    return "it ran in real time, where what an agent knew depended on the network";
  }
  const auto roster = summary.value("agents", nlohmann::ordered_json());
  if (!roster.is_array()) return "its summary names no agents";
  if (roster.size() != agents) {
    return "its roster has " + std::to_string(roster.size()) + " entries for " +
           std::to_string(agents) + " agents: agents were restarted, or never came";
  }
  for (const auto& agent : roster) {
    const std::string who = "agent " + agent.at("id").dump();
    if (!agent.at("active_until").is_null()) {
      return who + " left or was evicted at tick " + agent.at("active_until").dump();
    }
    if (agent.at("active_from") != 0) {
      return who + " joined at tick " + agent.at("active_from").dump();
    }
  }
  return "";
}

/// The same for any JSON, whoever wrote it.
std::string why_not_repeatable(const nlohmann::ordered_json& summary, std::size_t agents) {
  try {
    return what_cannot_be_repeated(summary, agents);
  } catch (const nlohmann::json::exception& error) {
    return std::string(kSummaryFile) + " is not one that ergocast wrote: " + error.what();
  }
}

/// Compares a recorded table with one that is simulated bit by bit.
class Comparison {
 public:
  explicit Comparison(const fs::path& recorded) : recorded_(recorded, std::ios::binary) {}

  bool readable() const { return recorded_.good(); }
  /// Compares as many whole lines as there are; false at the first difference.
  bool compare(std::istream& simulated) {
    for (std::string line; same_ && !recorded_over_ && std::getline(simulated, line);) {
      std::string recorded;
      std::getline(recorded_, recorded);
      recorded_over_ = recorded_.eof();  // also a last line that was cut off
      if (recorded_over_) break;
      same_ = recorded == line;
      if (same_) {
        last_ = line;
      } else {
        difference_ = "recorded:  " + recorded + "\nsimulated: " + line + '\n';
        first_ = line;
      }
    }
    return same_ && !recorded_over_;
  }
  bool same() const { return same_; }
  /// Whether the record ended before the simulation did.
  bool recorded_over() const { return recorded_over_; }
  /// Whether the record goes on after the simulation's end.
  bool has_more() {
    return recorded_.peek() != std::char_traits<char>::eof();
  }
  /// "tick 12, agent 3" of the first line that differs.
  std::string place() const {
    std::istringstream fields(first_);
    std::string tick, t_s, agent;
    std::getline(std::getline(std::getline(fields, tick, ','), t_s, ','), agent, ',');
    return "tick " + tick + ", agent " + agent;
  }
  const std::string& difference() const { return difference_; }
  std::string last_tick() const { return last_.substr(0, last_.find(',')); }

 private:
  std::ifstream recorded_;
  bool same_ = true, recorded_over_ = false;
  std::string last_, first_, difference_;
};

/// Simulates `scenario` until something differs or one of the two ends.
void simulate_and_compare(const Scenario& scenario, Comparison& comparison) {
  lab::Options options;
  options.plan = scenario.plan();
  options.decode_plan = decode_plan;
  options.agents = static_cast<int>(scenario.mission().starts_m.size());
  options.version = version();
  std::ostringstream trajectory, metrics;
  lab::Swarm swarm(std::move(options), trajectory, metrics);
  bool more = true;
  for (bool going_on = true; more && going_on;) {
    for (int i = 0; i < kTurnsBetweenComparisons && more; ++i) more = swarm.step();
    std::istringstream simulated(std::exchange(trajectory, std::ostringstream()).str());
    metrics.str("");
    going_on = comparison.compare(simulated);
  }
}

/// Says how the comparison went.
int verdict(const fs::path& run_dir, Comparison& comparison,
            const nlohmann::ordered_json& summary) {
  const bool complete = summary.value("result", "") == "done";
  if (!comparison.same()) {
    std::printf("%s differs from its simulation, first at %s\n%s", run_dir.c_str(),
                comparison.place().c_str(), comparison.difference().c_str());
    if (summary.value("cpu_fma", cpu_has_fma()) != cpu_has_fma()) {
      std::printf("It was recorded on another kind of processor, whose sine differs.\n");
    }
    return kExitDiffers;
  }
  if (comparison.recorded_over() && complete) {
    std::printf("%s says it is done, but ends after tick %s\n", run_dir.c_str(),
                comparison.last_tick().c_str());
    return kExitDiffers;
  }
  if (!comparison.recorded_over() && comparison.has_more()) {
    std::printf("%s goes on after the plan's last tick\n", run_dir.c_str());
    return kExitDiffers;
  }
  std::printf("%s: identical to its simulation, byte for byte, up to tick %s%s\n", run_dir.c_str(),
              comparison.last_tick().c_str(), complete ? "" : ", where the record ends");
  return kExitDone;
}

}  // namespace

int verify(const fs::path& run_dir) {
  std::ifstream plan_file(run_dir / kPlanFile, std::ios::binary);
  const std::string plan((std::istreambuf_iterator<char>(plan_file)), {});
  const auto scenario = Scenario::from_plan(std::as_bytes(std::span(plan)));
  Comparison comparison(run_dir / kTrajectoryFile);
  if (!scenario || !comparison.readable()) {
    std::fprintf(stderr, "%s: missing, damaged, or written by another version than %s\n",
                 (run_dir / (scenario ? kTrajectoryFile : kPlanFile)).c_str(), version().c_str());
    return kExitBadInput;
  }
  auto read = read_summary(run_dir);
  if (const auto* problem = std::get_if<std::string>(&read)) {
    std::fprintf(stderr, "%s\n", problem->c_str());
    return kExitBadInput;
  }
  auto& summary = std::get<nlohmann::ordered_json>(read);
  if (summary.is_object()) {
    const auto reason = why_not_repeatable(summary, scenario->mission().starts_m.size());
    if (!reason.empty()) {
      std::fprintf(stderr, "%s cannot be verified: %s\n", run_dir.c_str(), reason.c_str());
      return kExitBadInput;
    }
  } else {
    std::fprintf(stderr, "%s: no %s, so nothing is known of restarts; comparing all the same\n",
                 run_dir.c_str(), kSummaryFile);
    summary = nlohmann::ordered_json::object();
  }

  simulate_and_compare(*scenario, comparison);
  return verdict(run_dir, comparison, summary);
}

}  // namespace ergocast::cli
