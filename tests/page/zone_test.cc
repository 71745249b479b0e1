// SPDX-License-Identifier: BSD-3-Clause
// A zone is drawn on the map of a real-time team's page. With control it is sent; without, the page
// shows the command.
#include <cmath>

#include "tests/page/drawn_zone_in_a_browser.h"

namespace ergocast::test {
namespace {

TEST_F(DrawnZoneInABrowser, IsChangedSentAndLeft) {
  open_page(Control::kTaken);
  // All agents are inside soon, and the target keeps them there.
  ASSERT_TRUE(browser_->becomes("return ergocast.S.run.end > 150"));
  browser_->click("#drawZone");
  EXPECT_EQ(js("return document.activeElement.id"), "drawn");
  EXPECT_EQ(js("return document.getElementById('sendDrawn').disabled"), true);
  draw_large_square();
  const double pixel_m = 1 / js("return ergocast.view.scale").get<double>();
  const double corner_m = drawn(".parts[0].corners[1][0]");
  EXPECT_NEAR(corner_m, 1800, 1.5 * pixel_m);
  const auto right = static_cast<int>(std::lround(800 / pixel_m));
  browser_->drag("#drawn", 20, 10, right, right);  // the south-eastern corner
  EXPECT_NEAR(drawn(".parts[0].corners[1][0]"), corner_m + 20 * pixel_m, 1.5 * pixel_m);
  EXPECT_EQ(drawn(".parts.length"), 1);
  EXPECT_TRUE(becomes("drawnText", "^[1-4] of 4 agents (is|are) inside now\\.$"))
      << text("drawnText");
  EXPECT_TRUE(becomes("drawnWays", "^To the nearest edge, at least: agent \\d: [\\d.]+ m"))
      << text("drawnWays");
  EXPECT_FALSE(visible("#heights"));
  screenshot("zone_drawing");
  type("zoneFor", "1000000");
  // One press alone sends nothing.
  browser_->click("#sendDrawn");
  EXPECT_TRUE(becomes("controlSpoken", "Press again within 3 seconds: Send"));
  EXPECT_TRUE(becomes("sendDrawn", "^Send$"));
  EXPECT_FALSE(printed("asks for")) << printed();
  const auto corners_m = drawn(".parts[0].corners");
  // Agents leave within seconds: what is shown and read aloud meanwhile is collected.
  js("window.shown = []; for (const id of ['zoneList', 'spoken']) {"
     " const node = document.getElementById(id);"
     " new MutationObserver(() => shown.push(`${id}: ${node.textContent}`))"
     ".observe(node, { childList: true, characterData: true, subtree: true }); }");
  const auto has_shown = [&](const std::string& pattern) {
    return browser_->becomes("return shown.some(text => /" + pattern + "/.test(text))");
  };
  send();
  EXPECT_TRUE(becomes("controlText", "^new zone: amendment 0, zone \\w+, holds (from|since) tick"))
      << text("controlText");
  EXPECT_TRUE(browser_->becomes("return ergocast.S.drawing === null"));
  EXPECT_FALSE(visible("#drawing"));
  EXPECT_TRUE(has_shown("^zoneList: Zone 0: agents leave within \\d+ s")) << text("zoneList");
  EXPECT_TRUE(has_shown("^spoken: Zone 0 is closed: agents leave it within \\d+ s")) << spoken();
  screenshot("zone_leaving");
  // On a slow machine commands come late, and agents leave later.
  EXPECT_TRUE(becomes("controlText", "holds since tick .* in it$")) << text("controlText");
  EXPECT_TRUE(becomes("zoneList", "^Zone 0: closed, \\d+ h \\d+ min left Cancel"))
      << text("zoneList");
  EXPECT_TRUE(becomes("spoken", "^Zone 0 stays closed for .*(No agent is inside|Agents inside: )"))
      << spoken();
  screenshot("zone_closed");
  // A long mission begins again on the page, with fewer rows. That is nothing new to say.
  js("const { S } = ergocast; document.getElementById('spoken').textContent = '';"
     "S.run = Object.assign(Object.create(Object.getPrototypeOf(S.run)), S.run)");
  draws();
  EXPECT_EQ(spoken().find("Zone"), std::string::npos) << spoken();
  EXPECT_TRUE(printed("control: an operator without a name asks for: new zone, at tick"));
  expect_no_errors();
  end_mission();

  const auto zone = recorded_zone();
  EXPECT_EQ(zone["kind"], "zone") << zone;
  ASSERT_EQ(zone["corners_m"].size(), 4U) << zone;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t axis = 0; axis < 2; ++axis)
      EXPECT_NEAR(zone["corners_m"][i][axis], corners_m[i][axis], 0.06) << zone;
  const Tick from = zone["from_tick"];
  EXPECT_EQ(zone["until_tick"].get<Tick>() - from, 10'000'000) << zone;
  int before = 0, after = 0;
  for (const auto& [tick, row] : recorded_rows(out()))
    for (const auto& [id, one] : row)
      if (one.x_m > 205 && one.x_m < 1795 && one.y_m > 205 && one.y_m < 1795)
        ++(tick < from ? before : after);
  EXPECT_TRUE(after == 0 || !all_on_time()) << after;
  EXPECT_GT(before, 0);
}

TEST_F(DrawnZoneInABrowser, IsRefusedWithTheWordsOfTheCommand) {
  open_page(Control::kTaken);
  browser_->click("#drawZone");
  click_corners({{-100, -100}, {100, 100}, {100, -100}, {-100, 100}});  // two sides cross
  EXPECT_TRUE(becomes("drawnText", "^Two of its edges cross"));
  EXPECT_EQ(text("drawnWays"), "");
  send();
  EXPECT_TRUE(becomes("controlText", "^new zone: .*(cross|touch)")) << text("controlText");
  EXPECT_EQ(js("return document.getElementById('controlText').className"), "outcome bad");
  EXPECT_EQ(drawn(".parts.length"), 1);  // it can be mended
  screenshot("zone_refused");

  js("const corners = Array.from({ length: 65 }, (_, i) =>"
     "  [1000 + 300 * Math.cos(i * Math.PI / 32.5), 1000 + 300 * Math.sin(i * Math.PI / 32.5)]);"
     "ergocast.S.drawing.parts[0].corners = corners");
  EXPECT_TRUE(becomes("drawnText", "^It has 65 corners, and a zone at most 64"));
  send();
  EXPECT_TRUE(becomes("controlText", "^new zone: .*has 65 corners, above the limit 64"))
      << text("controlText");

  type("zoneFor", "");
  EXPECT_EQ(text("drawnText"), "Write for how many seconds the zone lasts.");
  EXPECT_EQ(js("return document.getElementById('sendDrawn').disabled"), true);
  EXPECT_EQ(js("return ergocast.S.run.amendments.length"), 0);
  expect_no_errors();
  end_mission();
}

TEST_F(DrawnZoneInABrowser, OverAStationIsRefused) {
  open_page(Control::kTaken, scenario_file("home_by_dusk"));
  browser_->click("#drawZone");
  // One line more beside the map, such as the first command that came too late, would make the map
  // smaller between two presses.
  js("const stage = document.getElementById('stage');"
     "const { width, height } = stage.getBoundingClientRect();"
     "Object.assign(stage.style, { flex: 'none', width: `${width}px`, height: `${height}px` })");
  const double scale = js("return ergocast.view.scale");
  const auto pixels = [scale](double metres) {
    return static_cast<int>(std::lround(metres * scale));
  };
  click_corners({{pixels(-28), pixels(10)},
                 {pixels(-20), pixels(10)},
                 {pixels(-20), pixels(18)},
                 {pixels(-28), pixels(18)}});  // the first station is at (-24, 16)
  send();
  EXPECT_TRUE(becomes("controlText", "^new zone: covers the station of agent 0"))
      << text("controlText");
  EXPECT_EQ(js("return ergocast.S.run.amendments.length"), 0);
  expect_no_errors();
  end_mission();
}

TEST_F(DrawnZoneInABrowser, TheNinthZoneIsRefused) {
  open_page(Control::kTaken);
  for (int i = 0; i < 8; ++i) {
    send_small_square();
    ASSERT_TRUE(
        browser_->becomes("return ergocast.S.run.zones.length === " + std::to_string(i + 1)))
        << text("controlText");
    ASSERT_TRUE(browser_->becomes("return ergocast.S.drawing === null"));
    // The next one waits until this one has its number.
    ASSERT_TRUE(becomes("controlText", "new zone: amendment " + std::to_string(i) + ","))
        << text("controlText");
  }
  // On a fast machine, too, all orders have ended before the next one.
  ASSERT_TRUE(becomes("controlText", "new zone: amendment 7, .* in it$")) << text("controlText");
  ASSERT_TRUE(becomes("controlActs", "^$")) << text("controlActs");
  send_small_square();
  EXPECT_TRUE(becomes("controlText", "new zone: 8 zones are in force, and there can be no more"))
      << text("controlText");
  EXPECT_EQ(drawn(".parts.length"), 1);
  screenshot("zone_ninth");
  expect_no_errors();
  end_mission();
}

TEST_F(DrawnZoneInABrowser, WithoutControlThePageShowsTheCommand) {
  open_page(Control::kNone);
  browser_->click("#drawZone");
  browser_->press("\uE007");  // Enter
  browser_->press("c");       // the first corner
  browser_->press("\uE012");  // left
  browser_->press("c");
  browser_->press("\uE015");  // down
  EXPECT_EQ(drawn(".parts[0].corners"),
            nlohmann::json::parse("[[780, 800], [1200, 780], [1200, 1200], [800, 1200]]"));
  EXPECT_FALSE(visible("#sendDrawn"));
  type("zoneFor", "90.5");
  ASSERT_TRUE(visible("#drawnCommand"));
  screenshot("zone_command");
  browser_->resize(400, 800);
  wait_for_frame();
  EXPECT_EQ(js("return document.documentElement.scrollWidth <= innerWidth"), true);
  screenshot("zone_command_phone");
  browser_->resize(1300, 900);
  wait_for_frame();
  EXPECT_EQ(try_command(), 0) << output();
  EXPECT_TRUE(answered("4 corners, for 90.5 s")) << output();
  EXPECT_EQ(text_of(folder_ / "zone.textproto"),
            "vertices { x_m: 780  y_m: 800 }\nvertices { x_m: 1200  y_m: 780 }\n"
            "vertices { x_m: 1200  y_m: 1200 }\nvertices { x_m: 800  y_m: 1200 }\n");
  browser_->click("#closeDrawing");
  EXPECT_EQ(js("return document.activeElement.id"), "drawZone");
  expect_no_errors();
  end_mission();
}

TEST_F(DrawnZoneInABrowser, InABoxHasItsHeights) {
  open_page(Control::kTaken, scenario_file("cube_corners"));
  browser_->click("#drawZone");
  EXPECT_EQ(js("return ergocast.S.view"), "xy");
  browser_->press("\uE007");  // Enter
  EXPECT_EQ(drawn(".parts[0].heights"), nlohmann::json({0, 1000}));
  type("lowZ", "800");
  type("highZ", "300");
  EXPECT_EQ(text("drawnText"), "The lower height has to be below the upper one.");
  EXPECT_EQ(js("return document.getElementById('sendDrawn').disabled"), true);
  type("lowZ", "100");
  EXPECT_TRUE(becomes("drawnText", "inside now"));
  type("zoneFor", "1000000");
  screenshot("zone_box");
  send();
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.zones.length === 1")) << text("controlText");
  EXPECT_EQ(js("return ergocast.S.run.zones[0].heights_m"), nlohmann::json({100, 300}));
  js("ergocast.showView('xz')");
  EXPECT_TRUE(becomes("zoneList", "^Zone 0: "));
  screenshot("zone_box_xz");
  expect_no_errors();
  end_mission();
  EXPECT_EQ(recorded_zone()["heights_m"], nlohmann::json({100, 300})) << recorded_zone();
}

}  // namespace
}  // namespace ergocast::test
