// SPDX-License-Identifier: BSD-3-Clause
// The one table of allowed dependencies: which folder may include which, and what of outside.
#pragma once

#include <set>
#include <string_view>
#include <vector>

namespace ergocast {

// Headers outside the tree, by the capability they give. The harmless part of the standard library
// and Eigen are allowed everywhere.
enum class Outside {
  kProtobuf,     // the scenario's messages
  kLcm,          // the network
  kLcmTypes,     // lcm-gen's structs
  kInstalled,    // our own headers, as libergocast-dev installs them
  kZstd,         // libzstd
  kLog,          // spdlog
  kCommandLine,  // CLI11
  kJson,         // nlohmann
  kHash,         // xxHash
  kCrypto,       // libsodium
  kTls,          // OpenSSL
  kGenerator,    // Random123
  kExpected,     // tl::expected, for Result
  kSpectra,      // Spectra, and the sparse part of Eigen
  kPng,          // libpng
  kLoader,       // dlopen: libnetcdf, librsvg, libgdal
  kHttp,         // cpp-httplib
  kPython,       // pybind11
  kEarth,        // PROJ
  kXml,          // pugixml
  kPhysics,      // MuJoCo, and EGL for its pictures
  kProcessor,    // the instructions of one kind of processor
  kDds,          // CycloneDDS, and what its idlc makes
  kFiles,        // files and standard streams
  kSystem,       // sockets, signals, processes, threads, the machine's clocks and dice
};
using enum Outside;

/// The allowed includes of a folder, or of one file that differs from its folder.
struct Rule {
  std::string_view who;
  std::set<std::string_view> folders;
  std::set<Outside> outside;
};

// From the bottom up: a folder may include those above it in this list, and only those that it
// names.
inline const std::set<std::string_view> kCore = {"core/base",  "core/basis",   "core/mission",
                                                 "core/law",   "core/measure", "core/search",
                                                 "core/motion"};
inline const std::vector<Rule> kRules = {
    // The method. Law and motion do not see each other, but lanes lead around walls.
    {"core/base", {}, {kGenerator, kExpected}},
    {"core/basis", {"core/base"}, {}},
    {"core/mission", {"core/base", "core/basis"}, {}},
    {"core/measure", {"core/base", "core/basis", "core/mission"}, {}},
    {"core/search", {"core/base", "core/mission", "core/measure"}, {}},
    {"core/motion", {"core/base", "core/mission"}, {}},
    {"core/law", {"core/base", "core/basis", "core/mission", "core/measure", "core/search"}, {}},
    {"core/law/mower.h", {"core/base", "core/basis", "core/law", "core/motion"}, {}},
    {"core/law/mower.cc", {"core/law", "core/measure", "core/mission", "core/motion"}, {}},
    {"text", {"core/base"}, {kFiles}},
    {"text/input_file.cc", {"text"}, {kFiles, kSystem}},
    // Modes of a free domain: a process without their table computes them.
    {"modes", {"core"}, {}},
    {"modes/eigen_modes.cc", {"core", "modes"}, {kSpectra}},
    {"modes/table.cc", {"core", "modes"}, {kHash}},
    {"modes/table_file.h", {"core", "modes"}, {kFiles}},
    {"modes/table_file.cc", {"core", "modes"}, {kFiles, kSystem}},
    {"modes/provide.cc", {"core", "modes"}, {kHash, kSystem}},
    {"plan", {"core", "modes"}, {kHash}},
    {"team", {"core", "plan"}, {}},
    {"lcmtypes", {"text", "core", "plan", "team"}, {kLcmTypes, kHash, kCrypto}},
    {"target", {"text", "core"}, {}},
    // Polygons around cells: for maps of robots, and for drawings.
    {"target/contour", {"core", "target"}, {}},
    {"target/maps", {"text", "core", "target", "target/contour"}, {kPng, kFiles}},
    {"target/maps/symbol.h", {}, {kLoader}},
    {"target/maps/netcdf_library.cc", {"target/maps"}, {kLoader}},
    // Places on the earth, and drawings: for scenarios and exports, not for participants.
    {"target/geo", {"text", "core", "target/contour"}, {kEarth, kFiles, kJson, kXml}},
    {"target/geo/bounded_child.cc", {"target/geo"}, {kFiles, kSystem}},
    {"target/geo/svg_painter.cc", {"target/geo", "target/maps"}, {kLoader}},
    {"target/geo/gdal_library.cc", {"target/geo", "target/maps"}, {kLoader, kFiles}},
    {"target/geo/gdal_files.h", {"core", "target/geo", "target/maps"}, {kFiles}},
    {"target/geo/geotiff.cc", {"text", "core", "target/geo", "target/maps"}, {kFiles, kJson}},
    {"scenario/parse", {"text", "core", "plan", "target"}, {kProtobuf, kCommandLine, kFiles}},
    {"scenario/rules",
     {"text", "core", "plan", "target", "target/maps", "target/geo", "scenario/parse"},
     {kProtobuf, kFiles}},
    {"scenario/compile",
     {"text", "core", "modes", "plan", "target", "target/contour", "target/maps", "target/geo",
      "scenario/parse", "scenario/rules"},
     {kProtobuf, kFiles}},
    {"scenario",
     {"text", "core", "modes", "plan", "target", "target/maps", "target/geo", "scenario/parse",
      "scenario/rules", "scenario/compile"},
     {kProtobuf, kFiles}},
    {"runtime/bus", {"text", "core", "plan", "team", "lcmtypes"}, {kLcm, kFiles, kSystem}},
    {"runtime/record",
     {"text", "core", "team", "lcmtypes", "runtime/bus"},
     {kZstd, kFiles, kSystem}},
    {"runtime/process",
     {"text", "core", "modes", "plan", "team", "lcmtypes", "runtime/bus"},
     {kLcm, kLog, kCommandLine, kCrypto, kFiles, kSystem}},
    // The participants: they know the shared parts, but not each other.
    {"agent", {"core", "plan", "team"}, {}},
    {"coordinator", {"core", "plan", "team"}, {}},
    {"sim", {"core", "plan", "team"}, {}},
    {"logger", {"text", "core", "modes", "plan", "team"}, {kFiles, kJson}},
    {"agent/main.cc", {"agent", "runtime/bus", "runtime/process"}, {kLog}},
    {"coordinator/main.cc",
     {"plan", "team", "coordinator", "scenario", "scenario/parse", "runtime/bus",
      "runtime/process"},
     {kLog}},
    {"sim/main.cc", {"sim", "runtime/bus", "runtime/process"}, {kLog}},
    {"sim/world_process.h", {"sim", "runtime/bus", "runtime/process"}, {}},
    {"sim/world_process.cc", {"sim", "runtime/bus", "runtime/process"}, {kLog}},
    {"logger/main.cc",
     {"text", "modes", "plan", "team", "logger", "lcmtypes", "runtime/bus", "runtime/record",
      "runtime/process"},
     {kLog, kFiles, kSystem}},
    // Sites beyond one network. Sites and hubs are values; the last three files have the sockets.
    {"relay", {"core", "team", "lcmtypes", "runtime/bus"}, {kHash, kCrypto}},
    {"relay/endpoint.h", {"core", "relay", "runtime/bus"}, {kSystem}},
    {"relay/endpoint.cc", {"text", "relay", "runtime/bus"}, {kSystem}},
    {"relay/question.h", {"core", "lcmtypes", "relay"}, {}},
    {"relay/question.cc", {"relay", "runtime/bus"}, {kSystem}},
    {"relay/local_group.h", {"core", "team", "relay", "runtime/bus"}, {kSystem}},
    {"relay/local_group.cc", {"relay", "runtime/bus"}, {kSystem}},
    {"relay/main.cc", {"relay", "runtime/bus", "runtime/process"}, {kLog, kSystem}},
    {"report", {"text", "core", "target", "target/maps", "team", "logger"}, {kFiles, kJson}},
    {"report/export",
     {"text", "core", "target", "target/geo", "team", "logger", "report"},
     {kFiles, kJson}},
    // The same participants in one process: no network, no clock, no threads.
    {"lab/shadow", {"core", "team"}, {}},
    {"lab",
     {"core", "plan", "team", "lcmtypes", "agent", "coordinator", "sim", "logger", "lab/shadow"},
     {}},
    {"studies",
     {"text", "core", "plan", "target", "team", "scenario", "scenario/rules", "logger", "report",
      "lab"},
     {kJson, kFiles}},
    {"cli/doctor",
     {"text", "core", "team", "lcmtypes", "runtime/bus", "runtime/process"},
     {kJson, kFiles, kSystem}},
    {"cli/deploy",
     {"text", "core", "plan", "scenario", "scenario/parse", "runtime/bus", "runtime/process"},
     {kFiles}},
    // The commands. The lower rooms show nothing and start nothing.
    {"cli",
     {"text", "core", "scenario", "scenario/parse", "runtime/bus", "runtime/process"},
     {kCommandLine, kFiles, kSystem}},
    {"cli/team",
     {"text", "core", "plan", "team", "lcmtypes", "target", "scenario", "runtime/bus",
      "runtime/record", "runtime/process", "logger", "report", "cli"},
     {kJson, kFiles, kSystem}},
    // The team as events for TAK; only the last has a socket and a clock.
    {"cli/tak", {"text", "core", "team", "target/geo", "cli/team"}, {}},
    {"cli/tak/cot_event.cc", {"text", "cli/tak"}, {kXml}},
    {"cli/tak/cot_output.h",
     {"core", "relay", "runtime/bus", "cli/team", "cli/tak"},
     {kCommandLine}},
    {"cli/tak/cot_output.cc", {"runtime/bus", "cli", "cli/tak"}, {kSystem}},
    {"cli/record",
     {"text", "core", "modes", "plan", "team", "lcmtypes", "scenario", "runtime/bus",
      "runtime/record", "runtime/process", "logger", "report", "report/export", "lab", "cli",
      "cli/team"},
     {kLog, kCommandLine, kJson, kFiles, kSystem}},
    {"cli/watch",
     {"text", "core", "plan", "team", "lcmtypes", "scenario", "runtime/bus", "runtime/record",
      "runtime/process", "logger", "report", "cli", "cli/team", "cli/record"},
     {kLog, kCommandLine, kJson, kFiles, kSystem}},
    {"cli/watch/tls_server.cc", {"text", "runtime/process", "cli/watch"}, {kTls, kSystem}},
    // The team for Foxglove; only the last has a socket and a clock.
    {"cli/foxglove",
     {"core", "team", "target/geo", "logger", "report", "report/export", "cli/team", "cli/watch"},
     {kJson}},
    {"cli/foxglove/websocket.cc", {"report", "cli/foxglove"}, {kTls}},
    {"cli/foxglove/foxglove_output.h",
     {"core", "cli/team", "cli/watch", "cli/foxglove"},
     {kCommandLine}},
    {"cli/foxglove/foxglove_output.cc", {"runtime/bus", "cli/foxglove"}, {kSystem}},
    {"cli/watch/page_server.cc", {"runtime/bus", "runtime/process", "cli/watch"}, {kHttp, kSystem}},
    // An operator's orders to a team. Commands and the page give the same orders.
    {"cli/operate",
     {"text", "core", "plan", "team", "lcmtypes", "scenario", "scenario/parse", "runtime/bus",
      "runtime/process", "report", "cli", "cli/team", "cli/tak", "cli/record", "cli/watch",
      "cli/foxglove"},
     {kCommandLine, kJson, kFiles, kSystem}},
    {"cli/launch",
     {"text", "core", "modes", "plan", "team", "scenario", "scenario/parse", "runtime/bus",
      "runtime/record", "runtime/process", "logger", "cli", "cli/team", "cli/record", "cli/watch",
      "cli/operate"},
     {kLog, kCommandLine, kJson, kFiles, kSystem}},
    {"cli/study",
     {"text", "core", "plan", "scenario", "scenario/parse", "runtime/process", "logger", "report",
      "lab", "studies", "cli", "cli/record", "cli/watch"},
     {kLog, kCommandLine, kJson, kFiles, kSystem}},
    {"cli/doctor/doctor_command.cc",
     {"text", "team", "relay", "runtime/bus", "runtime/process", "cli", "cli/doctor"},
     {kCommandLine, kFiles, kSystem}},
    {"cli/deploy/deploy_command.cc",
     {"text", "core", "modes", "plan", "scenario", "scenario/parse", "runtime/bus",
      "runtime/process", "logger", "cli", "cli/record", "cli/launch", "cli/deploy"},
     {kCommandLine, kFiles, kSystem}},
    {"cli/spy",
     {"text", "runtime/bus", "runtime/process", "cli", "cli/watch"},
     {kCommandLine, kFiles, kSystem}},
    // The Python module: it uses only the command's part that writes a run directory.
    {"python",
     {"text", "core", "plan", "target", "team", "scenario", "scenario/rules", "runtime/process",
      "logger", "report", "lab", "studies", "cli", "cli/team", "cli/record"},
     {kPython, kFiles}},
    // Robots and displays with ROS 2. Robot, driver and display are values.
    {"bridges/ros2", {"text", "core", "team", "cli/team"}, {}},
    {"bridges/ros2/bridge_file.h", {"core", "bridges/ros2"}, {kFiles}},
    {"bridges/ros2/bridge_file.cc", {"text", "bridges/ros2"}, {kProtobuf}},
    {"bridges/ros2/map.cc", {"text", "target/maps", "bridges/ros2"}, {}},
    {"bridges/ros2/map_command.cc",
     {"text", "runtime/bus", "runtime/process", "bridges/ros2"},
     {kCommandLine, kFiles, kSystem}},
    {"bridges/ros2/dds_node.h", {"core"}, {kDds}},
    {"bridges/ros2/dds_node.cc", {"text", "bridges/ros2"}, {kDds, kSystem}},
    {"bridges/ros2/message_types.h", {"bridges/ros2"}, {kDds}},
    {"bridges/ros2/options.h", {"runtime/process", "bridges/ros2"}, {kFiles}},
    {"bridges/ros2/options.cc", {"bridges/ros2"}, {}},
    {"bridges/ros2/main.cc", {"runtime/bus", "runtime/process", "bridges/ros2"}, {kLog, kSystem}},
    // What a compiler for arm64 includes first.
    {"cmake", {}, {kProcessor}},
    // What the generated reference says of fields and messages.
    {"docs/reference",
     {"text", "core", "plan", "team", "lcmtypes", "scenario", "scenario/parse"},
     {kProtobuf, kFiles}},
    // Somebody else's programs: they see the installed headers alone.
    {"bridges/mavlink", {}, {kInstalled}},
    {"bridges/mavlink/frame_writer.cc", {"bridges/mavlink"}, {kCrypto}},
    {"bridges/mavlink/options.cc",
     {"bridges/mavlink"},
     {kInstalled, kCommandLine, kCrypto, kFiles, kSystem}},
    {"bridges/mavlink/buses.cc", {"bridges/mavlink"}, {kInstalled, kSystem}},
    {"bridges/mavlink/link.cc", {"bridges/mavlink"}, {kInstalled, kSystem}},
    {"bridges/mavlink/main.cc", {"bridges/mavlink"}, {kInstalled, kSystem}},
    {"examples/embed", {}, {kInstalled, kSystem}},
    {"examples/law", {}, {kInstalled}},
    // The example to copy: a participant with its main.
    {"examples/driver", {"core", "team"}, {}},
    {"examples/driver/main.cc", {"examples/driver", "runtime/bus", "runtime/process"}, {kLog}},
    // Robots in a physics engine: the simulated world with other bodies.
    {"examples/mujoco", {"core", "team", "sim"}, {kPhysics}},
    {"examples/mujoco/main.cc", {"sim", "runtime/process", "examples/mujoco"}, {kLog}},
    {"examples/mujoco/film.cc",
     {"plan", "team", "scenario", "lab", "examples/mujoco"},
     {kPhysics, kFiles}},
};

/// Folders with code that may include everything.
inline const std::set<std::string_view> kFree = {"tests"};

/// Names of headers by kind; a star matches anything.
struct Kind {
  Outside outside;
  std::vector<std::string_view> names;
};
inline const std::vector<Kind> kKinds = {
    {kProtobuf, {"google/protobuf/*", "*.pb.h"}},
    {kLcm, {"lcm/*"}},
    {kLcmTypes, {"ergocast/*_t.hpp"}},
    {kInstalled,
     {"ergocast/core/*", "ergocast/plan/*", "ergocast/target/*", "ergocast/team/*",
      "ergocast/agent/*", "ergocast/lcmtypes/*", "ergocast/lab/*", "ergocast/scenario/*",
      "ergocast/studies/*"}},
    {kZstd, {"zstd.h"}},
    {kLog, {"spdlog/*"}},
    {kCommandLine, {"CLI/*"}},
    {kJson, {"nlohmann/*"}},
    {kHash, {"xxhash.h"}},
    {kCrypto, {"sodium.h"}},
    {kTls, {"openssl/*"}},
    {kGenerator, {"Random123/*"}},
    {kExpected, {"tl/expected.hpp"}},
    {kSpectra, {"Spectra/*"}},
    {kPng, {"png.h"}},
    {kLoader, {"dlfcn.h"}},
    {kHttp, {"httplib.h"}},
    {kPython, {"pybind11/*"}},
    {kEarth, {"proj.h"}},
    {kXml, {"pugixml.hpp"}},
    {kPhysics, {"mujoco/*", "EGL/*"}},
    {kDds, {"dds/*", "ros_types.h"}},
    {kProcessor, {"arm_neon.h"}},
    {kFiles, {"fstream", "filesystem", "iostream", "syncstream", "ext/stdio_filebuf.h"}},
    {kSystem, {"thread",     "mutex",     "shared_mutex", "condition_variable",
               "future",     "semaphore", "latch",        "barrier",
               "stop_token", "random",    "ctime",        "csignal",
               "sys/*",      "netinet/*", "arpa/*",       "net/*",
               "linux/*",    "dirent.h",  "fcntl.h",      "ifaddrs.h",
               "netdb.h",    "poll.h",    "pthread.h",    "signal.h",
               "spawn.h",    "termios.h", "time.h",       "unistd.h",
               "pwd.h"}},
};

// The time or a random device needs no special #include: <chrono> is allowed everywhere.
inline const std::string_view kClocksAndDice[] = {"_clock::now", "clock_gettime", "gettimeofday",
                                                  "std::time(",  "random_device", "std::rand(",
                                                  "sleep_for",   "sleep_until"};

}  // namespace ergocast
