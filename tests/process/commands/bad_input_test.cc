// SPDX-License-Identifier: BSD-3-Clause
// Bad input gives one clear error and the documented exit code; no file is written.

#include "runtime/process/program_options.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

class BadInput : public OwnHost {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  bool printed(const std::string& part) const { return output().find(part) != std::string::npos; }
};

constexpr const char* kManyProblems = R"(
domain { size_x_m: 100 size_y_m: -50 }
target { uniform_weight: -1 }
basis { modes_x: 65 }
law { u_max_mps: nan }
time { duration_s: 60 durration_s: 3 }
agents { starts { x_m: 500 y_m: 20 } }
)";

TEST_F(BadInput, CheckNamesEveryProblemAtOnceWithItsLine) {
  const auto file = write("bad.textproto", kManyProblems);
  EXPECT_EQ(ergocast({"check", file}), 2);
  for (const char* part :
       {"bad.textproto:2:", "size_y_m", "bad.textproto:3:", "uniform_weight",
        "bad.textproto:4:", "modes_x", "64", "bad.textproto:5:", "u_max_mps",
        "bad.textproto:6:", "durration_s", "duration_s", "bad.textproto:7:", "x_m", "problems"}) {
    EXPECT_TRUE(printed(part)) << part << " in\n" << output();
  }
}

TEST_F(BadInput, RunAndSimulateRefuseABadScenarioAndWriteNothing) {
  const auto file = write("bad.textproto", kManyProblems);
  for (const char* command : {"run", "simulate"}) {
    EXPECT_EQ(ergocast({command, file, "--out", out()}), 2);
    EXPECT_FALSE(std::filesystem::exists(out()));
  }
}

TEST_F(BadInput, CheckPrintsAScenarioThatIsItself) {
  ASSERT_EQ(ergocast({"check", "--print", scenario_file("quadrimodal_corners")}), 0);
  const auto canonical = write("printed.textproto", output());
  ASSERT_EQ(ergocast({"check", "--print", canonical}), 0) << output();
  EXPECT_EQ(output(), text_of(canonical));
}

TEST_F(BadInput, UnknownCommandsAndOptionsAreRefused) {
  const auto scenario = scenario_file("quadrimodal_corners");
  EXPECT_EQ(ergocast({}), 2);
  EXPECT_EQ(ergocast({"fly", scenario}), 2);
  EXPECT_EQ(ergocast({"run", scenario, "--speed", "3"}), 2);
  EXPECT_EQ(ergocast({"run", scenario, "--lockstep", "--realtime"}), 2);
  EXPECT_EQ(ergocast({"run", scenario, "--duration", "long", "--out", out()}), 2);
  EXPECT_EQ(ergocast({"run", scenario, "--agents", "0", "--out", out()}), 2);
  EXPECT_EQ(ergocast({"run", scenario, "--seed", "-1", "--out", out()}), 2);
  EXPECT_EQ(ergocast({"run", scenario, "--lcm-url", "udpm://10.0.0.1:7667", "--out", out()}), 2);
  EXPECT_TRUE(printed("multicast")) << output();
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(BadInput, ATeamOfSitesIsOnlySimulated) {
  const auto file = write("sites.textproto", R"(
domain { size_x_m: 100 size_y_m: 50 } target { uniform_weight: 1 } law { u_max_mps: 5 }
time { duration_s: 5 } agents { random_count: 4 } team { sites: 2 }
)");
  EXPECT_EQ(ergocast({"run", file, "--out", out()}), 2);
  EXPECT_TRUE(printed("a team of sites runs in ergocast simulate and study only")) << output();
  EXPECT_EQ(ergocast({"simulate", file, "--seeds", "1:2"}), 2);
  EXPECT_TRUE(printed("--seeds: the laboratory has no team of sites yet")) << output();
  EXPECT_EQ(ergocast({"simulate", file, "--event-log", "--out", out()}), 2);
  EXPECT_TRUE(printed("--event-log: a team of sites sends no messages yet")) << output();
  EXPECT_EQ(ergocast({"simulate", file, "--end", "1:+10s", "--out", out()}), 2);
  EXPECT_TRUE(printed(": nothing amends a team of sites yet")) << output();
  EXPECT_FALSE(std::filesystem::exists(out()));
  EXPECT_EQ(ergocast({"simulate", file, "--out", out()}), 0) << output();
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

TEST_F(BadInput, EveryProgramKnowsHelpAndVersion) {
  for (const char* program :
       {"ergocast", "ergocast-agent", "ergocast-coordinator", "ergocast-sim", "ergocast-logger"}) {
    EXPECT_EQ(run(program, {"--help"}), 0) << program;
    EXPECT_TRUE(printed("--version")) << output();
    EXPECT_EQ(run(program, {"--version"}), 0) << program;
    EXPECT_TRUE(printed("ergocast " + version() + " (LCM 1.")) << output();
    EXPECT_TRUE(printed("\nprocessor: built for ")) << output();
    EXPECT_TRUE(printed(cpu_has_fma() ? "FMA" : "; here: ")) << output();
    EXPECT_TRUE(printed("\ncommit ") || !std::filesystem::exists(ERGOCAST_SOURCE_DIR "/.git"))
        << output();
  }
}

TEST_F(BadInput, EveryCommandKnowsHelpAndVersion) {
  for (const char* command : {"run", "simulate", "study", "check", "report", "verify"}) {
    EXPECT_EQ(ergocast({command, "--help"}), 0) << command;
    EXPECT_EQ(ergocast({command, "--version"}), 0) << command;
    EXPECT_TRUE(printed("LCM 1.")) << output();
  }
}

TEST_F(BadInput, AnOutThatIsNotEmptyIsLeftAlone) {
  std::filesystem::create_directory(out());
  const auto precious = write("run/precious", "data");
  for (const char* command : {"run", "simulate"}) {
    EXPECT_EQ(ergocast({command, scenario_file("quadrimodal_corners"), "--out", out()}), 2);
    EXPECT_TRUE(printed("is not empty")) << output();
    EXPECT_EQ(text_of(precious), "data");
    EXPECT_FALSE(std::filesystem::exists(out() / "trajectory.csv"));
  }
}

TEST_F(BadInput, AnOutThatCannotBeMadeIsNamed) {
  const auto file = write("file", "");
  EXPECT_EQ(ergocast({"run", scenario_file("quadrimodal_corners"), "--out", file}), 2);
  EXPECT_TRUE(printed("is a file")) << output();
  EXPECT_EQ(ergocast({"run", scenario_file("quadrimodal_corners"), "--out", file / "below"}), 2);
  EXPECT_TRUE(printed("Not a directory")) << output();
  EXPECT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--out", "/proc/run"}), 2);
  EXPECT_TRUE(printed("/proc/run")) << output();
}

TEST_F(BadInput, LoggerRefusesAFolderWithARecord) {
  std::filesystem::create_directory(out());
  const auto record = write("run/trajectory.csv", "old");
  EXPECT_EQ(run("ergocast-logger", {"--out", out(), "--lcm-url", "udpm://239.255.76.67:24800"}), 2);
  EXPECT_TRUE(printed("already a record")) << output();
  EXPECT_EQ(text_of(record), "old");
}

TEST_F(BadInput, WithoutAMulticastRouteTheCommandsThatMendItAreNamed) {
  ASSERT_EQ(std::system("ip route del 224.0.0.0/4 dev lo"), 0);
  EXPECT_EQ(ergocast({"run", scenario_file("quadrimodal_corners"), "--out", out()}), 3);
  EXPECT_TRUE(printed("ip route add 224.0.0.0/4 dev lo")) << output();
  EXPECT_FALSE(std::filesystem::exists(out()));
  EXPECT_EQ(run("ergocast-agent", {}), 3);
  EXPECT_TRUE(printed("ip route add 224.0.0.0/4 dev lo")) << output();
  ASSERT_EQ(std::system("ip route add 224.0.0.0/4 dev lo"), 0);
}

TEST_F(BadInput, ReportAndVerifyNameWhatIsMissing) {
  EXPECT_EQ(ergocast({"report", folder_ / "nothing"}), 2);
  EXPECT_TRUE(printed("plan.binpb")) << output();
  EXPECT_EQ(ergocast({"verify", folder_ / "nothing"}), 2);
  EXPECT_TRUE(printed("plan.binpb")) << output();
}

/// Files of at most 16 MB that would need gigabytes, read by programs with half a gigabyte of
/// memory.
class LittleMemory : public BadInput {
 protected:
  /// The output is in output().
  int in_half_a_gigabyte(const std::vector<std::string>& arguments) {
    std::string command =
        "ulimit -v 524288; exec '" + (program_folder() / "ergocast").string() + "'";
    for (const std::string& argument : arguments) command += " '" + argument + "'";
    Child child = begin({"/bin/sh", "-c", command});
    return wait_for(child);
  }
  void expect_refused(const std::string& name, const std::string& content, const std::string& part,
                      const std::string& why) {
    write(name, content);
    std::string text = "origin { latitude_deg: 47 longitude_deg: 9 }\n" +
                       text_of(scenario_file("quadrimodal_corners"));
    text.insert(text.find("target {") + 8, ' ' + part + ' ');
    EXPECT_EQ(in_half_a_gigabyte({"check", write("s.textproto", text)}), 2) << name;
    EXPECT_TRUE(printed(name) && printed(why)) << output().substr(0, 1000);
  }
};

TEST_F(LittleMemory, IsEnoughToReadAScenario) {
  EXPECT_EQ(in_half_a_gigabyte({"check", scenario_file("harbour_patrol")}), 0) << output();
}

TEST_F(LittleMemory, IsEnoughToRefuseGeoJsonThatIsNestedOrHasMoreValuesThanAnyPolygon) {
  const std::string part = "keep_outs { file: \"m.geojson\" }";
  constexpr std::size_t kBytes = (std::size_t{16} << 20) - 10;
  expect_refused("m.geojson", std::string(kBytes, '['), part, "nested in more than 64 levels");
  std::string objects = "[";
  while (objects.size() < kBytes) objects += "{},";
  expect_refused("m.geojson", objects, part, "has more than 4000000 values");
}

TEST_F(LittleMemory, IsEnoughToRefuseADrawingOfMillionsOfTags) {
  std::string text = "<svg>";
  while (text.size() < (std::size_t{16} << 20) - 10) text += "<g>";
  expect_refused("m.svg", text, "keep_outs { file: \"m.svg\" }", "has more than 1 000 000 tags");
}

TEST_F(LittleMemory, IsEnoughToRefuseARecordThatIsDamaged) {
  ASSERT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--duration", "3", "--out",
                      out()}),
            0);
  const auto precious = text_of(out() / "summary.json");
  write("run/summary.json", std::string(16000000, '['));
  EXPECT_EQ(in_half_a_gigabyte({"verify", out()}), 2);
  EXPECT_TRUE(printed("summary.json") && printed("nested in more than 64 levels")) << output();
  write("run/summary.json", precious);
  const auto rows = out() / "trajectory.csv";
  std::filesystem::resize_file(rows, std::filesystem::file_size(rows) + (std::uintmax_t{1} << 30));
  EXPECT_EQ(in_half_a_gigabyte({"report", out()}), 0) << "as after a power failure: " << output();
  std::ofstream(rows, std::ios::app) << "\n";
  EXPECT_EQ(in_half_a_gigabyte({"report", out()}), 2);
  EXPECT_TRUE(printed("trajectory.csv") && printed("longer than any row")) << output();
}

}  // namespace
}  // namespace ergocast::test
