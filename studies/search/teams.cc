// SPDX-License-Identifier: BSD-3-Clause
// What teams that search find in spite of slow and lost messages, of a lost agent and of false
// alarms, and how they watch: the tables of docs/search.md. Agents know where teammates are.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/base/noise.h"
#include "core/law/searcher.h"
#include "core/measure/detection.h"
#include "core/measure/objects.h"
#include "core/measure/target_mass.h"
#include "core/motion/push.h"
#include "core/search/confirmations.h"
#include "core/search/reports.h"
#include "lab/ideal_team.h"
#include "report/statistics.h"
#include "scenario/scenario.h"

namespace ergocast::studies {
namespace {

/// As in agent/search_exchange.cc.
constexpr std::size_t kTilesPerMessage = 8;
constexpr double kDeath_s = 150;

/// What happens to a team.
struct Conditions {
  double period_s = 2;     ///< between two sendings of an agent
  double loss = 0;         ///< of each message, for each receiver
  bool dies = false;       ///< the last agent, at kDeath_s
  bool all_known = false;  ///< then all that was searched, to those that stay
};

/// Agents with rows of their own, which exchange tiles like SearchExchange.
class Team {
 public:
  Team(const Mission& mission, const Conditions& conditions)
      : mission_(mission),
        conditions_(conditions),
        objects_(mission),
        reports_(mission),
        period_(std::max<Tick>(1, std::llround(conditions.period_s / mission.timing.dt_s))) {
    for (const Eigen::Vector3d& start_m : mission.starts_m) {
      const auto id = static_cast<AgentId>(agents_.size());
      agents_.push_back({{id, 1}, std::make_unique<Searcher>(mission), Efforts(mission), start_m});
      agents_.back().efforts.add_row(agents_.back().author);
    }
  }

  std::size_t size() const { return agents_.size(); }
  const Eigen::Vector3d& x_m(std::size_t agent) const { return agents_[agent].x_m; }

  void step() {
    if (conditions_.dies && tick_ == std::llround(kDeath_s / mission_.timing.dt_s)) bury();
    places_.clear();
    team_.clear();
    for (Agent& agent : agents_) {
      const AgentId id = agent.author.agent;
      team_.push_back(id);
      places_.push_back({id, agent.x_m});
      const ObjectSet detected = objects_.detected(id, tick_, agent.x_m);
      agent.efforts.set_now(tick_);
      agent.efforts.look(agent.author, tick_, agent.x_m);
      agent.efforts.report(agent.author, tick_,
                           reports_.cell(id, tick_, agent.x_m, detected, objects_.places_m()));
    }
    for (Agent& agent : agents_)
      if ((tick_ - agent.author.agent) % period_ == 0) send(agent);
    for (Agent& agent : agents_) {
      const BasisAt at(agent.x_m, mission_.domain, mission_.basis);
      agent.next_mps = agent.law->wanted_mps(
          {agent.author.agent, tick_, agent.x_m, at, team_, places_, &agent.efforts});
    }
    for (Agent& agent : agents_)
      agent.x_m = reflect(moved(mission_, agent.author.agent, tick_, agent.x_m, agent.next_mps),
                          mission_.domain);
    ++tick_;
  }

 private:
  struct Agent {
    Author author;
    std::unique_ptr<Searcher> law;
    Efforts efforts;
    Eigen::Vector3d x_m, next_mps{0, 0, 0};
    Tick sent = -1;
    std::size_t own_turn = 0, row_turn = 0, tile_turn = 0;
  };
  struct Sent {
    std::size_t number;
    EffortTile content;
  };

  void bury() {
    const Agent gone = std::move(agents_.back());
    agents_.pop_back();
    if (!conditions_.all_known) return;
    for (Agent& agent : agents_) {
      for (const Agent& other : agents_) copy(other, agent);
      copy(gone, agent);
    }
  }
  static void copy(const Agent& from, Agent& to) {
    if (from.author == to.author) return;
    const std::vector<EffortTile>& row = *from.efforts.row_of(from.author);
    for (std::size_t tile = 0; tile < row.size(); ++tile)
      if (row[tile].newest_look >= 0)
        to.efforts.merge(from.author, tile, row[tile], row[tile].newest_look);
  }

  /// What has changed, older tiles in turn, and tiles of one other row in turn.
  void send(Agent& agent) {
    const std::vector<EffortTile>& row = *agent.efforts.row_of(agent.author);
    std::vector<Sent> tiles;
    for (std::size_t tile = 0; tile < row.size(); ++tile)
      if (row[tile].newest_look > agent.sent) tiles.push_back({tile, row[tile]});
    agent.sent = tick_;
    const std::size_t full = (tiles.size() / kTilesPerMessage + 1) * kTilesPerMessage;
    fill(row, full, agent.own_turn, tiles);
    for (std::size_t first = 0; first < tiles.size(); first += kTilesPerMessage)
      deliver(agent, agent.author,
              std::span(tiles).subspan(first, std::min(kTilesPerMessage, tiles.size() - first)));
    relay(agent);
  }
  void relay(Agent& agent) {
    const Efforts& known = agent.efforts;
    if (known.row_count() < 2) return;
    agent.row_turn %= known.row_count();
    if (known.author(agent.row_turn) == agent.author)
      agent.row_turn = (agent.row_turn + 1) % known.row_count();
    const Author author = known.author(agent.row_turn);
    std::vector<Sent> tiles;
    const std::vector<EffortTile>& row = *known.row_of(author);
    fill(row, kTilesPerMessage, agent.tile_turn, tiles);
    if (agent.tile_turn >= row.size()) {
      agent.tile_turn = 0;
      ++agent.row_turn;
    }
    deliver(agent, author, tiles);
  }
  static void fill(const std::vector<EffortTile>& row, std::size_t full, std::size_t& turn,
                   std::vector<Sent>& tiles) {
    for (std::size_t i = 0; i < row.size() && tiles.size() < full; ++i) {
      const std::size_t tile = turn++ % row.size();
      const bool there =
          std::ranges::any_of(tiles, [&](const Sent& one) { return one.number == tile; });
      if (row[tile].newest_look >= 0 && !there) tiles.push_back({tile, row[tile]});
    }
  }
  void deliver(const Agent& from, const Author& author, std::span<const Sent> tiles) {
    for (Agent& to : agents_) {
      if (to.author == from.author || to.author == author) continue;
      const double draw =
          uniform_pair(mission_.seed, Purpose::kFault, 1, static_cast<std::uint64_t>(++draws_)).x();
      if (draw < conditions_.loss) continue;
      for (const Sent& tile : tiles) to.efforts.merge(author, tile.number, tile.content, tick_);
    }
  }

  Mission mission_;
  Conditions conditions_;
  Objects objects_;
  Reports reports_;
  Tick period_, tick_ = 0;
  std::int64_t draws_ = 0;
  std::vector<Agent> agents_;
  std::vector<AgentId> team_;
  std::vector<TeamPlace> places_;
};

/// What a team achieved.
struct Result {
  double probability = 0, four_fifths_s = 0, found = 0, wrong = 0;
  double mean_age_s = 0, greatest_age_s = 0;
};

/// Judges a team by its places.
class Judge {
 public:
  explicit Judge(const Mission& mission)
      : mission_(mission),
        detection_(mission),
        objects_(mission),
        reports_(mission),
        confirmations_(mission),
        finds_(mission.objects.total()),
        seen_s_(detection_.cells().total(), 0) {
    detection_.begin_target(
        target_mass(mission.basis, mission.walls, mission.target_coefficients, detection_.cells()),
        0);
  }

  void see(AgentId id, Tick tick, const Eigen::Vector3d& x_m) {
    detection_.see(tick, x_m);
    const ObjectSet detected = objects_.detected(id, tick, x_m);
    const std::int32_t cell = reports_.cell(id, tick, x_m, detected, objects_.places_m());
    finds_.note(confirmations_.see(id, tick, x_m, detected, cell), {.agent = id, .tick = tick});
    if (tick % 10 != 0) return;
    const double t_s = static_cast<double>(tick) * mission_.timing.dt_s;
    const Cells& cells = detection_.cells();
    cells.for_near(x_m, sensor_radius_m(mission_), [&](int i, int j, int l) {
      seen_s_[cells.column(i, l) + static_cast<std::size_t>(j)] = t_s;
    });
  }
  void pass(Tick tick) {
    detection_.pass(tick);
    if (tick % 100 != 0) return;
    const double t_s = static_cast<double>(tick) * mission_.timing.dt_s;
    double age_s = 0;
    for (std::size_t cell = 0; cell < seen_s_.size(); ++cell)
      age_s += detection_.mass()[cell] * (t_s - seen_s_[cell]);
    ages_s_ += age_s;
    ++samples_;
  }
  Result result(Tick ticks) const {
    return {
        detection_.probability(),
        detection_.four_fifths_time_s().value_or(std::numeric_limits<double>::infinity()),
        finds_.objects() == 0 ? 0 : static_cast<double>(finds_.list().size()) / finds_.objects(),
        static_cast<double>(confirmations_.wrong()),
        ages_s_ / static_cast<double>(samples_),
        detection_.greatest_age_s(ticks, 0.95)};
  }

 private:
  Mission mission_;
  Detection detection_;
  Objects objects_;
  Reports reports_;
  Confirmations confirmations_;
  Finds finds_;
  std::vector<double> seen_s_;
  double ages_s_ = 0;
  int samples_ = 0;
};

template <class AnyTeam>
Result judged(const Mission& mission, AnyTeam&& team) {
  Judge judge(mission);
  for (Tick tick = 0; tick < mission.timing.tick_count; ++tick) {
    for (std::size_t i = 0; i < team.size(); ++i)
      judge.see(static_cast<AgentId>(i), tick, team.x_m(i));
    judge.pass(tick);
    team.step();
  }
  return judge.result(mission.timing.tick_count);
}

using Fields = std::vector<std::pair<std::string, std::string>>;

Mission mission_of(const std::string& file, const std::string& duration_s, const Fields& fields,
                   int seed) {
  Overrides overrides;
  overrides.seed = static_cast<std::uint64_t>(seed);
  overrides.duration_s = std::stod(duration_s);
  overrides.fields = {{"sensor.radius_m", "50", ""}};
  for (const auto& [path, value] : fields) overrides.fields.push_back({path, value, ""});
  auto loaded = Scenario::load(file, overrides);
  if (!loaded) throw std::runtime_error(to_string(loaded.error().front()));
  return loaded->mission();
}

struct Row {
  std::string name;
  Fields fields;
  std::optional<Conditions> conditions;  // nothing: an IdealTeam
};

/// A mean, and the half of its interval of 95 %.
std::string mean(const std::vector<Result>& results, double Result::*member) {
  double sum = 0, squares = 0;
  const auto n = static_cast<double>(results.size());
  for (const Result& one : results) {
    sum += one.*member;
    squares += one.*member * one.*member;
  }
  const double variance = std::max(0.0, squares / n - sum * sum / n / n);
  char text[60];
  std::snprintf(text, sizeof text, "%.4g ± %.2g", sum / n, 1.96 * std::sqrt(variance / n));
  return text;
}

void print(const Row& row, const std::vector<Result>& results) {
  std::vector<double> times_s;
  for (const Result& one : results) times_s.push_back(one.four_fifths_s);
  std::string line = "| " + row.name;
  for (double Result::*member : {&Result::probability, &Result::found, &Result::wrong,
                                 &Result::mean_age_s, &Result::greatest_age_s})
    line += " | " + mean(results, member);
  std::printf("%s | %.0f |\n", line.c_str(), median_of(times_s).value);
  std::fflush(stdout);
}

void run(const std::string& file, int first, int last, const std::string& duration_s,
         const std::vector<Row>& rows) {
  std::printf(
      "| %s, seeds %d to %d | P(found) | objects found | wrong contacts | mean age [s] | "
      "greatest age of 95 %% [s] | 80 %% after [s] |\n|---|---|---|---|---|---|---|\n",
      file.c_str(), first, last);
  for (const Row& row : rows) {
    std::vector<Result> results;
    for (int seed = first; seed <= last; ++seed) {
      const Mission mission = mission_of(file, duration_s, row.fields, seed);
      results.push_back(row.conditions ? judged(mission, Team(mission, *row.conditions))
                                       : judged(mission, lab::IdealTeam(mission)));
    }
    print(row, results);
  }
}

const Fields kSearch{{"law.kind", "SEARCH"}};
Fields search_with(Fields more) {
  more.insert(more.begin(), kSearch.begin(), kSearch.end());
  return more;
}

const std::vector<Row> kLosses{
    {"rows each 2 s", kSearch, Conditions{}},
    {"rows each 2 s, 30 % lost", kSearch, Conditions{.loss = 0.3}},
    {"rows each 10 s, 30 % lost", kSearch, Conditions{.period_s = 10, .loss = 0.3}},
};
const std::vector<Row> kDeaths{
    {"an agent is lost", kSearch, Conditions{.loss = 0.3, .dies = true}},
    {"the same, and all is known", kSearch,
     Conditions{.loss = 0.3, .dies = true, .all_known = true}},
};
const Fields kAlarms{{"sensor.false_alarms_per_s", "0.01"}, {"sensor.position_error_m", "10"}};
const std::vector<Row> kFalseAlarms{
    {"no false alarms", search_with({{"world.objects.count", "4"}}), Conditions{.loss = 0.3}},
    {"0.01 per s", search_with({{"world.objects.count", "4"}, kAlarms[0], kAlarms[1]}),
     Conditions{.loss = 0.3}},
    {"0.01 per s, one object", search_with({{"world.objects.count", "1"}, kAlarms[0], kAlarms[1]}),
     Conditions{.loss = 0.3}},
};
const std::vector<Row> kWatching{
    {"COVER", {{"law.kind", "COVER"}}, std::nullopt},
    {"MOW", {{"law.kind", "MOW"}}, std::nullopt},
    {"SEARCH, half-life 150 s", search_with({{"law.memory_half_life_s", "150"}}), Conditions{}},
    {"SEARCH, half-life 300 s", search_with({{"law.memory_half_life_s", "300"}}), Conditions{}},
    {"SEARCH, half-life 600 s", search_with({{"law.memory_half_life_s", "600"}}), Conditions{}},
};

/// Three objects that drift, sought in a way.
Row drifting(const std::string& name, const std::string& speed_mps, Fields fields,
             std::optional<Conditions> conditions = Conditions{.loss = 0.3}) {
  fields.insert(fields.end(),
                {{"world.objects.count", "3"}, {"world.objects.motion.speed_mps", speed_mps}});
  return {speed_mps + " m/s, " + name, std::move(fields), conditions};
}
const Fields kNothingFades{{"law.kind", "SEARCH"}, {"law.memory_half_life_s", "0"}};
const std::vector<Row> kDrifting{
    drifting("nothing fades", "0.6", kNothingFades),
    drifting("the usual half-life", "0.6", kSearch),
    drifting("half-life 150 s", "0.6", search_with({{"law.memory_half_life_s", "150"}})),
    drifting("nothing fades", "2", kNothingFades),
    drifting("the usual half-life", "2", kSearch),
    drifting("MOW", "2", {{"law.kind", "MOW"}}, std::nullopt),
    drifting("MOW", "0.6", {{"law.kind", "MOW"}}, std::nullopt),
};

}  // namespace
}  // namespace ergocast::studies

int main(int argc, char** argv) {
  using namespace ergocast::studies;
  if (argc != 5) {
    std::fprintf(
        stderr,
        "usage: studies-search losses|deaths|alarms|watching|drifting SCENARIO FIRST LAST\n");
    return 2;
  }
  try {
    const std::string table = argv[1];
    const bool watching = table == "watching";
    const auto& rows = watching              ? kWatching
                       : table == "losses"   ? kLosses
                       : table == "deaths"   ? kDeaths
                       : table == "drifting" ? kDrifting
                                             : kFalseAlarms;
    run(argv[2], std::stoi(argv[3]), std::stoi(argv[4]), watching ? "6000" : "600", rows);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "studies-search: %s\n", error.what());
    return 2;
  }
}
