// SPDX-License-Identifier: BSD-3-Clause
// Reads every #include of the tree and compares it with the one table of allowed dependencies.
// Reads every import of the pages' modules and finds circles. Counts the files of each folder.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ergocast {
namespace {

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
  kGenerator,    // Random123
  kSpectra,      // Spectra, and the sparse part of Eigen
  kPng,          // libpng
  kLoader,       // dlopen: libnetcdf
  kHttp,         // cpp-httplib
  kPython,       // pybind11
  kEarth,        // PROJ
  kXml,          // pugixml
  kPhysics,      // MuJoCo, and EGL for its pictures
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
const std::set<std::string_view> kCore = {"core/base", "core/basis", "core/mission", "core/law",
                                          "core/motion"};
const std::vector<Rule> kRules = {
    {"text", {}, {kFiles}},
    {"text/input_file.cc", {"text"}, {kFiles, kSystem}},
    // The method. Law and motion do not see each other.
    {"core/base", {}, {kGenerator}},
    {"core/basis", {"core/base"}, {}},
    {"core/mission", {"core/base", "core/basis"}, {}},
    {"core/law", {"core/base", "core/basis", "core/mission"}, {}},
    {"core/motion", {"core/base", "core/mission"}, {}},
    // Modes of a free domain: a process without their table computes them.
    {"modes", {"core"}, {}},
    {"modes/eigen_modes.cc", {"core", "modes"}, {kSpectra}},
    {"modes/table.cc", {"core", "modes"}, {kHash}},
    {"modes/table_file.h", {"modes"}, {kFiles}},
    {"modes/table_file.cc", {"core", "modes"}, {kFiles, kSystem}},
    {"modes/provide.cc", {"core", "modes"}, {kHash, kSystem}},
    {"plan", {"core", "modes"}, {kHash}},
    {"team", {"core", "plan"}, {}},
    {"lcmtypes", {"text", "core", "plan", "team"}, {kLcmTypes, kHash, kCrypto}},
    {"target", {"text", "core"}, {}},
    {"target/maps", {"text", "core", "target"}, {kPng, kFiles}},
    {"target/maps/netcdf_library.cc", {"target/maps"}, {kLoader}},
    // Places on the earth, and drawings: for scenarios and exports, not for participants.
    {"target/geo", {"text", "core"}, {kEarth, kFiles, kJson, kXml}},
    {"scenario/parse", {"text", "core", "plan", "target"}, {kProtobuf, kCommandLine, kFiles}},
    {"scenario/rules",
     {"text", "core", "plan", "target", "target/maps", "target/geo", "scenario/parse"},
     {kProtobuf, kFiles}},
    {"scenario/compile",
     {"text", "core", "modes", "plan", "target", "target/maps", "target/geo", "scenario/parse",
      "scenario/rules"},
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
    {"report", {"text", "core", "target", "target/maps", "team", "logger"}, {kFiles, kJson}},
    {"report/export",
     {"text", "core", "target", "target/geo", "team", "logger", "report"},
     {kFiles, kJson}},
    // The same participants in one process: no network, no clock, no threads.
    {"lab", {"core", "plan", "team", "lcmtypes", "agent", "coordinator", "sim", "logger"}, {}},
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
    {"cli/record",
     {"text", "core", "modes", "plan", "team", "lcmtypes", "scenario", "runtime/bus",
      "runtime/record", "runtime/process", "logger", "report", "report/export", "lab", "cli",
      "cli/team"},
     {kLog, kCommandLine, kJson, kFiles, kSystem}},
    {"cli/watch",
     {"text", "core", "plan", "team", "lcmtypes", "scenario", "runtime/bus", "runtime/record",
      "runtime/process", "logger", "report", "cli", "cli/team", "cli/record"},
     {kLog, kCommandLine, kJson, kFiles, kSystem}},
    {"cli/watch/page_server.cc", {"runtime/bus", "runtime/process", "cli/watch"}, {kHttp, kSystem}},
    {"cli/launch",
     {"text", "core", "modes", "plan", "team", "scenario", "scenario/parse", "runtime/bus",
      "runtime/record", "runtime/process", "logger", "cli", "cli/team", "cli/record", "cli/watch"},
     {kLog, kCommandLine, kJson, kFiles, kSystem}},
    {"cli/study",
     {"text", "core", "plan", "scenario", "scenario/parse", "runtime/process", "logger", "report",
      "lab", "studies", "cli", "cli/record", "cli/watch"},
     {kLog, kCommandLine, kJson, kFiles, kSystem}},
    {"cli/doctor/doctor_command.cc",
     {"text", "team", "runtime/bus", "runtime/process", "cli", "cli/doctor"},
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
     {"text", "core", "plan", "target", "scenario", "scenario/rules", "runtime/process", "logger",
      "report", "lab", "cli", "cli/team", "cli/record"},
     {kPython, kFiles}},
    // What the generated reference says of fields and messages.
    {"docs/reference",
     {"text", "core", "plan", "team", "lcmtypes", "scenario", "scenario/parse"},
     {kProtobuf, kFiles}},
    // Somebody else's program: it sees the installed headers alone.
    {"examples/embed", {}, {kInstalled, kSystem}},
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
const std::set<std::string_view> kFree = {"tests"};

/// Names of headers by kind; a star matches anything.
struct Kind {
  Outside outside;
  std::vector<std::string_view> names;
};
const std::vector<Kind> kKinds = {
    {kProtobuf, {"google/protobuf/*", "*.pb.h"}},
    {kLcm, {"lcm/*"}},
    {kLcmTypes, {"ergocast/*_t.hpp"}},
    {kInstalled,
     {"ergocast/core/*", "ergocast/plan/*", "ergocast/target/*", "ergocast/team/*",
      "ergocast/agent/*", "ergocast/lcmtypes/*"}},
    {kZstd, {"zstd.h"}},
    {kLog, {"spdlog/*"}},
    {kCommandLine, {"CLI/*"}},
    {kJson, {"nlohmann/*"}},
    {kHash, {"xxhash.h"}},
    {kCrypto, {"sodium.h"}},
    {kGenerator, {"Random123/*"}},
    {kSpectra, {"Spectra/*", "Eigen/Sparse*"}},
    {kPng, {"png.h"}},
    {kLoader, {"dlfcn.h"}},
    {kHttp, {"httplib.h"}},
    {kPython, {"pybind11/*"}},
    {kEarth, {"proj.h"}},
    {kXml, {"pugixml.hpp"}},
    {kPhysics, {"mujoco/*", "EGL/*"}},
    {kFiles, {"fstream", "filesystem", "iostream", "syncstream", "ext/stdio_filebuf.h"}},
    {kSystem, {"thread",     "mutex",     "shared_mutex", "condition_variable",
               "future",     "semaphore", "latch",        "barrier",
               "stop_token", "random",    "ctime",        "csignal",
               "sys/*",      "netinet/*", "arpa/*",       "net/*",
               "linux/*",    "dirent.h",  "fcntl.h",      "ifaddrs.h",
               "netdb.h",    "poll.h",    "pthread.h",    "signal.h",
               "spawn.h",    "time.h",    "unistd.h"}},
};

// The time or a random device needs no special #include: <chrono> is allowed everywhere.
const std::string_view kClocksAndDice[] = {"_clock::now", "clock_gettime", "gettimeofday",
                                           "std::time(",  "random_device", "std::rand(",
                                           "sleep_for",   "sleep_until"};

bool matches(std::string_view name, std::string_view pattern) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return name == pattern;
  return name.starts_with(pattern.substr(0, star)) && name.ends_with(pattern.substr(star + 1));
}

const Rule* rule_of(const std::string& path) {
  const Rule* found = nullptr;
  for (const Rule& rule : kRules) {
    if (path == rule.who) return &rule;
    const bool nearer = found == nullptr || rule.who.size() > found->who.size();
    if (nearer && path.starts_with(std::string(rule.who) + "/")) found = &rule;
  }
  return found;
}

/// The folder of the table that contains `header`; its first folder if the table has none.
std::string_view folder_of(std::string_view header) {
  std::string_view found = header.substr(0, header.find('/'));
  for (const Rule& rule : kRules) {
    const bool inside =
        header.starts_with(rule.who) && header.substr(rule.who.size()).starts_with('/');
    if (inside && rule.who.size() > found.size()) found = rule.who;
  }
  return found;
}

/// Why `rule` does not allow `header`; empty if it does.
std::string objection(const std::string& path, const Rule& rule, const std::string& header,
                      bool quoted) {
  for (const Kind& kind : kKinds) {
    for (const std::string_view name : kind.names) {
      if (!matches(header, name)) continue;
      return rule.outside.contains(kind.outside) ? "" : "must not use <" + header + ">";
    }
  }
  if (quoted) {
    const std::string_view folder = folder_of(header);
    const bool may = folder == folder_of(path) || rule.folders.contains(folder) ||
                     (kCore.contains(folder) && rule.folders.contains("core"));
    return may ? "" : "must not know " + std::string(folder) + "/";
  }
  const bool of_the_language = header.find_first_of("./") == std::string::npos;
  const bool harmless = of_the_language || matches(header, "Eigen/*");
  return harmless ? "" : "<" + header + "> has no entry in this table";
}

/// The name that a line includes and whether it is in quotes; an empty name if it is no #include.
std::pair<std::string, bool> include_in(std::string line) {
  std::erase_if(line, [](char c) { return c == ' ' || c == '\t'; });
  for (const auto& [start, end] : {std::pair("#include\"", '"'), std::pair("#include<", '>')}) {
    if (!line.starts_with(start)) continue;
    const std::size_t first = std::string_view(start).size();
    return {line.substr(first, line.find(end, first) - first), end == '"'};
  }
  return {};
}

/// "path:line: …" for every line of `text` that breaks the rules of `path`.
std::vector<std::string> violations_in(const std::string& path, const std::string& text) {
  const Rule* rule = rule_of(path);
  if (rule == nullptr) return {path + ":1: its folder has no entry in this table"};
  std::vector<std::string> found;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::string where =
        path + ":" + std::to_string(++number) + ": " + std::string(rule->who) + " ";
    const auto [header, quoted] = include_in(line);
    const std::string why = header.empty() ? "" : objection(path, *rule, header, quoted);
    if (!why.empty()) found.push_back(where + why);
    if (rule->outside.contains(kSystem)) continue;
    for (const std::string_view forbidden : kClocksAndDice) {
      if (line.find(forbidden) == std::string::npos) continue;
      found.push_back(where + "must not say " + std::string(forbidden));
    }
  }
  return found;
}

bool is_code(const std::filesystem::path& file) {
  static const std::set<std::string> kExtensions = {".h", ".hpp", ".cc", ".cpp"};
  return kExtensions.contains(file.extension().string());
}

/// Paths of the tree's code, relative to its root.
std::vector<std::string> code_of_the_tree() {
  namespace fs = std::filesystem;
  const fs::path root(ERGOCAST_SOURCE_DIR);
  std::vector<std::string> paths;
  for (const auto& top : fs::directory_iterator(root)) {
    const std::string name = top.path().filename().string();
    if (name.starts_with('.') || name.starts_with("build") || kFree.contains(name)) continue;
    if (!top.is_directory()) {
      if (is_code(top.path())) paths.push_back(name);
      continue;
    }
    for (const auto& file : fs::recursive_directory_iterator(top.path())) {
      if (is_code(file.path())) paths.push_back(fs::relative(file.path(), root).string());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Modules of JavaScript by their paths, each with the paths that it imports.
using Modules = std::map<std::string, std::vector<std::string>>;

/// The paths that a module in `folder` imports.
std::vector<std::string> imports_in(const std::string& text, const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const std::string_view before : {"from '.", "import '.", "import('."}) {
    for (auto at = text.find(before); at != text.npos; at = text.find(before, at + 1)) {
      const std::size_t name = at + before.size() - 1;
      const std::string path = text.substr(name, text.find('\'', name) - name);
      names.push_back((folder / path).lexically_normal().string());
    }
  }
  return names;
}

Modules modules_of_the_pages() {
  namespace fs = std::filesystem;
  Modules modules;
  const fs::path root(ERGOCAST_SOURCE_DIR "/report/web");
  for (const auto& file : fs::recursive_directory_iterator(root)) {
    if (file.path().extension() != ".js") continue;
    const fs::path path = fs::relative(file.path(), root);
    modules[path.string()] = imports_in(text_of(file.path()), path.parent_path());
  }
  return modules;
}

/// "a.js > b.js > a.js" if modules import each other so; empty if none do.
std::string circle_in(Modules modules) {
  const auto next_of = [&modules](const std::vector<std::string>& imports) {
    return std::find_if(imports.begin(), imports.end(),
                        [&](const std::string& name) { return modules.contains(name); });
  };
  // A module that imports none of the others is in no circle.
  while (std::erase_if(modules, [&](const auto& module) {
           return next_of(module.second) == module.second.end();
         }) > 0) {
  }
  if (modules.empty()) return "";
  std::vector<std::string> path{modules.begin()->first};
  while (std::count(path.begin(), path.end(), path.back()) == 1)
    path.push_back(*next_of(modules.at(path.back())));
  std::string circle;
  for (auto name = std::find(path.begin(), path.end(), path.back()); name != path.end(); ++name)
    circle += (circle.empty() ? "" : " > ") + *name;
  return circle;
}

TEST(Layering, NoFileIncludesWhatItsLayerMayNotKnow) {
  for (const std::string& path : code_of_the_tree()) {
    const std::string text = text_of(std::filesystem::path(ERGOCAST_SOURCE_DIR) / path);
    ASSERT_FALSE(text.empty()) << path;
    for (const std::string& violation : violations_in(path, text)) ADD_FAILURE() << violation;
  }
}

TEST(Layering, ModulesOfThePagesImportEachOtherInNoCircle) {
  const Modules modules = modules_of_the_pages();
  EXPECT_GE(modules.size(), 40U);
  EXPECT_EQ(circle_in(modules), "");
}

TEST(Layering, ModulesOfThePagesImportWhatIsThere) {
  const Modules modules = modules_of_the_pages();
  for (const auto& [name, imports] : modules) {
    for (const std::string& imported : imports)
      EXPECT_TRUE(modules.contains(imported)) << name << " imports " << imported;
  }
}

// A longer list of files shows no architecture.
TEST(Layering, NoFolderHoldsMoreFilesThanAPersonCanLookThrough) {
  namespace fs = std::filesystem;
  constexpr int kMostFiles = 45;
  std::map<std::string, int> count;
  for (const auto& top : fs::directory_iterator(ERGOCAST_SOURCE_DIR)) {
    const std::string name = top.path().filename().string();
    if (name.starts_with('.') || name.starts_with("build") || !top.is_directory()) continue;
    for (const auto& file : fs::recursive_directory_iterator(top.path())) {
      if (file.is_regular_file()) ++count[file.path().parent_path().string()];
    }
  }
  EXPECT_GE(count.size(), 50U);
  for (const auto& [folder, files] : count) EXPECT_LE(files, kMostFiles) << folder;
}

TEST(Layering, EveryRuleIsAboutSomethingThatIsThere) {
  const std::vector<std::string> paths = code_of_the_tree();
  for (const Rule& rule : kRules) {
    EXPECT_TRUE(std::any_of(paths.begin(), paths.end(), [&](const std::string& path) {
      return rule_of(path) == &rule;
    })) << rule.who;
  }
}

// The table is a list of layers: a rule that names a folder below its own would let a circle in.
TEST(Layering, NoRuleNamesAFolderBelowItsOwn) {
  std::set<std::string_view> above;
  for (const Rule& rule : kRules) {
    above.insert(rule.who);
    for (const std::string_view folder : rule.folders)
      EXPECT_TRUE(above.contains(folder) || folder == "core") << rule.who << " names " << folder;
  }
}

TEST(Sources, BeginWithTheirLicenceAndASentenceOfTheirOwn) {
  std::vector<std::string> sentences;
  for (const std::string& path : code_of_the_tree()) {
    std::ifstream file(std::filesystem::path(ERGOCAST_SOURCE_DIR) / path);
    std::string licence, sentence;
    std::getline(file, licence) && std::getline(file, sentence);
    EXPECT_EQ(licence, "// SPDX-License-Identifier: BSD-3-Clause") << path;
    EXPECT_TRUE(sentence.starts_with("// ")) << path << ": write what the file is about";
    sentences.push_back(sentence);
  }
  std::sort(sentences.begin(), sentences.end());
  const auto twice = std::adjacent_find(sentences.begin(), sentences.end());
  EXPECT_EQ(twice, sentences.end()) << *twice;
}

TEST(Sources, ModulesBeginWithTheirLicenceAndASentenceOfTheirOwn) {
  std::set<std::string> sentences;
  for (const auto& [name, imports] : modules_of_the_pages()) {
    std::ifstream file(std::filesystem::path(ERGOCAST_SOURCE_DIR "/report/web") / name);
    std::string licence, sentence;
    std::getline(file, licence) && std::getline(file, sentence);
    EXPECT_EQ(licence, "// SPDX-License-Identifier: BSD-3-Clause") << name;
    EXPECT_TRUE(sentence.starts_with("// ") && sentence.ends_with('.'))
        << name << ": write on this line what the module is";
    EXPECT_TRUE(sentences.insert(sentence).second) << name << ": " << sentence;
  }
}

/// The checker's report on one line in a file.
std::string problem_of(const std::string& path, const std::string& line) {
  const auto found = violations_in(path, "// first\n" + line + "\n");
  return found.empty() ? "" : found.front();
}

TEST(LayeringChecker, NamesFileAndLineOfEveryPlantedViolation) {
  EXPECT_EQ(problem_of("core/basis/basis.cc", "#include \"agent/agent.h\""),
            "core/basis/basis.cc:2: core/basis must not know agent/");
  EXPECT_EQ(problem_of("agent/agent.h", "  #  include  \"sim/world.h\"  // why not"),
            "agent/agent.h:2: agent must not know sim/");
  const std::pair<const char*, const char*> planted[] = {
      {"coordinator/coordinator.cc", "#include \"agent/agent.h\""},
      {"sim/world.cc", "#include \"lcmtypes/codec.h\""},
      {"logger/recorder.cc", "#include \"runtime/bus/clock.h\""},
      {"report/report.cc", "#include <lcm/lcm-cpp.hpp>"},
      {"lab/simulation.cc", "#include \"runtime/bus/transport.h\""},
      {"lab/simulation.cc", "#include <thread>"},
      {"scenario/scenario.cc", "#include \"agent/agent.h\""},
      {"scenario/scenario.cc", "#include \"lcmtypes/codec.h\""},
      {"lcmtypes/codec.cc", "#include \"runtime/bus/transport.h\""},
      {"runtime/process/node.cc", "#include \"agent/agent.h\""},
      {"runtime/bus/transport.cc", "#include <ergocast/hello_t.hpp>"},
      {"target/target.h", "#include <google/protobuf/message.h>"},
      {"core/basis/basis.h", "#include \"target/maps/map_file.h\""},
      {"core/law/forecast.h", "#include \"team/messages.h\""},
      {"team/messages.h", "#include \"agent/agent.h\""},
      {"lab/simulation_faults.cc", "#include \"studies/study_run.h\""},
      {"logger/recorder.cc", "#include \"report/report.h\""},
      {"scenario/scenario.cc", "#include <png.h>"},
      {"scenario/compile/polygon_files.cc", "#include <proj.h>"},
      {"agent/agent.cc", "#include <proj.h>"},
      {"agent/agent.cc", "#include \"target/geo/local_plane.h\""},
      {"sim/main.cc", "#include \"target/geo/local_plane.h\""},
      {"core/basis/basis.h", "#include \"target/geo/local_plane.h\""},
      {"report/report.cc", "#include \"target/geo/geojson.h\""},
      {"agent/agent.cc", "#include \"target/maps/map_file.h\""},
      {"plan/plan.cc", "#include <google/protobuf/message.h>"},
      {"scenario/scenario.cc", "#include \"team/messages.h\""},
      {"core/law/control.cc", "#include \"core/motion/vehicle.h\""},
      {"core/motion/walls.cc", "#include \"core/law/forecast.h\""},
      {"core/base/ids.h", "#include \"core/mission/mission.h\""},
      {"core/mission/station.cc", "#include \"core/motion/walls.h\""},
      {"plan/plan.cc", "#include \"team/messages.h\""},
      {"scenario/parse/text.cc", "#include \"scenario/rules/validate.h\""},
      {"runtime/bus/transport.cc", "#include \"runtime/process/node.h\""},
      {"cli/team/team_view.cc", "#include \"cli/launch/launcher.h\""},
      {"agent/agent.cc", "#include \"scenario/scenario.h\""},
      {"agent/agent.cc", "#include <spdlog/spdlog.h>"},
      {"agent/agent.cc", "#include <sys/socket.h>"},
      {"agent/agent.cc", "#include <unistd.h>"},
      {"agent/agent.cc", "#include <fstream>"},
      {"sim/world.cc", "#include <random>"},
      {"agent/main.cc", "#include \"coordinator/coordinator.h\""},
      {"agent/main.cc", "#include \"scenario/scenario.h\""},
      {"sim/main.cc", "#include \"scenario/scenario.h\""},
      {"logger/main.cc", "#include \"scenario/scenario.h\""},
      {"examples/driver/main.cc", "#include \"scenario/scenario.h\""},
      {"agent/main.cc", "#include <lcm/lcm-cpp.hpp>"},
      {"cli/launch/run.cc", "#include \"agent/agent.h\""},
      {"cli/launch/run.cc", "#include <lcm/lcm.h>"},
      {"core/base/ids.h", "#include \"tests/support/team.h\""},
      {"core/base/ids.h", "#include <boost/optional.hpp>"},
      {"core/base/ids.h", "#include <ergocast/core/basis/basis.h>"},
      {"examples/embed/embed.cc", "#include \"agent/agent.h\""},
      {"examples/embed/embed.cc", "#include <ergocast/hello_t.hpp>"},
      {"python/team.cc", "#include \"agent/agent.h\""},
      {"cli/study/simulate.cc", "#include <pybind11/pybind11.h>"},
      {"core/base/ids.h", "#include \"ids.h\""},
      {"agent/agent.cc", "  const auto now = std::chrono::steady_clock::now();"},
      {"sim/world.cc", "  std::this_thread::sleep_for(1s);"},
      {"core/base/noise.cc", "  std::random_device device;"},
      {"hosts/new.cc", "int x;"},
  };
  for (const auto& [path, line] : planted)
    EXPECT_NE(problem_of(path, line), "") << path << ": " << line;
}

TEST(LayeringChecker, LetsThroughWhatTheArchitectureAllows) {
  const std::pair<const char*, const char*> honest[] = {
      {"core/basis/basis.cc", "#include \"core/basis/basis.h\""},
      {"core/basis/basis.cc", "#include <Eigen/Core>"},
      {"core/basis/basis.cc", "#include <string_view>"},
      {"core/base/ids.h", "#include <chrono>"},
      {"core/base/noise.cc", "#include <Random123/philox.h>"},
      {"agent/agent.cc", "#include \"core/law/control.h\""},
      {"agent/main.cc", "#include \"runtime/process/event_loop.h\""},
      {"coordinator/main.cc", "#include \"scenario/scenario.h\""},
      {"scenario/parse/text.cc", "#include \"scenario/scenario.pb.h\""},
      {"lcmtypes/codec.cc", "#include <ergocast/hello_t.hpp>"},
      {"lab/simulation.h", "#include \"agent/agent.h\""},
      {"runtime/bus/clock.h", "  return steady_clock::now();"},
      {"cli/study/simulate.cc", "#include \"lab/simulation.h\""},
      {"agent/agent.cc", "  // the coordinator/coordinator.h side of it"},
  };
  for (const auto& [path, line] : honest) EXPECT_EQ(problem_of(path, line), "");
}

TEST(LayeringChecker, NamesTheModulesOfACircle) {
  const Modules honest = {{"a.js", {"b.js", "c.js"}}, {"b.js", {"c.js"}}, {"c.js", {}}};
  EXPECT_EQ(circle_in(honest), "");
  for (const std::string line :
       {"import { far } from './a.js';", "import {\n  far,\n} from './a.js';", "import './a.js';",
        "export { far } from './a.js';", "await import('./a.js');"}) {
    Modules planted = honest;
    planted["c.js"] = imports_in("// first\n" + line + "\nlet x = 'a.js';\n", "");
    EXPECT_EQ(circle_in(planted), "a.js > b.js > c.js > a.js") << line;
  }
  EXPECT_EQ(circle_in({{"a.js", {"a.js"}}}), "a.js > a.js");
  EXPECT_EQ(circle_in({{"a.js", {"b.js"}}, {"b.js", {"c.js"}}, {"c.js", {"b.js"}}}),
            "b.js > c.js > b.js");
}

}  // namespace
}  // namespace ergocast
