// SPDX-License-Identifier: BSD-3-Clause
// Compiles each target and each zone for the mission, and lists them by their ticks.
#include "cli/study/planned_targets.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "cli/record/new_target.h"
#include "cli/report_error.h"
#include "core/motion/zones.h"
#include "plan/amendment_list.h"
#include "plan/plan.h"
#include "runtime/process/shipped_scenarios.h"
#include "scenario/zone_file.h"
#include "text/read_number.h"
#include "text/shortest.h"

namespace ergocast::cli {
namespace {

PlannedTarget planned_from(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string_view time = std::string_view(text).substr(0, colon);
  const std::size_t plus = time.find('+');
  const auto t_s = read_number<double>(time.substr(0, plus));
  std::optional<double> lasts_s;
  if (plus != std::string_view::npos)
    lasts_s = read_number<double>(time.substr(plus + 1)).value_or(-1);
  if (colon == std::string::npos || colon + 1 == text.size() || !t_s || !(*t_s >= 0) ||
      (lasts_s && !(*lasts_s > 0)))
    throw CLI::ValidationError("--amend",
                               "\"" + text +
                                   "\" is not T:FILE, such as 60:north.textproto for a target "
                                   "from t = 60 s on, or 60+300:field.geojson for a zone that is "
                                   "free then and for 300 s");
  std::string file = text.substr(colon + 1);
  if (const std::string problem = shipped_scenario()(file); !problem.empty())
    throw CLI::ValidationError("--amend", problem);
  return {*t_s, file, "--amend " + text, lasts_s};
}

bool is_zone_file(const PlannedTarget& one) { return one.lasts_s || looks_like_zone(one.file); }

/// Why the ticks of targets are impossible; nothing if they are not.
std::optional<std::string> why_impossible(const std::vector<std::pair<Tick, PlannedTarget>>& all,
                                          const Timing& timing) {
  if (all.size() > kMaxRecentAmendments)
    return "--amend: at most " + std::to_string(kMaxRecentAmendments) +
           " amendments can be planned, and these are " + std::to_string(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [tick, one] = all[i];
    if (tick >= timing.tick_count)
      return one.flag + ": the mission has ended then, at t = " +
             shortest(static_cast<double>(timing.tick_count) * timing.dt_s) +
             " s: name an earlier time";
    const bool both_targets = i > 0 && !is_zone_file(one) && !is_zone_file(all[i - 1].second);
    if (both_targets && tick == all[i - 1].first)
      return one.flag + ": another target holds from the same tick on: name another time";
  }
  return std::nullopt;
}

void append(Tick tick, TargetChange change, Amendments& list) {
  change.number = list.named++;
  change.from = tick;
  list.recent.push_back({change.number, AmendmentKind::kTarget, tick, target_hash(change)});
  list.targets.push_back(std::move(change));
}

/// Adds a zone that is free from a tick on, and closed as long before as agents need to leave it.
/// If it has a problem, prints it and returns false.
bool add_zone(Tick tick, const PlannedTarget& planned, const Mission& mission,
              const std::filesystem::path& scenario, Amendments& list) {
  auto loaded = load_zone(planned.file, zone_context(mission, scenario));
  if (!loaded) return report_error(kExitBadInput, loaded.error()) == kExitDone;
  Zone zone = *std::move(loaded);
  const double dt_s = mission.timing.dt_s;
  const Tick lasts = planned.lasts_s ? static_cast<Tick>(std::llround(*planned.lasts_s / dt_s))
                                     : mission.timing.tick_count;
  zone.until = std::max<Tick>(1, lasts);
  std::vector<Zone> others = list.zones;
  std::erase_if(others, [tick](const Zone& other) { return other.until <= tick; });
  if (const auto problem = zone_problem(mission, zone, others)) {
    const Problem found{planned.file.string(), problem->what, problem->remedy};
    return report_error(kExitBadInput, std::vector{found}) == kExitDone;
  }
  const Tick notice = least_notice_ticks(mission, zone, others);
  if (tick < notice) {
    print_message(planned.flag + ": the agents may need " + seconds_text(notice, mission) +
                  " to leave the zone: name a later time");
    return false;
  }
  const Tick closed = tick - notice;
  if (zones_at(list, closed) >= kMaxZones) {
    print_message(planned.flag + ": at most " + std::to_string(kMaxZones) +
                  " zones can be in force at a time");
    return false;
  }
  zone.number = list.named++;
  zone.closed = closed;
  zone.from = tick;
  zone.until += tick;
  list.recent.push_back({zone.number, AmendmentKind::kZone, tick, zone_hash(zone)});
  list.zones.push_back(std::move(zone));
  return true;
}

}  // namespace

CLI::Option* add_amend_option(CLI::App& command, std::vector<PlannedTarget>& planned) {
  return command
      .add_option_function<std::vector<std::string>>(
          "--amend",
          [&planned](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) planned.push_back(planned_from(text));
          },
          "A new target from mission time T [s] on, as `ergocast amend --target FILE` gives it, or "
          "with T+TIME a zone that is free then and for TIME [s]; once for each")
      ->allow_extra_args(false)
      ->type_name("T[+TIME]:FILE");
}

std::optional<Amendments> amendments_with(const std::vector<PlannedTarget>& planned,
                                          const Scenario& scenario,
                                          const std::filesystem::path& file) {
  const Mission& mission = scenario.mission();
  std::vector<std::pair<Tick, PlannedTarget>> all;
  for (const PlannedTarget& one : planned) {
    const double tick = std::min(std::round(one.t_s / mission.timing.dt_s), 1e15);
    all.emplace_back(static_cast<Tick>(tick), one);
  }
  std::ranges::stable_sort(all, {}, &std::pair<Tick, PlannedTarget>::first);
  if (const auto problem = why_impossible(all, mission.timing)) {
    print_message(*problem);
    return std::nullopt;
  }
  Amendments list;
  for (const auto& [tick, one] : all) {
    if (is_zone_file(one)) {
      if (!add_zone(tick, one, mission, file, list)) return std::nullopt;
      continue;
    }
    const auto loaded = load_new_target(mission, one.file, {}, file);
    if (!loaded) {
      report_error(kExitBadInput, loaded.error());
      return std::nullopt;
    }
    for (const Problem& warning : loaded->warnings())
      print_message("warning: " + to_string(warning));
    append(tick, target_change_of(*loaded), list);
  }
  if (encode_plan(mission).size() + encode_amendments(list).size() <= kMaxPlanBytes) return list;
  print_message("--amend: the targets have more coefficients than a mission can carry: plan fewer");
  return std::nullopt;
}

}  // namespace ergocast::cli
