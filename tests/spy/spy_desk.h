// SPDX-License-Identifier: BSD-3-Clause
// A virtual screen with LCM's viewer on it.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

#include "tests/process/support/mission.h"

namespace ergocast::test {

/// The programs that this machine lacks for the tests: " xvfb xdotool"; empty if none.
inline std::string missing_for_spy(bool with_screen) {
  const std::string jar = std::string(ERGOCAST_BIN_DIR) + "/../cli/spy/ergocast-spy.jar";
  std::vector<std::pair<std::string, std::string>> needs{{jar, " default-jdk liblcm-java"}};
  if (with_screen) {
    needs.insert(needs.end(), {{"/usr/share/java/jchart2d.jar", " libjchart2d-java"},
                               {"/usr/bin/Xvfb", " xvfb"},
                               {"/usr/bin/openbox", " openbox"},
                               {"/usr/bin/xdotool", " xdotool"}});
  }
  std::string missing;
  for (const auto& [file, package] : needs) {
    if (!std::filesystem::exists(file)) missing += package;
  }
  return missing;
}

/// A part of the screen.
struct Area {
  int x = 0, y = 0, width = 0, height = 0;
};
using Pixel = std::pair<int, int>;

/// The picture of Xvfb: a file in the format of xwd, which it keeps up to date.
class Screenshot {
 public:
  explicit Screenshot(const std::filesystem::path& file) : bytes_(text_of(file)) {
    width_ = number(4), height_ = number(5), stride_ = number(12);
    first_ = number(0) + 12 * number(19);  // after the header and the colour map
  }
  /// 0xrrggbb; white outside the screen.
  int color(int x, int y) const {
    const auto at = static_cast<std::size_t>(first_ + y * stride_ + 4 * x);
    if (x < 0 || y < 0 || x >= width_ || y >= height_ || at + 3 > bytes_.size()) return 0xffffff;
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes_[at + i]); };
    return byte(2) << 16 | byte(1) << 8 | byte(0);
  }
  std::map<int, std::set<Pixel>> pixels_by_color(const Area& area) const {
    std::map<int, std::set<Pixel>> found;
    for (int y = area.y; y < area.y + area.height; ++y) {
      for (int x = area.x; x < area.x + area.width; ++x) found[color(x, y)].insert({x, y});
    }
    return found;
  }

 private:
  /// The i-th 32-bit number of the header, most significant byte first.
  int number(std::size_t i) const {
    std::uint32_t value = 0;
    for (std::size_t k = 4 * i; k < 4 * i + 4 && k < bytes_.size(); ++k) {
      value = value << 8 | static_cast<unsigned char>(bytes_[k]);
    }
    return static_cast<int>(value);
  }
  std::string bytes_;
  int width_ = 0, height_ = 0, stride_ = 0, first_ = 0;
};

/// Runs the Java checks; see SpyProbe.java.
class WithProbe : public RunningMission {
 protected:
  std::vector<std::string> probe_command(const std::vector<std::string>& question) const {
    std::vector<std::string> command{ERGOCAST_JAVA,
                                     "-Xmx64m",
                                     "-Djava.awt.headless=true",
                                     "-Djava.net.preferIPv4Stack=true",
                                     "-cp",
                                     ERGOCAST_SPY_CLASSES,
                                     "ergocast.spy.SpyProbe"};
    command.insert(command.end(), question.begin(), question.end());
    return command;
  }
  /// Runs one to its end; returns its output.
  std::string sent_by(const std::vector<std::string>& command) {
    Child child = begin(command);
    EXPECT_TRUE(eventually([&child] { return !child.running(); })) << command.front();
    return output();
  }
  std::string ask(const std::vector<std::string>& question) {
    return sent_by(probe_command(question));
  }
};

/// Tests with a screen and a window manager.
class Desk : public WithProbe {
 protected:
  void SetUp() override {
    const std::string missing = missing_for_spy(true);
    if (!missing.empty()) GTEST_SKIP() << "not installed:" << missing;
    screen_ = begin(screen_command({"-displayfd", "1"}));
    const auto log = log_;
    ASSERT_TRUE(
        eventually([&] { return text_of(log).find('\n') != std::string::npos; }, screen_->pid()));
    const std::string printed = text_of(log);
    const auto end = printed.rfind('\n');
    const auto begin_of_number = printed.find_last_not_of("0123456789", end - 1) + 1;
    setenv("DISPLAY", (":" + printed.substr(begin_of_number, end - begin_of_number)).c_str(), 1);
    manager_ = begin({"/usr/bin/openbox"});
  }
  void TearDown() override {
    forget_watched();
    for (std::optional<Child>* child : {&manager_, &screen_}) {
      if (!*child) continue;
      (*child)->send(SIGTERM);
      wait_for(**child);
    }
    unsetenv("DISPLAY");
    OwnHost::TearDown();
  }

  /// The screen has only an abstract socket in the test's network; all tests of a machine would
  /// share a socket file and a lock file.
  // Without -noreset the screen restarts when its last client leaves, and refuses others meanwhile.
  // xdotool may be its only client while the window manager still starts.
  std::vector<std::string> screen_command(const std::vector<std::string>& more) const {
    std::vector<std::string> command{"/usr/bin/Xvfb", "-screen",  "0",         "1600x1000x24",
                                     "-nolisten",     "tcp",      "-nolisten", "unix",
                                     "-nolock",       "-noreset", "-fbdir",    folder_};
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  Screenshot look() const { return Screenshot(folder_ / "Xvfb_screen0"); }
  std::string xdotool(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "/usr/bin/xdotool");
    return sent_by(arguments);
  }
  /// The id of the window with that name, or nullopt.
  std::string window(const std::string& name) {
    const std::string found = xdotool({"search", "--onlyvisible", "--name", "^" + name + "$"});
    return found.substr(0, found.find('\n'));
  }
  bool sees(const std::string& name) {
    return eventually([&] { return !window(name).empty(); });
  }
  /// Brings the window to the front; returns its position, without the height of its title.
  Area front(const std::string& name) {
    const std::string id = window(name);
    xdotool({"windowactivate", "--sync", id});
    std::istringstream lines(xdotool({"getwindowgeometry", "--shell", id}));
    std::map<std::string, int> values;
    for (std::string line; std::getline(lines, line);) {
      const auto equals = line.find('=');
      if (equals != line.npos)
        values[line.substr(0, equals)] = std::atoi(line.c_str() + equals + 1);
    }
    return {values["X"], values["Y"], values["WIDTH"], values["HEIGHT"]};
  }
  /// The window's pixels. Each look brings it to the front and asks where it is: a window of a row
  /// that open() tried may come late and above it, and it may still change its size.
  std::map<int, std::set<Pixel>> pixels_of(const std::string& name) {
    return look().pixels_by_color(front(name));
  }
  /// Double-clicks rows of the viewer's table until the window of that channel is there. Starts at
  /// `row` and tries the next rows, because channels may appear and disappear.
  bool open(const std::string& channel, int row) {
    constexpr int kHeader = 24, kRow = 16, kMoreRows = 3;  // pixels; lcm-spy has fixed ones
    int tries = 0;
    return eventually([&] {
      if (window("LCM Spy").empty()) return false;
      front("LCM Spy");
      const int y = kHeader + kRow * (row + tries++ % kMoreRows);
      xdotool({"mousemove", "--window", window("LCM Spy"), "60", std::to_string(y), "click",
               "--repeat", "2", "--delay", "60", "1"});
      for (int i = 0; i < 20; ++i) {
        if (!window(channel).empty()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
      return false;
    });
  }

  std::optional<Child> screen_;

 private:
  std::optional<Child> manager_;
};

}  // namespace ergocast::test
