// SPDX-License-Identifier: BSD-3-Clause
// `ergocast deploy`, and the shipped scenarios that commands know by name.
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

class Deploy : public OwnHost {
 protected:
  std::filesystem::path hosts(const std::string& text) {
    std::ofstream(folder_ / "hosts.txt") << text;
    return folder_ / "hosts.txt";
  }
  int deploy(const std::string& to, const std::string& text, std::vector<std::string> more = {}) {
    more.insert(more.begin(),
                {"deploy", scenario_file("lake_search"), "--to", to, "--hosts", hosts(text)});
    return ergocast(more);
  }
  bool printed(const std::string& part) const { return output().find(part) != std::string::npos; }
};

constexpr const char* kTwoHosts = "ground coordinator logger sim\nrover agents=5\n";

TEST_F(Deploy, PrintsAScriptWithTheScenarioAndItsMap) {
  for (const char* to : {"ssh", "systemd"}) {
    ASSERT_EQ(deploy(to, kTwoHosts), 0) << output();
    EXPECT_TRUE(output().starts_with("#!/usr/bin/env bash\n"));
    EXPECT_TRUE(printed("scenario_files=(lake_search.textproto maps/lake.png)")) << output();
    EXPECT_TRUE(printed("url='udpm://239.255.76.67:7667?ttl=1'")) << output();
  }
}

TEST_F(Deploy, WritesIntoAFolderAndNeverOverAFile) {
  ASSERT_EQ(deploy("compose", kTwoHosts, {"--out", out()}), 0) << output();
  EXPECT_EQ(output(), (out() / "ground.compose.yaml").string() + '\n' +
                          (out() / "rover.compose.yaml").string() + '\n');
  ASSERT_EQ(deploy("ssh", kTwoHosts, {"--out", out()}), 0) << output();
  EXPECT_EQ(std::system(("bash -n " + (out() / "lake_search-ssh.sh").string()).c_str()), 0);
  EXPECT_NE(std::filesystem::status(out() / "lake_search-ssh.sh").permissions() &
                std::filesystem::perms::owner_exec,
            std::filesystem::perms::none);
  std::filesystem::remove(out() / "ground.compose.yaml");
  const std::string before = text_of(out() / "rover.compose.yaml");
  EXPECT_EQ(deploy("compose", "ground coordinator logger sim\nrover agent 7 8 9 10 11\n",
                   {"--out", out()}),
            2);
  EXPECT_TRUE(printed("rover.compose.yaml is there already")) << output();
  EXPECT_EQ(text_of(out() / "rover.compose.yaml"), before);
  EXPECT_FALSE(std::filesystem::exists(out() / "ground.compose.yaml"));
}

TEST_F(Deploy, HandsTheTableOfModesToEveryHost) {
  const std::string office =
      (std::filesystem::path(ERGOCAST_SOURCE_DIR) / "scenarios/office.textproto").string();
  for (const char* to : {"ssh", "systemd", "compose"}) {
    const std::filesystem::path into = out() / to;
    ASSERT_EQ(ergocast({"deploy", office, "--to", to, "--hosts",
                        hosts("ground coordinator logger sim\nrover agents=6\n"), "--out", into}),
              0)
        << output();
    const std::string printed = output();
    const auto table = printed.find("modes-");
    ASSERT_NE(table, std::string::npos) << printed;
    const std::string name = printed.substr(table, printed.find('\n', table) - table);
    EXPECT_GT(std::filesystem::file_size(into / name), 1000000U);
    std::string texts;
    for (const auto& entry : std::filesystem::directory_iterator(into))
      if (entry.path().extension() != ".bin") texts += text_of(entry);
    EXPECT_NE(texts.find(name), std::string::npos) << texts;
  }
}

TEST_F(Deploy, NotesThatEachRobotNeedsItsOwnDriver) {
  const std::string leased =
      (std::filesystem::path(ERGOCAST_SOURCE_DIR) / "tests/lab/leased_team.textproto").string();
  const auto deployed = [&](const std::string& roles) {
    return ergocast({"deploy", leased, "--to", "ssh", "--hosts",
                     hosts("ground coordinator\nrover agents=40 " + roles + "\n")});
  };
  ASSERT_EQ(deployed("driver"), 0) << output();
  EXPECT_TRUE(printed("beside agent N, such as ergocast-example-driver --id N")) << output();
  ASSERT_EQ(deployed("sim"), 0) << output();
  EXPECT_FALSE(printed("ergocast-example-driver")) << output();
}

TEST_F(Deploy, NamesEveryProblemAtOnce) {
  EXPECT_EQ(
      deploy("ssh", "ground sim\nrover agents=4\n", {"--lcm-url", "udpm://239.1.2.3:7000?ttl=0"}),
      2);
  for (const char* part : {"no host is the coordinator", "fewer than the quorum", "ttl=1"})
    EXPECT_TRUE(printed(part)) << output();
  EXPECT_EQ(deploy("ssh", "ground captain\nrover agents=x\n"), 2);
  EXPECT_TRUE(printed("hosts.txt:1:8: \"captain\" is no role") && printed("hosts.txt:2:7: "))
      << output();
  EXPECT_EQ(deploy("compose", "box coordinator sim agents=5\n",
                   {"--lcm-url", "udpm://239.1.2.3:7000?ttl=0"}),
            2);
  EXPECT_TRUE(printed("container")) << output();
  EXPECT_EQ(deploy("rsh", kTwoHosts), 2);
  EXPECT_EQ(ergocast({"deploy", scenario_file("lake_search"), "--to", "ssh", "--hosts",
                      folder_ / "none"}),
            2);
  EXPECT_TRUE(printed("there is no such file")) << output();
}

TEST_F(Deploy, RefusesKeysThatWouldNotDo) {
  const std::string name = folder_ / "team";
  EXPECT_EQ(deploy("ssh", kTwoHosts, {"--keys", name}), 2);
  EXPECT_TRUE(printed(name + ".key: there is no such file; `ergocast keygen " + name)) << output();
  ASSERT_EQ(ergocast({"keygen", name}), 0);
  EXPECT_EQ(deploy("ssh", kTwoHosts, {"--keys", name}), 0) << output();
  EXPECT_TRUE(printed("keys=" + name + "\n")) << output();

  const std::string other = folder_ / "other";
  ASSERT_EQ(ergocast({"keygen", other}), 0);
  const auto exchange = [&](const char* from, const char* to) {
    std::filesystem::copy_file(from + std::string(".key"), to + std::string(".key"),
                               std::filesystem::copy_options::overwrite_existing);
  };
  exchange((other + ".coordinator").c_str(), (name + ".coordinator").c_str());
  EXPECT_EQ(deploy("systemd", kTwoHosts, {"--keys", name}), 2);
  EXPECT_TRUE(printed("different keys")) << output();
  exchange((other + ".coordinator").c_str(), name.c_str());
  EXPECT_EQ(deploy("compose", kTwoHosts, {"--keys", name}), 2);
  EXPECT_TRUE(printed("every host could begin and end missions")) << output();
  exchange(other.c_str(), name.c_str());
  exchange(other.c_str(), (name + ".coordinator").c_str());
  EXPECT_EQ(deploy("compose", kTwoHosts, {"--keys", name}), 2);
  EXPECT_TRUE(printed("cannot begin or end missions")) << output();
  std::filesystem::permissions(name + ".key", std::filesystem::perms(0644));
  EXPECT_EQ(deploy("ssh", kTwoHosts, {"--keys", name}), 2);
  EXPECT_TRUE(printed("chmod 600")) << output();
}

TEST_F(Deploy, RefusesAFileThatTheScenarioNamesByItsAbsolutePath) {
  std::ofstream(folder_ / "room.svg")
      << R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">)"
         R"(<path d="M 40 40 L 60 40 L 60 60 L 40 60 Z"/></svg>)";
  const auto walled = [&](const std::string& file) {
    std::ofstream(folder_ / "walled.textproto")
        << "domain { size_x_m: 100 size_y_m: 100 } target { uniform_weight: 1 } "
           "law { u_max_mps: 3 } time { duration_s: 60 } world { speed_limit_mps: 9 "
           "wall_clearance_m: 2 walls { file: \"" +
               file +
               "\" } } "
               "agents { starts { x_m: 10 y_m: 10 } }";
    return ergocast({"deploy", folder_ / "walled.textproto", "--to", "ssh", "--hosts",
                     hosts("ground coordinator logger sim agent 0\n")});
  };
  ASSERT_EQ(walled("room.svg"), 0) << output();
  EXPECT_TRUE(printed("scenario_files=(walled.textproto room.svg)")) << output();
  EXPECT_EQ(walled((folder_ / "room.svg").string()), 2);
  EXPECT_TRUE(printed("room.svg\" is a whole path") && printed("name it relative to that folder"))
      << output();
}

TEST_F(Deploy, RefusesDriversOfAMissionInLockstep) {
  const char* driven = "ground coordinator logger driver\nrover agents=5\n";
  EXPECT_EQ(deploy("ssh", driven, {"--lockstep"}), 2);
  EXPECT_TRUE(printed("is in lockstep, and robots follow the clock") && printed("give --realtime"))
      << output();
  EXPECT_EQ(deploy("ssh", driven, {"--realtime"}), 0) << output();
}

TEST_F(Deploy, TheCoordinatorChangesTheScenarioAsItWasChangedHere) {
  const std::vector<std::string> changes{"--set", "law.epsilon=0.2", "--realtime", "--seed", "7"};
  ASSERT_EQ(deploy("ssh", kTwoHosts, changes), 0) << output();
  EXPECT_TRUE(
      printed("ergocast-coordinator ./lake_search.textproto '--realtime=1' --set "
              "'law.epsilon=0.2' --seed 7"))
      << output();
  ASSERT_EQ(deploy("compose", kTwoHosts, changes), 0) << output();
  EXPECT_TRUE(printed(R"("--realtime=1", "--set", "law.epsilon=0.2", "--seed", "7"])")) << output();
  ASSERT_EQ(deploy("systemd", kTwoHosts, changes), 0) << output();
  EXPECT_TRUE(printed("overrides='--realtime=1 --set law.epsilon=0.2 --seed 7'")) << output();
  EXPECT_EQ(deploy("ssh", kTwoHosts, {"--set", "law.epsilom=0.2"}), 2);
  EXPECT_TRUE(printed("unknown field")) << output();
  EXPECT_EQ(deploy("systemd", kTwoHosts, {"--set", "law.epsilon= 0.2"}), 2);
  EXPECT_TRUE(printed("a service's settings cannot hold")) << output();
}

TEST_F(Deploy, NotesThatOnlyFilesTakeTheTableOfModesAlong) {
  const std::string office =
      (std::filesystem::path(ERGOCAST_SOURCE_DIR) / "scenarios/office.textproto").string();
  ASSERT_EQ(ergocast({"deploy", office, "--to", "ssh", "--hosts",
                      hosts("ground coordinator logger sim\nrover agents=6\n")}),
            0);
  EXPECT_TRUE(printed("note: the table of the free domain's modes is written only with --out DIR"))
      << output();
}

TEST_F(Deploy, RefusesAMapThatLiesElsewhere) {
  const auto shipped = scenario_file("lake_search").parent_path();
  std::string text = text_of(scenario_file("lake_search"));
  text.replace(text.find("maps/lake.png"), 13, (shipped / "maps/lake.png").string());
  std::ofstream(folder_ / "far.textproto") << text;
  EXPECT_EQ(
      ergocast({"deploy", folder_ / "far.textproto", "--to", "ssh", "--hosts", hosts(kTwoHosts)}),
      2);
  EXPECT_TRUE(printed("cannot be copied to another host")) << output();
}

/// Programs and scenarios as an installation has them.
class Installed : public Deploy {
 protected:
  Installed() {
    namespace fs = std::filesystem;
    fs::create_directories(folder_ / "bin");
    fs::create_directories(folder_ / "share/ergocast");
    fs::copy(program_folder() / "ergocast", folder_ / "bin");
    fs::copy(ERGOCAST_SCENARIO_DIR, folder_ / "share/ergocast/scenarios",
             fs::copy_options::recursive);
  }
  int installed(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), folder_ / "bin/ergocast");
    log_ = folder_ / "said";
    std::filesystem::remove(log_);
    Child child = Child::start({arguments, log_, SIGKILL}).value();
    return wait_for(child);
  }
};

TEST_F(Installed, ShippedScenariosAreKnownByName) {
  EXPECT_EQ(installed({"check", "lake_search"}), 0) << output();
  EXPECT_TRUE(
      printed((folder_ / "share/ergocast/scenarios/lake_search.textproto: no problems").string()))
      << output();
  EXPECT_EQ(installed({"simulate", "uniform_square", "--duration", "1", "--out", out()}), 0)
      << output();
}

TEST_F(Installed, ANameThatNothingHasIsRefusedWithThoseThatAre) {
  EXPECT_EQ(installed({"check", "lake_serch"}), 2);
  EXPECT_TRUE(
      printed("lake_serch") &&
      printed("harbour_patrol, home_by_dusk, lake_search, lost_hiker, mine_line, mixed_team"))
      << output();
  EXPECT_EQ(installed({"check", "lake_serch.textproto"}), 2);
  EXPECT_TRUE(printed("lake_serch.textproto: there is no such file")) << output();
}

TEST_F(Installed, AFileGoesBeforeAShippedScenarioOfItsName) {
  std::filesystem::copy(scenario_file("uniform_square"), folder_ / "lake_search");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder_);
  EXPECT_EQ(installed({"check", "lake_search"}), 0);
  std::filesystem::current_path(before);
  EXPECT_TRUE(printed("lake_search: no problems. ") && !printed("share")) << output();
}

}  // namespace
}  // namespace ergocast::test
