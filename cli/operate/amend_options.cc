// SPDX-License-Identifier: BSD-3-Clause
// Adds the options of each kind of amendment, and reads their values.
#include "cli/operate/amend_options.h"

#include "cli/record/sighting.h"
#include "runtime/process/shipped_scenarios.h"
#include "text/read_number.h"

namespace ergocast::cli {
namespace {

/// Limit (Commands): time that `amend --at` counts from now [s]. Beyond it: it is refused.
constexpr double kMostDelay_s = 1e7;
/// The seconds of "+10s".
double delay_from(std::string text) {
  const std::string written = text;
  if (text.ends_with('s')) text.pop_back();
  if (text.starts_with('+')) {
    const auto value = read_number<double>(text.substr(1));
    if (value && *value >= 0 && *value <= kMostDelay_s) return *value;
  }
  throw CLI::ValidationError(
      "--at",
      "\"" + written + "\" is no time from now on: write +10s for ten seconds of the world's time");
}

std::int32_t number_from(const std::string& text) {
  if (const auto number = read_number<std::int32_t>(text)) return *number;
  throw CLI::ValidationError(
      "--cancel",
      "\"" + text + "\" is no number of an amendment: ergocast amend --list shows them");
}

EndWish end_from(const std::string& text) {
  if (const auto wish = end_wish_from(text)) return *wish;
  throw CLI::ValidationError(
      "--end",
      "\"" + text +
          "\" is no end: write 3600s for that mission time, or +600s for ten minutes later "
          "than the end that holds");
}

/// The seconds of "600s".
double duration_from(std::string text) {
  const std::string written = text;
  if (text.ends_with('s')) text.pop_back();
  const auto value = read_number<double>(text);
  if (value && *value > 0 && *value <= kMostDelay_s) return *value;
  throw CLI::ValidationError(
      "--for", "\"" + written + "\" is no time: write 600s for ten minutes of the world's time");
}

LawWish law_from(const std::string& text) {
  if (const auto wish = law_wish_from(text)) return *wish;
  throw CLI::ValidationError(
      "--law", "\"" + text +
                   "\" is not FIELD=VALUE: write u_max_mps=8, or scout.u_max_mps=8 for the "
                   "agents of one kind");
}

void add_search_options(CLI::App& command, AmendOptions& options) {
  auto* sighting =
      command
          .add_option_function<std::string>(
              "--sighting",
              [&options](const std::string& text) {
                options.sighting = sighting_from(text);
                if (!options.sighting)
                  throw CLI::ValidationError(
                      "--sighting", "\"" + text + "\" is no sighting: write " + kSightingForm +
                                        ", such as 412,77.5,50,0.8 for one that is right with a "
                                        "probability of 0.8, within some 50 m");
              },
              "Where an object may be [m]. The target gets a Gaussian there with the standard "
              "deviation SIGMA_M and the SHARE of the mass, by default 0.5; a team that searches "
              "looks there again")
          ->type_name(kSightingForm);
  auto* dismissed =
      command
          .add_option_function<std::string>(
              "--dismiss",
              [&options](const std::string& text) {
                const auto x_m = place_from(text);
                if (!x_m)
                  throw CLI::ValidationError(
                      "--dismiss", "\"" + text +
                                       "\" is no place: write X,Y of a contact in metres, "
                                       "such as 412,77.5");
                options.dismissal = SearchNote{.x_m = *x_m};
              },
              "The place of a contact that is no object [m]: what sensors have reported in its "
              "cell and the neighbouring ones counts no more")
          ->type_name("X,Y");
  sighting->excludes(dismissed);
  for (auto* one : {sighting, dismissed})
    for (const char* other :
         {"--target", "--set", "--list", "--end", "--cancel", "--zone", "--law"})
      one->excludes(command.get_option(other));
  for (const char* other : {"--at", "--dry-run"}) dismissed->excludes(command.get_option(other));
}

void add_law_options(CLI::App& command, AmendOptions& options) {
  auto* law = command
                  .add_option_function<std::vector<std::string>>(
                      "--law",
                      [&options](const std::vector<std::string>& texts) {
                        for (const std::string& text : texts) options.law.push_back(law_from(text));
                      },
                      "Another u_max_mps, noise_intensity or noise_ceiling of the law, for all "
                      "agents or as KIND.FIELD for one kind; once for each field. A speed is at "
                      "most that of the plan")
                  ->allow_extra_args(false)
                  ->type_name("FIELD=VALUE");
  for (const char* other : {"--target", "--set", "--list", "--end", "--cancel", "--zone"})
    law->excludes(command.get_option(other));
}

void add_zone_options(CLI::App& command, AmendOptions& options) {
  auto* zone =
      command
          .add_option("--zone", options.zone,
                      "A polygon that the team leaves and does not enter, as text, GeoJSON "
                      "or a drawing")
          ->type_name("FILE");
  auto* lasts =
      command
          .add_option_function<std::string>(
              "--for",
              [&options](const std::string& text) { options.zone_lasts_s = duration_from(text); },
              "How long the zone lasts from when nobody is inside, in the world's time, which a "
              "pause does not stop: 600s")
          ->type_name("TIME");
  auto* force = command.add_flag(
      "--force", options.force,
      "Take an --at that is too early for all to leave the zone; the agents inside are named");
  zone->needs(lasts);
  lasts->needs(zone);
  force->needs(zone);
  for (const char* other : {"--target", "--set", "--list", "--end", "--cancel"})
    zone->excludes(command.get_option(other));
}

void add_target_options(CLI::App& command, AmendOptions& options) {
  command
      .add_option("--target", options.target,
                  "A scenario, of which only the target counts, or a map, GeoJSON or drawing")
      ->transform(shipped_scenario())
      ->type_name("FILE");
  add_set_option(command, options.overrides.fields);
  command.get_option("--set")->description(
      "A field of the target and its value, such as target.uniform_weight=0.1; once for each "
      "field. Without --target: of the scenario in the run's directory");
  command
      .add_option_function<std::string>(
          "--at", [&options](const std::string& text) { options.delay_s = delay_from(text); },
          "How much later than necessary a target or law holds, or how long after it is closed a "
          "zone is free, in the world's time, which a pause does not stop: +10s")
      ->type_name("+TIME");
  command
      .add_option_function<std::string>(
          "--end", [&options](const std::string& text) { options.end = end_from(text); },
          "Another end of the mission: 3600s in mission time, or +600s later or -60s earlier than "
          "the end that holds")
      ->type_name("TIME");
  command
      .add_option_function<std::string>(
          "--cancel", [&options](const std::string& text) { options.cancel = number_from(text); },
          "Undo amendment N, as --list numbers it: what held before it holds again, and a zone "
          "ends")
      ->type_name("N");
  command.add_flag("--dry-run", options.dry_run,
                   "Only check the target, law or zone and show what would change; send nothing");
  auto* list = command.add_flag("--list", options.list, "List what has changed in the mission");
  for (const char* other : {"--target", "--set", "--at", "--dry-run"})
    list->excludes(command.get_option(other));
  for (const char* one : {"--end", "--cancel"})
    for (const char* other : {"--target", "--set", "--at", "--dry-run", "--list"})
      command.get_option(one)->excludes(command.get_option(other));
  command.get_option("--end")->excludes(command.get_option("--cancel"));
}

}  // namespace

void add_amend_options(CLI::App& command, AmendOptions& options) {
  add_target_options(command, options);
  add_zone_options(command, options);
  add_law_options(command, options);
  add_search_options(command, options);
  // The page's process names its operator.
  command.add_option("--by", options.by)->group("");
}

bool names_nothing(const AmendOptions& options) {
  const bool has_target = !options.target.empty() || !options.overrides.fields.empty();
  return !has_target && !options.sighting && !options.dismissal && options.zone.empty() &&
         options.law.empty() && !options.list && !options.end && !options.cancel;
}

}  // namespace ergocast::cli
