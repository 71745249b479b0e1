// SPDX-License-Identifier: BSD-3-Clause
// Compiles each target and each zone for the mission, and lists them by their ticks.
#include "cli/study/planned_targets.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "cli/record/new_target.h"
#include "cli/record/sighting.h"
#include "cli/report_error.h"
#include "core/motion/end_rules.h"
#include "core/motion/zones.h"
#include "plan/amendment_list.h"
#include "plan/plan.h"
#include "runtime/process/shipped_scenarios.h"
#include "scenario/zone_file.h"
#include "text/read_number.h"
#include "text/shortest.h"

namespace ergocast::cli {
namespace {

/// "T:REST" as T and REST; REST is empty without a colon.
std::pair<std::string_view, std::string> at_colon(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string_view time = std::string_view(text).substr(0, colon);
  return {time, colon == std::string::npos ? "" : text.substr(colon + 1)};
}

std::optional<double> seconds_in(std::string_view text) {
  const auto value = read_number<double>(text);
  return value && *value >= 0 ? value : std::nullopt;
}

PlannedAmendment planned_from(const std::string& text) {
  const auto [time, file] = at_colon(text);
  const std::size_t plus = time.find('+');
  const auto t_s = seconds_in(time.substr(0, plus));
  std::optional<double> lasts_s;
  if (plus != std::string_view::npos) lasts_s = seconds_in(time.substr(plus + 1)).value_or(0);
  if (!file.empty() && t_s && lasts_s && *lasts_s == 0)
    throw CLI::ValidationError(
        "--amend", "\"" + text + "\": a zone lasts for TIME above 0: write 60+300:" + file +
                       " for one that is free from t = 60 s on, for 300 s");
  if (file.empty() || !t_s)
    throw CLI::ValidationError("--amend",
                               "\"" + text +
                                   "\" is not T:FILE, such as 60:north.textproto for a target "
                                   "from t = 60 s on, or 60+300:field.geojson for a zone that is "
                                   "free then and for 300 s");
  std::string found = file;
  if (const std::string problem = shipped_scenario()(found); !problem.empty())
    throw CLI::ValidationError("--amend", problem);
  return {.t_s = *t_s, .file = found, .lasts_s = lasts_s, .flag = "--amend " + text};
}

PlannedAmendment planned_end_from(const std::string& text) {
  const auto [time, rest] = at_colon(text);
  const auto t_s = seconds_in(time);
  const auto wish = t_s ? end_wish_from(rest) : std::nullopt;
  if (!wish)
    throw CLI::ValidationError("--end", "\"" + text +
                                            "\" is not T:TIME, such as 60:+600s for an end ten "
                                            "minutes later, named at t = 60 s");
  return {.t_s = *t_s, .end = wish, .flag = "--end " + text};
}

PlannedAmendment planned_law_from(const std::string& text) {
  const auto [time, rest] = at_colon(text);
  const auto t_s = seconds_in(time);
  const auto wish = t_s ? law_wish_from(rest) : std::nullopt;
  if (!wish)
    throw CLI::ValidationError("--law", "\"" + text +
                                            "\" is not T:FIELD=VALUE, such as 60:u_max_mps=8 for "
                                            "that speed from t = 60 s on");
  return {.t_s = *t_s, .law = wish, .flag = "--law " + text};
}

PlannedAmendment planned_sighting_from(const std::string& text) {
  const auto [time, rest] = at_colon(text);
  const auto t_s = seconds_in(time);
  const auto sighting = t_s ? sighting_from(rest) : std::nullopt;
  if (!sighting)
    throw CLI::ValidationError("--sighting", "\"" + text + "\" is not T:" + kSightingForm +
                                                 ", such as 60:412,77.5,50 for one at t = 60 s");
  return {.t_s = *t_s, .note = sighting, .flag = "--sighting " + text};
}

PlannedAmendment planned_dismissal_from(const std::string& text) {
  const auto [time, rest] = at_colon(text);
  const auto t_s = seconds_in(time);
  const auto x_m = t_s ? place_from(rest) : std::nullopt;
  if (!x_m)
    throw CLI::ValidationError("--dismiss", "\"" + text +
                                                "\" is not T:X,Y, such as 60:412,77.5 for a "
                                                "contact there, at t = 60 s");
  return {.t_s = *t_s, .note = SearchNote{.x_m = *x_m}, .flag = "--dismiss " + text};
}

bool is_zone_file(const PlannedAmendment& one) {
  return !one.end && !one.law && !one.note && (one.lasts_s || looks_like_zone(one.file));
}

using Planned = std::vector<std::pair<Tick, PlannedAmendment>>;

/// Why an amendment cannot be the next one at its tick; nothing if it can.
std::optional<std::string> why_impossible(Tick tick, const PlannedAmendment& one,
                                          const Amendments& list, const Timing& timing) {
  if (list.recent.size() >= kMaxRecentAmendments)
    return one.flag + ": at most " + std::to_string(kMaxRecentAmendments) +
           " amendments can be planned";
  const Tick end = tick_count_of(timing, list.ends);
  if (tick >= end)
    return one.flag + ": the mission has ended then, at t = " +
           shortest(static_cast<double>(end) * timing.dt_s) + " s: name an earlier time";
  const bool is_target =
      one.note ? one.note->is_sighting() : !one.end && !one.law && !is_zone_file(one);
  if (is_target && !list.targets.empty() && list.targets.back().from == tick)
    return one.flag + ": another target holds from the same tick on: name another time";
  return std::nullopt;
}

/// Why a mission cannot get this end at a tick; nothing if it got it.
std::optional<std::string> append_end(Tick tick, const PlannedAmendment& one,
                                      const Mission& mission, Amendments& list) {
  const auto count = one.end->tick_count(mission.timing, tick_count_of(mission.timing, list.ends));
  if (!count) return one.flag + ": " + count.error();
  switch (EndRules().problem(mission, list, tick, tick, *count, {})) {
    case EndProblem::kNone:
      name_end(list, tick, *count);
      return std::nullopt;
    case EndProblem::kSame:
      return one.flag + ": the mission ends then already: name another end";
    case EndProblem::kTooLate:
      return one.flag + ": a later end must be named " + shortest(kEndNotice_s) +
             " s before the end that holds: name it earlier";
    default:
      return one.flag + ": that end is before it is named: name a later end";
  }
}

/// Why a mission cannot get this law at a tick; nothing if it got it. Several fields of one tick
/// are one law.
std::optional<std::string> append_law(Tick tick, const PlannedAmendment& one,
                                      const Mission& mission, Amendments& list) {
  auto law = law_with(mission, newest_law(mission, list.laws), {&*one.law, 1});
  if (!law) return "--law: " + law.error();
  law->from = tick;
  if (!list.laws.empty() && list.laws.back().from == tick) {
    law->number = list.laws.back().number;
    std::ranges::find(list.recent, law->number, &Amendment::number)->hash = law_hash(*law);
    list.laws.back() = *std::move(law);
    return std::nullopt;
  }
  law->number = list.named++;
  list.recent.push_back({law->number, AmendmentKind::kLaw, tick, law_hash(*law)});
  list.laws.push_back(*std::move(law));
  return std::nullopt;
}

/// Appends the target of a file; an error was printed if that is not possible.
bool append_target(Tick tick, const PlannedAmendment& one, const Mission& mission,
                   const std::filesystem::path& file, Amendments& list) {
  const auto loaded = load_new_target(mission, one.file, {}, file);
  if (!loaded) {
    report_error(kExitBadInput, loaded.error());
    return false;
  }
  for (const Problem& warning : loaded->warnings()) print_message("warning: " + to_string(warning));
  add_target(list, tick, target_change_of(*loaded));
  return true;
}

/// Appends a sighting with its target, or a dismissal; an error was printed if that is not
/// possible.
bool append_note(Tick tick, const SearchNote& note, const Mission& mission, Amendments& list) {
  if (!note.is_sighting()) {
    if (const auto problem = why_not_dismissed(mission, note))
      return report_error(kExitBadInput, std::vector{*problem}) == kExitDone;
    name_dismissal(list, tick, note);
    return true;
  }
  const auto sighted = target_with(mission, target_now(mission, list, tick), note);
  if (!sighted) return report_error(kExitBadInput, sighted.error()) == kExitDone;
  for (const Problem& warning : sighted->warnings) print_message("warning: " + to_string(warning));
  add_target(list, tick, sighted->target);
  note_sighting(list, sighted->sighting);
  return true;
}

/// Adds a zone that is free from a tick on, and closed as long before as agents need to leave it.
/// If it has a problem, prints it and returns false.
bool append_zone(Tick tick, const PlannedAmendment& planned, const Mission& mission,
                 const std::filesystem::path& scenario, Amendments& list) {
  auto loaded = load_zone(planned.file, zone_context(mission, scenario));
  if (!loaded) return report_error(kExitBadInput, loaded.error()) == kExitDone;
  Zone zone = *std::move(loaded);
  const double dt_s = mission.timing.dt_s;
  const Tick lasts = planned.lasts_s ? static_cast<Tick>(std::llround(*planned.lasts_s / dt_s))
                                     : tick_count_of(mission.timing, list.ends);
  zone.until = std::max<Tick>(1, lasts);
  const std::vector<Zone> others = not_ended(list.zones, tick);
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
  add_zone(list, closed, notice, std::move(zone));
  return true;
}

}  // namespace

CLI::Option* add_amend_option(CLI::App& command, std::vector<PlannedAmendment>& planned) {
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

CLI::Option* add_end_option(CLI::App& command, std::vector<PlannedAmendment>& planned) {
  return command
      .add_option_function<std::vector<std::string>>(
          "--end",
          [&planned](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) planned.push_back(planned_end_from(text));
          },
          "Another end, named at mission time T [s], as `ergocast amend --end TIME` gives it; once "
          "for each end")
      ->allow_extra_args(false)
      ->type_name("T:TIME");
}

CLI::Option* add_law_option(CLI::App& command, std::vector<PlannedAmendment>& planned) {
  return command
      .add_option_function<std::vector<std::string>>(
          "--law",
          [&planned](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) planned.push_back(planned_law_from(text));
          },
          "Another number of the law from mission time T [s] on, as `ergocast amend --law "
          "FIELD=VALUE` gives it; once for each field")
      ->allow_extra_args(false)
      ->type_name("T:FIELD=VALUE");
}

void add_search_options(CLI::App& command, std::vector<PlannedAmendment>& planned,
                        CLI::Option* excluded) {
  const auto add = [&](const char* name, auto read, const char* description) {
    return command
        .add_option_function<std::vector<std::string>>(
            name,
            [&planned, read](const std::vector<std::string>& texts) {
              for (const std::string& text : texts) planned.push_back(read(text));
            },
            description)
        ->allow_extra_args(false)
        ->excludes(excluded);
  };
  add("--sighting", planned_sighting_from,
      "A sighting at mission time T [s], as `ergocast amend --sighting` gives it; once for each")
      ->type_name(std::string("T:") + kSightingForm);
  add("--dismiss", planned_dismissal_from,
      "A contact that is dismissed at mission time T [s], as `ergocast amend --dismiss` does it; "
      "once for each")
      ->type_name("T:X,Y");
}

std::optional<Amendments> amendments_with(const std::vector<PlannedAmendment>& planned,
                                          const Scenario& scenario,
                                          const std::filesystem::path& file) {
  const Mission& mission = scenario.mission();
  Planned all;
  for (const PlannedAmendment& one : planned) {
    const double tick = std::min(std::round(one.t_s / mission.timing.dt_s), 1e15);
    all.emplace_back(static_cast<Tick>(tick), one);
  }
  std::ranges::stable_sort(all, {}, &Planned::value_type::first);
  Amendments list;
  for (const auto& [tick, one] : all) {
    auto problem = why_impossible(tick, one, list, mission.timing);
    if (!problem && one.end) problem = append_end(tick, one, mission, list);
    if (!problem && one.law) problem = append_law(tick, one, mission, list);
    if (problem) {
      print_message(*problem);
      return std::nullopt;
    }
    if (one.end || one.law) continue;
    const bool appended = one.note            ? append_note(tick, *one.note, mission, list)
                          : is_zone_file(one) ? append_zone(tick, one, mission, file, list)
                                              : append_target(tick, one, mission, file, list);
    if (!appended) return std::nullopt;
  }
  for (Amendment& one : list.recent) one.by = "simulate";
  if (encode_plan(mission).size() + encode_amendments(list).size() <= kMaxPlanBytes) return list;
  print_message("--amend: the targets have more coefficients than a mission can carry: plan fewer");
  return std::nullopt;
}

}  // namespace ergocast::cli
