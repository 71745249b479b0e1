// SPDX-License-Identifier: BSD-3-Clause
// A page of a real-time team, on which a target or a zone is drawn.
#pragma once

#include <iterator>
#include <regex>

#include "tests/page/page_in_a_browser.h"

namespace ergocast::test {

class DrawingInABrowser : public PageInABrowser {
 protected:
  enum class Control { kTaken, kNone };

  /// Starts a real-time team and opens its page. With control the page is opened with the token
  /// that permits orders.
  void open_page(Control control, const std::filesystem::path& scenario_file) {
    mission_ =
        launch_endless(scenario_file, {"--realtime=10", "--watch", "--control", "--port", "8821"});
    browser_->resize(1300, 900);
    browser_->open(control == Control::kTaken ? address() : kAddress);
    ASSERT_TRUE(browser_->becomes("return window.ergocast?.S.facts?.state?.world_tick > 100"));
    if (control == Control::kTaken) {
      take_control();
    }
    ASSERT_TRUE(browser_->becomes("return !document.getElementById('drawTarget').hidden"));
    // A warning that the machine is slow would move the map between two presses.
    js("document.getElementById('overload').style.display = 'none'");
  }
  void open_page(Control control) { open_page(control, scenario("pace: REALTIME")); }
  /// With the token that permits orders.
  std::string address() const {
    const std::string text = printed(), begin = std::string(kAddress) + "#control=";
    EXPECT_NE(text.find(begin), text.npos) << text;
    return text.substr(text.find(begin), begin.size() + 32);
  }
  bool becomes(const std::string& id, const std::string& pattern) {
    return browser_->becomes("return /" + pattern + "/.test(document.getElementById('" + id +
                             "').textContent)");
  }
  bool visible(const std::string& selector) {
    return js("return document.querySelector('" + selector + "').checkVisibility()").get<bool>();
  }
  /// Waits until the page has drawn what it knows now.
  void draws() {
    js("ergocast.clearFrames()");
    EXPECT_TRUE(browser_->becomes("return ergocast.frames().length > 1"));
  }
  /// Clicks at corners, and on the first one again: pixels to the right of the map's middle, and
  /// below it.
  void click_corners(const std::vector<std::pair<int, int>>& corners) {
    for (const auto& [right, down] : corners) browser_->drag("#drawn", 0, 0, right, down);
    browser_->drag("#drawn", 0, 0, corners[0].first, corners[0].second);
  }
  /// On a slow machine a request may name an old tick, or not be sent: it is then repeated.
  void take_control() {
    EXPECT_TRUE(eventually([&] {
      js("document.getElementById('take').click()");
      EXPECT_TRUE(browser_->becomes(
          "const text = id => document.getElementById(id).textContent;"
          "return text('holder') === 'You have control' || text('controlNotice') !== ''"));
      return text("holder") == "You have control";
    })) << text("controlNotice");
  }
  /// Both presses in one script, so that no machine is too slow for the second one.
  void press_send(const std::string& selector = kSend) {
    js("const button = document.querySelector('" + selector + "'); button.click(); button.click()");
  }
  /// Sends what is drawn, or gives the order of another button, until the team's process has
  /// received it.
  void send(const std::string& selector = kSend) {
    const int before = received();
    press_send(selector);
    expect_received(before + 1, selector);
  }
  /// How many targets, zones and cancellations of this page have become orders.
  int received() const {
    static const std::regex order(
        "control: .* asks for: (new target|new zone|cancel zone \\d+), at ");
    const std::string text = printed();
    return static_cast<int>(
        std::distance(std::sregex_iterator(text.begin(), text.end(), order), {}));
  }
  /// On a slow machine an order may be refused, or not be sent, and the page says so: it is then
  /// sent again.
  void expect_received(int count, const std::string& selector = kSend) {
    EXPECT_TRUE(eventually([&] {
      if (received() >= count) return true;
      if (text("holder") != "You have control") {
        take_control();
        if (received() >= count) return true;
        press_send(selector);
        return false;
      }
      // Seen and pressed in one script: the answer may come at any time.
      js("const { textContent: notice } = document.getElementById('controlNotice');"
         "const button = document.querySelector('" +
         selector +
         "');"
         "if (/refused: |not sent|not answered/.test(notice) && button?.checkVisibility()) {"
         " button.click(); button.click(); }");
      return false;
    })) << text("controlNotice")
        << '\n'
        << printed();
  }
  /// Types into a field.
  void type(const std::string& id, const std::string& value) {
    js("const field = document.getElementById('" + id + "'); field.value = '" + value +
       "'; field.dispatchEvent(new Event('input'))");
  }
  nlohmann::json drawn(const std::string& what) { return js("return ergocast.S.drawing" + what); }
  /// Runs the command that the page shows, without sending anything.
  int try_command() { return run_command(text("drawnCommand") + " --dry-run"); }
  int run_command(const std::string& text) {
    Child command = begin(
        {"/bin/sh", "-c",
         "cd " + folder_.string() + " && PATH=" + program_folder().string() + ":$PATH && " + text});
    return wait_for(command);
  }
  void end_mission() {
    mission_->send(SIGINT);
    close_page_of(*mission_);
  }

  static constexpr const char* kSend = "#sendDrawn";
  static constexpr const char* kAddress = "http://127.0.0.1:8821/";
  std::optional<Child> mission_;
};

}  // namespace ergocast::test
