// SPDX-License-Identifier: BSD-3-Clause
// The page of a real-time team with control, in a window as large as a phone's.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/page/page_in_a_browser.h"

namespace ergocast::test {

class ControlledPage : public PageInABrowser {
 protected:
  /// Starts a real-time team, and opens its page with the token that permits orders.
  void control(const std::vector<std::string>& more = {}, const std::string& vehicle = "",
               int realtime_factor = 10) {
    std::vector<std::string> options{"--watch", "--control", "--port", "8820"};
    options.insert(options.end(), more.begin(), more.end());
    const auto file =
        scenario("pace: REALTIME realtime_factor: " + std::to_string(realtime_factor));
    std::ofstream(file, std::ios::app) << vehicle;
    mission_ = launch_endless(file, options);
    browser_->resize(400, 800);
    browser_->open(address());
    ASSERT_TRUE(browser_->becomes("return !document.getElementById('control')?.hidden"));
  }
  std::string address() const {
    const std::string text = printed(), end = "#control=";
    const auto at = text.find(end);
    EXPECT_NE(at, text.npos) << text;
    const auto begin = text.rfind("http", at);
    return text.substr(begin, at + end.size() + 32 - begin);
  }
  void take_control(const std::string& name = "anna") {
    js("document.getElementById('operatorName').value = '" + name + "'");
    browser_->click("#take");
    EXPECT_TRUE(becomes("holder", "You have control"));
  }
  static std::string button(const std::string& act) { return "#orders [data-act=" + act + "]"; }
  /// Both presses in one script, so that no machine is too slow for the second one.
  void order(const std::string& act) {
    js("const button = document.querySelector('" + button(act) +
       "');"
       "if (!button.classList.contains('armed')) button.click();"
       "button.click()");
  }
  /// Waits until a text of the page matches.
  bool becomes(const std::string& id, const std::string& pattern) {
    return browser_->becomes("return /" + pattern + "/.test(document.getElementById('" + id +
                             "').textContent)");
  }
  bool visible(const std::string& selector) {
    return js("return document.querySelector('" + selector + "').checkVisibility()").get<bool>();
  }
  void end_with_the_mission() {
    ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
    // A browser that has not received the end yet would connect again, in vain.
    EXPECT_TRUE(browser_->becomes("return ergocast.S.live === false"));
    mission_->send(SIGINT);
    EXPECT_EQ(wait_for(*mission_), 0) << printed();
  }

  std::optional<Child> mission_;
};

}  // namespace ergocast::test
