// SPDX-License-Identifier: BSD-3-Clause
// Compiles each target for the mission, and lists them by their ticks.
#include "cli/study/planned_targets.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "cli/record/new_target.h"
#include "cli/report_error.h"
#include "plan/amendment_list.h"
#include "plan/plan.h"
#include "runtime/process/shipped_scenarios.h"
#include "text/read_number.h"
#include "text/shortest.h"

namespace ergocast::cli {
namespace {

PlannedTarget planned_from(const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto t_s = read_number<double>(std::string_view(text).substr(0, colon));
  if (colon == std::string::npos || colon + 1 == text.size() || !t_s || !(*t_s >= 0))
    throw CLI::ValidationError("--amend", "\"" + text +
                                              "\" is not T:FILE, such as 60:north.textproto for a "
                                              "target from t = 60 s on");
  std::string file = text.substr(colon + 1);
  if (const std::string problem = shipped_scenario()(file); !problem.empty())
    throw CLI::ValidationError("--amend", problem);
  return {*t_s, file, "--amend " + text};
}

/// Why the ticks of targets are impossible; nothing if they are not.
std::optional<std::string> why_impossible(const std::vector<std::pair<Tick, PlannedTarget>>& all,
                                          const Timing& timing) {
  if (all.size() > kMaxRecentAmendments)
    return "--amend: at most " + std::to_string(kMaxRecentAmendments) +
           " targets can be planned, and these are " + std::to_string(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [tick, one] = all[i];
    if (tick >= timing.tick_count)
      return one.flag + ": the mission has ended then, at t = " +
             shortest(static_cast<double>(timing.tick_count) * timing.dt_s) +
             " s: name an earlier time";
    if (i > 0 && tick == all[i - 1].first)
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

}  // namespace

CLI::Option* add_amend_option(CLI::App& command, std::vector<PlannedTarget>& planned) {
  return command
      .add_option_function<std::vector<std::string>>(
          "--amend",
          [&planned](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) planned.push_back(planned_from(text));
          },
          "A new target from mission time T [s] on, as `ergocast amend --target FILE` gives it; "
          "once for each target")
      ->allow_extra_args(false)
      ->type_name("T:FILE");
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
