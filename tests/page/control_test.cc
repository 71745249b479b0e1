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
  EXPECT_TRUE(becomes("holder", "The mission has ended"));
  for (const char* id : {"controlText", "controlSpoken"})
    EXPECT_TRUE(becomes(id, "^stop by anna: the mission has ended at tick \\d+.*stopped by anna"))
        << text(id);
  for (const char* id : {"#stopNow", "#take", "#orders"}) EXPECT_FALSE(visible(id)) << id;
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
  js("document.getElementById('operatorName').value = 'anna'");
  browser_->click("#stopNow");  // also without control
  // What it has achieved stays on the page of the record, too.
  EXPECT_TRUE(browser_->becomes("return ergocast.S.live === false"));
  for (const char* id : {"controlText", "controlSpoken"})
    EXPECT_TRUE(becomes(id, "^stop now by anna: stopped at tick \\d+.*: all stand still"))
        << text(id);
  EXPECT_TRUE(visible("#controlText"));
  EXPECT_EQ(js("return ergocast.S.run.tracks.map(({ id }) => ergocast.course(id)).every(c => c === "
               "null)"),
            true);
  EXPECT_EQ(js("return [...new Set([...document.querySelectorAll('#rows td:nth-child(3)')].map("
               "td => td.textContent))].join()"),
            "0.0 m/s");
  js("scrollTo(0, 0)");
  screenshot("control_stopped");
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
  EXPECT_TRUE(becomes("controlText", "stopped at tick"));
  end_with_the_mission();
  expect_no_errors();
}

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

TEST_F(ControlledPage, ShowsEachOrderThatFailedOrIsUnfinishedAndSpeaksItOnce) {
  control();
  js("window.spoken = [];"
     "new MutationObserver(() => spoken.push(document.getElementById('controlSpoken').textContent))"
     ".observe(document.getElementById('controlSpoken'),"
     " { childList: true, characterData: true, subtree: true });"
     "window.act = (number, what, state, over, text) =>"
     " ({ operator: 5, name: 'bert', number, what, at: '', state, over, text });"
     "window.show = acts => ergocast.showControl({ operator: null, acts, refused: [] })");
  // Shown and read in one script: the next message of the real team shows its own orders.
  js("window.texts = acts => { show(acts);"
     " const acted = [...document.querySelectorAll('#controlActs li')].map(li => li.textContent);"
     " return [document.getElementById('controlText').textContent, ...acted].join('|'); }");
  EXPECT_EQ(js("return texts([act(1, 'agent 3 home', 'failed', true, 'agent 3 does not report it'),"
               " act(2, 'pause', 'done', true, 'paused'),"
               " act(3, 'agent 1 home', 'obeyed', false, 'leaves'),"
               " act(4, 'resume', 'sent', false, 'no answer yet')])"),
            "resume by bert: no answer yet|agent 1 home by bert: leaves|"
            "agent 3 home by bert: agent 3 does not report it");
  screenshot("control_acts");
  EXPECT_EQ(js("return texts([act(1, 'agent 3 home', 'failed', true, 'agent 3 does not report it'),"
               " act(4, 'resume', 'sent', false, 'still no answer'),"
               " act(5, 'agent 3 home', 'done', true, 'agent 3 rests')])"),
            "agent 3 home by bert: agent 3 rests|resume by bert: still no answer");
  EXPECT_EQ(js("return spoken.filter(text => text.includes('no answer')).length"), 1);
  EXPECT_EQ(js("return spoken.filter(text => text.includes('agent 3')).length"), 2);
  browser_->click("#stopNow");
  end_with_the_mission();
}

// The server's answers are the test's own; it obeys nothing but a stop.
TEST_F(ControlledPage, SaysWhatBecameOfEachOrder) {
  control();
  take_control();
  js("const real = window.fetch; window.answer = { status: 503 }; window.numbers = [];"
     "window.fetch = (url, options) => {"
     " if (url !== 'control') return real(url, options);"
     " const { act, number, operator } = JSON.parse(options.headers['X-Ergocast-Request']);"
     " if (['here', 'stop-now'].includes(act)) return real(url, options);"
     " numbers.push(number); window.operator = operator;"
     " return answer ? Promise.resolve(new Response('busy', answer)) :"
     "   Promise.reject(new TypeError('lost')); }");
  // Shown and read in one script: the next message of the real team shows its own orders.
  js("window.show = (acts, refused) => {"
     " ergocast.showControl({ operator: { id: operator }, refused: refused.map(one =>"
     "   ({ operator, ...one })), acts: acts.map(one =>"
     "   ({ operator, name: '', at: '', over: true, state: 'done', text: 'yes', ...one })) });"
     " return ['controlText', 'controlNotice'].map(id =>"
     "   document.getElementById(id).textContent).join('|'); }");
  order("pause");
  EXPECT_TRUE(becomes("controlNotice", "^Pause: not sent: busy$"));
  EXPECT_EQ(text("controlText"), "Pause: not sent");

  js("answer = { status: 202 }");
  order("resume");
  EXPECT_EQ(text("controlText"), "Resume: sent");
  EXPECT_EQ(js("return show([], [{ number: numbers[1], what: 'resume', text: 'too late' },"
               " { operator: 5, number: 1, what: 'pause', text: 'bert has control' }])"),
            "Resume: refused|Resume: refused: too late");

  // It is not known whether it was received: the next press repeats it under its number.
  js("answer = null");
  order("pause");
  EXPECT_TRUE(becomes("controlNotice", "^Pause: not answered. Press again: it is obeyed once.$"));
  EXPECT_EQ(text("controlText"), "Pause: not answered");
  js("answer = { status: 503 }");
  order("pause");
  EXPECT_TRUE(becomes("controlNotice", "^Pause: not answered. Press again"));
  js("answer = { status: 202 }");
  order("pause");
  EXPECT_EQ(js("return new Set(numbers.slice(2)).size"), 1);
  EXPECT_TRUE(becomes("controlNotice", "^Pause: not answered. Press again"));  // nor is this one
  EXPECT_EQ(js("return show([{ number: numbers[2], what: 'pause' }], [])"), "pause: yes|");
  order("pause");
  EXPECT_GT(js("return numbers.at(-1)"), js("return numbers[2]"));

  // It can no longer be obeyed, because a later one was.
  order("resume");
  EXPECT_EQ(js("return show([{ number: numbers.at(-1), what: 'resume' }], [])"),
            "resume: yes|Pause: not obeyed, because a later order came first. Press again.");
  browser_->click("#stopNow");
  end_with_the_mission();
}

// A flood of connections, or a page's process that is started again, may cost requests.
TEST_F(ControlledPage, StopNowIsRepeatedByItselfUntilItIsAnswered) {
  control();
  js("const real = window.fetch; window.tries = [];"
     "window.fetch = (url, options) => {"
     " if (url !== 'control') return real(url, options);"
     " tries.push(JSON.parse(options.headers['X-Ergocast-Request']).number);"
     " return tries.length < 4 ? Promise.reject(new TypeError('lost')) : real(url, options); }");
  browser_->click("#stopNow");
  EXPECT_TRUE(becomes("controlText", "no answer yet, sent \\d times|stopped at"));
  EXPECT_TRUE(becomes("controlText", "stopped at tick .*: all stand still"));
  EXPECT_EQ(js("return tries.length >= 4 && new Set(tries).size"), 1);
  end_with_the_mission();
  const std::string text = printed(), asks = "asks for: stop now";
  EXPECT_NE(text.find(asks), text.npos);
  EXPECT_EQ(text.find(asks), text.rfind(asks)) << text;
}

TEST_F(ControlledPage, SignsOfTheBrowserAreNoOrders) {
  control();
  take_control();
  const std::string spoken = text("controlSpoken");
  js("const real = window.fetch; let count = 0;"
     "window.fetch = (...all) => count++ ? real(...all) : Promise.reject(new TypeError('lost'));"
     "window.notices = []; const node = document.getElementById('controlNotice');"
     "new MutationObserver(() => notices.push(node.textContent))"
     ".observe(node, { childList: true, characterData: true, subtree: true })");
  // A slow machine may cause a notice of its own before.
  EXPECT_TRUE(
      browser_->becomes("const lost = notices.findIndex(text => text.startsWith("
                        "'The server does not receive')); return lost >= 0 && "
                        "notices.indexOf('', lost) > lost"));
  EXPECT_EQ(text("controlSpoken"), spoken);
  browser_->click("#stopNow");
  end_with_the_mission();
}

// As a command of another operator does, of which this page knows nothing.
TEST_F(ControlledPage, ShowsWhatWasOrderedElsewhere) {
  control();
  take_control();
  const std::string other = "by [^ ]+@[^ ]+, on another page or by a command: ";
  EXPECT_EQ(ergocast({"pause"}), 0) << output();
  EXPECT_TRUE(becomes("controlText", "^pause " + other + "from tick \\d+")) << text("controlText");
  EXPECT_TRUE(becomes("pause", "“Resume” lets it go on"));
  order("resume");
  EXPECT_TRUE(becomes("controlText", "^resume: the mission goes on at tick"))
      << text("controlText");
  EXPECT_EQ(ergocast({"recall", "2"}), 0) << output();
  EXPECT_TRUE(becomes("controlText",
                      "^agent 2 home by another operator, on another page or by a command: "))
      << text("controlText");
  EXPECT_FALSE(printed("resume by ")) << printed();
  browser_->click("#stopNow");
  end_with_the_mission();
}

// A vehicle with inertia moves for seconds after the pause.
TEST_F(ControlledPage, ShowsCommandsAndWhatStillMovesInAPause) {
  control(
      {},
      "world { speed_limit_mps: 25 }\nvehicle { kind: ACCELERATION max_acceleration_mps2: 0.7 }\n",
      2);  // vehicles brake for a quarter of a minute, in which a slow browser sees them
  take_control();
  EXPECT_TRUE(
      browser_->becomes("const { tracks } = ergocast.S.run; return tracks.length === 4 && "
                        "tracks.every(({ id }) => ergocast.command(id)?.long > 0)"));
  screenshot("control_commands");
  js("window.moving = false; const rows = document.getElementById('rows');"
     "new MutationObserver(() => { moving ||= rows.textContent.includes('paused: still moves'); })"
     ".observe(rows, { childList: true, characterData: true, subtree: true })");
  order("pause");
  EXPECT_TRUE(browser_->becomes("return moving"));
  EXPECT_TRUE(browser_->becomes(
      "return ergocast.S.run.tracks.every(({ id }) => ergocast.command(id) === null)"));
  screenshot("control_moving");
  EXPECT_TRUE(becomes("controlText", "4 of 4 stand$"));
  EXPECT_TRUE(
      browser_->becomes("return [...document.querySelectorAll('#rows td')].every(td => "
                        "td.textContent !== 'paused: still moves')"));
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
  EXPECT_TRUE(becomes("controlNotice", "bert has taken control from you"));
  EXPECT_FALSE(visible("#orders"));
  // Taking over takes control away from somebody, so it needs two presses.
  EXPECT_EQ(
      js("const take = document.getElementById('take'); take.click(); return take.textContent"),
      "Again: Take over");
  // His browser is silent, so he loses it, and the mission goes on.
  EXPECT_TRUE(becomes("holder", "No operator has control"));
  EXPECT_EQ(text("controlNotice"), "bert has taken control from you.");  // it stays
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
  js("const { S } = ergocast, ticks = window.ticks = []; let facts = S.facts;"
     "Object.defineProperty(S, 'facts', { get: () => facts, set(value) { facts = value;"
     " ticks.push(value?.state?.world_tick ?? null); } })");
  signal_to({"ergocast run-page"}, SIGSTOP);
  order("pause");
  kill_next({"ergocast run-page"});
  ASSERT_TRUE(
      becomes("control", "4 of 4 stand|[Nn]ot answered|not sent|refused|control from|no longer"))
      << text("control");
  if (text("controlText").find("stand") == std::string::npos) {
    if (text("holder") != "You have control") take_control();
    order("pause");
  }
  EXPECT_TRUE(becomes("controlText", "4 of 4 stand"));
  // After the new connection, too, each order names a tick.
  EXPECT_EQ(js("return ticks.includes(null)"), false) << js("return ticks");
  browser_->click("#stopNow");
  end_with_the_mission();
  EXPECT_EQ(summary()["restarts"], 0);  // the mission has not noticed
}

}  // namespace
}  // namespace ergocast::test
