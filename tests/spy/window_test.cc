// SPDX-License-Identifier: BSD-3-Clause
// `ergocast spy` during a real mission, on a virtual screen.
#include <gtest/gtest-spi.h>

#include "tests/spy/spy_desk.h"

namespace ergocast::test {
namespace {

constexpr const char* kWorldUrl = "udpm://239.255.76.67:24701?ttl=0";
constexpr const char* kCommandUrl = "udpm://239.255.76.67:24702?ttl=0";

/// The colours of agents 0 to 3, as in TeamView.java.
constexpr int kAgentColors[] = {0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7};
/// Pixels of an agent's disc that have only its colour.
constexpr std::size_t kMarker = 40;
/// Rows of the swarm bus: names in order, four agents.
constexpr int kTeamStatusRow = 13;

class Spy : public Desk {
 protected:
  Child start_mission() { return launch_endless(scenario(), {"--realtime=5", "--lcm-url", kUrl}); }
  static void end(Child& child, int expected) {
    child.send(SIGINT);
    EXPECT_EQ(wait_for(child), expected);
  }
  static constexpr int kJavaInterrupted = 130;
};

TEST_F(Spy, EveryMessageOfAMissionIsDecoded) {
  Child listener = begin(probe_command({"listen", kUrl, kWorldUrl, kCommandUrl}));
  const auto log = log_;
  ASSERT_TRUE(eventually([&] { return text_of(log).find("listening") != std::string::npos; }));
  Child mission = start_mission();
  end(mission, 0);  // sends STOP
  for (const char* type : {"HELLO", "MISSION", "CONTRIBUTION", "AGENT_STATUS", "TEAM_STATUS",
                           "STOP", "WORLD_STATE", "COMMAND", "RECORD_ACK", "DIGEST"}) {
    EXPECT_TRUE(eventually([&] {
      return text_of(log).find(std::string("decoded ERGOCAST_") + type) != std::string::npos;
    })) << type;
  }
  EXPECT_EQ(text_of(log).find("undecodable"), std::string::npos) << text_of(log);
  listener.send(SIGKILL);
  wait_for(listener);
}

TEST_F(Spy, DrawsTheTeamAsItMoves) {
  Child mission = start_mission();
  Child spy = start("ergocast", {"spy", "--lcm-url", kUrl});
  ASSERT_TRUE(sees("LCM Spy")) << output();

  ASSERT_TRUE(open("ERGOCAST_TEAM_STATUS", kTeamStatusRow));
  const auto agents = [&] {
    const auto pixels = pixels_of("ERGOCAST_TEAM_STATUS");
    std::vector<std::set<Pixel>> found;
    for (const int color : kAgentColors) {
      const auto at = pixels.find(color);
      found.push_back(at == pixels.end() ? std::set<Pixel>() : at->second);
    }
    return found;
  };
  const auto all_there = [&](const std::vector<std::set<Pixel>>& found) {
    return std::all_of(found.begin(), found.end(),
                       [](const auto& one) { return one.size() > kMarker; });
  };
  std::vector<std::set<Pixel>> before;
  EXPECT_TRUE(eventually([&] { return all_there(before = agents()); }));
  // The window finds its size in a few pictures, and only later ones come from the mission.
  constexpr int kPictures = 10;
  int pictures = 0;
  EXPECT_TRUE(eventually([&] {
    const auto after = agents();
    bool all_moved = all_there(after);
    for (std::size_t i = 0; i < after.size(); ++i) all_moved = all_moved && after[i] != before[i];
    if (all_moved) {
      ++pictures;
      before = after;
    }
    return pictures >= kPictures;
  }));

  end(spy, kJavaInterrupted);
  end(mission, 0);
}

TEST_F(Spy, DebiansScriptTakesTheJarToo) {
  if (!std::filesystem::exists("/usr/bin/lcm-spy")) GTEST_SKIP() << "not installed: liblcm-bin";
  Child mission = start_mission();
  setenv("JDK_JAVA_OPTIONS", "-XX:+IgnoreUnrecognizedVMOptions", 1);
  setenv("CLASSPATH", (std::string(ERGOCAST_BIN_DIR) + "/../cli/spy/ergocast-spy.jar").c_str(), 1);
  setenv("LCM_DEFAULT_URL", kUrl, 1);
  Child spy = begin({"/usr/bin/lcm-spy"});
  const auto log = log_;
  for (const char* name : {"JDK_JAVA_OPTIONS", "CLASSPATH", "LCM_DEFAULT_URL"}) unsetenv(name);
  ASSERT_TRUE(sees("LCM Spy")) << text_of(log);
  EXPECT_TRUE(
      eventually([&] { return text_of(log).find("Found 1 plugins") != std::string::npos; }));
  ASSERT_TRUE(open("ERGOCAST_TEAM_STATUS", kTeamStatusRow));
  EXPECT_TRUE(
      eventually([&] { return pixels_of("ERGOCAST_TEAM_STATUS").contains(kAgentColors[0]); }));
  end(spy, kJavaInterrupted);
  end(mission, 0);
}

TEST_F(Spy, HasAScreenWithoutANameThatAnotherTestCouldTake) {
  std::istringstream sockets(text_of("/proc/net/unix"));
  int names = 0;
  for (std::string line; std::getline(sockets, line);) {
    if (line.find("/.X11-unix/") == line.npos) continue;
    EXPECT_NE(line.find('@'), line.npos) << line;  // abstract
    ++names;
  }
  EXPECT_GT(names, 0);
  const std::string lock = "/tmp/.X" + std::string(std::getenv("DISPLAY")).substr(1) + "-lock";
  EXPECT_NE(std::atoi(text_of(lock).c_str()), screen_->pid()) << lock;
}

TEST_F(Spy, WaitsNoLongerForAWindowOfAProgramWhoseScreenWasTaken) {
  begin(screen_command({std::getenv("DISPLAY")}));
  ::testing::TestPartResultArray failures;
  {
    using Reporter = ::testing::ScopedFakeTestPartResultReporter;
    const Reporter reporter(Reporter::INTERCEPT_ONLY_CURRENT_THREAD, &failures);
    EXPECT_FALSE(sees("LCM Spy"));
  }
  ASSERT_EQ(failures.size(), 1);
  const std::string printed = failures.GetTestPartResult(0).message();
  EXPECT_NE(printed.find("/usr/bin/Xvfb "), printed.npos) << printed;
  EXPECT_NE(printed.find("Cannot establish any listening sockets"), printed.npos) << printed;
}

TEST_F(Spy, PrintsTheCommandOfTheBusThatIsAskedFor) {
  EXPECT_EQ(ergocast({"spy", "--print", "--bus", "world", "--lcm-url", kUrl}), 0);
  EXPECT_NE(output().find(std::string("lcm.spy.Spy -l '") + kWorldUrl + "'"), std::string::npos)
      << output();
  EXPECT_NE(output().find(std::string("'-Dergocast.url=") + kUrl + "'"), std::string::npos);
  setenv("LCM_DEFAULT_URL", kUrl, 1);
  EXPECT_EQ(ergocast({"spy", "--print"}), 0);
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_NE(output().find(std::string("lcm.spy.Spy -l '") + kUrl + "'"), std::string::npos)
      << output();
}

TEST_F(Spy, ReportsThatThereIsNoScreen) {
  const std::string display = std::getenv("DISPLAY");
  unsetenv("DISPLAY");
  EXPECT_EQ(ergocast({"spy"}), 3);
  setenv("DISPLAY", display.c_str(), 1);
  EXPECT_NE(output().find("DISPLAY is not set"), std::string::npos) << output();
}

TEST_F(Spy, NamesThePackageThatIsMissing) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder_.c_str(), 1);
  EXPECT_EQ(ergocast({"spy"}), 3);
  setenv("PATH", path.c_str(), 1);
  EXPECT_NE(output().find("apt-get install default-jre\n"), std::string::npos) << output();
}

}  // namespace
}  // namespace ergocast::test
