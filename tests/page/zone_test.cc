// SPDX-License-Identifier: BSD-3-Clause
// A zone is drawn on the map of a real-time team's page. With control it is sent; without, the page
// shows the command.
#include <cmath>

#include "tests/page/drawing_in_a_browser.h"
#include "tests/process/support/record.h"
#include "tests/support/http.h"

namespace ergocast::test {
namespace {

class DrawnZoneInABrowser : public DrawingInABrowser {
 protected:
  /// A square of 1600 m round all peaks of the target, so that agents are inside.
  void draw_large_square() {
    const auto half =
        static_cast<int>(std::lround(800 * js("return ergocast.view.scale").get<double>()));
    click_corners({{-half, half}, {half, half}, {half, -half}, {-half, -half}});
    ASSERT_EQ(drawn(".parts.length"), 1);
  }
  /// Draws a square in the middle by keys, and sends it.
  void send_small_square() {
    browser_->click("#drawZone");
    browser_->press("\uE007");  // Enter
    ASSERT_EQ(drawn(".parts.length"), 1);
    type("zoneFor", "1000000");  // on a slow machine, too, it lasts longer than the test
    send();
  }
  /// Whether an agent is well inside the large square.
  static constexpr const char* kOneInside =
      "return ergocast.S.facts.state.agents.some(({ position_m: [x, y] }) =>"
      " x > 300 && x < 1700 && y > 300 && y < 1700)";
  /// Loses the next request for a zone. For the one that follows it the page runs `then`, in which
  /// first() sends the lost one and second() this one.
  void lose_next_zone(const std::string& then) {
    js("const real = window.fetch, key = 'X-Ergocast-Request'; let lost = null, late = false;"
       // On a slow machine the tick would be too old by then.
       "const sending = options => () => { const { tick, ...more } ="
       "  JSON.parse(options.headers[key]), { world_tick } = ergocast.S.facts.state;"
       " return real('control', { ...options, signal: null, headers: { ...options.headers,"
       "  [key]: JSON.stringify({ ...more, tick: world_tick }) } }); };"
       "window.fetch = async (url, options) => {"
       " if (url !== 'control' || late || JSON.parse(options.headers[key]).act !== 'zone')"
       "  return real(url, options);"
       " if (!lost) { lost = options; throw new TypeError('lost'); }"
       " late = true; const first = sending(lost), second = sending(options); " +
       then + " }");
  }
  /// The record's newest amendment.
  nlohmann::json recorded_zone() const {
    return nlohmann::json::parse(text_of(out() / "amendments.json"))["amendments"].back();
  }
  std::string spoken() { return text("spoken"); }
  /// Sends a zone whose request is lost, changes it and sends it again.
  void send_changed() {
    browser_->click("#drawZone");
    browser_->press("\uE007");  // Enter
    type("zoneFor", "1000000");
    press_send();
    EXPECT_TRUE(becomes("controlNotice", "^New zone: not answered. Press again"));
    browser_->press("c");       // the first corner
    browser_->press("\uE012");  // left
    EXPECT_EQ(drawn(".parts[0].corners[0]"), nlohmann::json({780, 800}));
    press_send();
  }

  static constexpr const char* kCancel = "#zoneList button";
};

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

TEST_F(DrawnZoneInABrowser, OfARequestWithoutTheTokenIsNone) {
  open_page(Control::kTaken);
  const auto post = [&](const std::string& token, std::uint32_t id) {
    const nlohmann::json request = {
        {"operator", id},
        {"name", "eve"},
        {"number", 1},
        {"tick", js("return ergocast.S.facts.state.world_tick")},
        {"act", "zone"},
        {"zone", {{"corners_m", {{800, 800}, {1200, 800}, {1000, 1200}}}, {"lasts_s", 600}}}};
    std::vector<std::string> lines = {"Host: 127.0.0.1:8821", "Origin: http://127.0.0.1:8821",
                                      "X-Ergocast-Request: " + request.dump()};
    if (!token.empty()) lines.push_back("X-Ergocast-Token: " + token);
    return http(8821, "POST", "/control", lines).status;
  };
  EXPECT_EQ(post("", 5), 403);
  EXPECT_EQ(post(std::string(32, '0'), 5), 403);
  // The token alone does not suffice: another operator has control.
  const std::string token = address().substr(address().find('=') + 1);
  EXPECT_EQ(post(token, 5), 202);
  EXPECT_TRUE(eventually([&] {
    return printed(
        "control: eve asks for: new zone: refused: an operator without a name has control now");
  })) << printed();
  // The same process goes on to answer, and no zone has come.
  send_small_square();
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.zones.length === 1"));
  end_mission();
  const auto amendments = nlohmann::json::parse(text_of(out() / "amendments.json"))["amendments"];
  EXPECT_EQ(amendments.size(), 1U) << amendments;
  EXPECT_EQ(recorded_zone()["corners_m"].size(), 4U);
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

// A request is slow: it arrives after the next press.
TEST_F(DrawnZoneInABrowser, IsNotDoubledByAPressAfterAnOrderWithoutAnAnswer) {
  open_page(Control::kTaken);
  js("const real = window.fetch; let slow = null; window.late = false;"
     "window.fetch = async (url, options) => {"
     " if (url !== 'control') return real(url, options);"
     " const { act } = JSON.parse(options.headers['X-Ergocast-Request']);"
     " if (act !== 'zone' || late) return real(url, options);"
     " if (!slow) { slow = options; throw new TypeError('lost'); }"
     " late = true; await real(url, { ...slow, signal: null });"
     " await new Promise(done => { window.repeat = done; });"
     " const answer = await real(url, { ...options, signal: null });"
     " window.repeated = true; return answer; }");
  browser_->click("#drawZone");
  browser_->press("\uE007");  // Enter
  type("zoneFor", "1000000");
  press_send();
  EXPECT_TRUE(becomes("controlNotice", "^New zone: not answered. Press again"));
  send();
  ASSERT_TRUE(eventually([&] { return printed("control: new zone of"); })) << printed();
  js("repeat()");
  EXPECT_TRUE(browser_->becomes("return window.repeated"));
  // An order that comes later is answered.
  browser_->click("#release");
  EXPECT_TRUE(becomes("holder", "No operator has control"));
  EXPECT_EQ(received(), 1) << printed();
  expect_no_errors();
  end_mission();
}

// The first request arrives after all, before the changed one: it alone is obeyed.
TEST_F(DrawnZoneInABrowser, IsNotDoubledByAChangeAfterAnOrderWithoutAnAnswer) {
  open_page(Control::kTaken);
  lose_next_zone(
      "await first(); await new Promise(done => { window.go = done; });"
      "return second();");
  send_changed();
  ASSERT_TRUE(browser_->becomes("return ergocast.S.run.zones.length === 1")) << printed();
  ASSERT_TRUE(eventually([&] { return printed("control: new zone of"); })) << printed();
  js("go()");
  EXPECT_TRUE(becomes("controlNotice", "^New zone: refused: an earlier drawing has arrived"))
      << text("controlNotice") << printed();
  EXPECT_EQ(received(), 1) << printed();
  EXPECT_EQ(js("return ergocast.S.run.zones[0].corners_m[0]"), nlohmann::json({800, 800}));
  // The person has seen it, and wants the other one, too.
  send();
  EXPECT_TRUE(browser_->becomes("return ergocast.S.run.zones.length === 2")) << printed();
  expect_no_errors();
  end_mission();
}

// The changed one comes first, so the first one is too late.
TEST_F(DrawnZoneInABrowser, AChangedOneReplacesAnOrderThatWasLost) {
  open_page(Control::kTaken);
  lose_next_zone(
      "const answer = await second(); await first(); window.both = true; return answer;");
  js("window.notices = []; const node = document.getElementById('controlNotice');"
     "new MutationObserver(() => notices.push(node.textContent))"
     ".observe(node, { childList: true, characterData: true, subtree: true })");
  send_changed();
  ASSERT_TRUE(browser_->becomes("return window.both && ergocast.S.run.zones.length === 1"))
      << printed();
  EXPECT_EQ(js("return ergocast.S.run.zones[0].corners_m[0]"), nlohmann::json({780, 800}));
  EXPECT_TRUE(browser_->becomes("return ergocast.S.drawing === null"));
  // An order that comes later is answered.
  browser_->click("#release");
  EXPECT_TRUE(becomes("holder", "No operator has control"));
  EXPECT_EQ(received(), 1) << printed();
  EXPECT_EQ(js("return notices.filter(text => /refused|not obeyed/.test(text))"),
            nlohmann::json::array());
  expect_no_errors();
  end_mission();
}

TEST_F(DrawnZoneInABrowser, IsCancelledAndAgentsEnterAgain) {
  open_page(Control::kTaken);
  browser_->click("#drawZone");
  draw_large_square();
  type("zoneFor", "1000000");
  send();
  ASSERT_TRUE(becomes("zoneList", "^Zone 0: closed, \\d+ h \\d+ min left Cancel zone 0$"))
      << text("zoneList");
  ASSERT_TRUE(visible(kCancel));
  EXPECT_EQ(js(kOneInside), false);
  // One press alone cancels nothing.
  js(std::string("document.querySelector('") + kCancel + "').focus()");
  browser_->press("\uE007");  // Enter
  EXPECT_TRUE(becomes("controlSpoken", "Press again within 3 seconds: Cancel zone 0"));
  screenshot("zone_cancel");
  EXPECT_TRUE(becomes("zoneList", "Cancel zone 0$"));
  EXPECT_TRUE(browser_->becomes("return !document.querySelector('.armed')"));
  EXPECT_FALSE(printed("asks for: cancel")) << printed();

  send(kCancel);
  EXPECT_TRUE(becomes("controlText",
                      "^cancel zone 0: amendment 1, the end of the zone of amendment 0, holds"))
      << text("controlText");
  EXPECT_TRUE(becomes("spoken", "^(Zone 0 has ended|zone cancelled at )")) << spoken();
  EXPECT_TRUE(becomes("zoneList", "^$")) << text("zoneList");
  EXPECT_FALSE(visible("#cancelBox"));
  EXPECT_EQ(js("return document.activeElement.id"), "drawZone");
  EXPECT_TRUE(browser_->becomes(kOneInside));
  screenshot("zone_cancelled");
  EXPECT_EQ(received(), 2) << printed();
  expect_no_errors();
  end_mission();
  EXPECT_EQ(recorded_zone()["kind"], "reopen") << recorded_zone();
  EXPECT_EQ(recorded_zone()["zone"], 0) << recorded_zone();
}

TEST_F(DrawnZoneInABrowser, ACancellationIsRefusedWithTheWordsOfTheCommand) {
  open_page(Control::kTaken);
  send_small_square();
  ASSERT_TRUE(becomes("zoneList", "Cancel zone 0$")) << text("zoneList");
  ASSERT_TRUE(becomes("controlText", "^new zone: amendment 0, .* in it$")) << text("controlText");
  // The page never offers this.
  js("const real = window.fetch; window.fetch = (url, options) => {"
     " const headers = { ...options?.headers }, request = headers['X-Ergocast-Request'];"
     " if (request) headers['X-Ergocast-Request'] ="
     "   request.replace('\"amendment\":0', '\"amendment\":7');"
     " return real(url, { ...options, headers }); }");
  const std::string refused = "Cancel zone 7: refused: there is no amendment 7: ";
  EXPECT_TRUE(eventually([&] {
    press_send(kCancel);
    EXPECT_TRUE(
        browser_->becomes("return /refused|not sent|not answered|control/.test("
                          "document.getElementById('controlNotice').textContent)"));
    if (text("holder") != "You have control") take_control();
    return text("controlNotice").starts_with(refused);
  })) << text("controlNotice");
  EXPECT_EQ(text("controlNotice"), refused + "ergocast amend --list shows them");
  EXPECT_EQ(js("return ergocast.S.run.amendments.length"), 1);
  end_mission();
}

TEST_F(DrawnZoneInABrowser, WithoutControlThePageShowsTheCommandThatCancels) {
  open_page(Control::kNone);
  EXPECT_FALSE(visible("#cancelBox"));
  std::ofstream(folder_ / "zone.textproto")
      << "vertices { x_m: 800 y_m: 800 } vertices { x_m: 1200 y_m: 800 } vertices { x_m: 1200 "
         "y_m: 1200 }";
  for (int i = 0; i < 2; ++i) run_command("ergocast amend --zone zone.textproto --for 1000000s");
  ASSERT_TRUE(
      browser_->becomes("return document.querySelectorAll('#zoneList button').length === 2"))
      << output();
  js(std::string("document.querySelector('") + kCancel + "').click()");
  EXPECT_TRUE(visible("#cancelBox"));
  EXPECT_EQ(js("return document.activeElement.id"), "cancelCommand");
  const std::string command = text("cancelCommand");
  EXPECT_EQ(command, "ergocast amend --run-id " +
                         js("return ergocast.S.facts.run").get<std::string>() + " --cancel 0");
  screenshot("zone_cancel_command");
  browser_->resize(400, 800);
  wait_for_frame();
  EXPECT_EQ(js("return document.documentElement.scrollWidth <= innerWidth"), true);
  screenshot("zone_cancel_command_phone");
  EXPECT_EQ(run_command(command), 0) << output();
  EXPECT_TRUE(becomes("zoneList", "^Zone 1: [^Z]*Cancel zone 1$")) << text("zoneList");
  EXPECT_FALSE(visible("#cancelBox"));
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
