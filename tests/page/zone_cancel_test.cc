// SPDX-License-Identifier: BSD-3-Clause
// The page cancels a zone, or shows the command that does.
#include <fstream>

#include "tests/page/drawn_zone_in_a_browser.h"

namespace ergocast::test {
namespace {

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

}  // namespace
}  // namespace ergocast::test
