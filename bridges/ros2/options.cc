// SPDX-License-Identifier: BSD-3-Clause
// Reads the bridge's file, and chooses robots of it.
#include "bridges/ros2/options.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "bridges/ros2/map_command.h"

namespace ergocast::ros2 {
std::optional<int> domain_of_environment() {
  const char* text = std::getenv("ROS_DOMAIN_ID");
  if (text == nullptr || *text == '\0') return 0;
  const std::string_view digits(text);
  int domain = 0;
  const auto [end, error] = std::from_chars(digits.begin(), digits.end(), domain);
  const bool valid = error == std::errc() && end == digits.end() && domain >= 0 && domain <= 232;
  return valid ? std::optional(domain) : std::nullopt;
}

namespace {

/// What is wrong with the file or the choice; empty if all is well.
std::string read_file(const std::filesystem::path& file, const std::vector<AgentId>& chosen,
                      Options& options) {
  auto bridge = read_bridge_file(file);
  if (!bridge) return bridge.error();
  options.bridge = *std::move(bridge);
  auto& robots = options.bridge.robots;
  for (const AgentId id : chosen) {
    if (std::ranges::find(robots, id, &BridgedRobot::id) == robots.end())
      return "--robot " + std::to_string(id) + ": " + file.string() + " has no such robot";
  }
  if (!chosen.empty()) {
    std::erase_if(robots, [&](const BridgedRobot& robot) {
      return std::ranges::find(chosen, robot.id) == chosen.end();
    });
    options.bridge.display.reset();
  }
  const auto domain = options.bridge.domain_id ? options.bridge.domain_id : domain_of_environment();
  if (!domain) return kNoDomain;
  options.domain_id = *domain;
  return "";
}

}  // namespace

int read_command_line(int argc, char** argv, Options& options) {
  CLI::App app("Robots and displays with ROS 2 in the place of ergocast-sim, over DDS.",
               "ergocast-ros2");
  std::filesystem::path file;
  std::vector<AgentId> chosen;
  add_node_options(app, options.node);
  app.add_option("FILE", file, "The robots, their topics and frames, and the displays")
      ->required()
      ->type_name("FILE");
  app.add_option("--robot", chosen, "Drive only these robots of the file, without its display")
      ->check(CLI::Range(0, kMaxAgents - 1).description(""))
      ->type_name("N");
  app.add_subcommand("map", kMapSummary);  // for the help: map_command() reads its own arguments
  app.footer(
      "Exit codes: 0 done; 2 bad arguments or file; 3 LCM or DDS cannot be used on this machine; "
      "4 the\nmission failed, or was refused.");
  if (const int code = parse_command_line(app, argc, argv); code >= 0) return code;
  const std::string problem = read_file(file, chosen, options);
  if (problem.empty()) return -1;
  std::fprintf(stderr, "%s\n", problem.c_str());
  return kExitBadInput;
}

}  // namespace ergocast::ros2
