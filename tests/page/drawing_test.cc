// SPDX-License-Identifier: BSD-3-Clause
// A new target is drawn on the map of a real-time team's page. With control it is sent; without,
// the page shows the command.
#include "tests/page/drawing_in_a_browser.h"

namespace ergocast::test {
namespace {

class DrawnTargetInABrowser : public DrawingInABrowser {
 protected:
  void draw_polygon(const std::vector<std::pair<int, int>>& corners) {
    browser_->click("#tool [data-value=polygon]");
    click_corners(corners);
  }
};

TEST_F(DrawnTargetInABrowser, IsMovedComparedAndSent) {
  open_page(Control::kTaken);
  browser_->click("#drawTarget");
  EXPECT_EQ(js("return document.getElementById('sendDrawn').disabled"), true);
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
                      "so far: [\\d.].* against this target, .* against the present one. "
                      "[\\d.]+\\u00a0% of the mass is elsewhere"));
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

TEST_F(DrawnTargetInABrowser, IsShownAsSentUntilTheServerShowsIt) {
  open_page(Control::kTaken);
  const int before = received();
  js("const real = window.fetch; window.fetch = (url, options) => {"
     " if (url !== 'control') return real(url, options);"
     " window.id = JSON.parse(options.headers['X-Ergocast-Request']).operator;"
     " return real(url, options); }");
  browser_->click("#drawTarget");
  browser_->drag("#drawn", 60, 0);
  EXPECT_EQ(
      js("const button = document.getElementById('sendDrawn'); button.click(); button.click();"
         "ergocast.showControl({ operator: { id }, refused: [], acts: [{ operator: 1, number: 1,"
         "  name: 'anna', what: 'pause', over: true, state: 'done', text: 'all stand' }] });"
         "return document.getElementById('controlText').textContent"),
      "New target: sent");
  expect_received(before + 1);
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.targets.length === 2"));
  EXPECT_TRUE(browser_->becomes("return ergocast.S.drawing === null"));
  expect_no_errors();
  end_mission();
}

TEST_F(DrawnTargetInABrowser, IsRefusedWithTheWordsOfTheCommand) {
  open_page(Control::kTaken);
  browser_->click("#drawTarget");
  draw_polygon({{-100, -100}, {100, 100}, {100, -100}, {-100, 100}});  // two sides cross
  ASSERT_EQ(drawn(".parts.length"), 1);
  send();
  EXPECT_TRUE(becomes("controlText", "^new target: target.regions\\[0\\].polygon.*cross"))
      << text("controlText");
  EXPECT_EQ(js("return document.getElementById('controlText').className"), "outcome bad");
  EXPECT_EQ(drawn(".parts.length"), 1);  // it can be mended
  screenshot("drawing_refused");
  EXPECT_EQ(js("return ergocast.S.run.amendments.length"), 0);
  // Nor does the target of another operator close it.
  ASSERT_EQ(ergocast({"amend", "--set", "target.uniform_weight=0.3"}), 0) << output();
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.targets.length === 2"));
  draws();
  EXPECT_EQ(drawn("?.parts.length"), 1);
  browser_->click("#release");
  EXPECT_TRUE(becomes("whyCommand", "^Take control to send it"));
  expect_no_errors();
  end_mission();
}

TEST_F(DrawnTargetInABrowser, WithoutControlThePageShowsTheCommand) {
  open_page(Control::kNone);
  browser_->click("#drawTarget");
  // The same with keys.
  js("document.getElementById('drawn').focus()");
  browser_->press("\uE007");  // Enter
  browser_->press("\uE014");  // right
  ASSERT_EQ(drawn(".parts.length"), 1);
  EXPECT_NEAR(drawn(".parts[0].at[0]"), 1020, 1e-6);
  EXPECT_FALSE(visible("#sendDrawn"));
  ASSERT_TRUE(visible("#drawnCommand"));
  screenshot("drawing_command");
  browser_->resize(400, 800);
  wait_for_frame();
  EXPECT_EQ(js("return document.documentElement.scrollWidth <= innerWidth"), true);
  browser_->resize(1300, 900);
  wait_for_frame();
  EXPECT_TRUE(text("whyCommand").starts_with("This page only shows.")) << text("whyCommand");
  EXPECT_EQ(try_command(), 0) << output();
  EXPECT_NE(output().find("no problems: target "), std::string::npos) << output();
  EXPECT_NE(text_of(folder_ / "target.textproto").find("mean_x_m: 1020  mean_y_m: 1000"),
            std::string::npos)
      << text_of(folder_ / "target.textproto");
  browser_->press("\uE017");  // Delete
  EXPECT_EQ(drawn(".parts.length"), 0);
  EXPECT_FALSE(visible("#drawnCommand"));
  browser_->click("#closeDrawing");
  EXPECT_FALSE(visible("#drawn"));
  expect_no_errors();
  end_mission();
}

TEST_F(DrawnTargetInABrowser, InABoxHasHeightsAndIsCompared) {
  open_page(Control::kTaken, scenario_file("cube_corners"));
  browser_->click("#drawTarget");
  browser_->press("\uE007");  // Enter
  EXPECT_EQ(drawn(".parts[0].z"), 500);
  type("lowZ", "700");
  draw_polygon({{-100, 50}, {-20, 50}, {-20, 150}, {-100, 150}});
  type("lowZ", "200");
  type("highZ", "400");
  EXPECT_TRUE(becomes("drawnText", "[\\d.]+\\u00a0% of the mass is elsewhere"))
      << text("drawnText");
  screenshot("drawing_box");
  js("window.preview = [...ergocast.S.drawing.mu]");
  send();
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.targets.length === 2"))
      << text("controlText");
  EXPECT_TRUE(browser_->becomes("return ergocast.S.drawing === null"));
  EXPECT_LT(js("return Math.max(...ergocast.S.run.targets[1].coefficients.map("
               "(v, k) => Math.abs(v - preview[k])))")
                .get<double>(),
            0.03);
  expect_no_errors();
  end_mission();
}

}  // namespace
}  // namespace ergocast::test
