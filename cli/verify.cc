#include <cstdio>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "cli/commands.h"
#include "cli/run_directory.h"
#include "core/read_number.h"
#include "lab/swarm.h"
#include "logger/recorder.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "logger/table_lines.h"
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
    const auto switched = agent.value("coverage_switched_at", nlohmann::ordered_json());
    if (!switched.is_null()) {
      return "what " + who + " covered did not count for a while: it was last forgotten or remembered at tick " +
             switched.dump();
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

/// Tick and agent of a row of trajectory.csv, by which its rows ascend; nothing if it has none.
using RowKey = std::pair<Tick, AgentId>;
std::optional<RowKey> key_of(std::string_view row) {
  std::string_view cells[3];  // tick, time, agent
  for (std::string_view& cell : cells) {
    const std::size_t comma = row.find(',');
    if (comma == row.npos) return {};
    cell = row.substr(0, comma);
    row.remove_prefix(comma + 1);
  }
  const auto tick = read_number<Tick>(cells[0]);
  const auto agent = read_number<AgentId>(cells[2]);
  return tick && agent ? std::optional(RowKey(*tick, *agent)) : std::nullopt;
}

/// Compares the recorded trajectory with one that is simulated, row by row and bit by bit. Rows that
/// the record lacks are counted.
class Comparison {
 public:
  explicit Comparison(const fs::path& run_dir)
      : lines_(run_dir, kTrajectoryFile, kTrajectoryHeader) {
    read_next();
  }

  /// The run was stopped at once: in its last tick the vehicles stand still, which no simulation
  /// does.
  void expect_halt() { halted_ = true; }
  /// Why the record cannot be read, if so.
  const std::optional<std::string>& problem() const { return lines_.problem(); }
  /// Compares as many whole lines as there are; false at the first difference.
  bool compare(std::istream& simulated) {
    for (std::string line; same_ && !recorded_over_ && std::getline(simulated, line);) {
      if (line != kTrajectoryHeader) compare_row(line);
    }
    return same_ && !recorded_over_;
  }
  bool same() const { return same_; }
  /// Whether the record ended before the simulation did.
  bool recorded_over() const { return recorded_over_; }
  /// Whether the record goes on after the simulation's end.
  bool has_more() const { return recorded_.has_value(); }
  /// "tick 12, agent 3" of the first line that differs.
  std::string place() const {
    const RowKey key = key_of(first_).value_or(RowKey{});
    return "tick " + std::to_string(key.first) + ", agent " + std::to_string(key.second);
  }
  const std::string& difference() const { return difference_; }
  std::string last_tick() const { return last_.substr(0, last_.find(',')); }
  /// Ticks up to the last compared row that lack rows.
  Tick missing() const { return missing_; }

 private:
  void read_next() {
    std::string line;
    recorded_ = lines_.next(line) ? std::optional(line) : std::nullopt;
  }

  void compare_row(const std::string& simulated) {
    recorded_over_ = !recorded_;
    if (recorded_over_) return;
    if (*recorded_ == simulated) {
      last_ = simulated;
      return read_next();
    }
    const auto key = key_of(simulated), recorded_key = key_of(*recorded_);
    if (recorded_key > key) {
      if (key->first != last_missing_) ++missing_;
      last_missing_ = key->first;
      return;
    }
    recorded_over_ = halted_ && stands_where(simulated);
    if (recorded_over_) return;
    same_ = false;
    difference_ = "recorded:  " + *recorded_ + "\nsimulated: " + simulated + '\n';
    first_ = simulated;
  }

  /// Whether the recorded row is the simulated one but for a velocity of zero.
  bool stands_where(const std::string& simulated) const {
    const auto vx = simulated.rfind(',', simulated.rfind(',') - 1);
    return *recorded_ == simulated.substr(0, vx) + ",0,0";
  }

  TableLines lines_;
  bool halted_ = false;
  std::optional<std::string> recorded_;  // the row to be compared next
  bool same_ = true, recorded_over_ = false;
  std::string last_, first_, difference_;
  Tick missing_ = 0, last_missing_ = -1;
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
  if (const Tick missing = comparison.missing(); missing > 0) {
    std::printf("%lld ticks before that are missing in the record\n", static_cast<long long>(missing));
  }
  return kExitDone;
}

}  // namespace

int verify(const fs::path& run_dir) {
  const auto scenario = recorded_plan_or_complain(run_dir);
  if (!scenario) return kExitBadInput;
  Comparison comparison(run_dir);
  if (comparison.problem()) {
    std::fprintf(stderr, "%s: missing, damaged, or written by another version than %s\n",
                 (run_dir / kTrajectoryFile).c_str(), version().c_str());
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

  if (summary.value("emergency_stop", false)) comparison.expect_halt();
  simulate_and_compare(*scenario, comparison);
  if (const auto& problem = comparison.problem()) {
    std::fprintf(stderr, "%s\n", problem->c_str());
    return kExitBadInput;
  }
  return verdict(run_dir, comparison, summary);
}

}  // namespace ergocast::cli
