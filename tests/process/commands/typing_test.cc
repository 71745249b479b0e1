// SPDX-License-Identifier: BSD-3-Clause
// Typing errors and invalid files: one sentence with the remedy, no text that controls a terminal,
// and no program that blocks.
#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>

#include "runtime/process/program_options.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

class Typing : public OwnHost {
 protected:
  bool printed(const std::string& part) const { return output().find(part) != std::string::npos; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  auto lines() const {
    const std::string text = output();
    return std::count(text.begin(), text.end(), '\n');
  }
};

TEST_F(Typing, UnknownOptionsAndCommandsGetWhatTheyMayHaveMeant) {
  const std::string scenario = scenario_file("quadrimodal_corners");
  EXPECT_EQ(ergocast({"run", "--sed", "3", scenario}), 2);
  EXPECT_TRUE(printed("run: there is no option --sed; did you mean --seed?")) << output();
  EXPECT_EQ(ergocast({"simulate", "--duraton=3", scenario}), 2);
  EXPECT_TRUE(printed("did you mean --duration?")) << output();
  EXPECT_EQ(ergocast({"stat"}), 2);
  EXPECT_TRUE(printed("there is no command stat; did you mean status?")) << output();
  EXPECT_EQ(ergocast({"verfy", out()}), 2);
  EXPECT_TRUE(printed("did you mean verify?")) << output();
  EXPECT_EQ(ergocast({"run", scenario, "--quite-unlike-anything", "3"}), 2);
  EXPECT_TRUE(printed("there is no option --quite-unlike-anything; --help lists")) << output();
  EXPECT_EQ(run("ergocast-agent", {"--idd", "3"}), 2);
  EXPECT_TRUE(printed("did you mean --id?")) << output();
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(Typing, OneSlipInAScenarioIsOneProblem) {
  const std::string good = text_of(scenario_file("quadrimodal_corners"));
  struct Slip {
    std::string right, wrong;
  };
  for (const auto& [right, wrong] :
       {Slip{"size_x_m", "size_xm"}, Slip{"size_x_m", "width"}, Slip{"domain {", "domian {"},
        Slip{"u_max_mps", "umax_mps"}, Slip{"duration_s", "duration"}, Slip{"mean_x_m", "x"},
        Slip{"law {", "lwa {"}}) {
    std::string text = good;
    const auto at = text.find(right);
    ASSERT_NE(at, std::string::npos) << right;
    text.replace(at, right.size(), wrong);
    EXPECT_EQ(ergocast({"check", write("slip.textproto", text)}), 2);
    EXPECT_TRUE(printed("\n1 problem\n")) << right << " → " << wrong << ":\n" << output();
  }
}

TEST_F(Typing, ErrorsInPlacesNameTheDomainAndNotADistantLimit) {
  std::string text = text_of(scenario_file("quadrimodal_corners"));
  text.insert(text.find("starts {"), "starts { x_m: 1e20  y_m: 1 }\n  ");
  EXPECT_EQ(ergocast({"check", write("far.textproto", text)}), 2);
  EXPECT_TRUE(printed("1e+20 is far outside the domain (write a number in the domain, 0 to 2000)"))
      << output();
  EXPECT_FALSE(printed("1e+13")) << output();
}

// No process writes into the pipe: a program that opens it to read would never continue.
TEST_F(Typing, PipesAreRefusedWhereverAFileIsNamed) {
  const std::string pipe = folder_ / "pipe", scenario = scenario_file("quadrimodal_corners");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::vector<std::vector<std::string>> commands = {
      {"check", pipe},
      {"run", pipe},
      {"simulate", pipe},
      {"study", pipe, "--seeds", "1", "--out", out()},
      {"simulate", scenario, "--faults", pipe, "--seeds", "1"},
      {"run", scenario, "--key-file", pipe},
      {"deploy", scenario, "--to", "ssh", "--hosts", pipe},
      {"check", "/dev/zero"},
      {"deploy", scenario, "--to", "ssh", "--hosts", "/dev/zero"}};
  for (const auto& command : commands) {
    EXPECT_EQ(ergocast(command), 2) << ::testing::PrintToString(command);
    EXPECT_TRUE(printed("not a regular file") || printed("not a file")) << output();
  }
  EXPECT_EQ(run("ergocast-coordinator", {pipe}), 2) << output();
}

TEST_F(Typing, PipesInARunDirectoryAreRefused) {
  ASSERT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--duration", "3", "--out",
                      out()}),
            0);
  for (const char* file : {"plan.binpb", "summary.json", "trajectory.csv", "metrics.csv"}) {
    const auto path = out() / file, aside = folder_ / "aside";
    std::filesystem::rename(path, aside);
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    for (const char* command : {"verify", "report"}) {
      EXPECT_EQ(ergocast({command, out()}), 2) << command << ' ' << file;
      EXPECT_TRUE(printed(file) && printed("not a regular file")) << output();
    }
    std::filesystem::rename(aside, path);
  }
}

TEST_F(Typing, APipeAmongTheEventLogsBlocksNoCommand) {
  ASSERT_EQ(ergocast({"simulate", scenario_file("quadrimodal_corners"), "--duration", "3",
                      "--event-log", "--out", out()}),
            0);
  for (const char* name : {"events-000.lcm", "events-001.lcm", "events-001.lcm.zst"}) {
    const auto path = out() / name, aside = folder_ / "aside";
    const bool first = std::filesystem::exists(path);
    if (first) std::filesystem::rename(path, aside);
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    EXPECT_EQ(ergocast({"replay", out(), "--rate", "1000"}), 2) << name;
    EXPECT_TRUE(printed(name) && printed("not a regular file")) << output();
    EXPECT_EQ(ergocast({"report", out()}), 0) << name;
    EXPECT_TRUE(printed(name) && printed("not a regular file")) << output();
    std::filesystem::remove(path);
    if (first) std::filesystem::rename(aside, path);
  }
}

TEST_F(Typing, PipesAmongTheMapsOfAScenarioAreRefused) {
  std::string plane = text_of(scenario_file("quadrimodal_corners"));
  std::string box = text_of(scenario_file("water_column"));
  const auto with = [](std::string text, const std::string& part) {
    text.insert(text.find("target {") + 8, ' ' + part + ' ');
    return text;
  };
  const std::string area = " origin_x_m: 0 origin_y_m: 0 size_x_m: 9 size_y_m: 9 } ";
  const std::map<std::string, std::string> parts = {
      {"m.png", with(plane, "maps { file: \"m.png\"" + area)},
      {"m.csv", with(plane, "maps { file: \"m.csv\"" + area)},
      {"m.asc", with(plane, "maps { file: \"m.asc\" }")},
      {"m.svg", with(plane, "keep_outs { file: \"m.svg\" }")},
      {"m.geojson", "origin { latitude_deg: 47 longitude_deg: 9 }\n" +
                        with(plane, "keep_outs { file: \"m.geojson\" }")},
      {"m.nc", with(box, "voxels { file: \"m.nc\" variable: \"chl\" }")}};
  for (const auto& [name, scenario] : parts) {
    ASSERT_EQ(mkfifo((folder_ / name).c_str(), 0600), 0);
    EXPECT_EQ(ergocast({"check", write("piped.textproto", scenario)}), 2) << name;
    EXPECT_TRUE(printed(name) && printed("not a regular file")) << output();
  }
}

TEST_F(Typing, PipesInAStudyAreRefusedAndNotWrittenOver) {
  const std::vector<std::string> study = {
      "study", scenario_file("quadrimodal_corners"), "--seeds", "1", "--duration", "3", "--out",
      out()};
  ASSERT_EQ(ergocast(study), 0) << output();
  for (const char* name : {"study.csv", "study.json"}) {
    std::filesystem::remove(out() / name);
    ASSERT_EQ(mkfifo((out() / name).c_str(), 0600), 0);
    EXPECT_EQ(ergocast(study), 2) << name;
    EXPECT_TRUE(printed(name) && printed("not a regular file")) << output();
    EXPECT_TRUE(std::filesystem::is_fifo(out() / name));
  }
}

TEST_F(Typing, WhatFilesContainNeverSteersTheTerminal) {
  const std::string evil = "\x1b]0;owned\x07\x1b[2J\xc2\x9b\xff";
  const std::string scenario = scenario_file("quadrimodal_corners");
  const auto faults = write("faults", evil + " = 1\n");
  const auto hosts = write("hosts", evil + " sim " + evil + "\n");
  const auto key = write("evil.key", evil);
  std::filesystem::permissions(key, std::filesystem::perms::owner_read);
  const auto text =
      write("evil.textproto", "name: \"" + std::string("\x1b[2J") + "\" " + "\x1b]0;x\x07: 3\n");
  const std::vector<std::vector<std::string>> commands = {
      {"check", text},
      {"check", folder_ / evil},
      {"simulate", scenario, "--faults", faults, "--seeds", "1"},
      {"run", scenario, "--key-file", key},
      {"deploy", scenario, "--to", "ssh", "--hosts", hosts},
      {"run", scenario, "--" + evil},
      {evil}};
  const auto steers = [](const std::string& words) {
    return std::any_of(words.begin(), words.end(),
                       [](unsigned char c) {
                         return (c < 0x20 && c != '\n' && c != '\t') || c == 0x7f || c == 0xff;
                       }) ||
           words.find("\xc2\x9b") != std::string::npos;
  };
  for (const auto& command : commands) {
    EXPECT_EQ(ergocast(command), 2) << ::testing::PrintToString(command);
    EXPECT_FALSE(steers(output())) << ::testing::PrintToString(output());
    EXPECT_GT(output().size(), 20U) << ::testing::PrintToString(command);
  }
  EXPECT_EQ(run("ergocast-coordinator", {text}), 2);
  EXPECT_FALSE(steers(output())) << ::testing::PrintToString(output());
}

TEST_F(Typing, ALongListOfProblemsIsCounted) {
  std::string noise;
  for (int i = 0; i < 200000; ++i) noise += static_cast<char>(i * 7 + i / 256);
  const std::string scenario = scenario_file("quadrimodal_corners");
  EXPECT_EQ(ergocast({"deploy", scenario, "--to", "ssh", "--hosts", write("hosts", noise)}), 2);
  EXPECT_LE(lines(), 60);
  EXPECT_LT(output().size(), 150000U);
  EXPECT_TRUE(printed(" more\n")) << output().substr(0, 1000);
  std::string faults;
  for (int i = 0; i < 5000; ++i) faults += "nonsense_" + std::to_string(i) + " = 1\n";
  EXPECT_EQ(ergocast({"simulate", scenario, "--faults", write("faults", faults), "--seeds", "1"}),
            2);
  EXPECT_LE(lines(), 60);
  EXPECT_TRUE(printed("and 4950 more\n")) << output().substr(0, 1000);
  EXPECT_EQ(ergocast({"deploy", scenario, "--to", "ssh", "--hosts", write("hosts", noise + noise)}),
            2);
  EXPECT_TRUE(printed("longer than the limit")) << output().substr(0, 1000);
}

TEST_F(Typing, AnEmptyKeyVariableIsRefused) {
  const std::string scenario = scenario_file("quadrimodal_corners");
  setenv("ERGOCAST_KEY_FILE", "", 1);
  EXPECT_EQ(ergocast({"run", scenario, "--duration", "1", "--out", out()}), 2);
  EXPECT_TRUE(printed("ERGOCAST_KEY_FILE") && printed("unset it")) << output();
  EXPECT_EQ(ergocast({"status"}), 2);
  for (const char* program : {"ergocast-agent", "ergocast-sim"}) {
    EXPECT_EQ(run(program, {}), 2) << program;
    EXPECT_TRUE(printed("ERGOCAST_KEY_FILE")) << output();
  }
  EXPECT_EQ(ergocast({"check", scenario}), 0)
      << "what takes no key does not ask for one: " << output();
  unsetenv("ERGOCAST_KEY_FILE");
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(Typing, TooFewDescriptorsAreCalledByTheirName) {
  const std::string agent = program_folder() / "ergocast-agent";
  int refused = 0;
  for (const int limit : {4, 5, 6, 7, 8, 9, 10, 20}) {
    const auto log = folder_ / ("limit-" + std::to_string(limit));
    // The shell itself needs more of them to redirect.
    const std::string command = "exec timeout -s INT 2 prlimit --nofile=" + std::to_string(limit) +
                                " " + agent + " > " + log.string() + " 2>&1";
    std::system(("sh -c '" + command + "'").c_str());
    const std::string words = text_of(log);
    EXPECT_EQ(words.find("irewall"), std::string::npos) << limit << ": " << words;
    refused += words.find("Too many open files") != std::string::npos ? 1 : 0;
  }
  EXPECT_GE(refused, 4);
}

}  // namespace
}  // namespace ergocast::test
