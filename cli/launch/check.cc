// SPDX-License-Identifier: BSD-3-Clause
// `ergocast check`: loads a scenario and prints its warnings. Then it prints one line about it,
// what became of its maps, and writes a picture, or it prints its whole text with all defaults.
#include <algorithm>
#include <cstdio>
#include <memory>

#include "cli/commands.h"
#include "cli/launch/check_picture.h"
#include "cli/mission_options.h"
#include "cli/record/run_directory.h"
#include "cli/report_error.h"
#include "core/motion/separation.h"
#include "core/motion/vehicle.h"
#include "logger/run_record.h"
#include "plan/plan.h"
#include "runtime/process/program_options.h"
#include "scenario/parse/override_options.h"
#include "text/printable.h"
#include "text/shortest.h"

namespace ergocast::cli {
namespace {

struct CheckOptions {
  std::filesystem::path scenario;
  Overrides overrides;
  bool print = false;  ///< the scenario with all defaults
  std::filesystem::path picture;
};

constexpr std::size_t kMostRoomsListed = 6;

/// What bodies that follow late keep, in the scenario's numbers.
void tell_margins(const Mission& mission) {
  const Separation& rule = mission.separation;
  if (rule.distance_m == 0 || rule.response_s == 0) return;
  const double margin_m = rule.response_s * fastest_mps(mission);
  const double from_edges_m = margin_m + 2 * rule.position_error_m;
  const std::string from_walls =
      mission.walls.empty()
          ? ""
          : " and " + shortest(mission.wall_clearance_m + from_edges_m) + " m from walls";
  std::printf(
      "bodies follow %g s late: they close %.3g %% of a gap in a tick, and keep %g m more, in all "
      "%g m from each other, %g m from the edges%s\n",
      rule.response_s, 100 * closing_gain(mission), margin_m,
      SeparationFilter(mission, 0).contact_m(0, 0), from_edges_m, from_walls.c_str());
}

/// What bodies can reach of a map, and what it shows that is closed.
void print_rooms(const MapRooms& map) {
  const auto place = [](const MapRooms::Room& room) {
    char text[100];
    std::snprintf(text, sizeof text, "%.4g m^2 around x %.4g, y %.4g m", room.area_m2,
                  room.middle_m.x(), room.middle_m.y());
    return std::string(text);
  };
  std::printf("%s: %.4g m^2 free; rooms for bodies that keep %g m from walls: %zu\n",
              printable(map.file.string()).c_str(), map.free_m2, map.clearance_m, map.rooms.size());
  const auto used = static_cast<std::size_t>(map.used);
  if (used < map.rooms.size())
    std::printf("  %s: agents start here\n", place(map.rooms[used]).c_str());
  std::size_t listed = 1;
  double rest_m2 = 0;
  for (std::size_t i = 0; i < map.rooms.size(); ++i) {
    if (i == used) continue;
    if (listed++ < kMostRoomsListed)
      std::printf("  %s: cut off, so it counts as wall\n", place(map.rooms[i]).c_str());
    else
      rest_m2 += map.rooms[i].area_m2;
  }
  if (map.rooms.size() > kMostRoomsListed)
    std::printf("  %zu more, %.3g m^2: cut off\n", map.rooms.size() - kMostRoomsListed, rest_m2);
}

int check(const CheckOptions& options) {
  const auto scenario = load_or_complain(options.scenario, options.overrides);
  if (!scenario) return kExitBadInput;
  for (const Problem& warning : scenario->warnings()) {
    print_message("warning: " + to_string(warning));
  }
  if (options.print) {
    std::fputs(scenario->print().c_str(), stdout);
    return kExitDone;
  }
  const Mission& mission = scenario->mission();
  const std::vector<std::byte> plan = encode_plan(mission);
  const Basis& basis = mission.basis;
  const std::string along_z = mission.domain.planar() ? "" : " x " + std::to_string(basis.modes_z);
  const char* const kind = basis.free_domain ? " modes of the free domain" : " modes";
  std::printf("%s: no problems. %zu agents, %d x %d%s%s, %lld ticks of %g s, plan %s (%zu bytes)\n",
              options.scenario.c_str(), mission.starts_m.size(), basis.modes_x, basis.modes_y,
              along_z.c_str(), kind, static_cast<long long>(mission.timing.tick_count),
              mission.timing.dt_s, plan_hash(plan).c_str(), plan.size());
  tell_margins(mission);
  for (const MapRooms& map : scenario->map_rooms()) print_rooms(map);
  if (options.picture.empty()) return kExitDone;
  if (const auto problem = write_file(options.picture, picture_of(*scenario)))
    return report_error(kExitBadInput, *problem);
  return kExitDone;
}

}  // namespace

void add_check(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("check", "Name every problem of a scenario");
  auto options = std::make_shared<CheckOptions>();
  add_scenario_argument(*command, options->scenario);
  auto* const print =
      command->add_flag("--print", options->print, "Show the scenario with all defaults filled in");
  command
      ->add_option("--picture", options->picture,
                   "Draw domain, walls and starts, and hatched what is closed of maps, as SVG")
      ->type_name("FILE.svg")
      ->excludes(print);
  add_override_options(*command, options->overrides);
  command->callback([&action, options] { action = [options] { return check(*options); }; });
}

}  // namespace ergocast::cli
