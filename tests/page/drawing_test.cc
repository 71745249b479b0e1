// SPDX-License-Identifier: BSD-3-Clause
// A new target is drawn on the map of a real-time team's page. With control it is sent; without,
// the page shows the command.
#include "tests/page/page_in_a_browser.h"

namespace ergocast::test {
namespace {

class DrawnTargetInABrowser : public PageInABrowser {
 protected:
  /// @param secret  whether the page is opened with the token that permits orders
  void open_page(bool secret) {
    mission_ = launch_endless(scenario("pace: REALTIME realtime_factor: 10"),
                              {"--watch", "--control", "--port", "8821"});
    const std::string text = printed(), begin = "http://127.0.0.1:8821/#control=";
    ASSERT_NE(text.find(begin), text.npos) << text;
    browser_->resize(1300, 900);
    browser_->open(secret ? text.substr(text.find(begin), begin.size() + 32)
                          : "http://127.0.0.1:8821/");
    ASSERT_TRUE(browser_->becomes("return window.ergocast?.S.facts?.state?.world_tick > 100"));
    if (secret) {
      browser_->click("#take");
      ASSERT_TRUE(becomes("holder", "You have control"));
    }
    ASSERT_TRUE(browser_->becomes("return !document.getElementById('drawTarget').hidden"));
    // A warning that the machine is slow would move the map between two presses.
    js("document.getElementById('overload').style.display = 'none'");
    browser_->click("#drawTarget");
  }
  bool becomes(const std::string& id, const std::string& pattern) {
    return browser_->becomes("return /" + pattern + "/.test(document.getElementById('" + id +
                             "').textContent)");
  }
  bool visible(const std::string& selector) {
    return js("return document.querySelector('" + selector + "').checkVisibility()").get<bool>();
  }
  /// Clicks at corners: pixels to the right of the map's middle, and below it.
  void draw_polygon(const std::vector<std::pair<int, int>>& corners) {
    browser_->click("#tool [data-value=polygon]");
    for (const auto& [right, down] : corners) browser_->drag("#drawn", 0, 0, right, down);
    browser_->drag("#drawn", 0, 0, corners[0].first, corners[0].second);
  }
  /// Both presses in one script, so that no machine is too slow for the second one.
  void send() {
    js("const button = document.getElementById('sendTarget'); button.click(); button.click()");
  }
  nlohmann::json drawn(const std::string& what) { return js("return ergocast.S.drawing" + what); }
  void end_mission() {
    mission_->send(SIGINT);
    ASSERT_TRUE(eventually([&] { return printed("until Ctrl-C"); })) << printed();
    mission_->send(SIGINT);
    EXPECT_EQ(wait_for(*mission_), 0) << printed();
  }

  std::optional<Child> mission_;
};

TEST_F(DrawnTargetInABrowser, IsMovedComparedAndSent) {
  open_page(true);
  EXPECT_EQ(js("return document.getElementById('sendTarget').disabled"), true);
  browser_->drag("#drawn", 60, 0);  // centre and spread
  ASSERT_EQ(drawn(".parts.length"), 1);
  const double pixel_m = 1 / js("return ergocast.view.scale").get<double>();
  EXPECT_NEAR(drawn(".parts[0].at[0]"), 1000, pixel_m);
  EXPECT_NEAR(drawn(".parts[0].spread"), 60 * pixel_m, 1.5 * pixel_m);
  browser_->drag("#drawn", 40, -80);  // the whole peak
  EXPECT_EQ(drawn(".parts.length"), 1);
  EXPECT_NEAR(drawn(".parts[0].at[0]"), 1000 + 40 * pixel_m, 1.5 * pixel_m);
  EXPECT_NEAR(drawn(".parts[0].at[1]"), 1000 + 80 * pixel_m, 1.5 * pixel_m);
  EXPECT_NEAR(drawn(".parts[0].spread"), 60 * pixel_m, 1.5 * pixel_m);
  browser_->drag("#drawn", 30, 0, 100, -80);  // its rim
  EXPECT_NEAR(drawn(".parts[0].spread"), 90 * pixel_m, 3 * pixel_m);
  draw_polygon({{-200, 100}, {-80, 100}, {-80, 200}, {-200, 200}});
  EXPECT_EQ(drawn(".parts.length"), 2);
  EXPECT_TRUE(becomes("drawnText",
                      "by now: [\\d.].* against this target, .* against the present one. "
                      "[\\d.]+\\u00a0% of its mass is elsewhere"));
  EXPECT_FALSE(visible("#commandBox"));
  screenshot("drawing");
  // The page has computed the modes that the team then gets.
  js("window.preview = [...ergocast.S.drawing.mu]");
  send();
  EXPECT_TRUE(
      becomes("controlText", "^new target: amendment 0, target \\w+, holds (from|since) tick"))
      << text("controlText");
  EXPECT_TRUE(browser_->becomes("return ergocast.S.drawing === null"));
  EXPECT_FALSE(visible("#drawing"));
  EXPECT_TRUE(becomes("controlText", "holds since tick"));
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.targets.length === 2"));
  EXPECT_LT(js("return Math.max(...ergocast.S.run.targets[1].coefficients.map("
               "(v, k) => Math.abs(v - preview[k])))")
                .get<double>(),
            0.02);
  EXPECT_TRUE(
      browser_->becomes("return [...document.querySelectorAll('#strip button')].some(mark => "
                        "mark.title.startsWith('amendment 0: new target at '))"));
  screenshot("drawing_sent");
  EXPECT_TRUE(printed("control: an operator without a name asks for: new target, at tick"));
  expect_no_errors();
  end_mission();
}

TEST_F(DrawnTargetInABrowser, IsRefusedWithTheWordsOfTheCommand) {
  open_page(true);
  draw_polygon({{-100, -100}, {100, 100}, {100, -100}, {-100, 100}});  // two sides cross
  ASSERT_EQ(drawn(".parts.length"), 1);
  send();
  EXPECT_TRUE(becomes("controlText", "^new target: target.regions\\[0\\].polygon.*cross"))
      << text("controlText");
  EXPECT_EQ(js("return document.getElementById('controlText').className"), "outcome bad");
  EXPECT_EQ(drawn(".parts.length"), 1);  // it can be mended
  screenshot("drawing_refused");
  EXPECT_EQ(js("return ergocast.S.run.amendments.length"), 0);
  browser_->click("#release");
  EXPECT_TRUE(becomes("whyCommand", "^Take control to send it"));
  expect_no_errors();
  end_mission();
}

TEST_F(DrawnTargetInABrowser, WithoutControlThePageShowsTheCommand) {
  open_page(false);
  // The same with keys.
  js("document.getElementById('drawn').focus()");
  browser_->press("\uE007");  // Enter
  browser_->press("\uE014");  // right
  ASSERT_EQ(drawn(".parts.length"), 1);
  EXPECT_NEAR(drawn(".parts[0].at[0]"), 1020, 1e-6);
  EXPECT_FALSE(visible("#sendTarget"));
  ASSERT_TRUE(visible("#targetCommand"));
  screenshot("drawing_command");
  browser_->resize(400, 800);
  wait_for_frame();
  EXPECT_EQ(js("return document.documentElement.scrollWidth <= innerWidth"), true);
  browser_->resize(1300, 900);
  wait_for_frame();
  EXPECT_TRUE(text("whyCommand").starts_with("This page only shows.")) << text("whyCommand");
  Child command = begin({"/bin/sh", "-c",
                         "cd " + folder_.string() + " && PATH=" + program_folder().string() +
                             ":$PATH && " + text("targetCommand") + " --dry-run"});
  EXPECT_EQ(wait_for(command), 0) << output();
  EXPECT_NE(output().find("no problems: target "), std::string::npos) << output();
  EXPECT_NE(text_of(folder_ / "target.textproto").find("mean_x_m: 1020  mean_y_m: 1000"),
            std::string::npos)
      << text_of(folder_ / "target.textproto");
  browser_->press("\uE017");  // Delete
  EXPECT_EQ(drawn(".parts.length"), 0);
  EXPECT_FALSE(visible("#targetCommand"));
  browser_->click("#closeDrawing");
  EXPECT_FALSE(visible("#drawn"));
  expect_no_errors();
  end_mission();
}

}  // namespace
}  // namespace ergocast::test
