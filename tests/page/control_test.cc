// SPDX-License-Identifier: BSD-3-Clause
// An operator gives orders on the page of a real-time team, from a window as large as a phone's.
#include "tests/page/page_in_a_browser.h"
#include "tests/support/http.h"
#include "tests/support/tls.h"

namespace ergocast::test {
namespace {

class ControlledPage : public PageInABrowser {
 protected:
  /// Starts a real-time team, and opens its page with the token that permits orders.
  void control(const std::vector<std::string>& more = {}) {
    std::vector<std::string> options{"--watch", "--control", "--port", "8820"};
    options.insert(options.end(), more.begin(), more.end());
    mission_ = launch_endless(scenario("pace: REALTIME realtime_factor: 10"), options);
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

TEST_F(ControlledPage, PausesResumesAndStopsATeamFromAPhonesWindow) {
  control();
  EXPECT_FALSE(visible(button("pause")));  // no operator has control yet
  take_control();
  screenshot("control_phone");
  EXPECT_EQ(js("return document.documentElement.scrollWidth <= innerWidth"), true);

  browser_->click(button("pause"));
  EXPECT_TRUE(becomes("controlSpoken", "Press again within 3 seconds: Pause"));
  order("pause");
  EXPECT_TRUE(becomes("controlText", "paused at tick .*: 4 of 4 stand"));
  EXPECT_TRUE(becomes("controlSpoken", "4 of 4 stand"));
  EXPECT_TRUE(becomes("state", "paused"));
  screenshot("control_paused");
  order("resume");
  EXPECT_TRUE(becomes("controlText", "the mission goes on at tick"));
  EXPECT_TRUE(becomes("state", "running"));

  order("stop");
  EXPECT_TRUE(browser_->becomes("return document.getElementById('control').hidden"));
  end_with_the_mission();
  EXPECT_EQ(summary()["result"], "stopped");
  EXPECT_TRUE(summary()["reason"].get<std::string>().starts_with("stopped by anna on the page of"))
      << summary()["reason"];
  EXPECT_EQ(summary()["holds"].size(), 1U) << summary()["holds"];
  for (const char* line :
       {"control: anna takes control at tick", "control: anna asks for: pause, at",
        "control: pause of anna, asked for at", ": 4 of 4 stand", "control: resume of anna",
        "control: stop of anna"}) {
    EXPECT_NE(text_of(out() / "log/run.log").find(line), std::string::npos) << line;
  }
  expect_no_errors();
}

TEST_F(ControlledPage, SendsOneAgentHomeAndAnotherOneOut) {
  control();
  take_control();
  // The agent that is pinned is the one that is chosen.
  EXPECT_TRUE(
      browser_->becomes("return document.querySelectorAll('#orderedAgent option').length === 4"));
  js("ergocast.pin(2)");
  EXPECT_TRUE(browser_->becomes("return document.getElementById('orderedAgent').value === '2'"));
  order("home");
  EXPECT_TRUE(becomes("controlText", "^agent 2 (is on its way|rests at) home"));
  js("ergocast.pin(-1); document.getElementById('orderedAgent').value = 1");
  order("out");
  EXPECT_TRUE(becomes("controlText", "^agent 1 has left the mission"));
  EXPECT_TRUE(
      browser_->becomes("return ergocast.S.facts.state.agents.some(a => a.id === 2 && "
                        "/home|rest/.test(a.phase))"))
      << js("return ergocast.S.facts.state.agents");
  screenshot("control_recalled");
  order("stop");
  end_with_the_mission();
  EXPECT_EQ(summary()["recalls"].size(), 2U) << summary()["recalls"];
  EXPECT_EQ(summary()["result"], "stopped");
}

TEST_F(ControlledPage, StopsAtOnceWithOnePressThatIsAlwaysInSight) {
  control();
  js("scrollTo(0, document.body.scrollHeight)");
  const auto in_sight =
      js("const box = document.getElementById('stopNow').getBoundingClientRect();"
         "return box.top >= 0 && box.bottom <= innerHeight && box.left >= 0 && "
         "box.right <= innerWidth && box.height >= 40");
  EXPECT_EQ(in_sight, true);
  browser_->click("#stopNow");  // also without control
  end_with_the_mission();
  EXPECT_TRUE(summary()["reason"].get<std::string>().starts_with("stopped at once by "))
      << summary()["reason"];
  EXPECT_TRUE(printed(": all stand still")) << printed();
}

// The address has two tokens: one becomes a cookie and the other stays in the browser.
TEST_F(ControlledPage, GivesOrdersByHttpsWhereOtherHostsReachIt) {
  const auto [certificate, key] = make_certificate(folder_, "page");
  control({"--listen", "127.0.0.2", "--tls-cert", certificate, "--tls-key", key});
  EXPECT_TRUE(address().starts_with("https://127.0.0.2:8820/?token=")) << address();
  EXPECT_EQ(js("return location.href"), "https://127.0.0.2:8820/");
  take_control();
  order("pause");
  EXPECT_TRUE(becomes("controlText", "paused at tick .*: 4 of 4 stand"));
  browser_->click("#stopNow");
  EXPECT_TRUE(browser_->becomes("return document.getElementById('control').hidden"));
  end_with_the_mission();
  expect_no_errors();
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

TEST_F(ControlledPage, AnAddressWithoutItsFragmentOnlyShows) {
  control();
  EXPECT_EQ(js("return location.href"), "http://127.0.0.1:8820/");  // the token is in no history
  browser_->open("http://127.0.0.1:8820/");
  EXPECT_TRUE(browser_->becomes("return !document.getElementById('control')?.hidden"));
  for (const char* id : {"#stopNow", "#take", "#orders"}) EXPECT_FALSE(visible(id)) << id;
  EXPECT_TRUE(visible("#readOnly"));
  EXPECT_EQ(js("return fetch('control', { method: 'POST' }).then(r => r.status)"), 403);
  EXPECT_EQ(js("return [document.cookie, localStorage.length, sessionStorage.length].join()"),
            ",0,0");
  mission_->send(SIGINT);
  end_with_the_mission();
}

TEST_F(ControlledPage, AnotherOperatorTakesOverVisibly) {
  control();
  take_control();
  const std::string token = address().substr(address().find('=') + 1);
  const auto post = [&](const nlohmann::json& request) {
    return http(8820, "POST", "/control",
                {"Host: 127.0.0.1:8820", "Origin: http://127.0.0.1:8820",
                 "X-Ergocast-Token: " + token, "X-Ergocast-Request: " + request.dump()})
        .status;
  };
  const Tick tick = js("return ergocast.S.facts.state.world_tick");
  EXPECT_EQ(
      post({{"operator", 5}, {"name", "bert"}, {"number", 1}, {"tick", tick}, {"act", "take"}}),
      202);
  EXPECT_TRUE(becomes("holder", "bert has control"));
  EXPECT_TRUE(becomes("controlText", "bert has taken control from you"));
  EXPECT_FALSE(visible("#orders"));
  // His browser is silent, so he loses it, and the mission goes on.
  EXPECT_TRUE(becomes("holder", "No operator has control"));
  EXPECT_TRUE(printed("bert loses control at tick")) << printed();
  take_control();
  browser_->click("#release");
  EXPECT_TRUE(becomes("holder", "No operator has control"));
  EXPECT_EQ(js("return ergocast.S.live"), true);
  browser_->click("#stopNow");
  end_with_the_mission();
}

// The connection waits for the process that is started again, or the page says what is unknown.
TEST_F(ControlledPage, APressIsNotLostSilentlyWhenThePagesProcessIsKilled) {
  control();
  take_control();
  signal_to({"ergocast run-page"}, SIGSTOP);
  order("pause");
  kill_next({"ergocast run-page"});
  ASSERT_TRUE(becomes("controlText", "4 of 4 stand|may not have been sent")) << text("controlText");
  if (text("controlText").find("stand") == std::string::npos) {
    if (text("holder") != "You have control") take_control();
    order("pause");
  }
  EXPECT_TRUE(becomes("controlText", "4 of 4 stand"));
  browser_->click("#stopNow");
  end_with_the_mission();
  EXPECT_EQ(summary()["restarts"], 0);  // the mission has not noticed
}

}  // namespace
}  // namespace ergocast::test
