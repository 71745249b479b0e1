// SPDX-License-Identifier: BSD-3-Clause
// Reads every #include of the tree and compares it with the table of allowed dependencies.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/layering/rules.h"
#include "tests/layering/tree.h"

namespace ergocast {
namespace {

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

TEST(Layering, NoFileIncludesWhatItsLayerMayNotKnow) {
  for (const std::string& path : code_of_the_tree()) {
    const std::string text = text_of(std::filesystem::path(ERGOCAST_SOURCE_DIR) / path);
    ASSERT_FALSE(text.empty()) << path;
    for (const std::string& violation : violations_in(path, text)) ADD_FAILURE() << violation;
  }
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
      {"runtime/process/program_options.cc", "#include \"agent/agent.h\""},
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
      {"runtime/bus/transport.cc", "#include \"runtime/process/program_options.h\""},
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

}  // namespace
}  // namespace ergocast
