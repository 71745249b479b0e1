// SPDX-License-Identifier: BSD-3-Clause
// Reads every #include of the tree and compares it with the one table of allowed dependencies.
// Reads every import of the pages' modules and finds circles.
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

const std::vector<Rule> kRules = {
    {"text", {"text"}, {kFiles}},
    {"text/input_file.cc", {"text"}, {kFiles, kSystem}},
    {"core", {"core"}, {kGenerator}},
    {"target", {"text", "core", "target"}, {kPng, kFiles}},
    {"target/netcdf_library.cc", {"target"}, {kLoader}},
    // Modes of a free domain: a process without their table computes them.
    {"modes", {"core", "modes"}, {}},
    {"modes/eigen_modes.cc", {"core", "modes"}, {kSpectra}},
    {"modes/table.cc", {"core", "modes"}, {kHash}},
    {"modes/table_file.h", {"modes"}, {kFiles}},
    {"modes/table_file.cc", {"core", "modes"}, {kFiles, kSystem}},
    {"modes/provide.cc", {"core", "modes"}, {kHash, kSystem}},
    {"team", {"core", "team"}, {}},
    {"team/plan.cc", {"core", "modes", "team"}, {kHash}},
    {"lcmtypes", {"text", "core", "team", "lcmtypes"}, {kLcmTypes, kHash, kCrypto}},
    // Places on the earth, and drawings: for scenarios and exports, not for participants.
    {"geo", {"text", "core", "geo"}, {kEarth, kFiles, kJson, kXml}},
    {"scenario",
     {"text", "core", "modes", "target", "geo", "scenario"},
     {kProtobuf, kCommandLine, kFiles}},
    {"runtime",
     {"text", "core", "modes", "team", "lcmtypes", "runtime"},
     {kLcm, kZstd, kLog, kCommandLine, kCrypto, kFiles, kSystem}},
    // The participants: they know the shared parts, but not each other.
    {"agent", {"core", "team", "agent"}, {}},
    {"coordinator", {"core", "team", "coordinator"}, {}},
    {"sim", {"core", "team", "sim"}, {}},
    {"logger", {"text", "core", "modes", "team", "logger"}, {kFiles, kJson}},
    {"agent/main.cc", {"agent", "runtime"}, {kLog}},
    {"coordinator/main.cc", {"team", "coordinator", "scenario", "runtime"}, {kLog}},
    {"sim/main.cc", {"sim", "runtime"}, {kLog}},
    {"sim/world_process.h", {"sim", "runtime"}, {}},
    {"sim/world_process.cc", {"sim", "runtime"}, {kLog}},
    {"logger/main.cc",
     {"text", "modes", "team", "logger", "runtime", "lcmtypes"},
     {kLog, kFiles, kSystem}},
    {"report", {"text", "core", "target", "team", "logger", "report"}, {kFiles, kJson}},
    {"export",
     {"text", "core", "target", "team", "logger", "report", "geo", "export"},
     {kFiles, kJson}},
    // The same participants in one process: no network, no clock, no threads.
    {"lab", {"core", "team", "lcmtypes", "agent", "coordinator", "sim", "logger", "lab"}, {}},
    {"lab/studies",
     {"text", "core", "target", "team", "scenario", "logger", "report", "lab", "lab/studies"},
     {kJson, kFiles}},
    {"ops/doctor",
     {"text", "core", "team", "lcmtypes", "runtime", "ops/doctor"},
     {kJson, kFiles, kSystem}},
    {"ops/deploy", {"text", "core", "scenario", "runtime", "ops/deploy"}, {kFiles}},
    {"cli/page_server.cc", {"cli"}, {kHttp, kSystem}},
    {"cli",
     {"text", "core", "modes", "target", "team", "lcmtypes", "scenario", "runtime", "logger",
      "report", "geo", "export", "lab", "lab/studies", "ops/doctor", "ops/deploy", "cli"},
     {kLog, kCommandLine, kJson, kFiles, kSystem}},
    // The Python module: it uses only the command's part that writes a run directory.
    {"python",
     {"text", "core", "target", "scenario", "runtime", "logger", "report", "lab", "cli", "python"},
     {kPython, kFiles}},
    // What the generated reference says of fields and messages.
    {"docs/reference", {"text", "core", "team", "lcmtypes", "scenario"}, {kProtobuf, kFiles}},
    // Somebody else's program: it sees the installed headers alone.
    {"examples/embed", {}, {kInstalled, kSystem}},
    // The example to copy: a participant with its main.
    {"examples/driver", {"core", "team", "examples/driver"}, {}},
    {"examples/driver/main.cc", {"examples/driver", "runtime"}, {kLog}},
    // Robots in a physics engine: the simulated world with other bodies.
    {"examples/mujoco", {"core", "team", "sim", "examples/mujoco"}, {kPhysics}},
    {"examples/mujoco/main.cc", {"sim", "runtime", "examples/mujoco"}, {kLog}},
    {"examples/mujoco/film.cc", {"team", "scenario", "lab", "examples/mujoco"}, {kPhysics, kFiles}},
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
     {"ergocast/core/*", "ergocast/target/*", "ergocast/team/*", "ergocast/agent/*",
      "ergocast/lcmtypes/*"}},
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
    if (path.starts_with(std::string(rule.who) + "/")) found = &rule;
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
std::string objection(const Rule& rule, const std::string& header, bool quoted) {
  for (const Kind& kind : kKinds) {
    for (const std::string_view name : kind.names) {
      if (!matches(header, name)) continue;
      return rule.outside.contains(kind.outside) ? "" : "must not use <" + header + ">";
    }
  }
  if (quoted) {
    const std::string_view folder = folder_of(header);
    return rule.folders.contains(folder) ? "" : "must not know " + std::string(folder) + "/";
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
    const std::string why = header.empty() ? "" : objection(*rule, header, quoted);
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

/// Modules of JavaScript in one folder, each with those that it imports.
using Modules = std::map<std::string, std::vector<std::string>>;

std::vector<std::string> imports_in(const std::string& text) {
  std::vector<std::string> names;
  for (const std::string_view before : {"from './", "import './", "import('./"}) {
    for (auto at = text.find(before); at != text.npos; at = text.find(before, at + 1)) {
      const std::size_t name = at + before.size();
      names.push_back(text.substr(name, text.find('\'', name) - name));
    }
  }
  return names;
}

Modules modules_of_the_pages() {
  Modules modules;
  const std::filesystem::path folder(ERGOCAST_SOURCE_DIR "/report/web");
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".js") continue;
    modules[file.path().filename().string()] = imports_in(text_of(file.path()));
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

TEST(Layering, EveryRuleIsAboutSomethingThatIsThere) {
  const std::vector<std::string> paths = code_of_the_tree();
  for (const Rule& rule : kRules) {
    EXPECT_TRUE(std::any_of(paths.begin(), paths.end(), [&](const std::string& path) {
      return rule_of(path) == &rule;
    })) << rule.who;
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
  EXPECT_EQ(problem_of("core/basis.cc", "#include \"agent/agent.h\""),
            "core/basis.cc:2: core must not know agent/");
  EXPECT_EQ(problem_of("agent/agent.h", "  #  include  \"sim/world.h\"  // why not"),
            "agent/agent.h:2: agent must not know sim/");
  const std::pair<const char*, const char*> planted[] = {
      {"coordinator/coordinator.cc", "#include \"agent/agent.h\""},
      {"sim/world.cc", "#include \"lcmtypes/codec.h\""},
      {"logger/recorder.cc", "#include \"runtime/clock.h\""},
      {"report/report.cc", "#include <lcm/lcm-cpp.hpp>"},
      {"lab/simulation.cc", "#include \"runtime/transport.h\""},
      {"lab/simulation.cc", "#include <thread>"},
      {"scenario/scenario.cc", "#include \"agent/agent.h\""},
      {"scenario/scenario.cc", "#include \"lcmtypes/codec.h\""},
      {"lcmtypes/codec.cc", "#include \"runtime/transport.h\""},
      {"runtime/node.cc", "#include \"agent/agent.h\""},
      {"runtime/transport.cc", "#include <ergocast/hello_t.hpp>"},
      {"target/target.h", "#include <google/protobuf/message.h>"},
      {"core/basis.h", "#include \"target/map_file.h\""},
      {"core/forecast.h", "#include \"team/messages.h\""},
      {"team/messages.h", "#include \"agent/agent.h\""},
      {"lab/simulation_faults.cc", "#include \"lab/studies/study_run.h\""},
      {"logger/recorder.cc", "#include \"report/report.h\""},
      {"scenario/scenario.cc", "#include <png.h>"},
      {"scenario/polygon_files.cc", "#include <proj.h>"},
      {"agent/agent.cc", "#include <proj.h>"},
      {"agent/agent.cc", "#include \"geo/local_plane.h\""},
      {"sim/main.cc", "#include \"geo/local_plane.h\""},
      {"core/basis.h", "#include \"geo/local_plane.h\""},
      {"report/report.cc", "#include \"geo/geojson.h\""},
      {"agent/agent.cc", "#include \"target/map_file.h\""},
      {"team/plan.cc", "#include <google/protobuf/message.h>"},
      {"scenario/scenario.cc", "#include \"team/plan.h\""},
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
      {"cli/run.cc", "#include \"agent/agent.h\""},
      {"cli/run.cc", "#include <lcm/lcm.h>"},
      {"core/ids.h", "#include \"tests/support/team.h\""},
      {"core/ids.h", "#include <boost/optional.hpp>"},
      {"core/ids.h", "#include <ergocast/core/basis.h>"},
      {"examples/embed/embed.cc", "#include \"agent/agent.h\""},
      {"examples/embed/embed.cc", "#include <ergocast/hello_t.hpp>"},
      {"python/team.cc", "#include \"agent/agent.h\""},
      {"cli/simulate.cc", "#include <pybind11/pybind11.h>"},
      {"core/ids.h", "#include \"ids.h\""},
      {"agent/agent.cc", "  const auto now = std::chrono::steady_clock::now();"},
      {"sim/world.cc", "  std::this_thread::sleep_for(1s);"},
      {"core/noise.cc", "  std::random_device device;"},
      {"hosts/new.cc", "int x;"},
  };
  for (const auto& [path, line] : planted)
    EXPECT_NE(problem_of(path, line), "") << path << ": " << line;
}

TEST(LayeringChecker, LetsThroughWhatTheArchitectureAllows) {
  const std::pair<const char*, const char*> honest[] = {
      {"core/basis.cc", "#include \"core/basis.h\""},
      {"core/basis.cc", "#include <Eigen/Core>"},
      {"core/basis.cc", "#include <string_view>"},
      {"core/ids.h", "#include <chrono>"},
      {"core/noise.cc", "#include <Random123/philox.h>"},
      {"agent/agent.cc", "#include \"core/control.h\""},
      {"agent/main.cc", "#include \"runtime/event_loop.h\""},
      {"coordinator/main.cc", "#include \"scenario/scenario.h\""},
      {"scenario/text.cc", "#include \"scenario/scenario.pb.h\""},
      {"lcmtypes/codec.cc", "#include <ergocast/hello_t.hpp>"},
      {"lab/simulation.h", "#include \"agent/agent.h\""},
      {"runtime/clock.h", "  return steady_clock::now();"},
      {"cli/simulate.cc", "#include \"lab/simulation.h\""},
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
    planted["c.js"] = imports_in("// first\n" + line + "\nlet x = 'a.js';\n");
    EXPECT_EQ(circle_in(planted), "a.js > b.js > c.js > a.js") << line;
  }
  EXPECT_EQ(circle_in({{"a.js", {"a.js"}}}), "a.js > a.js");
  EXPECT_EQ(circle_in({{"a.js", {"b.js"}}, {"b.js", {"c.js"}}, {"c.js", {"b.js"}}}),
            "b.js > c.js > b.js");
}

}  // namespace
}  // namespace ergocast
