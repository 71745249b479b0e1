// SPDX-License-Identifier: BSD-3-Clause
// Waits for one latched message, checks it, and writes two files that are not there yet.
#include "bridges/ros2/map_command.h"

#include <poll.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "bridges/ros2/bridge_file.h"
#include "bridges/ros2/dds_node.h"
#include "bridges/ros2/map.h"
#include "bridges/ros2/message_types.h"
#include "bridges/ros2/options.h"
#include "runtime/bus/clock.h"
#include "runtime/process/program_options.h"
#include "runtime/process/signals.h"
#include "text/printable.h"

namespace ergocast::ros2 {
namespace {

namespace fs = std::filesystem;
using OccupancyGrid = nav_msgs_msg_dds__OccupancyGrid_;

struct MapOptions {
  std::string topic = "map", frame = "map", mode = "trinary";
  fs::path save;
  double wait_s = 10;
  int domain_id = 0;
};

int complain(ExitCode code, const std::string& problem) {
  std::fprintf(stderr, "%s\n", printable(problem).c_str());
  return code;
}

fs::path picture_beside(fs::path yaml) { return yaml.replace_extension(".pgm"); }

/// Nothing, or why the file is not written.
std::optional<std::string> write(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (out) return std::nullopt;
  return file.string() + " cannot be written: " + std::strerror(errno);
}

MapMessage message_of(const OccupancyGrid& grid) {
  const auto& origin = grid.info.origin;
  return {.frame = grid.header.frame_id != nullptr ? grid.header.frame_id : "",
          .resolution_m = grid.info.resolution,
          .width = grid.info.width,
          .height = grid.info.height,
          .origin_m = {origin.position.x, origin.position.y, origin.position.z},
          .orientation = {origin.orientation.x, origin.orientation.y, origin.orientation.z,
                          origin.orientation.w},
          .data = {grid.data._buffer, grid.data._length}};
}

/// Whether no map can come, however long we wait.
bool is_hopeless(const std::string& problem) {
  return !problem.empty() && !problem.starts_with("nobody publishes");
}

/// The saved map, or what is wrong with the first one that comes; nothing: none came in time.
std::optional<Result<SavedMap>> receive(Reader& reader, DdsNode& node, const MapOptions& options,
                                        StopSignals& signals) {
  const MapMode mode = options.mode == "raw" ? MapMode::kRaw : MapMode::kTrinary;
  const Instant until = now() + std::chrono::nanoseconds(std::llround(options.wait_s * 1e9));
  std::optional<Result<SavedMap>> saved;
  while (!saved && now() < until && signals.take() == 0) {
    pollfd waiting[]{{node.fd(), POLLIN, 0}, {signals.fd(), POLLIN, 0}};
    poll(waiting, std::size(waiting), 100);
    if (node.clear() && is_hopeless(reader.problem())) break;
    reader.take([&](const void* message) {
      saved.emplace(save_map(message_of(*static_cast<const OccupancyGrid*>(message)), options.topic,
                             options.frame, picture_beside(options.save).filename().string(),
                             mode));
    });
  }
  return saved;
}

int run(const MapOptions& options) {
  const fs::path picture = picture_beside(options.save);
  for (const fs::path& file : {options.save, picture}) {
    std::error_code error;
    if (fs::exists(file, error))
      return complain(kExitBadInput, file.string() +
                                         " is there already: remove it, or choose "
                                         "another name with --save");
  }
  StopSignals signals;
  const auto node = DdsNode::open(options.domain_id);
  if (!node) return complain(kExitUnavailable, node.error());
  auto reader = Reader::make(**node, kOccupancyGrid, options.topic, {true, Latching::kNewest});
  if (!reader) return complain(kExitUnavailable, reader.error());
  const auto saved = receive(*reader, **node, options, signals);
  if (!saved) {
    const std::string why = reader->problem();
    return complain(kExitUnavailable,
                    "no map came: " + (why.empty() ? options.topic + " is silent" : why));
  }
  if (!*saved) return complain(kExitBadInput, saved->error());
  const SavedMap& map = **saved;
  if (auto problem = write(picture, map.picture)) return complain(kExitBadInput, *problem);
  if (auto problem = write(options.save, map.yaml)) return complain(kExitBadInput, *problem);
  const std::string name = printable(options.save.string());
  std::printf("%s: the map of %s, %zu cells unknown\n  ergocast new --map %s\n", name.c_str(),
              printable(options.topic).c_str(), map.unknown, name.c_str());
  return kExitDone;
}

}  // namespace

bool is_map_command(int argc, char** argv) {
  return argc > 1 && std::string_view(argv[1]) == "map";
}

int map_command(int argc, char** argv) {
  CLI::App app(kMapSummary, "ergocast-ros2 map");
  MapOptions options;
  app.add_option("--topic", options.topic, "The topic")->capture_default_str()->type_name("TOPIC");
  app.add_option("--frame", options.frame, "The frame_id that the map must have")
      ->capture_default_str()
      ->type_name("NAME");
  app.add_option("--save", options.save, "The description to write; the picture is beside it, .pgm")
      ->required()
      ->type_name("FILE.yaml");
  app.add_option("--mode", options.mode,
                 "trinary: free, occupied, unknown. raw: percentages, for a target")
      ->capture_default_str()
      ->check(CLI::IsMember({"trinary", "raw"}));
  app.add_option("--wait", options.wait_s, "How long to wait for the map [s]")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 3600.0));
  app.footer(
      "ROS_DOMAIN_ID names the domain. Exit codes: 0 done; 2 bad arguments or map, or a file is "
      "there\nalready; 3 no map came, or DDS cannot be used.");
  if (const int code = parse_command_line(app, argc - 1, argv + 1); code >= 0) return code;
  const auto topic = topic_named(options.topic);
  if (!topic) return complain(kExitBadInput, "--topic: " + no_topic(options.topic));
  options.topic = *topic;
  if (options.save.extension() != ".yaml")
    return complain(kExitBadInput, "--save: the name of " + options.save.string() +
                                       " must end in .yaml, as ergocast new expects it");
  const auto domain = domain_of_environment();
  if (!domain) return complain(kExitBadInput, kNoDomain);
  options.domain_id = *domain;
  return run(options);
}

}  // namespace ergocast::ros2
