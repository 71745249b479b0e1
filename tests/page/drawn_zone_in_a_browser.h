// SPDX-License-Identifier: BSD-3-Clause
// A zone that is drawn on the page of a real-time team, sent, and looked for in the record.
#pragma once

#include <cmath>
#include <string>

#include "tests/page/drawing_in_a_browser.h"
#include "tests/process/support/record.h"

namespace ergocast::test {

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

}  // namespace ergocast::test
