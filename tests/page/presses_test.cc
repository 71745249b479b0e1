// SPDX-License-Identifier: BSD-3-Clause
// Which presses give an order on the page: Stop now by one, all others by two.
#include "tests/page/controlled_page.h"

namespace ergocast::test {
namespace {

// Neither a dialog nor a menu covers it, or takes it away.
TEST_F(ControlledPage, NothingCoversStopNow) {
  control();  // without control it is as wide as the screen
  const auto covering = [&](const std::string& opened) {
    wait_for_frame();
    screenshot("control_under_" + opened);
    return js("const stop = document.getElementById('stopNow'), box = stop.getBoundingClientRect();"
              "const other = [[2, 2], [0.5, 0.5], [-2, -2]].map(([x, y]) =>"
              " document.elementFromPoint(x < 0 ? box.right + x : x < 1 ? (box.left + box.right) / "
              "2 :"
              " box.left + x, y < 0 ? box.bottom + y : y < 1 ? (box.top + box.bottom) / 2 :"
              " box.top + y)).find(node => node !== stop);"
              "return other === undefined ? '' : (other?.id || other?.tagName || 'out of sight')")
        .get<std::string>();
  };
  for (const int width : {400, 1200}) {
    browser_->resize(width, 800);
    for (const char* dialog : {"keys", "details"}) {
      browser_->click(dialog == std::string("keys") ? "#help" : "#detailsButton");
      EXPECT_EQ(covering(std::string(dialog) + std::to_string(width)), "") << dialog << width;
      browser_->press("\uE00C");
      EXPECT_FALSE(visible(std::string("#") + dialog));
    }
    browser_->click("#saveButton");
    EXPECT_EQ(covering("menu" + std::to_string(width)), "") << width;
    EXPECT_TRUE(visible("#savePng"));
    browser_->press("\uE00C");
  }
  browser_->resize(400, 800);
  browser_->click("#help");
  EXPECT_TRUE(becomes("keys", "Stop now: one press"));
  browser_->press("!");  // its key works in a dialog, too
  EXPECT_TRUE(becomes("controlText", "stopped at tick .*: all stand still"));
  end_with_the_mission();
}

// The second press gives the order of the first one, which the button names.
TEST_F(ControlledPage, ASecondPressConfirmsOnlyWhatTheFirstOneNamed) {
  control();
  take_control();
  EXPECT_TRUE(
      browser_->becomes("return document.querySelectorAll('#orderedAgent option').length === 4"));
  const std::string out = button("out");
  const auto press_out = [&](int agent) {
    return js("document.getElementById('orderedAgent').value = " + std::to_string(agent) +
              "; const out = document.querySelector('" + out +
              "'); out.click(); return out.textContent");
  };
  const std::string armed = "return document.querySelector('.armed')?.textContent ?? ''";
  EXPECT_EQ(press_out(2), "Again: agent 2 out");
  EXPECT_EQ(press_out(3), "Again: agent 3 out");
  screenshot("control_armed");
  js("document.getElementById('orderedAgent').dispatchEvent(new Event('change', { bubbles: true "
     "}))");
  EXPECT_EQ(js(armed), "");
  // Another place, the Escape key, and a key that is held.
  press_out(2);
  browser_->click("#holder");
  EXPECT_EQ(js(armed), "");
  press_out(2);
  browser_->press("\uE00C");
  EXPECT_EQ(js(armed), "");
  js("const key = repeat => new KeyboardEvent('keydown', { key: 'Enter', repeat, bubbles: true,"
     " cancelable: true }), out = document.querySelector('" +
     out +
     "');"
     "window.held = [false, true, true].map(repeat => out.dispatchEvent(key(repeat)))");
  EXPECT_EQ(js("return held.join()"), "true,false,false");  // false: the press is taken away
  order("pause");
  EXPECT_TRUE(becomes("controlText", "4 of 4 stand"));
  EXPECT_FALSE(printed("out of the mission")) << printed();
  browser_->click("#stopNow");
  end_with_the_mission();
}

TEST_F(ControlledPage, OnePressAloneGivesNoOrder) {
  control();
  take_control();
  browser_->click(button("pause"));
  EXPECT_TRUE(becomes("controlSpoken", "Press again within 3 seconds"));
  EXPECT_TRUE(browser_->becomes("return document.querySelector('#orders .armed') === null"));
  // A press of another button is a first press, too.
  EXPECT_EQ(js("const pressed = act => document.querySelector(`#orders [data-act=${act}]`).click();"
               "pressed('pause'); pressed('resume');"
               "return document.querySelector('#orders .armed').dataset.act"),
            "resume");
  EXPECT_FALSE(printed("asks for")) << printed();
  browser_->click("#stopNow");
  end_with_the_mission();
}

}  // namespace
}  // namespace ergocast::test
