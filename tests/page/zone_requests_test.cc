// SPDX-License-Identifier: BSD-3-Clause
// Each zone is ordered once, also if requests are lost, late or changed. A stranger orders none.
#include "tests/page/drawn_zone_in_a_browser.h"
#include "tests/support/http.h"

namespace ergocast::test {
namespace {

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

}  // namespace
}  // namespace ergocast::test
